#pragma once
/// What an element adds to the stiffness of its nodes, from which their stable time step follows
/// (src/sweep/assembled_step.hpp).

#include "elements/base/motion.hpp"

namespace brio {

/// Sets the stiffness that an element gives to each of its nodes, its share of the mass times omega^2, and
/// that against rotation. With what damping forces add at the time step, before the first one at the
/// element's own stable one: dt^2 omega^2 + 2 dt damping = 4 is how that was made, so that it tells the
/// damping. Lanes without a finite positive stable step give none. \returns what damping adds to the square
/// of the frequency
template <class Kind, class T, class Header, class Forces>
BRIO_INLINE T give_stiffness(const Kind& kind, const Header& header, double step,
                             const Increment<T>& increment, Forces& forces) {
  const T own = increment.stable_step;
  const auto counts = (own > T(0.0)) & (own < T(HUGE_VAL));
  const T stable = where(counts, own, T(1.0));
  const T frequency_squared = where(counts, increment.frequency_squared, T(0.0));
  const T left = where(counts, max(4.0 - square(stable) * frequency_squared, T(0.0)), T(0.0));
  const T damping = left / (stable * (step > 0 ? T(step) : stable));
  forces.stiffness = ((1.0 / Kind::nodes) * header.mass) * (frequency_squared + damping);
  if constexpr (Kind::rotations) forces.rotational_stiffness = kind.gyration_of(header) * forces.stiffness;
  return damping;
}

}  // namespace brio
