#pragma once
/// Skew support: prescribed motion along a direction that is not a global axis.
///
/// Where a node has one, each of its supports i has a unit vector d_i along which its velocity v is given,
/// d_i . v = g_i. The dual basis e_j of the independent ones (d_i . e_j = 1 for i = j, else 0) lies in their
/// span, so that
///     v + sum over j of e_j (g_j - d_j . v)
/// has all given components and changes v least. An impulse J of the supports on the node is the sum of
/// d_j (e_j . J): each pushes along its own direction.

#include <cstddef>
#include <vector>

#include "src/base/nodes.hpp"
#include "src/motion/constraints.hpp"

namespace brio {

/// A node in the list of an entry.
struct SupportPlace {
  int node = 0;
  std::size_t entry = 0, at = 0;
};
/// Of all skew entries of translations, or of rotations: by node, then by entry.
std::vector<SupportPlace> skew_places(const std::vector<PrescribedNodes>& prescribed, bool turns);

/// Prescribed components of all nodes, and axes of those with skew supports (Nodes::prescribed, axes_of).
/// Other supports of such nodes become skew ones along the global axes. A direction in the span of those
/// before it has a dual of 0.
/// \throws BuildError where directions are neither equal nor clearly different
void combine_supports(std::vector<PrescribedNodes>& prescribed, Nodes& nodes);

/// Whether unit vectors are equal but for rounding.
inline bool is_along(const Vector3d& a, const Vector3d& b) {
  constexpr double rounding = 1e-9;
  const Vector3d apart{a[0] - b[0], a[1] - b[1], a[2] - b[2]};
  return dot(apart, apart) <= rounding * rounding;
}

/// Takes the support of a node out of an entry. \pre the entry has it
void release(PrescribedNodes& given, int node);

}  // namespace brio
