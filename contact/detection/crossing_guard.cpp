#include "contact/detection/crossing_guard.hpp"

#include <algorithm>
#include <cmath>

#include "contact/closest_segments.hpp"
#include "contact/detection/hull_point.hpp"
#include "contact/edge_check.hpp"
#include "contact/velocity_check.hpp"

namespace brio {

using Eigen::Vector3d;

namespace {

/// Heights are certain beyond this share of the largest coordinate.
constexpr double rounding_of_heights = 2e-15;
/// Points keep this share of their radii from each other.
constexpr double floor_of_points = 0.5;
/// Of the distance at the start, where that is less than the floor.
constexpr double floor_at_start = 0.9;
constexpr double no_distance = 1e-12;  ///< of the smallest edge

class Look {
 public:
  Look(CrossingGuard& guard, const SurfaceFeatures& features, const Surface& surface,
       const ContactOptions& options, FeaturePairs& pairs, const FeatureMotion& motion)
      : guard_(guard),
        features_(features),
        surface_(surface),
        options_(options),
        pairs_(pairs),
        motion_(motion),
        tolerance_(rounding_of_heights * motion.magnitude()),
        separation_(separation_share * features.smallest_edge) {}

  void node_and_face(std::size_t pair) {
    PairList& list = pairs_.node_face;
    const int s = list.first[pair];
    const Face& face = surface_.face[static_cast<std::size_t>(list.second[pair])];
    std::array<int, 4> corner{};
    FaceVertices start, end;
    for (std::size_t k = 0; k < 4; ++k) {
      corner[k] = surface_.slave(face.node[k]);
      start[k] = motion_.start(corner[k]);
      end[k] = motion_.end(corner[k]);
    }
    const Vector3d x = motion_.start(s), y = motion_.end(s);
    const auto separates = [&](const Vector3d& d) {
      return std::min(height(d, x, start), height(d, y, end)) > tolerance_ * d.lpNorm<1>();
    };
    if (separates(list.direction_of(pair))) {
      ++guard_.certified;
      return;
    }
    const bool as_hull = list.spaced[pair] != 0;
    const HullPoint first = closest_on_face(x, start, as_hull), last = closest_on_face(y, end, as_hull);
    if (renews(list, pair, separates, first.offset, last.offset)) return;
    ++guard_.checked;
    const auto touch = first_touch({x, y - x}, start, end, as_hull);
    if (!touch) return;
    Hit hit{.kind = PairKind::node_face, .pair = pair, .time = touch->time, .at_start = {}, .at_hit = {}};
    Contact contact;
    contact.slave = s;
    contact.face = list.second[pair];
    contact.body = face.body;
    contact.own = 1;
    contact.node = {s, corner[0], corner[1], corner[2], corner[3]};
    contact.friction_coefficient =
        surface_.pairs.friction(surface_.node[static_cast<std::size_t>(s)], face.part, options_.friction);
    contact.weight[0] = 1;
    for (std::size_t k = 0; k < 4; ++k) contact.weight[k + 1] = -first.weights[k];
    set_start(hit, contact, first.offset, 0);
    for (std::size_t k = 0; k < 4; ++k) contact.weight[k + 1] = -touch->weights[k];
    set_hit(hit, contact, touch->side < 0 ? Vector3d(-touch->normal) : touch->normal, touch->side == 0);
    guard_.hits.push_back(hit);
  }

  void edge_and_edge(std::size_t pair) {
    PairList& list = pairs_.edge_edge;
    const EdgeFeature& a = features_.edge[static_cast<std::size_t>(list.first[pair])];
    const EdgeFeature& b = features_.edge[static_cast<std::size_t>(list.second[pair])];
    const Segment sa{motion_.start(a.node[0]), motion_.start(a.node[1])};
    const Segment sb{motion_.start(b.node[0]), motion_.start(b.node[1])};
    const Segment ea{motion_.end(a.node[0]), motion_.end(a.node[1])};
    const Segment eb{motion_.end(b.node[0]), motion_.end(b.node[1])};
    const bool points = a.is_point() || b.is_point();
    if (points && list.spaced[pair] == 0) return;
    double floor = points ? floor_of_points * (a.radius + b.radius) : 0;
    const auto separates = [&](const Vector3d& d) {
      return std::min(height(d, sa, sb), height(d, ea, eb)) > tolerance_ * d.lpNorm<1>() + floor * d.norm();
    };
    if (separates(list.direction_of(pair))) {
      ++guard_.certified;
      return;
    }
    const ClosestSegments first = closest_points_of_segments(sa, sb);
    const ClosestSegments last = closest_points_of_segments(ea, eb);
    floor = std::min(floor, floor_at_start * std::sqrt(first.squared_distance));
    if (renews(list, pair, separates, first.offset, last.offset)) return;
    ++guard_.checked;
    const MovingEdge moving_a{sa, {Vector3d(ea[0] - sa[0]), Vector3d(ea[1] - sa[1])}, floor};
    const MovingEdge moving_b{sb, {Vector3d(eb[0] - sb[0]), Vector3d(eb[1] - sb[1])}, 0};
    const auto touch = edge_check(moving_a, moving_b);
    if (!touch) return;
    Hit hit{.kind = PairKind::edge_edge, .pair = pair, .time = touch->time, .at_start = {}, .at_hit = {}};
    Contact contact;
    contact.slave = first_line_slave + list.first[pair];
    contact.face = -1;
    contact.body = b.body;
    contact.own = 2;
    contact.node = {a.node[0], a.node[1], b.node[0], b.node[1], b.node[1]};
    contact.friction_coefficient = surface_.pairs.friction_of_parts(a.part, b.part, options_.friction);
    const auto weigh = [&](const std::array<double, 2>& at) {
      contact.weight = {1 - at[0], at[0], at[1] - 1, -at[1], 0};
    };
    weigh(first.parameters);
    set_start(hit, contact, first.offset, floor);
    weigh(touch->parameters);
    set_hit(hit, contact, touch->normal, touch->side == 0);
    guard_.hits.push_back(hit);
  }

