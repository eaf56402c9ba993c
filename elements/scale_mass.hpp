#pragma once
/// Mass for elements whose stable step is too short.

#include "elements/base/motion.hpp"
#include "elements/block.hpp"

namespace brio {

/// Gives lanes whose stable step is below that of the block the mass with which it is as long: frequencies go
/// with the root of the mass. What they got is told by `block.scaled` and `block.mass_gain`; their nodes get
/// it after the sweep. \param count lanes that are elements
template <Floating Real, class Header>
void scale_mass(Block& block, Chunk chunk, std::size_t pack, int count, Header& header,
                Lanes<Real>& stable_step, SweepResult& result) {
  using T = Lanes<Real>;
  const T wanted(block.scaled_step);
  const auto is_short = (stable_step < wanted) & (stable_step > T(0.0));
  if (!any(is_short)) return;
  const T ratio = wanted / where(is_short, stable_step, wanted);
  const T before = header.mass;
  header.mass = before * (ratio * ratio);
  stable_step = where(is_short, wanted, stable_step);
  constexpr std::size_t width = lane_count<Real>;
  for (int lane = 0; lane < count; ++lane) {
    if (is_short.v[lane] == 0) continue;
    const std::size_t place = pack * width + static_cast<std::size_t>(lane);
    block.mass_gain[place] = static_cast<double>(header.mass[lane]) - static_cast<double>(before[lane]);
    block.scaled[chunk.first_pack * width + result.scaled++] = static_cast<int>(place);
  }
}

}  // namespace brio
