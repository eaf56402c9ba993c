#include "contact/convex_feature.hpp"

#include <algorithm>
#include <cmath>

#include "src/base/floating_point.hpp"

namespace brio {

using Eigen::Vector3d;

namespace {

/// Most faces that compete: those around the corners of one.
constexpr std::size_t most_faces = 24;
/// Faces closer in direction than this (about 8 degrees) are one smooth surface.
constexpr double smooth = 0.99;
/// The node's own surface opposes a face by at least this, and by this share of the best opposed one.
constexpr double least_opposed = 0.1;
constexpr double least_opposed_share = 0.5;
/// Impulses below a face may be extrapolated this far beside it, over its edge.
constexpr double farthest_beside = 0.05;
/// Depth of a face that is opposed where the closest one is not, over the edge.
constexpr double deepest_opposed = 0.05;
/// What a direction of the last step may be worse by, in hairs.
constexpr double kept_share = 1e-2;

struct Plane {
  int face = 0;
  std::array<double, 4> weights{};
  Vector3d normal = Vector3d::Zero();
  double beside = 0;  ///< of the node, from the face within its plane
  double start = 0;   ///< gap at the beginning of the step
  double end = 0;     ///< and at its predicted end
  double opposed = 1;
};

struct Planes {
  std::array<Plane, most_faces + 1> plane;
  std::size_t count = 0;

  void add(const Plane& entry) {
    if (count < plane.size()) plane[count++] = entry;
  }
  std::span<const Plane> all() const { return {plane.data(), count}; }
};

const Face& face_of(const NodeAtFeature& query, int f) {
  return query.surface.face[static_cast<std::size_t>(f)];
}

Vector3d relative_velocity(const NodeAtFeature& query, int f, const std::array<double, 4>& weights) {
  Vector3d relative = velocity(query.nodes, query.surface.node[static_cast<std::size_t>(query.slave)]);
  for (std::size_t k = 0; k < 4; ++k)
    if (weights[k] != 0) relative -= weights[k] * velocity(query.nodes, face_of(query, f).node[k]);
  return relative;
}

// How squarely a face around the node looks against the direction; nodes of shells alone look all ways.
double opposition(const NodeAtFeature& query, const Vector3d& direction) {
  if (query.surface.of_solid[static_cast<std::size_t>(query.slave)] == 0) return 1;
  double best = -1;
  for (int f : query.surface.faces_of.of(query.slave)) {
    if (face_of(query, f).shell) continue;
    const FaceVertices v = vertices(query.nodes, face_of(query, f));
    const Vector3d normal = unit_or((v[2] - v[0]).cross(v[3] - v[1]), Vector3d::Zero());
    best = std::max(best, -normal.dot(direction));
  }
  return best;
}

double distance_to_edge(const Vector3d& point, const Vector3d& a, const Vector3d& b) {
  const Vector3d along = b - a;
  const double length = along.squaredNorm();
  const double t = length > 0 ? std::clamp((point - a).dot(along) / length, 0.0, 1.0) : 0;
  return (point - a - t * along).norm();
}

// Faces next to that of the query whose common edge or vertex is within `range` of a point of it.
class FacesAround {
 public:
  FacesAround(const NodeAtFeature& query, const FaceVertices& v, const Vector3d& point, double range) {
    const Face& own = face_of(query, query.face);
    const auto corners = static_cast<std::size_t>(own.corners());
    for (std::size_t k = 0; k < corners; ++k) {
      if (distance_to_edge(point, v[k], v[(k + 1) % corners]) <= range)
        add(query, query.surface.neighbor[static_cast<std::size_t>(query.face)][k]);
      if ((point - v[k]).norm() > range) continue;
      for (int f : query.surface.faces_of.of(query.surface.slave(own.node[k]))) add(query, f);
    }
  }
  std::span<const int> all() const { return {face_.data(), count_}; }