 private:
  static double height(const Vector3d& d, const Vector3d& x, const FaceVertices& face) {
    return d.dot(x) -
           std::max(std::max(d.dot(face[0]), d.dot(face[1])), std::max(d.dot(face[2]), d.dot(face[3])));
  }
  static double height(const Vector3d& d, const Segment& a, const Segment& b) {
    return std::min(d.dot(a[0]), d.dot(a[1])) - std::max(d.dot(b[0]), d.dot(b[1]));
  }

  // Whether the direction of the closest points at the start, at the end, or their mean separates the pair.
  template <class Separates>
  bool renews(PairList& list, std::size_t pair, const Separates& separates, const Vector3d& first,
              const Vector3d& last) {
    const double a = first.norm(), b = last.norm();
    const Vector3d tries[3] = {a > 0 ? Vector3d(first / a) : Vector3d::Zero(),
                               b > 0 ? Vector3d(last / b) : Vector3d::Zero(),
                               a > 0 && b > 0 ? (first / a + last / b).normalized() : Vector3d::Zero()};
    for (const Vector3d& direction : tries) {
      const Vector3d rounded = direction.cast<float>().cast<double>();
      if (!separates(rounded)) continue;
      list.set_direction(pair, rounded);
      ++guard_.renewed;
      return true;
    }
    return false;
  }

  // The triangles of the face, the one that is met first.
  static std::optional<VelocityContact> first_touch(const MovingNode& node, const FaceVertices& start,
                                                    const FaceVertices& end, bool as_hull) {
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
      auto touch = velocity_check(node, moving, 0);
      if (!touch || (first && first->time <= touch->time)) continue;
      std::array<double, 4> weights{};
      for (std::size_t k = 0; k < 3; ++k) weights[corner[t][k]] = touch->weights[k];
      weights[corner[t][2]] += touch->weights[3];
      touch->weights = weights;
      first = touch;
    }
    return first;
  }

  // What is nearer than the separation does not approach, and is recovered as an overlap is.
  void set_start(Hit& hit, Contact& contact, const Vector3d& offset, double floor) const {
    const double distance = offset.norm();
    if (distance < no_distance * features_.smallest_edge) return;
    contact.normal = offset / distance;
    contact.gap = distance - floor - separation_;
    hit.at_start = contact;
  }

  void set_hit(Hit& hit, Contact contact, Vector3d normal, bool without_side) const {
    if (normal.squaredNorm() < 0.5) return;
    Vector3d offset = Vector3d::Zero();
    for (std::size_t k = 0; k < 5; ++k) offset += contact.weight[k] * motion_.start(contact.node[k]);
    if (without_side && hit.at_start.normal.dot(normal) < 0) normal = -normal;
    contact.normal = normal;
    const double gap = normal.dot(offset);
    if (gap <= 0) return;
    contact.gap = gap - separation_;
    hit.at_hit = contact;
  }

  CrossingGuard& guard_;
  const SurfaceFeatures& features_;
  const Surface& surface_;
  const ContactOptions& options_;
  FeaturePairs& pairs_;
  const FeatureMotion& motion_;
  double tolerance_;
  double separation_;
};

}  // namespace

void find_hits(CrossingGuard& guard, const Proximity& proximity, const SurfaceFeatures& features,
               const Surface& surface, const ContactOptions& options, FeaturePairs& pairs,
               const FeatureMotion& motion) {
  guard.hits.clear();
  Look look(guard, features, surface, options, pairs, motion);
  for (int pair : proximity.node_face) look.node_and_face(static_cast<std::size_t>(pair));
  for (int pair : proximity.edge_edge) look.edge_and_edge(static_cast<std::size_t>(pair));
  guard.found += guard.hits.size();
}

}  // namespace brio
