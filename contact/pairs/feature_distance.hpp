#pragma once
/// Lower bound of the distance of the features of two faces, or of a beam or particle and a face: of any
/// node, side, diagonal or face of one and any of the other that share no node.
///
/// Without a common node it is the distance of both hulls. With one, p, a plane through p separates them:
/// what of one does not contain p is as far from the other as its corners are from the plane. With two, p and
/// q, such a plane contains both, and what contains p alone is also apart from what contains q alone.

#include <algorithm>

#include "contact/pairs/hull_distance.hpp"
#include "contact/pairs/pair_packs.hpp"

namespace brio {

/// The corners of both sorted by whether they are common. The bound has a direction where none is.
class CommonCorners {
 public:
  template <class Kind>
  CommonCorners(const OnePair<Kind>& one, const typename OnePair<Kind>::Points& at) {
    const auto& first = one.kind.first_nodes(one.a);
    const auto& second = one.kind.second_nodes(one.b);
    const auto has = [](const auto& nodes, int node) {
      return std::find(nodes.begin(), nodes.end(), node) != nodes.end();
    };
    for (std::size_t k = 0; k < first.size(); ++k) {
      if (!has(second, first[k]))
        first_.add(at.first[k]);
      else if (std::find(first.begin(), first.begin() + static_cast<std::ptrdiff_t>(k), first[k]) ==
               first.begin() + static_cast<std::ptrdiff_t>(k))
        common_.add(at.first[k]);
    }
    for (std::size_t k = 0; k < second.size(); ++k)
      if (!has(first, second[k])) second_.add(at.second[k]);
  }

  DistanceBound distance() const {
    if (common_.empty()) return distance_bound(first_, second_);
    if (common_.size() == 1) return {distance_bound(away_from(common_[0], {0, 0, 0})).distance, {0, 0, 0}};
    if (common_.size() > 2) return {};
    const Vector3<double>&p = common_[0], &q = common_[1];
    const DistanceBound between = distance_bound(away_from(p, q - p));
    const DistanceBound along = distance_bound(with(first_, p), with(second_, q));
    const DistanceBound back = distance_bound(with(first_, q), with(second_, p));
    return {std::min({between.distance, along.distance, back.distance}), {0, 0, 0}};
  }

 private:
  static FewPoints with(FewPoints points, const Vector3<double>& point) {
    points.add(point);
    return points;
  }
  // From a common corner towards the first, and from the second to it, across an axis.
  FewPoints away_from(const Vector3<double>& corner, const Vector3<double>& axis) const {
    FewPoints arms;
    const double inverse = inverse_or_zero(dot(axis, axis));
    const auto add = [&](const Vector3<double>& arm) { arms.add(arm - (inverse * dot(arm, axis)) * axis); };
    for (const Vector3<double>& x : first_) add(x - corner);
    for (const Vector3<double>& x : second_) add(corner - x);
    return arms;
  }

  FewPoints first_, second_, common_;
};

/// Of what is not of one piece: corners of either that are not, and the other. Infinite where all are.
/// \param one_piece bits of corners (PairRecord)
template <class Points>
double distance_of_pieces(const Points& at, unsigned one_piece) {
  const auto corners = [](const auto& points, unsigned left_out) {
    FewPoints kept;
    for (std::size_t k = 0; k < points.size(); ++k)
      if ((left_out >> k & 1U) == 0) kept.add(points[k]);
    return kept;
  };
  double least = infinity;
  if (const FewPoints first = corners(at.first, one_piece); !first.empty())
    least = distance_bound(first, corners(at.second, 0)).distance;
  if (const FewPoints second = corners(at.second, one_piece >> 4); !second.empty())
    least = std::min(least, distance_bound(second, corners(at.first, 0)).distance);
  return least;
}

/// Of opposite sides of one face.
inline DistanceBound distance_of_opposite_sides(const std::array<Vector3<double>, 4>& at) {
  const auto side = [&](std::size_t k, std::size_t l) {
    FewPoints ends;
    ends.add(at[k]);
    ends.add(at[l]);
    return ends;
  };
  const DistanceBound one = distance_bound(side(0, 1), side(2, 3)),
                      other = distance_bound(side(1, 2), side(3, 0));
  return {std::min(one.distance, other.distance), {0, 0, 0}};
}

}  // namespace brio
