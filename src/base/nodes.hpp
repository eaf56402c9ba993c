#pragma once
/// Nodal state. One 64-byte record a node holds what every kernel reads; forces stand beside it. Rotational
/// twins are allocated only where shells or beams exist.

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "src/base/aligned.hpp"
#include "src/base/index.hpp"
#include "src/base/tensor.hpp"

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

/// Axes of a node whose supports are not along the global ones: rows of orthonormal components, those of its
/// translations and those of its rotations.
struct SupportAxes {
  Tensor<double> linear, angular;
};

/// Nodes to a range at most; sums over nodes are formed range by range in order.
inline constexpr std::size_t nodes_per_range = 2048;

/// Nodes [begin, end).
struct NodeRange {
  std::size_t begin, end;
  int domain;  ///< the first that has them; -1: none
  int rank;    ///< that sweeps the domain (src/domains/ranks.hpp)
};

class Ranks;

struct Nodes {
  AlignedBuffer<NodeRecord> record;
  AlignedBuffer<NodeVector> force;  ///< external minus internal, of the current step
  AlignedBuffer<double> mass;
  AlignedBuffer<NodeVector> angular_velocity;  ///< component[3] holds the inverse rotational inertia
  AlignedBuffer<NodeVector> moment;
  AlignedBuffer<double> rotational_inertia;
  /// Bit i: velocity component i is prescribed (infinite mass along axis i); bits 3 to 5: the rotations.
  /// Axes are the global ones, or the own ones of the node. Empty where no deck entry prescribes anything.
  AlignedBuffer<std::uint8_t> prescribed;
  std::vector<SupportAxes> support_axes;
  std::vector<int> axes_of;  ///< of each node: its own in `support_axes`, or -1. Empty: none has any
  /// Velocities at the half step before, for the work of impulses; empty where nothing but forces acts on
  /// nodes.
  AlignedBuffer<NodeVector> velocity_before;
  AlignedBuffer<NodeVector> angular_velocity_before;  ///< likewise, where there are rotations

  std::vector<NodeRange> ranges;    ///< of all nodes, in order
  std::vector<NodeRange> followed;  ///< beyond the ranges of the own domains: nodes that this rank needs
  Ranks* ranks = nullptr;           ///< if each knows nodes of its own domains and followed ones alone

  Nodes() = default;
  Nodes(std::size_t count, bool with_rotations)
      : record(count),
        force(count),
        mass(count),
        angular_velocity(with_rotations ? count : 0),
        moment(with_rotations ? count : 0),
        rotational_inertia(with_rotations ? count : 0) {
    for (std::size_t begin = 0; begin < count; begin += nodes_per_range)
      ranges.push_back({begin, begin + nodes_per_range < count ? begin + nodes_per_range : count, -1, -1});
  }

  std::size_t size() const { return record.size(); }
  /// From now on velocities of the half step before are kept.
  void keep_velocities_before() {
    velocity_before = AlignedBuffer<NodeVector>(size());
    if (has_rotations()) angular_velocity_before = AlignedBuffer<NodeVector>(size());
  }
  /// Null: the global axes.
  const SupportAxes* own_axes(std::size_t node) const {
    if (axes_of.empty() || axes_of[node] < 0) return nullptr;
    return &support_axes[index(axes_of[node])];
  }
  /// Bits 0 to 2 for the components of the translation, or of the rotation, that are prescribed.
  int prescribed_translations(std::size_t node) const {
    return prescribed.empty() ? 0 : prescribed[node] & 7;
  }
  int prescribed_rotations(std::size_t node) const {
    return prescribed.empty() ? 0 : prescribed[node] >> 3 & 7;
  }
  /// Projection on the directions in which the velocity of a node, or its angular velocity, is not
  /// prescribed.
  SymmetricTensor<double> free_translations(std::size_t node) const {
    const SupportAxes* own = own_axes(node);
    return free_directions(prescribed_translations(node), own == nullptr ? nullptr : &own->linear);
  }
  SymmetricTensor<double> free_rotations(std::size_t node) const {
    const SupportAxes* own = own_axes(node);
    return free_directions(prescribed_rotations(node), own == nullptr ? nullptr : &own->angular);
  }
  /// Inverse mass as contact and walls see it: 0 where the motion is prescribed.
  SymmetricTensor<double> free_inverse_mass(std::size_t node) const {
    return record[node].inverse_mass * free_translations(node);
  }
  /// Likewise of the rotation. \pre there are rotations
  SymmetricTensor<double> free_inverse_inertia(std::size_t node) const {
    return angular_velocity[node].component[3] * free_rotations(node);
  }
  bool has_rotations() const { return !angular_velocity.empty(); }

  /// Saved and restored (src/base/state_archive.hpp).
  template <class Archive>
  void serialize(Archive& archive) {
    archive(record, mass, angular_velocity, rotational_inertia, velocity_before, angular_velocity_before);
  }

 private:
  static SymmetricTensor<double> free_directions(int given, const Tensor<double>* axes) {
    if (axes == nullptr || given == 0 || given == 7)
      return {
          (given & 1) != 0 ? 0.0 : 1.0, (given & 2) != 0 ? 0.0 : 1.0, (given & 4) != 0 ? 0.0 : 1.0, 0, 0, 0};
    SymmetricTensor<double> sum = isotropic(1.0);
    for (int axis = 0; axis < 3; ++axis) {
      if ((given >> axis & 1) == 0) continue;
      const double* a = axes->m[axis];
      sum = sum - SymmetricTensor<double>{a[0] * a[0], a[1] * a[1], a[2] * a[2],
                                          a[0] * a[1], a[1] * a[2], a[0] * a[2]};
    }
    return sum;
  }
};

inline Vector3d position(const Nodes& nodes, std::integral auto node) {
  return vector_at(nodes.record[static_cast<std::size_t>(node)].position);
}
inline Vector3d velocity(const Nodes& nodes, std::integral auto node) {
  return vector_at(nodes.record[static_cast<std::size_t>(node)].velocity);
}

}  // namespace brio
