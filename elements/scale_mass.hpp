#pragma once
/// Mass scaling of elements whose stable time step is too small.

#include "elements/base/motion.hpp"
#include "elements/block.hpp"
#include "src/base/index.hpp"

namespace brio {

/// Raises the mass of lanes whose stable time step is below that of the block until it equals it: frequencies
/// are proportional to 1/sqrt(mass). The added mass is listed in `block.scaled` and `block.mass_gain`, and
/// added to the nodes after the sweep. \param count lanes that are elements
template <Floating Real, class Header>
void scale_mass(Block& block, Chunk chunk, std::size_t pack, int count, Header& header,
                Increment<Lanes<Real>>& increment, SweepResult& result) {
  using T = Lanes<Real>;
  const T wanted(block.scaled_step);
  T& stable_step = increment.stable_step;
  const auto is_short = (stable_step < wanted) & (stable_step > T(0.0));
  if (!any(is_short)) return;
  const T ratio = wanted / where(is_short, stable_step, wanted);
  const T before = header.mass;
  header.mass = before * (ratio * ratio);
  increment.frequency_squared = increment.frequency_squared / (ratio * ratio);
  stable_step = where(is_short, wanted, stable_step);
  constexpr std::size_t width = lane_count<Real>;
  for (int lane = 0; lane < count; ++lane) {
    if (is_short.v[lane] == 0) continue;
    const std::size_t place = pack * width + index(lane);
    block.mass_gain[place] = static_cast<double>(header.mass[lane]) - static_cast<double>(before[lane]);
    block.scaled[chunk.first_pack * width + result.scaled++] = static_cast<int>(place);
  }
}

}  // namespace brio
