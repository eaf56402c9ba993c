#include "tests/contact/geometry/exact_edges.hpp"

#include <algorithm>
#include <cmath>

#include "src/base/index.hpp"
#include "tests/contact/geometry/exact_geometry.hpp"

namespace brio::exact {

namespace {

Scaled scaled_for(const MovingEdge& a, const MovingEdge& b) {
  Scaled scaled;
  for (const MovingEdge* edge : {&a, &b}) {
    for (std::size_t k = 0; k < 2; ++k) {
      scaled.note(edge->start[k]);
      scaled.note(edge->displacement[k]);
    }
    scaled.note(edge->radius);
  }
  return scaled;
}

// End i of a minus end j of b, at 2 i + j.
std::array<Path, 4> differences(const MovingEdge& a, const MovingEdge& b, const Scaled& scaled) {
  std::array<Path, 4> result;
  for (std::size_t k = 0; k < 4; ++k)
    result[k] = Path{scaled(a.start[k / 2]), scaled(a.displacement[k / 2])} -
                Path{scaled(b.start[k % 2]), scaled(b.displacement[k % 2])};
  return result;
}

// An end as seen along the other edge, by two of the differences.
constexpr std::size_t ends_against_edges[4][2] = {{0, 1}, {2, 3}, {0, 2}, {1, 3}};

// The polynomials in time by whose signs a touch is decided.
class Predicates {
 public:
  Predicates(const std::array<Path, 4>& between, const Integer& reach)
      : c_{polynomial(between[0]), polynomial(between[1]), polynomial(between[2]), polynomial(between[3])},
        along_a_(c_[2] - c_[0]),
        along_b_(c_[0] - c_[1]),
        normal_(cross(along_a_, along_b_)),
        volume_(dot(c_[0], normal_)),
        reach_squared_(Polynomial(reach * reach)) {
    const Polynomial zero;
    inside_ = {zero - dot(cross(c_[0], along_b_), normal_), dot(cross(c_[2], along_b_), normal_),
               zero - dot(cross(c_[0], along_a_), normal_), dot(cross(c_[1], along_a_), normal_)};
  }

  std::optional<Number> first_touch() const {
    return reach_squared_.is_zero() ? first_crossing() : first_at_reach();
  }

 private:
  // Without a reach.
  std::optional<Number> first_crossing() const {
    if (!volume_.is_zero()) {
      for (Number& time : roots(volume_))
        if (crossing(time)) return time;
      return std::nullopt;
    }
    Number start = number({0, 0});
    if (crossing(start)) return start;
    // The times of touch are a closed set, and at its first some predicate vanishes.
    std::optional<Number> first;
    for (const Polynomial& p : turning_points()) {
      if (p.is_zero()) continue;
      for (Number& time : roots(p)) {
        if (!crossing(time)) continue;
        offer(first, time);
        break;
      }
    }
    return first;
  }

  bool crossing(Number& time) const {
    if (sign_at(volume_, time) != 0) return false;
    if (!vanishes(normal_, time)) return inside(time);
    return std::any_of(std::begin(ends_against_edges), std::end(ends_against_edges), [&](const auto& pair) {
      const PolynomialVector& p = c_[pair[0]];
      const PolynomialVector& q = c_[pair[1]];
      return vanishes(cross(p, q), time) && sign_at(dot(p, q), time) <= 0;
    });
  }

  std::vector<Polynomial> turning_points() const {
    std::vector<Polynomial> result;
    for (const Polynomial& component : normal_) {
      if (component.is_zero()) continue;
      result.assign(inside_.begin(), inside_.end());
      result.push_back(component);
      return result;
    }
    for (const auto& pair : ends_against_edges) {
      for (const Polynomial& component : cross(c_[pair[0]], c_[pair[1]])) result.push_back(component);
      result.push_back(dot(c_[pair[0]], c_[pair[1]]));
    }
    return result;
  }

