#pragma once
/// Impulses of single parts and supports in a step, for callers that ask for them.

#include <array>
#include <map>
#include <span>
#include <vector>

#include "src/base/tensor.hpp"

namespace brio {

struct ContactScene;

/// Linear impulse of a support on a prescribed node or rigid body; components that are free are 0.
struct SupportImpulse {
  int node = -1;  ///< global; -1: a body's
  int body = -1;
  Vector3d impulse{};
};

/// Filled anew in each step. Nodes that merged parts share belong to the first of them.
struct ImpulseLog {
  std::vector<int> part_of_node;           ///< of each global node; -1: of none
  std::vector<int> part_of_body;           ///< of each rigid body
  std::vector<std::array<int, 2>> wanted;  ///< pairs of parts; each ascending, and all of them
  std::vector<Vector3d> impulse;           ///< of each pair: of the second part on the first
  std::vector<Vector3d> friction;          ///< of it that of friction
  std::vector<SupportImpulse> supports;
  std::vector<Vector3d> reaction;  ///< scratch: of each velocity block

  void begin_step();
  /// An impulse of the second part on the first, and what of it is friction; of a part on itself the sizes of
  /// the components are added.
  void add(int first, int second, const Vector3d& of_second, const Vector3d& of_friction);
  /// Impulses that sum to zero over several parts: each pair gets the difference of its two over their
  /// number, the least distribution (exact for two parts).
  void add(const std::map<int, Vector3d>& impulse_of_part);
  /// Of a face or an edge: the last of its nodes' parts, since those that it shares belong to the first.
  int part_of(const ContactScene& scene, std::span<const int> slaves) const;
};

/// Adds the impulses of all constraints of the step.
void log_contacts(ContactScene& scene);

}  // namespace brio
