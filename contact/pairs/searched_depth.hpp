#pragma once
/// Depth to which overlaps are searched at the start: of a feature the least at its nodes, of a pair of
/// different bodies the mean of both.

#include <algorithm>
#include <span>

#include "contact/features/features.hpp"
#include "src/base/floating_point.hpp"
#include "src/base/index.hpp"

namespace brio {

struct SearchedDepth {
  std::span<const double> of_node;  ///< slave; empty: nothing overlaps
  bool bends_faces = false;         ///< nodes are going to be moved: no face is flat

  bool empty() const { return of_node.empty(); }
  double of(int slave) const { return empty() ? 0 : of_node[index(slave)]; }
  double of(const EdgeFeature& edge) const { return std::min(of(edge.node[0]), of(edge.node[1])); }
  double of(const Surface& surface, const Face& face) const {
    double least = infinity;
    for (int corner : face.node) least = std::min(least, of(surface.slave(corner)));
    return least;
  }
  /// The most at the nodes.
  template <class Slaves>
  double most_of(const Slaves& slaves) const {
    double most = 0;
    for (int slave : slaves) most = std::max(most, of(slave));
    return most;
  }
};

}  // namespace brio
