#pragma once
/// One contact constraint: a slave node and a face, or two edges, in contact or possibly in contact within
/// the time step.

#include <algorithm>
#include <array>
#include <span>

#include "src/base/tensor.hpp"

namespace brio {

/// Of contacts of edges: Contact::slave is this plus the number of the first edge.
inline constexpr int first_edge_slave = 1 << 30;

struct Contact {
  int slave = 0;              ///< index among the slave nodes
  int face = 0;               ///< -1: of two edges
  int body = 0;               ///< of the face, or of the second edge
  int own = 1;                ///< how many of the nodes are of the first side: the node, or both of an edge
  std::array<int, 5> node{};  ///< slave indices: the node, then the corners of the face
  std::array<double, 5> weight{};   ///< 1, then minus the weights of the corners; their sum is 0
  Vector3d normal{};                ///< unit vector from the second side to the first
  double gap = 0;                   ///< at the beginning of the step; negative: old overlap
  double friction_coefficient = 0;  ///< Coulomb's
  bool along_meeting = false;       ///< the normal is that at first contact, later in the step
  double impulse = 0;               ///< along the normal, on the first side; never negative
  Vector3d friction{};              ///< tangential impulse on the first side

  bool of_edges() const { return face < 0; }

  /// Saved and restored (src/base/state_archive.hpp).
  template <class Archive>
  void serialize(Archive& archive) {
    archive(slave, face, body, own, node, weight, normal, gap, friction_coefficient, along_meeting, impulse,
            friction);
  }
};

/// Whether a pair of edges is in a list that is ordered by Contact::slave. \param first the number of the
/// first edge \param nodes Contact::node
inline bool has_edges(std::span<const Contact> contacts, int first, const std::array<int, 5>& nodes) {
  const int slave = first_edge_slave + first;
  auto contact = std::lower_bound(contacts.begin(), contacts.end(), slave,
                                  [](const Contact& one, int value) { return one.slave < value; });
  for (; contact != contacts.end() && contact->slave == slave; ++contact)
    if (contact->node == nodes) return true;
  return false;
}

}  // namespace brio
