#include "tests/contact/geometry/exact_judge.hpp"

#include <algorithm>
#include <cmath>

#include "src/base/index.hpp"
#include "tests/contact/geometry/exact_geometry.hpp"

namespace brio::exact {

namespace {

Scaled scaled_for(const MovingNode& node, const MovingFace& face) {
  Scaled scaled;
  scaled.note(node.start);
  scaled.note(node.displacement);
  for (std::size_t k = 0; k < 4; ++k) {
    scaled.note(face.start[k]);
    scaled.note(face.displacement[k]);
  }
  return scaled;
}

// The sub-triangles of the face as seen from the node.
std::vector<std::array<Path, 3>> triangles(const MovingNode& node, const MovingFace& face,
                                           const Scaled& scaled) {
  const Path origin{scaled(node.start), scaled(node.displacement)};
  std::array<Path, 4> vertices;
  Path centroid{{0, 0, 0}, {0, 0, 0}};
  for (std::size_t k = 0; k < 4; ++k) {
    vertices[k] = Path{scaled(face.start[k]), scaled(face.displacement[k])} - origin;
    for (std::size_t i = 0; i < 3; ++i) {
      centroid.start[i] += vertices[k].start[i];
      centroid.displacement[i] += vertices[k].displacement[i];
    }
  }
  for (std::size_t i = 0; i < 3; ++i) {  // divisible: every integer is a multiple of four
    centroid.start[i] /= 4;
    centroid.displacement[i] /= 4;
  }
  if (face.start[3] == face.start[2] && face.displacement[3] == face.displacement[2])
    return {{vertices[0], vertices[1], vertices[2]}};
  return {{centroid, vertices[0], vertices[1]},
          {centroid, vertices[1], vertices[2]},
          {centroid, vertices[2], vertices[3]},
          {centroid, vertices[3], vertices[0]}};
}

// The polynomials in time by whose signs a touch is decided.
class Predicates {
 public:
  explicit Predicates(const std::array<Path, 3>& triangle)
      : to_{polynomial(triangle[0]), polynomial(triangle[1]), polynomial(triangle[2])},
        area_(cross(to_[1] - to_[0], to_[2] - to_[0])),
        volume_(dot(to_[0], area_)) {}

  const Polynomial& volume() const { return volume_; }

  bool touch(Number& time) const {
    if (sign_at(volume_, time) != 0) return false;
    for (const Polynomial& component : area_)
      if (sign_at(component, time) != 0) return inside(time);
    return on_a_segment(time);
  }

  // Polynomials among whose roots, besides 0, is the first touch of a triangle that stays in a plane with the
  // node: the set of times of touch is closed, and at its first time some predicate vanishes.
  std::vector<Polynomial> turning_points() const {
    std::vector<Polynomial> result;
    for (const Polynomial& component : area_) {
      if (component.is_zero()) continue;
      result.push_back(component);
      for (std::size_t k = 0; k < 3; ++k) result.push_back(dot(area_, off_line(k)));
      return result;
    }
    for (std::size_t k = 0; k < 3; ++k) {
      for (const Polynomial& component : off_line(k)) result.push_back(component);
      result.push_back(dot(to_[k], to_[(k + 1) % 3]));
    }
    return result;
  }

 private:
  PolynomialVector off_line(std::size_t k) const { return cross(to_[k], to_[(k + 1) % 3]); }

  bool inside(Number& time) const {
    for (std::size_t k = 0; k < 3; ++k)
      if (sign_at(dot(area_, off_line(k)), time) < 0) return false;
    return true;
  }

  bool on_a_segment(Number& time) const {
    for (std::size_t k = 0; k < 3; ++k) {
      const PolynomialVector off = off_line(k);
      const bool on_line =
          std::all_of(off.begin(), off.end(), [&](const Polynomial& p) { return sign_at(p, time) == 0; });
      if (on_line && sign_at(dot(to_[k], to_[(k + 1) % 3]), time) <= 0) return true;
    }
    return false;
  }

