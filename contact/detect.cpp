#include "contact/detect.hpp"

#include <algorithm>
#include <cmath>

#include "contact/convex_feature.hpp"
#include "contact/face_geometry.hpp"
#include "contact/velocity_check.hpp"

namespace brio {

using Eigen::Vector3d;

namespace {

/// Slave nodes to a task.
constexpr std::size_t slaves_per_task = 128;
/// Contacts of a node with one body closer in direction than this (about 8 degrees) are one.
constexpr double same_direction = 0.99;
/// A contact of the last step whose direction differs less than this continues; beyond, it is another
/// contact.
constexpr double continued_direction = 0.5;
/// A node belongs on the face's outside only if its own surface opposes the face's by at least this.
constexpr double opposing = -0.1;
/// Overlaps below this share of an edge are rounding and impulses not yet converged, not penetration.
constexpr double touching_share = 1e-6;
/// Directions are formed from positions only where these are farther apart than this share of an edge.
constexpr double direction_share = 1e-8;

/// The detailed check of one slave node.
class NodeCheck {
 public:
  NodeCheck(const Scenery& scenery, DetectionPiece& piece) : scene_(scenery), piece_(piece) {}

  void run(int slave) {
    slave_ = slave;
    const auto s = static_cast<std::size_t>(slave);
    node_ = scene_.surface.node[s];
    solid_ = scene_.surface.of_solid[s] != 0;
    begin_ = piece_.contact.size();
    // Whoever seems to be inside a body is judged once more with all that is near in sight.
    if (!judge_all(false)) {
      piece_.contact.resize(begin_);
      judge_all(true);
    }
    if (scene_.options.velocity_check) check_motion();
  }

 private:
  // ---- all that is near

  // \returns false where the node seems to be inside a body but faces that might prove otherwise were left
  // out.
  bool judge_all(bool everything) {
    scene_.swept.find(scene_.surface, scene_.candidates, scene_.options, scene_.nodes, scene_.travel, slave_,
                      everything, piece_.near);
    if (piece_.near.face.empty()) return true;
    find_history();
    for (std::size_t i = 0; i < piece_.near.face.size(); ++i) {
      judge(i);
      if (piece_.near.face[i].inside && !everything && !barely_inside(piece_.near.face[i])) return false;
    }
    return true;
  }

  // What was left out is farther away than the node is deep, now and in the last step: nothing in it proves
  // otherwise.
  bool barely_inside(const NearFace& near) const {
    const double least = band_share * scene_.candidates.smallest_edge;
    return near.distance < least && std::all_of(history_.begin(), history_.end(),
                                                [&](const Contact& old) { return old.gap > -least; });
  }

  void find_history() {
    const auto begin =
        std::lower_bound(scene_.last.begin(), scene_.last.end(), slave_,
                         [](const Contact& contact, int slave) { return contact.slave < slave; });
    auto end = begin;
    while (end != scene_.last.end() && end->slave == slave_) ++end;
    history_ = scene_.last.subspan(static_cast<std::size_t>(begin - scene_.last.begin()),
                                   static_cast<std::size_t>(end - begin));
  }

  // ---- small questions

  const Face& face(int f) const { return scene_.surface.face[static_cast<std::size_t>(f)]; }
  double edge(int f) const { return scene_.candidates.edge[static_cast<std::size_t>(f)]; }
  double touching(int f) const { return touching_distance(scene_.surface, scene_.options, f, slave_); }

  // Nodes of the face that its closest feature consists of.
  bool shares_feature(const NearFace& near, const Face& other) const {
    const Face& own = face(near.face);
    const auto k = static_cast<std::size_t>(near.closest.index);
    if (!other.has(own.node[k])) return false;
    return near.closest.feature == Feature::vertex ||
           other.has(own.node[(k + 1) % static_cast<std::size_t>(own.corners())]);
  }

  // The closest point lies on an edge or vertex that a face already judged has too, at a place at least as
  // close.
  bool repeated(std::size_t i) const {
    const NearFace& near = piece_.near.face[i];
    if (near.closest.feature == Feature::interior) return false;
    for (std::size_t j = 0; j < i; ++j)
      if (shares_feature(near, face(piece_.near.face[j].face))) return true;
    return false;
  }