  // With a reach: if not at the start, the distance falls to it first between two ends, between an end and
  // the inside of an edge, or between the insides, and that feature's polynomial vanishes then. One that is
  // zero throughout leaves the first time to a feature of one end more.
  std::optional<Number> first_at_reach() const {
    Number start = number({0, 0});
    std::optional<Number> first;
    const auto try_roots = [&](const Polynomial& p, const auto& valid) {
      if (sign_at(p, start) <= 0 && valid(start)) offer(first, start);
      if (p.is_zero()) return;
      for (Number& time : roots(p)) {
        if (!valid(time)) continue;
        offer(first, time);
        break;
      }
    };
    for (const PolynomialVector& c : c_)
      try_roots(dot(c, c) - reach_squared_, [](const Number&) { return true; });
    for (const auto& pair : ends_against_edges) {
      const PolynomialVector& p = c_[pair[0]];
      const PolynomialVector& q = c_[pair[1]];
      const PolynomialVector along = q - p;
      const PolynomialVector moment = cross(p, along);
      const Polynomial length_squared = dot(along, along);
      try_roots(dot(moment, moment) - reach_squared_ * length_squared, [&](Number& time) {
        return sign_at(length_squared, time) > 0 && sign_at(dot(p, along), time) <= 0 &&
               sign_at(dot(q, along), time) >= 0;
      });
    }
    try_roots(volume_ * volume_ - reach_squared_ * dot(normal_, normal_),
              [&](Number& time) { return !vanishes(normal_, time) && inside(time); });
    return first;
  }

  static bool vanishes(const PolynomialVector& v, Number& time) {
    return std::all_of(v.begin(), v.end(), [&](const Polynomial& p) { return sign_at(p, time) == 0; });
  }
  bool inside(Number& time) const {
    return std::all_of(inside_.begin(), inside_.end(),
                       [&](const Polynomial& p) { return sign_at(p, time) >= 0; });
  }

  std::array<PolynomialVector, 4> c_;
  PolynomialVector along_a_, along_b_, normal_;
  Polynomial volume_, reach_squared_;
  std::array<Polynomial, 4> inside_;
};

// A filter with proven bounds, in extended precision (64 bits): true only if the step can be cut into
// intervals in each of which all differences of ends stay beyond the reach along a fixed direction. With m
// the largest component of a difference plus that of its displacement, or the reach, and u = 2^-64: a
// component at a time is wrong by less than 16 u m, so along a direction d by less than 32 u m |d|_1, for
// which 64 u m |d|_1 is taken, with the length of d.
class ExtendedFilter {
 public:
  ExtendedFilter(const MovingEdge& a, const MovingEdge& b)
      : reach_(static_cast<long double>(a.radius) + b.radius), largest_(reach_) {
    for (std::size_t k = 0; k < 4; ++k) {
      for (int i = 0; i < 3; ++i) {
        const auto c = index(i);
        start_[k][c] = static_cast<long double>(a.start[k / 2][i]) - b.start[k % 2][i];
        displacement_[k][c] = static_cast<long double>(a.displacement[k / 2][i]) - b.displacement[k % 2][i];
        largest_ = std::max(largest_, std::abs(start_[k][c]) + std::abs(displacement_[k][c]));
      }
    }
  }

  bool apart() const { return apart(0, 1, 6); }

 private:
  using V = std::array<long double, 3>;
  using Corners = std::array<V, 4>;

  bool apart(long double from, long double to, int cuts) const {
    const Corners first = corners_at(from);
    const Corners last = corners_at(to);
    if (beyond_a_plane(first, last)) return true;
    if (cuts == 0) return false;
    const long double middle = (from + to) / 2;
    return apart(from, middle, cuts - 1) && apart(middle, to, cuts - 1);
  }

  Corners corners_at(long double time) const {
    Corners result;
    for (std::size_t k = 0; k < 4; ++k)
      for (std::size_t c = 0; c < 3; ++c) result[k][c] = start_[k][c] + time * displacement_[k][c];
    return result;
  }

