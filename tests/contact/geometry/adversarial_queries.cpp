#include "tests/contact/geometry/adversarial_queries.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "src/base/index.hpp"

namespace brio {

namespace {

using Weights = std::array<double, 4>;

MovingFace random_face(Random& random, double motion) {
  // A warped unit square, turned at will, or four points anywhere.
  MovingFace face;
  const Vector3d u = random.vector(1);
  const Vector3d v = random.vector(1);
  const bool square = random.integer(0, 3) > 0;
  const double warp = random.power_of_ten(-6, 0);
  static constexpr int corner[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  for (std::size_t k = 0; k < 4; ++k) {
    face.start[k] =
        square ? Vector3d(corner[k][0] * u + corner[k][1] * v + random.vector(warp)) : random.vector(1);
    face.displacement[k] = random.vector(motion);
  }
  return face;
}

Weights blend(const Weights& a, const Weights& b, double share) {
  Weights result;
  for (std::size_t k = 0; k < 4; ++k) result[k] = (1 - share) * a[k] + share * b[k];
  return result;
}

Weights at_corner(int k) {
  Weights weights{0, 0, 0, 0};
  weights[index(k % 4)] = 1;
  return weights;
}

constexpr Weights at_centroid = {0.25, 0.25, 0.25, 0.25};

Vector3d point_at(const MovingFace& face, const Weights& weights, double time) {
  Vector3d point{};
  for (std::size_t k = 0; k < 4; ++k) point += weights[k] * (face.start[k] + time * face.displacement[k]);
  return point;
}

double any_time(Random& random) {
  switch (random.integer(0, 9)) {
    case 0:
      return 0;
    case 1:
      return 1;
    case 2:
      return random.power_of_ten(-17, 0);
    default:
      return random.uniform(0, 1);
  }
}

// A node that passes through the point of the face at the time, but for rounding.
MovingNode aimed(const MovingFace& face, const Weights& weights, double time, const Vector3d& displacement) {
  return {point_at(face, weights, time) - time * displacement, displacement};
}

Query aimed_at_edge(Random& random, double motion) {
  Query query;
  query.face = random_face(random, motion);
  const int k = random.integer(0, 3);
  const Weights weights = blend(at_corner(k), at_corner(k + 1), random.uniform(0, 1));
  query.node = aimed(query.face, weights, any_time(random), random.vector(1));
  return query;
}

Query aimed_at_corner(Random& random) {
  Query query;
  query.face = random_face(random, 1);
  query.node = aimed(query.face, at_corner(random.integer(0, 3)), any_time(random), random.vector(1));
  return query;
}

Query aimed_at_seam(Random& random) {
  Query query;
  query.face = random_face(random, 1);
  const double share = random.integer(0, 4) == 0 ? 1 : random.uniform(0, 1);
  const Weights weights = blend(at_corner(random.integer(0, 3)), at_centroid, share);
  query.node = aimed(query.face, weights, any_time(random), random.vector(1));
  return query;
}

Query aimed_near_edge(Random& random) {
  Query query;
  query.face = random_face(random, 1);
  const int k = random.integer(0, 3);
  const double outside = random.power_of_ten(-17, -2) * (random.coin() ? 1 : -1);
  const Weights on_edge = blend(at_corner(k), at_corner(k + 1), random.uniform(0, 1));
  query.node = aimed(query.face, blend(on_edge, at_centroid, outside), any_time(random), random.vector(1));
  return query;
}

Vector3d lattice_vector(Random& random, int most) {
  const int x = random.integer(-most, most);
  const int y = random.integer(-most, most);
  return {64.0 * x, 64.0 * y, 64.0 * random.integer(-most, most)};
}

// Multiples of 64 with times of eighths and weights of sixteenths: every hit is exact.
Query lattice(Random& random) {
  Query query;
  const int most = random.integer(1, 4);
  for (std::size_t k = 0; k < 4; ++k) {
    query.face.start[k] = lattice_vector(random, most);
    query.face.displacement[k] = random.coin() ? lattice_vector(random, most) : Vector3d{0, 0, 0};
  }
  Weights weights;
  const int k = random.integer(0, 3);
  const double share = 0.25 * random.integer(0, 4);
  switch (random.integer(0, 3)) {
    case 0:
      weights = at_corner(k);
      break;
    case 1:
      weights = blend(at_corner(k), at_corner(k + 1), share);
      break;
    case 2:
      weights = blend(at_corner(k), at_centroid, share);
      break;
    default:
      weights = blend(blend(at_corner(k), at_corner(k + 1), share), at_centroid, 0.5);
      break;
  }
  query.node = aimed(query.face, weights, 0.125 * random.integer(0, 8), lattice_vector(random, most));
  return query;
}

double by_an_ulp(Random& random, double value) {
  const int steps = random.integer(-1, 1);
  return steps == 0 ? value : std::nextafter(value, steps * 1e300);
}

// The face turns about the x axis: its height at y is slope (t - a) y. The node at height c + d t moves along
// y from y0 by m, such that node minus face is -slope m (t - r)^2: it touches at r and does not cross.
Query grazing(Random& random) {
  Query query;
  const int half = random.integer(0, 1);
  const double slope = 4.0 * random.integer(-3, 3);
  const double a = 0.25 * random.integer(0, 4);
  const double y0 = 0.125 * random.integer(-8, 8);
  const double m = 0.25 * random.integer(-4, 4);
  const double r = 0.125 * random.integer(0, 8);
  const double d = 2 * slope * m * r + slope * y0 - slope * a * m;
  const double c = -slope * m * r * r - slope * a * y0;
  static constexpr int corner[4][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
  for (std::size_t k = 0; k < 4; ++k) {
    const double x = 2 * corner[k][0];
    const double y = half * 1.0 + 2 * corner[k][1];
    query.face.start[k] = {x, y, -slope * a * y};
    query.face.displacement[k] = {0, 0, slope * y};
  }
  query.node.start = {0.25 * random.integer(-8, 8), y0, by_an_ulp(random, c)};
  query.node.displacement = {0.25 * random.integer(-2, 2), m, by_an_ulp(random, d)};
  return query;
}

Query any_aimed(Random& random) {
  switch (random.integer(0, 4)) {
    case 0:
      return aimed_at_edge(random, 1);
    case 1:
      return aimed_at_corner(random);
    case 2:
      return aimed_at_seam(random);
    case 3:
      return aimed_near_edge(random);
    default:
      return lattice(random);
  }
}

double size_of(const Query& query) {
  double size = 0;
  for (std::size_t k = 1; k < 4; ++k) size = std::max(size, norm(query.face.start[k] - query.face.start[0]));
  return size;
}

Query far_from_origin(Random& random) {
  Query query = any_aimed(random);
  const double far = 1e6 * size_of(query);
  // Multiples of a power of two keep lattice hits exact; others are rounded like any mesh far away.
  const Vector3d shift = random.coin() ? random.vector(far) : Vector3d(lattice_vector(random, 1 << 20));
  query.node.start += shift;
  for (Vector3d& x : query.face.start) x += shift;
  return query;
}

Query moving_frame(Random& random) {
  Query query = any_aimed(random);
  const double fast = 1e3 * size_of(query);
  const Vector3d shift = random.coin() ? random.vector(fast) : Vector3d(lattice_vector(random, 1 << 10));
  query.node.displacement += shift;
  for (Vector3d& x : query.face.displacement) x += shift;
  return query;
}

Query sliver(Random& random) {
  Query query;
  query.face = random_face(random, random.coin() ? 1 : 0);
  const double height = random.integer(0, 3) == 0 ? 0 : random.power_of_ten(-15, -1);
  const Vector3d along = random.vector(1);
  const bool narrow_motion = random.coin();
  for (std::size_t k = 0; k < 4; ++k) {  // flattened onto a line, or onto a point
    const bool point = random.integer(0, 15) == 0;
    const double reach = point ? 0 : random.uniform(-1, 1);
    query.face.start[k] = reach * along + height * query.face.start[k];
    if (narrow_motion) query.face.displacement[k] = random.uniform(-1, 1) * along + height * random.vector(1);
  }
  if (random.integer(0, 7) == 0) {  // two vertices in one
    const int k = random.integer(0, 3);
    query.face.start[index(k)] = query.face.start[index((k + 1) % 4)];
    query.face.displacement[index(k)] = query.face.displacement[index((k + 1) % 4)];
  }
  const int k = random.integer(0, 3);
  const Weights on_edge = blend(at_corner(k), at_corner(k + 1), random.uniform(0, 1));
  const Weights target = random.coin() ? on_edge : blend(on_edge, at_centroid, random.uniform(-0.5, 1));
  query.node = aimed(query.face, target, any_time(random), random.vector(random.coin() ? 1 : height));
  return query;
}

Query fast(Random& random) {
  Query query;
  query.face = random_face(random, random.coin() ? 0 : 1);
  const double speed = random.power_of_ten(1, 4);
  const int k = random.integer(0, 3);
  const Weights on_edge = blend(at_corner(k), at_corner(k + 1), random.uniform(0, 1));
  const Weights target = random.coin() ? on_edge : blend(on_edge, at_centroid, random.uniform(-0.01, 1));
  query.node = aimed(query.face, target, random.uniform(0, 1), random.vector(speed));
  if (random.coin()) return query;
  for (Vector3d& displacement : query.face.displacement) displacement -= query.node.displacement;
  query.node.displacement = {};
  query.node.start = point_at(query.face, target, random.uniform(0, 1));
  return query;
}

Query coplanar(Random& random) {
  Query query = lattice(random);
  // x and y at will, z = 0 or z = x + 2 y for all: an exact plane.
  const bool level = random.coin();
  const auto flatten = [&](Vector3d& v) {
    if (random.integer(0, 7) == 0) v.x += random.integer(-63, 63);
    v.z = level ? 0 : v.x + 2 * v.y;
  };
  for (Vector3d& x : query.face.start) flatten(x);
  for (Vector3d& x : query.face.displacement) flatten(x);
  flatten(query.node.displacement);
  flatten(query.node.start);
  return query;
}

Query still(Random& random) {
  Query query = any_aimed(random);
  const Vector3d common = random.coin() ? Vector3d{0, 0, 0} : lattice_vector(random, 1000);
  const double time = 0.125 * random.integer(0, 8);
  query.node.start += time * query.node.displacement;
  query.node.displacement = common;
  for (std::size_t k = 0; k < 4; ++k) {
    query.face.start[k] += time * query.face.displacement[k];
    query.face.displacement[k] = common;
  }
  return query;
}

Query triangle(Random& random) {
  Query query = any_aimed(random);
  query.face.start[3] = query.face.start[2];
  query.face.displacement[3] = query.face.displacement[2];
  const int k = random.integer(0, 2);
  Weights weights{0, 0, 0, 0};
  const double share = 0.25 * random.integer(0, 4);
  weights[index(k)] = 1 - share;
  weights[index((k + 1) % 3)] = share;
  const double time = 0.125 * random.integer(0, 8);
  query.node = aimed(query.face, weights, time, query.node.displacement);
  return query;
}

// The same query in another unit (a power of two) and with its vertices in another order, where that is no
// matter.
void disguise(Query& query, Random& random, bool reorder) {
  const double unit = std::ldexp(1.0, random.integer(-20, 20));
  query.node.start *= unit;
  query.node.displacement *= unit;
  for (std::size_t k = 0; k < 4; ++k) {
    query.face.start[k] *= unit;
    query.face.displacement[k] *= unit;
  }
  if (!reorder) return;
  const auto turns = random.integer(0, 3);
  std::rotate(query.face.start.begin(), query.face.start.begin() + turns, query.face.start.end());
  std::rotate(query.face.displacement.begin(), query.face.displacement.begin() + turns,
              query.face.displacement.end());
  if (random.coin()) {
    std::swap(query.face.start[1], query.face.start[3]);
    std::swap(query.face.displacement[1], query.face.displacement[3]);
  }
}

Query plain(Family family, Random& random) {
  switch (family) {
    case Family::random:
      return {{random.vector(1), random.vector(1)}, random_face(random, 1)};
    case Family::outer_edge:
      return aimed_at_edge(random, 1);
    case Family::corner:
      return aimed_at_corner(random);
    case Family::seam:
      return aimed_at_seam(random);
    case Family::near_edge:
      return aimed_near_edge(random);
    case Family::lattice:
      return lattice(random);
    case Family::grazing:
      return grazing(random);
    case Family::far_from_origin:
      return far_from_origin(random);
    case Family::moving_frame:
      return moving_frame(random);
    case Family::sliver:
      return sliver(random);
    case Family::fast:
      return fast(random);
    case Family::coplanar:
      return coplanar(random);
    case Family::still:
      return still(random);
    case Family::triangle:
      break;
  }
  return triangle(random);
}

}  // namespace

std::string_view name_of(Family family) {
  static constexpr std::array<std::string_view, family_count> names = {
      "random",          "outer edge",   "corner", "seam", "near edge", "lattice", "grazing",
      "far from origin", "moving frame", "sliver", "fast", "coplanar",  "still",   "triangle"};
  return names[index(family)];
}

Query adversarial_query(Family family, Random& random) {
  Query query = plain(family, random);
  disguise(query, random, family != Family::triangle);
  return query;
}

}  // namespace brio
