#include "tests/contact/detection/exact_distance.hpp"

namespace brio::exact {

namespace {

struct Fraction {
  Integer numerator, denominator;
};

bool operator<(const Fraction& a, const Fraction& b) {
  return a.numerator * b.denominator < b.numerator * a.denominator;
}

// The origin against a segment between p and q.
Fraction squared_to_segment(const IntegerVector& p, const IntegerVector& q) {
  const IntegerVector along = q - p;
  const Integer length = dot(along, along);
  const Integer reach = -dot(p, along);
  if (length == 0 || reach <= 0) return {dot(p, p), 1};
  if (reach >= length) return {dot(q, q), 1};
  const IntegerVector area = cross(p, along);
  return {dot(area, area), length};
}

Fraction squared_to_triangle(const IntegerVector& a, const IntegerVector& b, const IntegerVector& c) {
  const IntegerVector normal = cross(b - a, c - a);
  const Integer square = dot(normal, normal);
  if (square > 0 && dot(normal, cross(a, b)) >= 0 && dot(normal, cross(b, c)) >= 0 &&
      dot(normal, cross(c, a)) >= 0) {
    const Integer height = dot(normal, a);
    return {height * height, square};
  }
  return std::min({squared_to_segment(a, b), squared_to_segment(b, c), squared_to_segment(c, a)});
}

template <std::size_t N>
Scaled scaled_for(const Vector3d& node, const std::array<Vector3d, N>& vertices) {
  Scaled scaled;
  scaled.note(node);
  for (const Vector3d& vertex : vertices) scaled.note(vertex);
  scaled.note(0x1p-130);  // below all distances to compare with
  return scaled;
}

std::array<IntegerVector, 4> seen_from(const Vector3d& node, const FaceVertices& vertices,
                                       const Scaled& scaled) {
  std::array<IntegerVector, 4> seen;
  for (std::size_t k = 0; k < 4; ++k) seen[k] = scaled(vertices[k]) - scaled(node);
  return seen;
}

double rounded(double distance) { return std::nearbyint(distance * 0x1p120) * 0x1p-120; }

}  // namespace

bool SquaredDistance::at_most(double distance) const {
  if (distance < 0) return false;
  const Integer length = scaled(rounded(distance));
  return numerator <= length * length * denominator;
}
bool SquaredDistance::at_least(double distance) const {
  if (distance <= 0) return true;
  const Integer length = scaled(rounded(distance));
  return numerator >= length * length * denominator;
}

SquaredDistance to_triangle(const Vector3d& node, const std::array<Vector3d, 3>& vertices) {
  const Scaled scaled = scaled_for(node, vertices);
  const IntegerVector origin = scaled(node);
  const Fraction square = squared_to_triangle(scaled(vertices[0]) - origin, scaled(vertices[1]) - origin,
                                              scaled(vertices[2]) - origin);
  return {square.numerator, square.denominator, scaled};
}

SquaredDistance to_hull_surface(const Vector3d& node, const FaceVertices& vertices) {
  const Scaled scaled = scaled_for(node, vertices);
  const auto x = seen_from(node, vertices, scaled);
  const Fraction square =
      std::min({squared_to_triangle(x[0], x[1], x[2]), squared_to_triangle(x[0], x[2], x[3]),
                squared_to_triangle(x[0], x[1], x[3]), squared_to_triangle(x[1], x[2], x[3])});
  return {square.numerator, square.denominator, scaled};
}

SquaredDistance between_segments(const Segment& a, const Segment& b) {
  Scaled scaled = scaled_for(a[0], std::array<Vector3d, 3>{a[1], b[0], b[1]});
  const IntegerVector a0 = scaled(a[0]);
  const IntegerVector a1 = scaled(a[1]);
  const IntegerVector b0 = scaled(b[0]);
  const IntegerVector b1 = scaled(b[1]);
  Fraction best = std::min({squared_to_segment(a0 - b0, a0 - b1), squared_to_segment(a1 - b0, a1 - b1),
                            squared_to_segment(a0 - b0, a1 - b0), squared_to_segment(a0 - b1, a1 - b1)});
  const IntegerVector along_a = a1 - a0;
  const IntegerVector along_b = b1 - b0;
  const IntegerVector normal = cross(along_a, along_b);
  const Integer square = dot(normal, normal);
  if (square > 0) {
    const Integer s = dot(normal, cross(along_b, a0 - b0));
    const Integer t = dot(normal, cross(along_a, a0 - b0));
    if (s >= 0 && s <= square && t >= 0 && t <= square) {
      const Integer height = dot(normal, a0 - b0);
      best = std::min(best, {height * height, square});
    }
  }
  return {best.numerator, best.denominator, scaled};
}

bool is_inside_hull(const Vector3d& node, const FaceVertices& vertices, double share) {
  Scaled scaled = scaled_for(node, vertices);
  const auto x = seen_from(node, vertices, scaled);
  const Integer volumes[4] = {dot(cross(x[1], x[2]), x[3]), -dot(cross(x[0], x[2]), x[3]),
                              dot(cross(x[0], x[1]), x[3]), -dot(cross(x[0], x[1]), x[2])};
  Integer largest = 0;
  for (const IntegerVector& v : x)
    for (const Integer& component : v) largest = std::max(largest, Integer(abs(component)));
  const auto parts = static_cast<long>(share * 0x1p53);
  Integer least = largest * largest * largest * parts;
  const auto beyond = [&](int sign) {
    return std::all_of(std::begin(volumes), std::end(volumes), [&](const Integer& volume) {
      Integer large = volume * sign;
      mpz_mul_2exp(large.get_mpz_t(), large.get_mpz_t(), 53);
      return large > least;
    });
  };
  return beyond(1) || beyond(-1);
}

bool separated_by(const Vector3d& d, const std::vector<Vector3d>& first, const std::vector<Vector3d>& second,
                  double value) {
  Scaled scaled;  // one unit for lengths and one for the direction; that of the value is their product
  Scaled direction;
  scaled.note(1);
  direction.note(1);
  direction.note(d);
  for (const auto* points : {&first, &second})
    for (const Vector3d& point : *points) scaled.note(point);
  const IntegerVector along = direction(d);
  Integer least = dot(along, scaled(first[0]));
  for (const Vector3d& p : first) least = std::min(least, dot(along, scaled(p)));
  Integer greatest = dot(along, scaled(second[0]));
  for (const Vector3d& q : second) greatest = std::max(greatest, dot(along, scaled(q)));
  return mpq_class(least - greatest) >= mpq_class(value) * scaled(1) * direction(1);
}

}  // namespace brio::exact
