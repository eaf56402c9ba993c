#pragma once
/// Lower bound of the distance of the features of two faces, or of a beam or particle and a face: of any
/// node, side, diagonal or face of one and any of the other that share no node.
///
/// Without a common node it is the distance of both hulls. With one, p, a plane through p separates them:
/// what of one does not contain p is as far from the other as its corners are from the plane. With two, p and
/// q, such a plane contains both, and what contains p alone is also apart from what contains q alone.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "contact/geometry/number.hpp"
#include "contact/pairs/pair_packs.hpp"

namespace brio {

/// At most eight points.
class FewPoints {
 public:
  using Number = double;

  void add(const Vector3d& x) { point_[count_++] = x; }
  std::size_t size() const { return count_; }
  bool empty() const { return count_ == 0; }
  const Vector3d& operator[](std::size_t i) const { return point_[i]; }
  const Vector3d* begin() const { return point_.data(); }
  const Vector3d* end() const { return point_.data() + count_; }

  Vector3d mean() const {
    Vector3d sum{0, 0, 0};
    for (const Vector3d& x : *this) sum = sum + x;
    return (1 / static_cast<double>(count_)) * sum;
  }
  /// The point that is farthest along a direction.
  const Vector3d& farthest(const Vector3d& direction) const {
    std::size_t best = 0;
    double height = dot(direction, point_[0]);
    for (std::size_t i = 1; i < count_; ++i) {
      const double other = dot(direction, point_[i]);
      best = other > height ? i : best;
      height = std::max(height, other);
    }
    return point_[best];
  }

 private:
  std::array<Vector3d, 8> point_;
  std::size_t count_ = 0;
};

/// The points of eight features.
template <std::size_t Count>
struct PackOfCorners {
  using Number = Pack;
  const std::array<Vector3<Pack>, Count>& point;

  BRIO_INLINE Vector3<Pack> mean() const {
    Vector3<Pack> sum{0.0, 0.0, 0.0};
    for (const Vector3<Pack>& x : point) sum = sum + x;
    return Pack(1 / static_cast<double>(Count)) * sum;
  }
  BRIO_INLINE Vector3<Pack> farthest(const Vector3<Pack>& direction) const {
    Vector3<Pack> best = point[0];
    Pack height = dot(direction, point[0]);
#pragma GCC unroll 4
    for (std::size_t i = 1; i < Count; ++i) {
      const Pack other = dot(direction, point[i]);
      best = where(other > height, point[i], best);
      height = max(height, other);
    }
    return best;
  }
};

template <class T>
struct DistanceBound {
  T distance = T(0.0);  ///< no point of one hull is nearer to one of the other; 0: not known
  /// Of unit length, from the second to the first, along which it is so.
  Vector3<T> direction{T(0.0), T(0.0), T(0.0)};
};

/// Of two hulls, none of them empty. Found to a tenth of the distance, or what few steps give.
template <class Points, class OtherPoints>
BRIO_INLINE DistanceBound<typename Points::Number> distance_bound(const Points& first,
                                                                  const OtherPoints& second) {
  using T = typename Points::Number;
  constexpr int most_steps = 8;
  constexpr double good_share = 0.9, roundings = 1e-12;
  DistanceBound<T> best;
  Vector3<T> nearest = first.mean() - second.mean();
  T square = dot(nearest, nearest);
  MaskOf<T> goes_on = square > T(least_square);
  for (int step = 0; step < most_steps && any(goes_on); ++step) {
    const Vector3<T> support = first.farthest(T(-1.0) * nearest) - second.farthest(nearest);
    const T height = dot(nearest, support), length = sqrt(where(goes_on, square, T(1.0)));
    const T bound = T(1 - roundings) * height / length;
    const MaskOf<T> is_better = goes_on & (bound > best.distance);
    best = {where(is_better, bound, best.distance),
            where(is_better, (T(1.0) / length) * nearest, best.direction)};
    const Vector3<T> way = support - nearest;
    const T way_square = dot(way, way);
    goes_on = goes_on & (!(best.distance >= T(good_share) * length)) & (way_square > T(least_square));
    const T share = clamp_to_unit((square - height) / where(goes_on, way_square, T(1.0)));
    nearest = where(goes_on, nearest + share * way, nearest);
    square = dot(nearest, nearest);
    goes_on = goes_on & (square > T(least_square));
  }
  return best;
}

/// Of a hull and the origin.
inline DistanceBound<double> distance_bound(const FewPoints& points) {
  FewPoints origin;
  origin.add({0, 0, 0});
  return distance_bound(points, origin);
}

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

  DistanceBound<double> distance() const {
    if (common_.empty()) return distance_bound(first_, second_);
    if (common_.size() == 1) return {distance_bound(away_from(common_[0], {0, 0, 0})).distance, {0, 0, 0}};
    if (common_.size() > 2) return {};
    const Vector3d &p = common_[0], &q = common_[1];
    const DistanceBound<double> between = distance_bound(away_from(p, q - p));
    const DistanceBound<double> along = distance_bound(with(first_, p), with(second_, q));
    const DistanceBound<double> back = distance_bound(with(first_, q), with(second_, p));
    return {std::min({between.distance, along.distance, back.distance}), {0, 0, 0}};
  }

 private:
  static FewPoints with(FewPoints points, const Vector3d& point) {
    points.add(point);
    return points;
  }
  // From a common corner towards the first, and from the second to it, across an axis.
  FewPoints away_from(const Vector3d& corner, const Vector3d& axis) const {
    FewPoints arms;
    const double inverse = inverse_or_zero(dot(axis, axis));
    const auto add = [&](const Vector3d& arm) { arms.add(arm - (inverse * dot(arm, axis)) * axis); };
    for (const Vector3d& x : first_) add(x - corner);
    for (const Vector3d& x : second_) add(corner - x);
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
inline DistanceBound<double> distance_of_opposite_sides(const std::array<Vector3d, 4>& at) {
  const auto side = [&](std::size_t k, std::size_t l) {
    FewPoints ends;
    ends.add(at[k]);
    ends.add(at[l]);
    return ends;
  };
  const DistanceBound<double> one = distance_bound(side(0, 1), side(2, 3)),
                              other = distance_bound(side(1, 2), side(3, 0));
  return {std::min(one.distance, other.distance), {0, 0, 0}};
}

}  // namespace brio
