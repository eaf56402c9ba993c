#pragma once
/// Nodal state. One 64-byte record a node holds what every kernel reads; forces stand beside it. Rotational
/// twins are allocated only where shells or beams exist.

#include <cstddef>
#include <cstdint>

#include "src/base/aligned.hpp"

namespace brio {

struct alignas(64) NodeRecord {
  double position[4];   ///< x y z, unused
  double velocity[3];   ///< at the last half step
  double inverse_mass;  ///< 0 where a node has no mass
};

/// Force, moment, angular velocity: three components and a fourth that keeps rows aligned, of forces and
/// moments minus the stiffness of the node (src/sweep/assembled_step.hpp).
struct alignas(32) NodeVector {
  double component[4];
};

/// A vector of all nodes, and one of their rotations where there are any.
struct NodalRows {
  NodeVector* linear;
  NodeVector* angular;
};

struct Nodes {
  AlignedBuffer<NodeRecord> record;
  AlignedBuffer<NodeVector> force;  ///< external minus internal, of the current step
  AlignedBuffer<double> mass;
  AlignedBuffer<NodeVector> angular_velocity;  ///< component[3] holds the inverse rotational inertia
  AlignedBuffer<NodeVector> moment;
  AlignedBuffer<double> rotational_inertia;
  /// Bit i: velocity component i is prescribed (infinite mass along axis i); bits 3 to 5: the rotations.
  /// Empty where no deck entry prescribes anything.
  AlignedBuffer<std::uint8_t> prescribed;
  /// Velocities at the half step before, for the work of impulses; empty where nothing but forces acts on
  /// nodes.
  AlignedBuffer<NodeVector> velocity_before;
  AlignedBuffer<NodeVector> angular_velocity_before;  ///< likewise, where there are rotations

  Nodes() = default;
  Nodes(std::size_t count, bool with_rotations)
      : record(count),
        force(count),
        mass(count),
        angular_velocity(with_rotations ? count : 0),
        moment(with_rotations ? count : 0),
        rotational_inertia(with_rotations ? count : 0) {}

  std::size_t size() const { return record.size(); }
  /// From now on velocities of the half step before are kept.
  void keep_velocities_before() {
    velocity_before = AlignedBuffer<NodeVector>(size());
    if (has_rotations()) angular_velocity_before = AlignedBuffer<NodeVector>(size());
  }
  /// Inverse mass as contact and walls see it along one axis: 0 where the motion is prescribed.
  double free_inverse_mass(std::size_t node, int axis) const {
    if (!prescribed.empty() && (prescribed[node] >> axis & 1) != 0) return 0;
    return record[node].inverse_mass;
  }
  bool has_rotations() const { return !angular_velocity.empty(); }

  /// Saved and restored (src/base/state_archive.hpp).
  template <class Archive>
  void serialize(Archive& archive) {
    archive(record, mass, angular_velocity, rotational_inertia, velocity_before, angular_velocity_before);
  }
};

}  // namespace brio