 private:
  void add(const NodeAtFeature& query, int f) {
    if (f < 0 || f == query.face || face_of(query, f).shell || count_ == face_.size()) return;
    if (std::find(face_.begin(), face_.begin() + count_, f) == face_.begin() + count_) face_[count_++] = f;
  }
  std::array<int, most_faces> face_{};
  std::size_t count_ = 0;
};

Vector3d centroid(const FaceVertices& v) {
  return v[0] + 0.25 * ((v[1] - v[0]) + (v[2] - v[0]) + (v[3] - v[0]));
}

Plane plane_of(const NodeAtFeature& query, int f, const ClosestPoint& closest) {
  Plane plane{.face = f, .weights = closest.weights, .normal = closest.normal};
  const double height = closest.separation.dot(plane.normal);
  plane.beside = (closest.separation - height * plane.normal).norm();
  plane.start = height - query.reach;
  plane.end = plane.start + query.dt * plane.normal.dot(relative_velocity(query, f, plane.weights));
  return plane;
}

// The planes of the faces that meet this one convexly at another angle, after its own. Empty: there are none.
Planes convex_planes(const NodeAtFeature& query, const Vector3d& point) {
  Planes planes;
  const double travel = query.dt * relative_velocity(query, query.face, query.closest.weights).norm();
  const double range = deepest_opposed * query.edge + 2 * travel;
  const FaceVertices own = vertices(query.nodes, face_of(query, query.face));
  const FacesAround around(query, own, point, range);
  if (around.all().empty()) return planes;
  const Vector3d middle = centroid(own);
  const Vector3d x = position(query.nodes, query.surface.node[static_cast<std::size_t>(query.slave)]);
  planes.add(plane_of(query, query.face, query.closest));
  for (int f : around.all()) {
    const FaceVertices v = vertices(query.nodes, face_of(query, f));
    const Vector3d away = centroid(v) - middle;
    if (away.dot(query.closest.normal) >= 0) continue;
    const Vector3d area = (v[2] - v[0]).cross(v[3] - v[1]);
    const double along = area.dot(query.closest.normal);
    if (away.dot(area) <= 0 || along > smooth * area.norm()) continue;
    planes.add(plane_of(query, f, closest_point_on_quad(x, v)));
  }
  if (planes.count == 1) planes.count = 0;
  return planes;
}

// Whether the closest point lies in a crease, where another face stands up from that of the query: neither
// face alone leads out of it, even where the crease itself is bent convexly.
bool lies_in_crease(const NodeAtFeature& query) {
  if (query.closest.feature == Feature::interior) return false;
  const Face& own = face_of(query, query.face);
  const auto k = static_cast<std::size_t>(query.closest.index);
  const Vector3d middle = centroid(vertices(query.nodes, own));
  const auto stands_up = [&](int f) {
    if (f < 0 || f == query.face || face_of(query, f).shell) return false;
    const FaceVertices v = vertices(query.nodes, face_of(query, f));
    const Vector3d area = (v[2] - v[0]).cross(v[3] - v[1]);
    return (centroid(v) - middle).dot(query.closest.normal) > 0 &&
           area.dot(query.closest.normal) < smooth * area.norm();
  };
  if (query.closest.feature == Feature::edge)
    return stands_up(query.surface.neighbor[static_cast<std::size_t>(query.face)][k]);
  const auto around = query.surface.faces_of.of(query.surface.slave(own.node[k]));
  return std::any_of(around.begin(), around.end(), stands_up);
}

// The weights of the point below the node along the normal, a little beside the face, so that an impulse
// along the normal has no moment: the smallest change of weights that moves the point there.
std::array<double, 4> weights_below(const NodeAtFeature& query, const Plane& plane) {
  const FaceVertices corner = vertices(query.nodes, face_of(query, plane.face));
  const Vector3d x = position(query.nodes, query.surface.node[static_cast<std::size_t>(query.slave)]);
  Vector3d beside = x - corner[0];
  for (std::size_t k = 1; k < 4; ++k) beside -= plane.weights[k] * (corner[k] - corner[0]);
  beside -= beside.dot(plane.normal) * plane.normal;
  const Vector3d centre = centroid(corner);
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const Vector3d& c : corner) spread += (c - centre) * (c - centre).transpose();
  spread += spread.trace() * plane.normal * plane.normal.transpose();
  const Vector3d change = spread.ldlt().solve(beside);
  std::array<double, 4> weights = plane.weights;
  for (std::size_t k = 0; k < 4; ++k) weights[k] += change.dot(corner[k] - centre);
  return weights;
}

bool continues(const NodeAtFeature& query, const Plane& plane) {
  const int body = face_of(query, plane.face).body;
  return std::any_of(query.history.begin(), query.history.end(), [&](const Contact& old) {
    return old.body == body && old.impulse > 0 && old.normal.dot(plane.normal) > smooth;
  });
}

double best_opposed(std::span<const Plane> planes, double not_below) {
  double best = least_opposed / least_opposed_share;
  for (const Plane& plane : planes)
    if (plane.start >= not_below) best = std::max(best, plane.opposed);
  return best;
}

}  // namespace