  // First (closest) entry of the same body.
  std::size_t closest_of_body(std::size_t i) const {
    const int body = face(piece_.near.face[i].face).body;
    for (std::size_t j = 0; j < i; ++j)
      if (face(piece_.near.face[j].face).body == body && !face(piece_.near.face[j].face).shell) return j;
    return i;
  }

  bool neighbors(int a, int b) const {
    if (a == b) return true;
    for (int k = 0; k < face(a).corners(); ++k)
      if (face(b).has(face(a).node[static_cast<std::size_t>(k)])) return true;
    return false;
  }

  // A contact of the last step with this face or one beside it that pushed about the same way and was about
  // as deep: around the edge of a thin body another face may be near in direction, but not in depth.
  bool was_tracked(int f, const Vector3d& direction, double gap) const {
    for (const Contact& old : history_)
      if (old.normal.dot(direction) > continued_direction && neighbors(old.face, f) &&
          gap > std::min(old.gap, 0.0) - band_share * edge(f))
        return true;
    return false;
  }

  // Whether the node's own surface faces the other way; nodes of shells alone face all ways. Any part of it
  // will do: on a rim the mean looks along the surface that it meets.
  bool faces_towards(const Vector3d& direction) const {
    return !solid_ || looks_against(scene_.surface, scene_.nodes, slave_, direction, opposing);
  }

  // Where a node is found deep inside a body, the mean of its own surface tells which way it came.
  bool came_against(const Vector3d& direction) const {
    if (!solid_ || scene_.surface.pinched[static_cast<std::size_t>(slave_)] != 0)
      return faces_towards(direction);
    return vertex_normal(scene_.surface, scene_.nodes, slave_).dot(direction) < opposing;
  }

  Vector3d relative_velocity(int f, const std::array<double, 4>& weights) const {
    Vector3d relative = velocity(scene_.nodes, node_);
    for (std::size_t k = 0; k < 4; ++k)
      if (weights[k] != 0) relative -= weights[k] * velocity(scene_.nodes, face(f).node[k]);
    return relative;
  }

  bool has_similar(int body, const Vector3d& normal) const {
    for (std::size_t i = begin_; i < piece_.contact.size(); ++i)
      if (piece_.contact[i].body == body && piece_.contact[i].normal.dot(normal) > same_direction)
        return true;
    return false;
  }

  // ---- judgement

  void judge(std::size_t i) {
    if (face(piece_.near.face[i].face).shell)
      judge_shell(i);
    else
      judge_solid(i);
  }

  // Whether the node can reach the face within the time that constraints look ahead.
  bool within_band(const NearFace& near) const {
    const double beyond = near.distance - touching(near.face) - band_share * edge(near.face);
    if (beyond <= 0) return true;
    return beyond <=
           approach_share * scene_.swept.dt * relative_velocity(near.face, near.closest.weights).norm();
  }

  // Unit vector that leads the node out of the body, from the closest point to the node if that is outside.
  Vector3d way_out(const NearFace& near, bool above) const {
    const ClosestPoint& closest = near.closest;
    const double along = closest.separation.dot(closest.normal);
    const bool over_triangle =
        closest.feature == Feature::interior && std::abs(along) >= (1 - 1e-12) * near.distance;
    if (over_triangle) return closest.normal;
    if (near.distance <= direction_share * edge(near.face))
      return pseudo_normal(scene_.surface, scene_.nodes, near.face, closest);
    return closest.separation / (above ? near.distance : -near.distance);
  }

  // Just under the surface of another body a node is stopped by the closest place whichever way its own
  // surface faces; deep below, that and the last step tell where it came from.
  bool may_stop(const NearFace& near, const Vector3d& push, double gap, bool outside,
                bool closest_of_other) const {
    if (outside) return faces_towards(push);
    if (near.distance > band_share * edge(near.face))
      return was_tracked(near.face, push, gap) || came_against(push);
    return closest_of_other || faces_towards(push);
  }

  NodeAtFeature at_feature(const NearFace& near) const {
    return {scene_.surface, scene_.nodes, history_,        scene_.swept.dt,    slave_,
            near.face,      near.closest, edge(near.face), touching(near.face)};
  }

