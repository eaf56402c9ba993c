#include "tests/contact/detection/still_queries.hpp"

#include "src/base/index.hpp"

namespace brio {

namespace {

double small(Random& random) { return random.integer(0, 5) == 0 ? 0 : random.power_of_ten(-17, 0); }

Vector3d lattice(Random& random) {
  return {double(random.integer(-2, 2)), double(random.integer(-2, 2)), double(random.integer(-2, 2))};
}

FaceVertices square(Random& random, double warp) {
  const Vector3d u = random.vector(1);
  const Vector3d v = random.vector(1);
  const Vector3d corner = random.vector(1);
  const Vector3d w = warp * random.vector(1);
  return {corner, corner + u, corner + u + v + w, corner + v};
}

// Four vertices along a line but for `height`, in any order along it.
FaceVertices sliver(Random& random, double height) {
  const Vector3d along = random.vector(1);
  FaceVertices face;
  for (Vector3d& vertex : face) vertex = random.uniform(-1, 1) * along + height * random.vector(1);
  return face;
}

FaceVertices any_face(Random& random) {
  FaceVertices face;
  switch (random.integer(0, 6)) {
    case 0:
      for (Vector3d& vertex : face) vertex = random.vector(1);
      break;
    case 1:
    case 2:
      face = square(random, small(random));
      break;
    case 3:
      face = sliver(random, small(random));
      break;
    case 4:
      for (Vector3d& vertex : face) vertex = lattice(random);
      break;
    case 5:  // flat, convex or not, or folded over
      face = square(random, 0);
      face[2] = face[0] + random.uniform(-0.5, 1.5) * (face[1] - face[0]) +
                random.uniform(-0.5, 1.5) * (face[3] - face[0]);
      break;
    default:
      face = square(random, 1);
      face[index(random.integer(0, 3))] =
          face[index(random.integer(0, 3))] + small(random) * random.vector(1);
      break;
  }
  if (random.integer(0, 4) == 0) face[3] = face[2];
  return face;
}

// Inside, on a side, a diagonal, or at a vertex.
Vector3d any_point(Random& random, const FaceVertices& face) {
  double weights[4] = {0, 0, 0, 0};
  const int vertices = random.integer(1, 4);
  double sum = 0;
  for (int k = 0; k < vertices; ++k) {
    const double weight = random.integer(0, 3) == 0 ? 0.25 * random.integer(1, 4) : random.uniform(0, 1);
    weights[random.integer(0, 3)] += weight;
    sum += weight;
  }
  Vector3d point{};
  for (std::size_t k = 0; k < 4; ++k) point += weights[k] / sum * face[k];
  return point;
}

Vector3d any_shift(Random& random) { return random.integer(0, 3) == 0 ? random.vector(1e6) : Vector3d{}; }

}  // namespace

FaceQuery any_face_query(Random& random) {
  FaceQuery query{Vector3d{}, any_face(random)};
  const Vector3d point = any_point(random, query.face);
  switch (random.integer(0, 4)) {
    case 0:
      query.node = random.vector(2);
      break;
    case 1:
      query.node = lattice(random);
      break;
    case 2:  // over the point, along the normal
      query.node =
          point + small(random) * cross(query.face[2] - query.face[0], query.face[3] - query.face[1]);
      break;
    default:
      query.node = point + small(random) * random.vector(1);
      break;
  }
  const Vector3d shift = any_shift(random);
  query.node += shift;
  const bool is_triangle = query.face[3] == query.face[2];
  for (Vector3d& vertex : query.face) vertex += shift;
  if (is_triangle) query.face[3] = query.face[2];
  return query;
}

SegmentQuery any_segment_query(Random& random) {
  SegmentQuery query;
  auto& [a, b] = query;
  const Vector3d along = random.vector(1);
  const Vector3d other =
      random.integer(0, 1) == 0 ? random.vector(1) : Vector3d(along + small(random) * random.vector(1));
  switch (random.integer(0, 4)) {
    case 0:
      a = {random.vector(1), random.vector(1)};
      b = {random.vector(1), random.vector(1)};
      break;
    case 1:
      a = {lattice(random), lattice(random)};
      b = {lattice(random), lattice(random)};
      break;
    case 2: {  // their lines meet at a point, or nearly
      const Vector3d meet = random.vector(1);
      const double s = random.uniform(-0.5, 1.5);
      const double t = random.uniform(-0.5, 1.5);
      const Vector3d apart = small(random) * cross(along, other) + small(random) * random.vector(1);
      a = {meet - s * along, meet + (1 - s) * along};
      b = {meet - t * other + apart, meet + (1 - t) * other + apart};
      break;
    }
    case 3: {  // side by side
      const double length = random.uniform(-2, 2);
      const Vector3d start = random.uniform(-2, 2) * along + small(random) * random.vector(1);
      a = {Vector3d{}, along};
      b = {start, start + length * (random.coin() ? along : other)};
      break;
    }
    default:
      a = {random.vector(1), random.vector(1)};
      b = {a[index(random.integer(0, 1))] + small(random) * random.vector(1), random.vector(1)};
      break;
  }
  if (random.integer(0, 5) == 0) a[1] = a[0] + small(random) * along;
  if (random.integer(0, 5) == 0) b[1] = b[0] + small(random) * other;
  if (random.coin()) std::swap(a, b);
  const Vector3d shift = any_shift(random);
  for (Segment* segment : {&a, &b})
    for (Vector3d& end : *segment) end += shift;
  return query;
}

}  // namespace brio