std::optional<Separation> separate_at_feature(const NodeAtFeature& query, const Vector3d& direct) {
  if (lies_in_crease(query)) return std::nullopt;
  Planes planes = convex_planes(query, query.closest.point);
  if (planes.count == 0) return std::nullopt;
  if (!direct.isZero()) {
    Plane straight{.face = query.face, .weights = query.closest.weights, .normal = direct};
    straight.start = query.closest.separation.dot(direct) - query.reach;
    straight.end =
        straight.start + query.dt * direct.dot(relative_velocity(query, query.face, straight.weights));
    planes.add(straight);
  }
  const double hair = hair_share * query.edge;
  double least_deep = -infinity;
  for (std::size_t i = 0; i < planes.count; ++i) {
    Plane& plane = planes.plane[i];
    plane.opposed = opposition(query, plane.normal);
    if (plane.opposed >= least_opposed) least_deep = std::max(least_deep, plane.start);
  }
  const double not_below = std::min(least_deep, 0.0) - hair;
  const double opposed = least_opposed_share * best_opposed(planes.all(), not_below);
  const Plane* chosen = nullptr;
  double best = 0;
  double clear = -infinity;
  for (const Plane& plane : planes.all()) {
    const bool beside = plane.opposed < opposed || plane.beside > farthest_beside * query.edge;
    if (beside) {
      const double margin = plane.opposed < opposed ? hair : -hair;
      if (std::min(plane.start, plane.end) > margin) clear = std::max(clear, plane.end - margin);
      continue;
    }
    if (plane.start < not_below) continue;
    const double end = plane.end + (continues(query, plane) ? kept_share * hair : 0);
    if (chosen != nullptr && end <= best) continue;
    chosen = &plane;
    best = end;
  }
  Separation result;
  if (chosen == nullptr || clear > best) return result;
  const bool too_deep = chosen->start < -deepest_opposed * query.edge;
  if (too_deep && chosen->face != query.face && !continues(query, *chosen)) return result;
  result.needed = true;
  result.face = chosen->face;
  result.normal = chosen->normal;
  result.gap = chosen->start;
  result.weights = chosen->beside > 0 ? weights_below(query, *chosen) : chosen->weights;
  return result;
}

bool passes_by(const NodeAtFeature& query, const std::array<double, 4>& weights) {
  const FaceVertices own = vertices(query.nodes, face_of(query, query.face));
  Vector3d met = own[0];
  for (std::size_t k = 1; k < 4; ++k) met += weights[k] * (own[k] - own[0]);
  const Planes planes = convex_planes(query, met);
  const double hair = hair_share * query.edge;
  const double opposed =
      std::max(least_opposed, least_opposed_share * opposition(query, query.closest.normal));
  for (const Plane& plane : planes.all()) {
    if (plane.face == query.face || std::min(plane.start, plane.end) < -hair) continue;
    if (std::min(plane.start, plane.end) > hair || opposition(query, plane.normal) >= opposed) return true;
  }
  return false;
}

}  // namespace brio