  void judge_solid(std::size_t i) {
    const std::size_t first = closest_of_body(i);
    NearFace& near = piece_.near.face[i];
    const bool self = face(near.face).body == scene_.surface.body[static_cast<std::size_t>(slave_)];
    const bool overlap_matters = !history_.empty() || (!self && first == i);
    if (!within_band(near) && !overlap_matters) return;
    const bool above = is_outside(scene_.surface, scene_.nodes, near.face, near.closest);
    const bool outside = above || near.distance <= touching_share * edge(near.face);
    if (first == i) near.inside = !outside;
    if (repeated(i)) return;
    // However shallow, an overlap keeps its sign: taken for a gap, it would be closed, which makes it twice
    // as deep.
    const Vector3d push = way_out(near, above);
    const double gap = (above ? near.distance : -near.distance) - touching(near.face);
    if (!outside) {
      if (!piece_.near.face[first].inside || near.distance > scene_.candidates.depth_share * edge(near.face))
        return;
      if ((self || first != i) && !was_tracked(near.face, push, gap)) return;
    }
    if (!self && judge_feature(near, above, push)) return;
    if (may_stop(near, push, gap, outside, !self && first == i)) add(near, push, gap);
  }

  // \returns false where faces of the body do not meet convexly at the closest point.
  bool judge_feature(const NearFace& near, bool above, const Vector3d& push) {
    const bool straight =
        above && near.closest.feature != Feature::interior && near.distance > hair_share * edge(near.face);
    const auto separation =
        separate_at_feature(at_feature(near), straight ? push : Vector3d(Vector3d::Zero()));
    if (!separation) return false;
    if (separation->needed &&
        within_reach(separation->face, separation->weights, separation->normal, separation->gap))
      append(separation->face, separation->weights, separation->normal, separation->gap);
    return true;
  }

  void judge_shell(std::size_t i) {
    const NearFace& near = piece_.near.face[i];
    if (!within_band(near) || repeated(i)) return;
    const double reach = touching(near.face);
    const Vector3d side = side_of(near);
    Vector3d push = side;
    double distance = near.distance;
    if (near.distance > direction_share * edge(near.face)) {
      push = near.closest.separation / near.distance;
      // Beyond the middle surface, against the side it was on in the last step: pushed back where it came
      // from.
      if (near.closest.feature == Feature::interior && near.distance < reach && push.dot(side) < 0) {
        push = -push;
        distance = -distance;
      }
    }
    if (faces_towards(push)) add(near, push, distance - reach);
  }

  // The side of a shell on which the node belongs: the last step's, else where it is now.
  Vector3d side_of(const NearFace& near) const {
    for (const Contact& old : history_)
      if (old.face == near.face || neighbors(old.face, near.face)) return old.normal;
    const double along = near.closest.separation.dot(near.closest.normal);
    const double approach = relative_velocity(near.face, near.closest.weights).dot(near.closest.normal);
    return along < 0 || (along == 0 && approach > 0) ? Vector3d(-near.closest.normal) : near.closest.normal;
  }

  bool within_reach(int f, const std::array<double, 4>& weights, const Vector3d& push, double gap) const {
    const double approach = relative_velocity(f, weights).dot(push);
    return gap <= band_share * edge(f) + approach_share * std::abs(approach) * scene_.swept.dt;
  }

  void add(const NearFace& near, const Vector3d& push, double gap) {
    if (within_reach(near.face, near.closest.weights, push, gap))
      append(near.face, near.closest.weights, push, gap);
  }

  void append(int f, const std::array<double, 4>& weights, const Vector3d& push, double gap) {
    if (has_similar(face(f).body, push)) return;
    Contact contact;
    contact.slave = slave_;
    contact.face = f;
    contact.body = face(f).body;
    contact.node[0] = slave_;
    contact.weight[0] = 1;
    for (std::size_t k = 0; k < 4; ++k) {
      contact.node[k + 1] = scene_.surface.slave(face(f).node[k]);
      contact.weight[k + 1] = -weights[k];
    }
    contact.normal = push;
    contact.gap = gap;
    contact.friction_coefficient =
        scene_.surface.pairs.friction(node_, face(f).part, scene_.options.friction);
    piece_.contact.push_back(contact);
  }

  // ---- first touches along the motion