  // Planes at right angles to the axes, to the mean common perpendicular, to that and an edge, and to mean
  // differences.
  bool beyond_a_plane(const Corners& p, const Corners& q) const {
    static constexpr V axes[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (const V& axis : axes)
      if (beyond(p, q, axis)) return true;
    Corners mean;
    for (std::size_t k = 0; k < 4; ++k) {
      for (std::size_t c = 0; c < 3; ++c) mean[k][c] = p[k][c] + q[k][c];
      if (beyond(p, q, mean[k])) return true;
    }
    const V along_a = difference(mean[2], mean[0]);
    const V along_b = difference(mean[0], mean[1]);
    const V normal = product(along_a, along_b);
    if (beyond(p, q, normal) || beyond(p, q, product(normal, along_a)) ||
        beyond(p, q, product(normal, along_b)))
      return true;
    return beyond(p, q, product(along_a, product(mean[0], along_a))) ||
           beyond(p, q, product(along_b, product(mean[0], along_b)));
  }

  bool beyond(const Corners& p, const Corners& q, const V& d) const {
    const long double sum = std::abs(d[0]) + std::abs(d[1]) + std::abs(d[2]);
    const long double length = std::sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
    const long double margin = reach_ * length + 64 * 0x1p-64L * largest_ * sum;
    int above = 0;
    int below = 0;
    for (const Corners* corners : {&p, &q}) {
      for (const V& corner : *corners) {
        const long double height = corner[0] * d[0] + corner[1] * d[1] + corner[2] * d[2];
        above += height > margin;
        below += height < -margin;
      }
    }
    return above == 8 || below == 8;
  }

  static V difference(const V& a, const V& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
  static V product(const V& a, const V& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
  }

  long double reach_;
  long double largest_;
  std::array<V, 4> start_, displacement_;
};

}  // namespace

std::optional<Number> first_contact(const MovingEdge& a, const MovingEdge& b) {
  if (ExtendedFilter(a, b).apart()) return std::nullopt;
  const Scaled scaled = scaled_for(a, b);
  return Predicates(differences(a, b, scaled), scaled(a.radius) + scaled(b.radius)).first_touch();
}

bool within(const MovingEdge& a, const MovingEdge& b, double time, double distance) {
  Scaled scaled = scaled_for(a, b);
  scaled.note(distance);
  const Dyadic moment = dyadic(time);
  Integer reach = scaled(a.radius) + scaled(b.radius) + scaled(distance);
  if (reach < 0) return false;
  mpz_mul_2exp(reach.get_mpz_t(), reach.get_mpz_t(), moment.exponent);
  const Integer limit = reach * reach;
  const std::array<Path, 4> between = differences(a, b, scaled);
  std::array<IntegerVector, 4> c;
  for (std::size_t k = 0; k < 4; ++k) {
    c[k] = at(between[k], moment);
    if (dot(c[k], c[k]) <= limit) return true;
  }
  for (const auto& pair : ends_against_edges) {
    const IntegerVector along = c[pair[1]] - c[pair[0]];
    if (dot(c[pair[0]], along) > 0 || dot(c[pair[1]], along) < 0) continue;
    const IntegerVector moment_about = cross(c[pair[0]], along);
    const Integer length_squared = dot(along, along);
    if (length_squared > 0 && dot(moment_about, moment_about) <= limit * length_squared) return true;
  }
  const IntegerVector along_a = c[2] - c[0];
  const IntegerVector along_b = c[0] - c[1];
  const IntegerVector normal = cross(along_a, along_b);
  if (dot(cross(c[0], along_b), normal) > 0 || dot(cross(c[2], along_b), normal) < 0 ||
      dot(cross(c[0], along_a), normal) > 0 || dot(cross(c[1], along_a), normal) < 0)
    return false;
  const Integer normal_squared = dot(normal, normal);
  const Integer volume = dot(c[0], normal);
  return normal_squared > 0 && volume * volume <= limit * normal_squared;
}

bool points_within(const MovingEdge& a, const MovingEdge& b, const std::array<double, 2>& parameters,
                   double time, double distance) {
  Scaled scaled = scaled_for(a, b);
  scaled.note(distance);
  const Dyadic moment = dyadic(time);
  const std::array<Path, 4> between = differences(a, b, scaled);
  const IntegerVector c0 = at(between[0], moment);
  const IntegerVector along_a = at(between[2], moment) - c0;
  const IntegerVector along_b = c0 - at(between[1], moment);
  std::array<Integer, 2> shares;  // times 2^1074, which makes every parameter an integer
  for (std::size_t k = 0; k < 2; ++k) {
    const Dyadic share = dyadic(parameters[k]);
    mpz_mul_2exp(shares[k].get_mpz_t(), share.numerator.get_mpz_t(), 1074 - share.exponent);
  }
  IntegerVector offset;
  for (std::size_t i = 0; i < 3; ++i) {
    mpz_mul_2exp(offset[i].get_mpz_t(), c0[i].get_mpz_t(), 1074);
    offset[i] += shares[0] * along_a[i] - shares[1] * along_b[i];
  }
  Integer reach = scaled(a.radius) + scaled(b.radius) + scaled(distance);
  mpz_mul_2exp(reach.get_mpz_t(), reach.get_mpz_t(), moment.exponent + 1074);
  return reach >= 0 && dot(offset, offset) <= reach * reach;
}

int side_at(const MovingEdge& a, const MovingEdge& b, double time) {
  const std::array<Path, 4> between = differences(a, b, scaled_for(a, b));
  const Dyadic moment = dyadic(time);
  const IntegerVector c0 = at(between[0], moment);
  return sgn(dot(c0, cross(at(between[2], moment) - c0, c0 - at(between[1], moment))));
}

}  // namespace brio::exact
