#pragma once
/// How the sweep gives a kernel what it sees of the nodes of a pack, and the nodes its forces.

#include "elements/base/element_kind.hpp"
#include "elements/block.hpp"
#include "src/base/gather.hpp"
#include "src/base/index.hpp"

namespace brio {

/// Positions are made relative to the first node, in double, unless the kernel forms differences itself and
/// nothing is rounded before it does.
template <class Kind, Floating Real>
inline constexpr bool makes_relative = !(sizeof(Real) == 8 && Kind::kernel_traits.uses_differences);

/// \param velocity rows that are `velocity_stride` doubles apart
template <class Kind, Floating Real>
BRIO_INLINE void gather_motion(const Nodes& nodes, const double* velocity, std::size_t velocity_stride,
                               const NodeVector* angular_velocity, const int* connectivity,
                               NodalMotionOf<Kind, Lanes<Real>>& motion) {
  constexpr int width = lane_count<Real>;
  constexpr std::size_t stride = sizeof(NodeRecord) / sizeof(double);
  const double* position = nodes.record.data()->position;
  const WideVector<Real> first_position = gather_rows<Real>(position, stride, connectivity);
  const WideVector<Real> first_velocity = gather_rows<Real>(velocity, velocity_stride, connectivity);
#pragma GCC unroll 8
  for (int corner = 0; corner < Kind::nodes; ++corner) {
    const int* node = connectivity + corner * width;
    WideVector<Real> x = corner == 0 ? first_position : gather_rows<Real>(position, stride, node);
    WideVector<Real> v = corner == 0 ? first_velocity : gather_rows<Real>(velocity, velocity_stride, node);
    if constexpr (makes_relative<Kind, Real>) {
      x = x - first_position;
      v = v - first_velocity;
    }
    motion.position[0][corner] = narrow<Real>(x.x);
    motion.position[1][corner] = narrow<Real>(x.y);
    motion.position[2][corner] = narrow<Real>(x.z);
    motion.velocity[0][corner] = narrow<Real>(v.x);
    motion.velocity[1][corner] = narrow<Real>(v.y);
    motion.velocity[2][corner] = narrow<Real>(v.z);
    if constexpr (Kind::rotations) {
      const WideVector<Real> w =
          gather_rows<Real>(angular_velocity->component, sizeof(NodeVector) / sizeof(double), node);
      motion.angular_velocity[0][corner] = narrow<Real>(w.x);
      motion.angular_velocity[1][corner] = narrow<Real>(w.y);
      motion.angular_velocity[2][corner] = narrow<Real>(w.z);
    }
  }
}

template <class Kind, Floating Real>
BRIO_CALLED void gather_motion(const Nodes& nodes, const int* connectivity,
                               MotionOf<Kind, Lanes<Real>>& motion) {
  gather_motion<Kind, Real>(nodes, nodes.record.data()->velocity, sizeof(NodeRecord) / sizeof(double),
                            nodes.angular_velocity.data(), connectivity, motion);
}
/// With other vectors in place of velocities.
template <class Kind, Floating Real>
BRIO_CALLED void gather_motion(const Nodes& nodes, const NodalRows& velocity, const int* connectivity,
                               NodalMotionOf<Kind, Lanes<Real>>& motion) {
  gather_motion<Kind, Real>(nodes, velocity.linear->component, sizeof(NodeVector) / sizeof(double),
                            velocity.angular, connectivity, motion);
}

template <class Kind, Floating Real>
BRIO_CALLED void scatter(const NodalRows& sum, const int* connectivity,
                         const ForcesOf<Kind, Lanes<Real>>& forces) {
#pragma GCC unroll 8
  for (int corner = 0; corner < Kind::nodes; ++corner) {
    const int* node = connectivity + corner * lane_count<Real>;
    subtract_from_rows<Real>(sum.linear, node, forces.force[0][corner], forces.force[1][corner],
                             forces.force[2][corner], forces.stiffness);
    if constexpr (Kind::rotations)
      subtract_from_rows<Real>(sum.angular, node, forces.moment[0][corner], forces.moment[1][corner],
                               forces.moment[2][corner], forces.rotational_stiffness);
  }
}

/// The first `count` lanes of the last pack of a chunk: kept out of the loop, where it would be the larger
/// part of the code.
template <class Kind, Floating Real>
BRIO_CALLED void scatter_first(const NodalRows& sum, const int* connectivity, int count,
                               const ForcesOf<Kind, Lanes<Real>>& forces) {
  for (int corner = 0; corner < Kind::nodes; ++corner)
    for (int lane = 0; lane < count; ++lane) {
      const auto node = index(connectivity[corner * lane_count<Real> + lane]);
      for (int i = 0; i < 3; ++i) {
        sum.linear[node].component[i] -= static_cast<double>(forces.force[i][corner][lane]);
        if constexpr (Kind::rotations)
          sum.angular[node].component[i] -= static_cast<double>(forces.moment[i][corner][lane]);
      }
      sum.linear[node].component[3] -= static_cast<double>(forces.stiffness[lane]);
      if constexpr (Kind::rotations)
        sum.angular[node].component[3] -= static_cast<double>(forces.rotational_stiffness[lane]);
    }
}

template <class Kind, Floating Real>
BRIO_INLINE void scatter_pack(const NodalRows& sum, const int* connectivity, int count,
                              const ForcesOf<Kind, Lanes<Real>>& forces) {
  if (count == lane_count<Real>) {
    scatter<Kind, Real>(sum, connectivity, forces);
  } else {
    scatter_first<Kind, Real>(sum, connectivity, count, forces);
  }
}

/// Takes back the forces of lost lanes and their half of the step's work. Of an element that has inverted
/// nothing of this step can be told: its increments are left out.
template <class Kind, Floating Real>
BRIO_INLINE void take_back(LaneMask<Real> lost, const MotionOf<Kind, Lanes<Real>>& motion, double step,
                           ForcesOf<Kind, Lanes<Real>>& forces, Increment<Lanes<Real>>& increment) {
  using T = Lanes<Real>;
  const T zero(0.0);
  T power = zero;
  for (int corner = 0; corner < Kind::nodes; ++corner)
    for (int i = 0; i < 3; ++i) {
      T& force = forces.force[i][corner];
      power += force * (motion.velocity[i][corner] - motion.velocity[i][0]);
      force = where(lost, zero, force);
      if constexpr (Kind::rotations) {
        T& moment = forces.moment[i][corner];
        power += moment * motion.angular_velocity[i][corner];
        moment = where(lost, zero, moment);
      }
    }
  const auto broken = lost & (increment.stable_step <= zero);
  const T internal = increment.internal_energy - where(lost, (0.5 * step) * power, zero);
  increment.internal_energy = where(broken, zero, internal);
  increment.hourglass_energy = where(broken, zero, increment.hourglass_energy);
  increment.viscous_energy = where(broken, zero, increment.viscous_energy);
  increment.stable_step = where(lost, T(HUGE_VAL), increment.stable_step);
}

/// Between the elements of a chunk and their own nodes. Kinds whose elements see more specialize it.
template <class Kind, Floating Real>
class NodeExchange {
 public:
  using T = Lanes<Real>;