  void check_motion() {
    const std::size_t judged = piece_.contact.size();
    const NearFace* earliest = nullptr;
    VelocityContact first{};
    for (const NearFace& near : piece_.near.face) {
      if (in_contact(near.face, judged)) continue;
      const double reach = touching(near.face);
      if (near.distance <= reach || farthest_travel(near.face) < near.distance - reach) continue;
      const auto touch = velocity_check(moving_node(), moving_face(near.face), reach);
      if (!touch || (earliest != nullptr && touch->time >= first.time)) continue;
      if (!face(near.face).shell && (touch->side < 0 || passes(near, *touch))) continue;
      earliest = &near;
      first = *touch;
    }
    if (earliest != nullptr) add_touch(earliest->face, first);
  }

  bool passes(const NearFace& near, const VelocityContact& touch) const {
    return face(near.face).body != scene_.surface.body[static_cast<std::size_t>(slave_)] &&
           passes_by(at_feature(near), touch.weights);
  }

  bool in_contact(int f, std::size_t judged) const {
    for (std::size_t i = begin_; i < judged; ++i)
      if (piece_.contact[i].face == f) return true;
    return false;
  }

  double farthest_travel(int f) const {
    double farthest = 0;
    const Vector3d own = velocity(scene_.nodes, node_);
    for (int corner : face(f).node)
      farthest = std::max(farthest, (own - velocity(scene_.nodes, corner)).norm());
    return farthest * scene_.swept.dt;
  }

  MovingNode moving_node() const {
    return {position(scene_.nodes, node_),
            scene_.swept.dt * (velocity(scene_.nodes, node_) - scene_.swept.frame)};
  }
  MovingFace moving_face(int f) const {
    MovingFace moving{.start = vertices(scene_.nodes, face(f)), .displacement = {}};
    for (std::size_t k = 0; k < 4; ++k)
      moving.displacement[k] =
          scene_.swept.dt * (velocity(scene_.nodes, face(f).node[k]) - scene_.swept.frame);
    return moving;
  }

  void add_touch(int f, const VelocityContact& touch) {
    const MovingNode node = moving_node();
    const MovingFace moving = moving_face(f);
    Vector3d start = node.start;
    Vector3d then = node.start + touch.time * node.displacement;
    for (std::size_t k = 0; k < 4; ++k) {
      start -= touch.weights[k] * moving.start[k];
      then -= touch.weights[k] * (moving.start[k] + touch.time * moving.displacement[k]);
    }
    const double reach = touching(f);
    Vector3d push = touch.side < 0 ? Vector3d(-touch.normal) : touch.normal;
    if (reach > direction_share * edge(f) && then.norm() > 0.5 * reach) push = then.normalized();
    if (push.squaredNorm() < 0.5 || !faces_towards(push)) return;
    append(f, touch.weights, push, std::max(push.dot(start) - reach, 0.0));
  }

  const Scenery& scene_;
  DetectionPiece& piece_;
  std::span<const Contact> history_;
  std::size_t begin_ = 0;
  int slave_ = 0;
  int node_ = 0;
  bool solid_ = false;
};

}  // namespace

void detect(Detection& detection, const Surface& surface, const Candidates& candidates,
            const ContactOptions& options, const Nodes& nodes, const Travel& travel,
            std::span<const Contact> last, ThreadTeam& team, std::vector<Contact>& contacts) {
  detection.swept.begin_step(surface, candidates, options, nodes, travel, team);
  const Scenery scenery{surface, candidates, options, nodes, travel, last, detection.swept};
  const std::size_t tasks = (surface.slaves() + slaves_per_task - 1) / slaves_per_task;
  detection.piece.resize(tasks);
  team.for_each(tasks, [&](std::size_t task) {
    DetectionPiece& piece = detection.piece[task];
    piece.contact.clear();
    NodeCheck check(scenery, piece);
    const std::size_t end = std::min(surface.slaves(), (task + 1) * slaves_per_task);
    for (std::size_t s = task * slaves_per_task; s < end; ++s)
      if (!detection.swept.sleeps(travel, static_cast<int>(s))) check.run(static_cast<int>(s));
  });
  contacts.clear();
  for (const DetectionPiece& piece : detection.piece)
    contacts.insert(contacts.end(), piece.contact.begin(), piece.contact.end());
}

}  // namespace brio