  std::array<PolynomialVector, 3> to_;
  PolynomialVector area_;
  Polynomial volume_;
};

std::optional<Number> first_contact(const std::array<Path, 3>& triangle) {
  const Predicates predicates(triangle);
  if (!predicates.volume().is_zero()) {
    for (Number& time : roots(predicates.volume()))
      if (predicates.touch(time)) return time;
    return std::nullopt;
  }
  Number start = number({0, 0});
  if (predicates.touch(start)) return start;
  std::optional<Number> first;
  for (const Polynomial& p : predicates.turning_points()) {
    if (p.is_zero()) continue;
    for (Number& time : roots(p)) {
      if (!predicates.touch(time)) continue;
      offer(first, time);
      break;
    }
  }
  return first;
}

// A filter with proven bounds, in extended precision (64 bits): true only if the step can be cut into
// intervals in each of which the exact volume of node and triangle keeps one sign, or the triangle stays on
// one side of a fixed plane through the node. With m the largest component of a relative position plus that
// of its displacement, and u = 2^-64: a component at a time is wrong by less than 16 u m; along a direction d
// by less than 32 u m |d|_1, for which 64 u m |d|_1 is taken; a triple product sums 6 terms of three factors
// below m, each wrong by less than (3 x 16 + 4) u m^3, and the Bernstein coefficients add three of them: 4000
// u m^3 bounds all.
class ExtendedFilter {
 public:
  ExtendedFilter(const MovingNode& node, const MovingFace& face) {
    for (std::size_t k = 0; k < 4; ++k) {
      for (int i = 0; i < 3; ++i) {
        const auto c = index(i);
        start_[k][c] = static_cast<long double>(face.start[k][i]) - node.start[i];
        displacement_[k][c] = static_cast<long double>(face.displacement[k][i]) - node.displacement[i];
        largest_ = std::max(largest_, std::abs(start_[k][c]) + std::abs(displacement_[k][c]));
      }
    }
    for (std::size_t c = 0; c < 3; ++c) {
      start_[4][c] = (start_[0][c] + start_[1][c] + start_[2][c] + start_[3][c]) / 4;
      displacement_[4][c] =
          (displacement_[0][c] + displacement_[1][c] + displacement_[2][c] + displacement_[3][c]) / 4;
    }
  }

  bool apart(const std::array<std::size_t, 3>& corners) const { return apart(corners, 0, 1, 5); }

 private:
  using V = std::array<long double, 3>;
  using Corners = std::array<V, 3>;

  bool apart(const std::array<std::size_t, 3>& corners, long double from, long double to, int cuts) const {
    const Corners first = corners_at(corners, from);
    const Corners last = corners_at(corners, to);
    if (volume_keeps_sign(first, last) || beyond_a_plane(first, last)) return true;
    if (cuts == 0) return false;
    const long double middle = (from + to) / 2;
    return apart(corners, from, middle, cuts - 1) && apart(corners, middle, to, cuts - 1);
  }

  Corners corners_at(const std::array<std::size_t, 3>& corners, long double time) const {
    Corners result;
    for (std::size_t k = 0; k < 3; ++k)
      for (std::size_t c = 0; c < 3; ++c)
        result[k][c] = start_[corners[k]][c] + time * displacement_[corners[k]][c];
    return result;
  }

  bool volume_keeps_sign(const Corners& p, const Corners& q) const {
    const auto& [a0, b0, c0] = p;
    const auto& [a1, b1, c1] = q;
    const long double v[4] = {
        volume(a0, b0, c0), volume(a1, b0, c0) + volume(a0, b1, c0) + volume(a0, b0, c1),
        volume(a1, b1, c0) + volume(a1, b0, c1) + volume(a0, b1, c1), volume(a1, b1, c1)};
    const long double error = 4000 * 0x1p-64L * largest_ * largest_ * largest_;
    return (v[0] > error && v[1] > error && v[2] > error && v[3] > error) ||
           (v[0] < -error && v[1] < -error && v[2] < -error && v[3] < -error);
  }

