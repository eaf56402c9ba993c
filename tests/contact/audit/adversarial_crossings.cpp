#include "tests/contact/audit/adversarial_crossings.hpp"

#include <cmath>

#include "src/base/index.hpp"

namespace brio::test {

namespace {

std::array<Vector3d, 3> random_triangle(Random& random) {
  return {random.vector(1), random.vector(1), random.vector(1)};
}

Vector3d point_at(const std::array<Vector3d, 3>& triangle, double first, double second) {
  return (1 - first - second) * triangle[0] + first * triangle[1] + second * triangle[2];
}

double tiny(Random& random) {
  return random.integer(0, 2) == 0 ? 0 : (random.coin() ? 1 : -1) * random.power_of_ten(-17, -2);
}

// Through a point, but for rounding.
std::array<Vector3d, 2> through(const Vector3d& point, Random& random) {
  const Vector3d along = random.vector(1);
  return {point - random.uniform(0.1, 1) * along, point + random.uniform(0.1, 1) * along};
}

SegmentAndTriangle aimed(double first, double second, Random& random) {
  SegmentAndTriangle pair{.segment = {}, .triangle = random_triangle(random)};
  pair.segment = through(point_at(pair.triangle, first, second), random);
  return pair;
}

SegmentAndTriangle end_on_triangle(Random& random) {
  SegmentAndTriangle pair{.segment = {}, .triangle = random_triangle(random)};
  const double first = random.uniform(0, 1);
  const Vector3d point = point_at(pair.triangle, first, random.uniform(0, 1 - first));
  const Vector3d other = random.vector(1);
  pair.segment = {point + tiny(random) * (point - other), other};
  return pair;
}

SegmentAndTriangle coplanar(Random& random) {
  SegmentAndTriangle pair{.segment = {}, .triangle = random_triangle(random)};
  for (Vector3d& end : pair.segment)
    end = point_at(pair.triangle, random.uniform(-1, 2), random.uniform(-1, 2));
  return pair;
}

SegmentAndTriangle lattice(Random& random) {
  const int most = random.integer(1, 3);
  const auto vector = [&]() -> Vector3d {
    const int x = random.integer(-most, most), y = random.integer(-most, most);
    return {0.1 * x, 0.1 * y, 0.1 * random.integer(-most, most)};
  };
  return {.segment = {vector(), vector()}, .triangle = {vector(), vector(), vector()}};
}

SegmentAndTriangle sliver(Random& random) {
  SegmentAndTriangle pair{.segment = {}, .triangle = random_triangle(random)};
  const double height = random.integer(0, 4) == 0 ? 0 : random.power_of_ten(-17, -1);
  pair.triangle[2] = pair.triangle[0] + random.uniform(-0.5, 1.5) * (pair.triangle[1] - pair.triangle[0]) +
                     height * random.vector(1);
  const double first = random.uniform(0, 1);
  pair.segment = through(point_at(pair.triangle, first, random.uniform(0, 1 - first)), random);
  return pair;
}

SegmentAndTriangle parallel_edge(Random& random) {
  SegmentAndTriangle pair{.segment = {}, .triangle = random_triangle(random)};
  const Vector3d along = pair.triangle[1] - pair.triangle[0];
  for (Vector3d& end : pair.segment)
    end = pair.triangle[0] + random.uniform(-1, 2) * along + tiny(random) * random.vector(1);
  return pair;
}

SegmentAndTriangle short_segment(Random& random) {
  SegmentAndTriangle pair = aimed(random.uniform(0, 0.5), random.uniform(0, 0.5), random);
  const Vector3d middle = 0.5 * (pair.segment[0] + pair.segment[1]);
  const double size = random.power_of_ten(-12, -3);
  for (Vector3d& end : pair.segment) end = middle + size * (end - middle);
  return pair;
}

}  // namespace

std::string_view name_of(CrossingFamily family) {
  constexpr std::array<std::string_view, crossing_family_count> names{
      "random",  "through_inside", "through_edge",  "through_corner", "end_on_triangle", "coplanar",
      "lattice", "sliver",         "parallel_edge", "short_segment",  "far_from_origin"};
  return names[index(family)];
}

SegmentAndTriangle adversarial_crossing(CrossingFamily family, Random& random) {
  switch (family) {
    case CrossingFamily::random:
      return {.segment = {random.vector(1), random.vector(1)}, .triangle = random_triangle(random)};
    case CrossingFamily::through_inside:
      return aimed(random.uniform(0, 0.5), random.uniform(0, 0.5), random);
    case CrossingFamily::through_edge:
      return aimed(random.uniform(-0.1, 1.1), tiny(random), random);
    case CrossingFamily::through_corner:
      return aimed(tiny(random), tiny(random), random);
    case CrossingFamily::end_on_triangle:
      return end_on_triangle(random);
    case CrossingFamily::coplanar:
      return coplanar(random);
    case CrossingFamily::lattice:
      return lattice(random);
    case CrossingFamily::sliver:
      return sliver(random);
    case CrossingFamily::parallel_edge:
      return parallel_edge(random);
    case CrossingFamily::short_segment:
      return short_segment(random);
    case CrossingFamily::far_from_origin:
      break;
  }
  SegmentAndTriangle pair =
      adversarial_crossing(static_cast<CrossingFamily>(random.integer(0, crossing_family_count - 2)), random);
  const Vector3d far = random.vector(1e6);
  for (Vector3d& x : pair.segment) x += far;
  for (Vector3d& x : pair.triangle) x += far;
  return pair;
}

}  // namespace brio::test
