#pragma once
/// Geometric queries of nodes and edges of a mesh at rest: sides, local minima of distance, parts.

#include <algorithm>
#include <cmath>
#include <vector>

#include "contact/features/features.hpp"
#include "contact/geometry/hull_point.hpp"
#include "contact/pairs/feature_pairs.hpp"
#include "contact/surface/face_geometry.hpp"
#include "src/base/floating_point.hpp"
#include "src/base/index.hpp"

namespace brio {

struct SidedPair;

/// Unit vectors that differ, and their mean.
class Directions {
 public:
  void add(const Vector3d& direction);
  /// Zero: there are none, or they cancel.
  Vector3d mean() const { return unit_or(norm(sum_) > least_sum ? sum_ : Vector3d{}, Vector3d{}); }

 private:
  static constexpr double same_cosine = 0.9999;
  static constexpr double least_sum = 1e-3;
  std::vector<Vector3d> known_;
  Vector3d sum_{};
};

class SidedLook {
 public:
  SidedLook(const SurfaceFeatures& surface_features, const Surface& of, const Nodes& at_rest,
            const SearchedDepth& searched_depth);

  const SurfaceFeatures& features;
  const Surface& surface;
  const Nodes& nodes;
  SearchedDepth depth;  ///< to which overlaps are looked for

  Vector3d at(int slave) const { return position(nodes, surface.node[index(slave)]); }
  FaceVertices corners(const Face& face) const { return vertices(nodes, face); }
  const EdgeFeature& edge(int e) const { return features.edge[index(e)]; }
  int part_of(int slave) const { return part_[index(slave)]; }
  /// What of a radius is skin.
  double skin_in(double radius) const { return radius <= features.skin ? radius : 0; }

  /// By the box of the face.
  bool surely_farther(int slave, const Face& face, double distance) const;
  /// Whether no neighbour of a node reaches behind a plane through it.
  bool is_before(int slave, const Vector3d& normal) const;
  /// The normal of a face towards the side on which the neighbours of a node on it lie; zero: on both.
  Vector3d side_of(int slave, const Face& face, const Vector3d& normal) const;
  /// Whether none of the neighbours (-1: none) is nearer than the foot along the direction away from the
  /// other side.
  template <class List>
  bool look_away(const List& neighbours, const Vector3d& foot, const Vector3d& away) const {
    return std::all_of(neighbours.begin(), neighbours.end(), [&](int neighbour) {
      if (neighbour < 0) return true;
      const Vector3d arm = at(neighbour) - foot;
      return dot(arm, away) >= -nearer_by_rounding * norm(arm);
    });
  }
  /// Whether a foot on a face is a local minimum on the union of faces; what it lies on.
  bool is_minimum(int face, const std::array<double, 4>& weights, const Vector3d& foot,
                  const Vector3d& normal, std::array<int, 2>& support) const;
  /// The same of a foot on an edge, away from the other side.
  bool is_minimum(int edge, double parameter, const Vector3d& foot, const Vector3d& away, int& support) const;

  static constexpr double nearer_by_rounding = 1e-6;
  /// Neighbours reach behind a plane by more than this sine.
  static constexpr double behind_sine = 1e-3;

 private:
  std::vector<int> part_;  ///< of each slave node
};

/// Append pairs of edges to `found`.
void find_sided_edges(const SidedLook& look, const FeaturePairs& pairs, double band,
                      std::vector<SidedPair>& found);

}  // namespace brio