  // Planes at right angles to the axes, to the triangle's mean normal, and to both that normal and an edge.
  bool beyond_a_plane(const Corners& p, const Corners& q) const {
    static constexpr V axes[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (const V& axis : axes)
      if (beyond(p, q, axis)) return true;
    Corners mean;
    for (std::size_t k = 0; k < 3; ++k)
      for (std::size_t c = 0; c < 3; ++c) mean[k][c] = p[k][c] + q[k][c];
    const V normal = product(difference(mean[1], mean[0]), difference(mean[2], mean[0]));
    if (beyond(p, q, normal)) return true;
    for (std::size_t k = 0; k < 3; ++k)
      if (beyond(p, q, product(difference(mean[(k + 1) % 3], mean[k]), normal))) return true;
    return false;
  }

  bool beyond(const Corners& p, const Corners& q, const V& direction) const {
    const long double margin =
        64 * 0x1p-64L * largest_ * (std::abs(direction[0]) + std::abs(direction[1]) + std::abs(direction[2]));
    int above = 0;
    int below = 0;
    for (const Corners* corners : {&p, &q}) {
      for (const V& corner : *corners) {
        const long double height =
            corner[0] * direction[0] + corner[1] * direction[1] + corner[2] * direction[2];
        above += height > margin;
        below += height < -margin;
      }
    }
    return above == 6 || below == 6;
  }

  static V difference(const V& a, const V& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
  static V product(const V& a, const V& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
  }
  static long double volume(const V& a, const V& b, const V& c) {
    return a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
           a[2] * (b[0] * c[1] - b[1] * c[0]);
  }
  std::array<V, 5> start_, displacement_;
  long double largest_ = 0;
};

bool triangle_within(const std::array<Path, 3>& triangle, const Dyadic& time,
                     const Integer& distance_squared) {
  const std::array<IntegerVector, 3> to = {at(triangle[0], time), at(triangle[1], time),
                                           at(triangle[2], time)};
  for (std::size_t k = 0; k < 3; ++k) {
    if (dot(to[k], to[k]) <= distance_squared) return true;
    const IntegerVector& next = to[(k + 1) % 3];
    const IntegerVector edge = next - to[k];
    if (dot(to[k], edge) > 0 || dot(next, edge) < 0) continue;
    const IntegerVector moment = cross(to[k], edge);
    const Integer length_squared = dot(edge, edge);
    if (length_squared > 0 && dot(moment, moment) <= distance_squared * length_squared) return true;
  }
  const IntegerVector area = cross(to[1] - to[0], to[2] - to[0]);
  for (std::size_t k = 0; k < 3; ++k)
    if (dot(area, cross(to[k], to[(k + 1) % 3])) < 0) return false;
  const Integer area_squared = dot(area, area);
  const Integer volume = dot(area, to[0]);
  return area_squared > 0 && volume * volume <= distance_squared * area_squared;
}

}  // namespace

std::optional<Number> first_contact(const MovingNode& node, const MovingFace& face) {
  const bool single = face.start[3] == face.start[2] && face.displacement[3] == face.displacement[2];
  const ExtendedFilter filter(node, face);
  std::vector<std::array<Path, 3>> parts;
  std::optional<Number> first;
  for (std::size_t k = 0; k < (single ? 1U : 4U); ++k) {
    if (filter.apart(single ? std::array<std::size_t, 3>{0, 1, 2}
                            : std::array<std::size_t, 3>{4, k, (k + 1) % 4}))
      continue;
    if (parts.empty()) parts = triangles(node, face, scaled_for(node, face));
    const std::optional<Number> here = first_contact(parts[k]);
    if (here) offer(first, *here);
  }
  return first;
}

bool within(const MovingNode& node, const MovingFace& face, double time, double distance) {
  Scaled scaled = scaled_for(node, face);
  scaled.note(distance);
  const Dyadic moment = dyadic(time);
  const Integer limit = square_of_scaled_distance(scaled, distance, moment);
  const auto parts = triangles(node, face, scaled);
  return std::any_of(parts.begin(), parts.end(),
                     [&](const std::array<Path, 3>& part) { return triangle_within(part, moment, limit); });
}

bool point_within(const MovingNode& node, const MovingFace& face, const std::array<double, 4>& weights,
                  double time, double distance) {
  Scaled scaled = scaled_for(node, face);
  scaled.note(distance);
  const Dyadic moment = dyadic(time);
  const Path origin{scaled(node.start), scaled(node.displacement)};
  IntegerVector sum{0, 0, 0};  // times 2^1074, which makes every weight an integer
  for (std::size_t k = 0; k < 4; ++k) {
    const IntegerVector to = at(Path{scaled(face.start[k]), scaled(face.displacement[k])} - origin, moment);
    const Dyadic weight = dyadic(weights[k]);
    Integer scaled_weight;
    mpz_mul_2exp(scaled_weight.get_mpz_t(), weight.numerator.get_mpz_t(), 1074 - weight.exponent);
    for (std::size_t i = 0; i < 3; ++i) sum[i] += scaled_weight * to[i];
  }
  Integer limit = square_of_scaled_distance(scaled, distance, moment);
  mpz_mul_2exp(limit.get_mpz_t(), limit.get_mpz_t(), 2 * 1074);
  return dot(sum, sum) <= limit;
}

int side_at(const MovingNode& node, const MovingFace& face, int sub_triangle, double time) {
  const auto parts = triangles(node, face, scaled_for(node, face));
  const Dyadic moment = dyadic(time);
  const std::array<Path, 3>& part = parts[index(sub_triangle)];
  const IntegerVector to = at(part[0], moment);
  const IntegerVector area = cross(at(part[1], moment) - to, at(part[2], moment) - to);
  return -sgn(dot(to, area));
}

}  // namespace brio::exact