  NodeExchange(Block&, Nodes& nodes, double step) : nodes_(nodes), step_(step) {}

  /// At the start of a run, for Kernel::initialize; its finish, when all elements have their state.
  void gather_start(const int* connectivity, MotionOf<Kind, T>& motion) const {
    gather_motion<Kind, Real>(nodes_, connectivity, motion);
  }
  template <class Law, class History>
  void finish_start(const Kind&, const Law&, const History&) const {}
  /// Of the element of a lane, from the mass that it gives to each of its nodes.
  double volume(const int*, int, double nodal_mass, double density) const {
    return Kind::nodes * nodal_mass / density;
  }

  /// \param connectivity nodes of a pack, [node][lane] \param count lanes that are elements
  BRIO_INLINE void gather(const int* connectivity, int, MotionOf<Kind, T>& motion) const {
    gather_motion<Kind, Real>(nodes_, connectivity, motion);
  }
  /// Of lanes that are lost.
  BRIO_INLINE void take_back(LaneMask<Real> lost, const MotionOf<Kind, T>& motion, ForcesOf<Kind, T>& forces,
                             Increment<T>& increment) const {
    brio::take_back<Kind, Real>(lost, motion, step_, forces, increment);
  }
  template <class Header>
  BRIO_INLINE void scatter(const int* connectivity, int count, const Header&,
                           const ForcesOf<Kind, T>& forces) const {
    scatter_pack<Kind, Real>({nodes_.force.data(), nodes_.moment.data()}, connectivity, count, forces);
  }

 private:
  Nodes& nodes_;
  double step_;
};

}  // namespace brio
