#include "tests/contact/geometry/adversarial_edges.hpp"

#include <algorithm>
#include <cmath>

#include "contact/geometry/closest_point.hpp"
#include "src/base/index.hpp"

namespace brio {

namespace {

MovingEdge random_edge(Random& random, double motion) {
  MovingEdge edge;
  for (std::size_t k = 0; k < 2; ++k) {
    edge.start[k] = random.vector(1);
    edge.displacement[k] = random.vector(motion);
  }
  return edge;
}

Vector3d point_at(const MovingEdge& edge, double share, double time) {
  return (1 - share) * (edge.start[0] + time * edge.displacement[0]) +
         share * (edge.start[1] + time * edge.displacement[1]);
}

Vector3d along(const MovingEdge& edge, double time) {
  return point_at(edge, 1, time) - point_at(edge, 0, time);
}

void shift(MovingEdge& edge, const Vector3d& by) {
  for (Vector3d& x : edge.start) x += by;
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

// Moves a so that the two points meet at the time, but for rounding.
EdgeQuery aimed(EdgeQuery query, double on_a, double on_b, double time) {
  shift(query.a, point_at(query.b, on_b, time) - point_at(query.a, on_a, time));
  return query;
}

EdgeQuery aimed_at_random(Random& random, double on_a, double on_b) {
  const double motion = random.integer(0, 3) == 0 ? 0 : 1;
  EdgeQuery query{random_edge(random, 1), random_edge(random, motion)};
  return aimed(query, on_a, on_b, any_time(random));
}

EdgeQuery near_miss(Random& random) {
  const double past = random.power_of_ten(-17, -2) * (random.coin() ? 1 : -1);
  const double on_b = random.integer(0, 3) == 0 ? 1 + random.power_of_ten(-17, -2) : random.uniform(0, 1);
  return aimed_at_random(random, random.coin() ? 1 + past : -past, on_b);
}

Vector3d lattice_vector(Random& random, int most) {
  const int x = random.integer(-most, most);
  const int y = random.integer(-most, most);
  return {64.0 * x, 64.0 * y, 64.0 * random.integer(-most, most)};
}

// Multiples of 64 with times of eighths and parameters of quarters: every hit is exact.
EdgeQuery edges_of_lattice(Random& random) {
  EdgeQuery query;
  const int most = random.integer(1, 4);
  for (MovingEdge* edge : {&query.a, &query.b}) {
    for (std::size_t k = 0; k < 2; ++k) {
      edge->start[k] = lattice_vector(random, most);
      edge->displacement[k] = random.coin() ? lattice_vector(random, most) : Vector3d{0, 0, 0};
    }
  }
  return aimed(query, 0.25 * random.integer(0, 4), 0.25 * random.integer(0, 4), 0.125 * random.integer(0, 8));
}

double by_an_ulp(Random& random, double value) {
  const int steps = random.integer(-1, 1);
  return steps == 0 || value == 0 ? value : std::nextafter(value, steps * 1e300);
}

// Edge b turns about the x axis: its height at y is slope (t - p) y. Edge a lies along x at the height c + d
// t and moves along y from y0 by m, such that a minus b is -slope m (t - r)^2: it touches at r and does not
// cross.
EdgeQuery grazing(Random& random) {
  EdgeQuery query;
  const double slope = 4.0 * random.integer(-3, 3);
  const double p = 0.25 * random.integer(0, 4);
  const double y0 = 0.125 * random.integer(-8, 8);
  const double m = 0.25 * random.integer(-4, 4);
  const double r = 0.125 * random.integer(0, 8);
  const double d = by_an_ulp(random, 2 * slope * m * r + slope * y0 - slope * p * m);
  const double c = by_an_ulp(random, -slope * m * r * r - slope * p * y0);
  const double x = 0.25 * random.integer(-4, 4);
  for (std::size_t k = 0; k < 2; ++k) {
    const double end = k == 0 ? -2 : 2;
    query.b.start[k] = {x, end, -slope * p * end};
    query.b.displacement[k] = {0, 0, slope * end};
    query.a.start[k] = {end + 0.25 * random.integer(-4, 4), y0, c};
    query.a.displacement[k] = {0, m, d};
  }
  return query;
}

// Lattice directions and motions: exactly parallel throughout, side by side, in one line, or past each other.
EdgeQuery parallel(Random& random) {
  EdgeQuery query;
  const Vector3d direction = lattice_vector(random, 2);
  const Vector3d turn = random.coin() ? lattice_vector(random, 2) : Vector3d{0, 0, 0};
  const double stretch = random.coin() ? 0 : 1;
  for (MovingEdge* edge : {&query.a, &query.b}) {
    const double length = 0.25 * random.integer(-4, 4);
    const Vector3d motion = random.integer(0, 2) == 0 ? Vector3d(0.5 * direction) : lattice_vector(random, 2);
    edge->start[0] = lattice_vector(random, 2);
    edge->start[1] = edge->start[0] + length * direction;
    edge->displacement[0] = motion;
    edge->displacement[1] = motion + length * (random.coin() ? turn : Vector3d(stretch * direction));
  }
  query =
      aimed(query, 0.25 * random.integer(-1, 5), 0.25 * random.integer(-1, 5), 0.125 * random.integer(0, 8));
  if (random.integer(0, 2) == 0)
    for (Vector3d& x : query.a.start)
      for (int i = 0; i < 3; ++i) x[i] = by_an_ulp(random, x[i]);
  if (random.integer(0, 3) > 0) return query;
  shift(query.a, random.vector(random.power_of_ten(-14, 0)));
  return query;
}

EdgeQuery becoming_parallel(Random& random) {
  EdgeQuery query{random_edge(random, 1), random_edge(random, 1)};
  const double time = any_time(random);
  const double scale = random.uniform(-1, 1);
  query.a.start[1] = query.a.start[0] + time * query.a.displacement[0] + scale * along(query.b, time) -
                     time * query.a.displacement[1];
  query = aimed(query, random.uniform(-0.1, 1.1), random.uniform(-0.1, 1.1), time);
  if (random.coin()) shift(query.a, random.vector(random.power_of_ten(-17, -1)));
  return query;
}

EdgeQuery coplanar(Random& random) {
  EdgeQuery query = edges_of_lattice(random);
  const bool level = random.coin();
  const bool odd = random.coin();
  for (MovingEdge* edge : {&query.a, &query.b}) {
    for (Segment* ends : {&edge->start, &edge->displacement}) {
      for (Vector3d& v : *ends) {
        if (odd) v.x += random.integer(-63, 63);
        v.z = level ? 0 : v.x + 2 * v.y;
      }
    }
  }
  return query;
}

EdgeQuery shared_end(Random& random) {
  EdgeQuery query{random_edge(random, 1), random_edge(random, 1)};
  const auto i = index(random.integer(0, 1));
  const auto j = index(random.integer(0, 1));
  query.a.start[i] = query.b.start[j];
  query.a.displacement[i] = query.b.displacement[j];
  if (random.coin()) return query;
  // All but: apart or past each other by little.
  const double little = random.power_of_ten(-17, -8);
  query.a.start[i] += random.vector(little);
  query.a.displacement[i] += random.vector(random.coin() ? little : 0);
  return query;
}

EdgeQuery sliver(Random& random) {
  EdgeQuery query{random_edge(random, random.coin() ? 1 : 0), random_edge(random, random.coin() ? 1 : 0)};
  const double angle = random.integer(0, 3) == 0 ? 0 : random.power_of_ten(-15, -1);
  const bool narrow_motion = random.coin();
  const Vector3d direction = random.vector(1);
  for (MovingEdge* edge : {&query.a, &query.b}) {
    double length = 1;
    if (random.integer(0, 3) == 0) length = random.integer(0, 3) == 0 ? 0 : random.power_of_ten(-15, -1);
    edge->start[1] = edge->start[0] + length * (direction + angle * random.vector(1));
    if (narrow_motion)
      edge->displacement[1] =
          edge->displacement[0] + length * (random.uniform(-1, 1) * direction + angle * random.vector(1));
    else if (length < 1)
      edge->displacement[1] = edge->displacement[0] + length * random.vector(1);
  }
  query = aimed(query, random.uniform(-0.1, 1.1), random.uniform(-0.1, 1.1), any_time(random));
  if (random.coin()) shift(query.a, random.vector(angle));
  return query;
}

EdgeQuery any_aimed(Random& random) {
  switch (random.integer(0, 5)) {
    case 0:
      return aimed_at_random(random, random.uniform(0, 1), random.uniform(0, 1));
    case 1:
      return aimed_at_random(random, random.integer(0, 1), random.uniform(0, 1));
    case 2:
      return aimed_at_random(random, random.integer(0, 1), random.integer(0, 1));
    case 3:
      return near_miss(random);
    case 4:
      return parallel(random);
    default:
      return edges_of_lattice(random);
  }
}

double size_of(const EdgeQuery& query) { return std::max(norm(along(query.a, 0)), norm(along(query.b, 0))); }

// Multiples of a power of two keep lattice hits exact; others are rounded like any mesh far away.
EdgeQuery far_from_origin(Random& random) {
  EdgeQuery query = any_aimed(random);
  const Vector3d far =
      random.coin() ? random.vector(1e6 * size_of(query)) : Vector3d(lattice_vector(random, 1 << 20));
  shift(query.a, far);
  shift(query.b, far);
  return query;
}

EdgeQuery moving_frame(Random& random) {
  EdgeQuery query = any_aimed(random);
  const Vector3d motion =
      random.coin() ? random.vector(1e3 * size_of(query)) : Vector3d(lattice_vector(random, 1 << 10));
  for (MovingEdge* edge : {&query.a, &query.b})
    for (Vector3d& displacement : edge->displacement) displacement += motion;
  return query;
}

EdgeQuery fast(Random& random) {
  EdgeQuery query{random_edge(random, 1), random_edge(random, random.coin() ? 1 : 0)};
  const double speed = random.power_of_ten(1, 4);
  const Vector3d motion = random.vector(speed);
  for (Vector3d& displacement : query.a.displacement)
    displacement = random.coin() ? motion : Vector3d(random.vector(speed));
  return aimed(query, random.uniform(-0.01, 1.01), random.uniform(-0.01, 1.01), random.uniform(0, 1));
}

EdgeQuery still(Random& random) {
  EdgeQuery query = any_aimed(random);
  const Vector3d common = random.coin() ? Vector3d{0, 0, 0} : lattice_vector(random, 1000);
  const double time = 0.125 * random.integer(0, 8);
  for (MovingEdge* edge : {&query.a, &query.b}) {
    for (std::size_t k = 0; k < 2; ++k) {
      edge->start[k] += time * edge->displacement[k];
      edge->displacement[k] = common;
    }
  }
  return query;
}

void add_radius(EdgeQuery& query, double reach, Random& random) {
  query.a.radius = random.integer(0, 3) == 0 ? 0 : random.uniform(0, 1) * reach;
  query.b.radius = reach - query.a.radius;
}

EdgeQuery at_reach(Random& random) {
  const auto family = static_cast<EdgeFamily>(random.integer(0, static_cast<int>(EdgeFamily::still)));
  EdgeQuery query = adversarial_edges(family, random);
  const double reach = size_of(query) * random.power_of_ten(-6, 0);
  add_radius(query, reach, random);
  if (random.coin()) shift(query.a, unit_or(random.vector(1), Vector3d{1, 0, 0}) * reach);
  return query;
}

// The points move past each other at right angles to the offset between them, which is the reach but for
// little; the edges turn as they like, or are at right angles to it too.
EdgeQuery past_at_reach(Random& random) {
  EdgeQuery query{random_edge(random, random.coin() ? 1 : 0), random_edge(random, 0)};
  const double time = any_time(random);
  const double on_a = random.integer(0, 2) == 0 ? random.integer(0, 1) : random.uniform(0, 1);
  const double on_b = random.integer(0, 2) == 0 ? random.integer(0, 1) : random.uniform(0, 1);
  query = aimed(query, on_a, on_b, time);
  Vector3d offset = cross(along(query.a, time), along(query.b, time));
  if (random.integer(0, 3) == 0) offset = cross(along(query.b, time), random.vector(1));
  offset = unit_or(offset, Vector3d{1, 0, 0});
  const Vector3d relative = (1 - on_a) * query.a.displacement[0] + on_a * query.a.displacement[1];
  for (Vector3d& displacement : query.a.displacement) displacement -= offset * dot(relative, offset);
  query = aimed(query, on_a, on_b, time);
  const double reach = random.power_of_ten(-6, 0);
  const double little = random.power_of_ten(-17, -2) * (random.coin() ? 1 : -1);
  shift(query.a, offset * (reach * (1 + little)));
  add_radius(query, reach, random);
  return query;
}

// The same query in another unit (a power of two), with its edges and ends in another order.
void disguise(EdgeQuery& query, Random& random) {
  const double unit = std::ldexp(1.0, random.integer(-20, 20));
  for (MovingEdge* edge : {&query.a, &query.b}) {
    for (std::size_t k = 0; k < 2; ++k) {
      edge->start[k] *= unit;
      edge->displacement[k] *= unit;
    }
    edge->radius *= unit;
    if (random.coin()) continue;
    std::swap(edge->start[0], edge->start[1]);
    std::swap(edge->displacement[0], edge->displacement[1]);
  }
  if (random.coin()) std::swap(query.a, query.b);
}

EdgeQuery plain(EdgeFamily family, Random& random) {
  switch (family) {
    case EdgeFamily::random:
      return {random_edge(random, 1), random_edge(random, 1)};
    case EdgeFamily::crossing:
      return aimed_at_random(random, random.uniform(0, 1), random.uniform(0, 1));
    case EdgeFamily::end_on_inside:
      return aimed_at_random(random, random.integer(0, 1), random.uniform(0, 1));
    case EdgeFamily::end_on_end:
      return aimed_at_random(random, random.integer(0, 1), random.integer(0, 1));
    case EdgeFamily::near_miss:
      return near_miss(random);
    case EdgeFamily::lattice:
      return edges_of_lattice(random);
    case EdgeFamily::grazing:
      return grazing(random);
    case EdgeFamily::parallel:
      return parallel(random);
    case EdgeFamily::becoming_parallel:
      return becoming_parallel(random);
    case EdgeFamily::coplanar:
      return coplanar(random);
    case EdgeFamily::shared_end:
      return shared_end(random);
    case EdgeFamily::sliver:
      return sliver(random);
    case EdgeFamily::far_from_origin:
      return far_from_origin(random);
    case EdgeFamily::moving_frame:
      return moving_frame(random);
    case EdgeFamily::fast:
      return fast(random);
    case EdgeFamily::still:
      return still(random);
    case EdgeFamily::radius:
      return at_reach(random);
    case EdgeFamily::radius_near_miss:
      break;
  }
  return past_at_reach(random);
}

}  // namespace

std::string_view name_of(EdgeFamily family) {
  static constexpr std::array<std::string_view, edge_family_count> names = {
      "random",     "crossing", "end on inside",   "end on end",        "near miss",
      "lattice",    "grazing",  "parallel",        "becoming parallel", "coplanar",
      "shared end", "sliver",   "far from origin", "moving frame",      "fast",
      "still",      "radius",   "radius near miss"};
  return names[index(family)];
}

EdgeQuery adversarial_edges(EdgeFamily family, Random& random) {
  EdgeQuery query = plain(family, random);
  disguise(query, random);
  return query;
}

}  // namespace brio
