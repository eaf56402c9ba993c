#include "contact/detection/crossing_check.hpp"

#include <algorithm>
#include <cmath>

#include "contact/geometry/closest_segments.hpp"
#include "contact/geometry/edge_check.hpp"
#include "contact/geometry/hull_point.hpp"
#include "contact/geometry/velocity_check.hpp"
#include "src/base/index.hpp"

namespace brio {

namespace {

// The triangles of the face, the one that is met first.
std::optional<VelocityContact> first_touch(const MovingNode& node, const FaceVertices& start,
                                           const FaceVertices& end, bool as_hull, double floor) {
  constexpr std::size_t corner[4][3] = {{0, 1, 2}, {0, 2, 3}, {0, 1, 3}, {1, 2, 3}};
  std::optional<VelocityContact> first;
  const std::size_t triangles = is_triangle(start) ? 1 : as_hull ? 4 : 2;
  for (std::size_t t = 0; t < triangles; ++t) {
    MovingFace moving;
    for (std::size_t k = 0; k < 4; ++k) {
      const std::size_t c = corner[t][std::min<std::size_t>(k, 2)];
      moving.start[k] = start[c];
      moving.displacement[k] = end[c] - start[c];
    }
    auto touch = velocity_check(node, moving, floor);
    if (!touch || (first && first->time <= touch->time)) continue;
    std::array<double, 4> weights{};
    for (std::size_t k = 0; k < 3; ++k) weights[corner[t][k]] = touch->weights[k];
    weights[corner[t][2]] += touch->weights[3];
    touch->weights = weights;
    first = touch;
  }
  return first;
}

}  // namespace

std::optional<Hit> CrossingCheck::node_and_face(std::size_t pair) const {
  const PairList& list = pairs_.node_face;
  const int s = list.first(pair), f = list.second(pair);
  const Face& face = surface_.face[index(f)];
  const std::array<int, 4>& corner = features_.face_node[index(f)];
  FaceVertices start, end;
  for (std::size_t k = 0; k < 4; ++k) {
    start[k] = motion_.start(corner[k]);
    end[k] = motion_.end(corner[k]);
  }
  const Vector3d x = motion_.start(s), y = motion_.end(s);
  const bool as_hull = list.has_radii(pair);
  const HullPoint first = closest_on_face(x, start, as_hull);
  const double radii = as_hull ? features_.node_radius[index(s)] + features_.face_radius[index(f)] : 0;
  const double floor =
      std::min(least_distance(features_, radii), floor_at_start * std::sqrt(first.squared_distance));
  const auto touch = first_touch({x, y - x}, start, end, as_hull, floor);
  if (!touch) return std::nullopt;
  Hit hit{.kind = PairKind::node_face, .pair = pair, .time = touch->time, .at_start = {}, .at_hit = {}};
  Contact contact;
  contact.slave = s;
  contact.face = f;
  contact.body = face.body;
  contact.own = 1;
  contact.node = {s, corner[0], corner[1], corner[2], corner[3]};
  contact.friction_coefficient =
      surface_.pairs.friction(surface_.node[index(s)], face.part, options_.friction);
  contact.weight[0] = 1;
  for (std::size_t k = 0; k < 4; ++k) contact.weight[k + 1] = -first.weights[k];
  set_start(hit, contact, first.offset, floor);
  for (std::size_t k = 0; k < 4; ++k) contact.weight[k + 1] = -touch->weights[k];
  set_hit(hit, contact, touch->side < 0 ? Vector3d(-touch->normal) : touch->normal, touch->side == 0, floor);
  return hit;
}

// Of listed edges: whether flat shapes hide one of them over the step, so that others of the kind may not be
// listed.
bool CrossingCheck::is_hidden(int a, int b, bool radii) const {
  for (const Moment moment : {Moment::start, Moment::end})
    if (pairs_.flatness().are_features(features_, motion_, a, b, {.radii = radii, .moment = moment}))
      return false;
  return !has_edges(constraints_, a,
                    nodes_of_edges(features_.edge_node[index(a)], features_.edge_node[index(b)]));
}

std::optional<Hit> CrossingCheck::edge_and_edge(std::size_t pair) const {
  const PairList& list = pairs_.edge_edge;
  const EdgeFeature& a = features_.edge[index(list.first(pair))];
  const EdgeFeature& b = features_.edge[index(list.second(pair))];
  const Segment sa{motion_.start(a.node[0]), motion_.start(a.node[1])};
  const Segment sb{motion_.start(b.node[0]), motion_.start(b.node[1])};
  const Segment ea{motion_.end(a.node[0]), motion_.end(a.node[1])};
  const Segment eb{motion_.end(b.node[0]), motion_.end(b.node[1])};
  const ClosestSegments first = closest_points_of_segments(sa, sb);
  const bool of_points = a.is_point() || b.is_point();
  const double radii = list.has_radii(pair) ? a.radius + b.radius : 0;
  const double floor = std::min(of_points ? floor_of_points * radii : least_distance(features_, radii),
                                floor_at_start * std::sqrt(first.squared_distance));
  const MovingEdge moving_a{sa, {Vector3d(ea[0] - sa[0]), Vector3d(ea[1] - sa[1])}, floor};
  const MovingEdge moving_b{sb, {Vector3d(eb[0] - sb[0]), Vector3d(eb[1] - sb[1])}, 0};
  const auto touch = edge_check(moving_a, moving_b);
  if (!touch || is_hidden(list.first(pair), list.second(pair), list.has_radii(pair))) return std::nullopt;
  Hit hit{.kind = PairKind::edge_edge, .pair = pair, .time = touch->time, .at_start = {}, .at_hit = {}};
  Contact contact;
  contact.slave = first_edge_slave + list.first(pair);
  contact.face = -1;
  contact.body = b.body;
  contact.own = 2;
  contact.node = nodes_of_edges(a.node, b.node);
  contact.friction_coefficient = surface_.pairs.friction_of_parts(a.part, b.part, options_.friction);
  const auto weigh = [&](const std::array<double, 2>& at) {
    contact.weight = {1 - at[0], at[0], at[1] - 1, -at[1], 0};
  };
  weigh(first.parameters);
  set_start(hit, contact, first.offset, floor);
  weigh(touch->parameters);
  set_hit(hit, contact, touch->normal, touch->side == 0, floor);
  return hit;
}

// What is nearer than the separation does not approach, and is recovered as an overlap is.
void CrossingCheck::set_start(Hit& hit, Contact& contact, const Vector3d& offset, double floor) const {
  const double distance = norm(offset);
  if (distance < no_distance * features_.smallest_edge) return;
  contact.normal = offset / distance;
  contact.gap = distance - floor - separation_;
  hit.at_start = contact;
}

void CrossingCheck::set_hit(Hit& hit, Contact contact, Vector3d normal, bool without_side,
                            double floor) const {
  if (squared_norm(normal) < 0.5) return;
  Vector3d offset{};
  for (std::size_t k = 0; k < 5; ++k) offset += contact.weight[k] * motion_.start(contact.node[k]);
  if (without_side && dot(hit.at_start.normal, normal) < 0) normal = -normal;
  contact.normal = normal;
  contact.along_meeting = true;
  const double gap = dot(normal, offset);
  if (gap <= 0) return;
  contact.gap = gap - floor - separation_;
  hit.at_hit = contact;
}

}  // namespace brio
