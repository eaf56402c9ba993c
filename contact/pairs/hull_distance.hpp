#pragma once
/// Lower bounds of the distance of convex hulls of few points: along a direction d of unit length, the least
/// height of one hull over the greatest of the other. Directions are found by the algorithm of Frank and
/// Wolfe (Gilbert 1966): of the point of the difference of both hulls nearest to the origin, approached from
/// support point to support point.

#include <array>
#include <cmath>
#include <cstddef>

#include "contact/geometry/number.hpp"

namespace brio {

/// At most eight points.
class FewPoints {
 public:
  void add(const Vector3<double>& x) { point_[count_++] = x; }
  std::size_t size() const { return count_; }
  bool empty() const { return count_ == 0; }
  const Vector3<double>& operator[](std::size_t i) const { return point_[i]; }
  const Vector3<double>* begin() const { return point_.data(); }
  const Vector3<double>* end() const { return point_.data() + count_; }

  Vector3<double> mean() const {
    Vector3<double> sum{0, 0, 0};
    for (const Vector3<double>& x : *this) sum = sum + x;
    return (1 / static_cast<double>(count_)) * sum;
  }
  /// The point that is farthest along a direction.
  const Vector3<double>& farthest(const Vector3<double>& direction) const {
    std::size_t best = 0;
    double height = dot(direction, point_[0]);
    for (std::size_t i = 1; i < count_; ++i) {
      const double other = dot(direction, point_[i]);
      best = other > height ? i : best;
      height = std::fmax(height, other);
    }
    return point_[best];
  }

 private:
  std::array<Vector3<double>, 8> point_;
  std::size_t count_ = 0;
};

struct DistanceBound {
  double distance = 0;                 ///< no point of one hull is nearer to one of the other; 0: not known
  Vector3<double> direction{0, 0, 0};  ///< of unit length, from the second to the first, along which it is so
};

/// Of two hulls, none of them empty. Found to a tenth of the distance, or what few steps give.
inline DistanceBound distance_bound(const FewPoints& first, const FewPoints& second) {
  constexpr int most_steps = 8;
  constexpr double good_share = 0.9, rounding = 1e-12;
  DistanceBound best;
  Vector3<double> nearest = first.mean() - second.mean();
  for (int step = 0; step < most_steps; ++step) {
    const double square = dot(nearest, nearest);
    if (!(square > least_square)) break;
    const Vector3<double> support = first.farthest(-1.0 * nearest) - second.farthest(nearest);
    const double height = dot(nearest, support), length = std::sqrt(square);
    const double bound = (1 - rounding) * height / length;
    if (bound > best.distance) best = {bound, (1 / length) * nearest};
    if (best.distance >= good_share * length) break;
    const Vector3<double> way = support - nearest;
    const double way_square = dot(way, way);
    if (!(way_square > least_square)) break;
    nearest = nearest + clamp_to_unit((square - height) / way_square) * way;
  }
  return best;
}

/// Of a hull and the origin.
inline DistanceBound distance_bound(const FewPoints& points) {
  FewPoints origin;
  origin.add({0, 0, 0});
  return distance_bound(points, origin);
}

}  // namespace brio
