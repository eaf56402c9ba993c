#pragma once
/// What an element kernel sees: positions and velocities of its nodes, and what it hands back.

#include <type_traits>

#include "materials/stress_state.hpp"

namespace brio {

/// Positions at step n and velocities at n-1/2, [component][node]; both relative to the element's first node,
/// so that precision does not depend on where the model stands or how fast its frame moves.
template <class T, int N>
struct NodalMotion {
  T position[3][N];
  T velocity[3][N];
};
/// The same with angular velocities (absolute), for elements whose nodes turn.
template <class T, int N>
struct RotatingNodalMotion : NodalMotion<T, N> {
  T angular_velocity[3][N];
};

/// Internal forces, [component][node]: what the element exerts is their negative.
template <class T, int N>
struct NodalForces {
  T force[3][N];
  T stiffness;  ///< that the element gives to each of its nodes; of the sweep (nodal_stiffness.hpp)
};
template <class T, int N>
struct RotatingNodalForces : NodalForces<T, N> {
  T moment[3][N];
  T rotational_stiffness;
};

/// Work done on the element since the last step, by kind, and the largest step for which it is stable now.
/// A stable step that is not positive says that the element has inverted.
template <class T>
struct Increment {
  T internal_energy;  ///< elastic and plastic
  T hourglass_energy;
  T viscous_energy;  ///< bulk viscosity and viscous hourglass control
  T stable_step;
  T frequency_squared;    ///< bound of the undamped element with the mass that it gives to its nodes
  T strain_rate_squared;  ///< D:D; 0 of kinds without a tangent (element_kind.hpp)
};

/// Lumped mass and rotational inertia that an element gives to each of its nodes (inertia 0 for solids).
template <class T>
struct NodalMass {
  T mass;
  T rotational_inertia;
};

template <class Element, class T>
using NodalMotionOf = std::conditional_t<Element::rotations, RotatingNodalMotion<T, Element::nodes>,
                                         NodalMotion<T, Element::nodes>>;

/// What a kernel reads and hands back. Kinds that see more than their own nodes specialize it.
template <class Element, class T>
struct SeenByKernel {
  using Motion = NodalMotionOf<Element, T>;
  using Forces = std::conditional_t<Element::rotations, RotatingNodalForces<T, Element::nodes>,
                                    NodalForces<T, Element::nodes>>;
};
template <class Element, class T>
using MotionOf = typename SeenByKernel<Element, T>::Motion;
template <class Element, class T>
using ForcesOf = typename SeenByKernel<Element, T>::Forces;

}  // namespace brio
