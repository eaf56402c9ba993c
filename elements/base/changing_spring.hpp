#pragma once
/// Springs whose stiffness changes with the shape and the material of their element: hourglass control and
/// resistance to drilling. With a strain kept as it is, or a force, a change of stiffness would supply energy
/// or lose it. So the energy is kept: the strain changes by the root of the ratio of the stiffnesses. What is
/// stored never falls below zero, and what the forces have done is what is stored.

#include "src/base/tensor.hpp"

namespace brio {

/// What a change of stiffness makes of the strain of a step.
template <class T>
struct SpringChange {
  T carried;  ///< old strain at the same energy, over old strain
  T growth;   ///< by which a displacement grows the new strain: that on the mean of the roots
};

/// No stiffness now: nothing is carried.
template <class T>
BRIO_INLINE SpringChange<T> spring_change(T old_stiffness, T stiffness) {
  const MaskOf<T> resists = stiffness > T(0.0);
  const T carried = sqrt(max(old_stiffness, T(0.0)) / where(resists, stiffness, T(1.0)));
  return {where(resists, carried, T(0.0)), 0.5 * (1.0 + where(resists, carried, T(0.0)))};
}

}  // namespace brio
