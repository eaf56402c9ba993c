#include "contact/enforcement/impact_zone.hpp"

#include <algorithm>
#include <vector>

#include "contact/scene.hpp"

namespace brio {

using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

/// Share of the inertia of a zone that keeps zones of nodes in a line solvable.
constexpr double least_inertia = 1e-12;

/// A node or a rigid body of a zone, as a mass that moves.
struct Member {
  double mass;
  Vector3d position, velocity;
  Matrix3d inertia = Matrix3d::Zero();
  Vector3d angular_velocity = Vector3d::Zero();
};

class Zones {
 public:
  Zones(ContactScene& scene, const Nodes& nodes, double dt, std::span<RigidMotion> bodies)
      : scene_(scene),
        nodes_(nodes),
        dt_(dt),
        bodies_(bodies),
        slaves_(static_cast<int>(scene.surface.slaves())) {
    if (!scene_.zone_impulse.empty()) return;
    scene_.zone_impulse.assign(scene.surface.slaves(), Vector3d::Zero());
    scene_.zone_of.resize(scene.surface.slaves() + bodies.size());
    for (std::size_t u = 0; u < scene_.zone_of.size(); ++u) scene_.zone_of[u] = static_cast<int>(u);
  }

  void run() {
    for (const Hit& hit : scene_.guard.hits) {
      const int count = hit.kind == PairKind::node_face ? 5 : 4;
      const auto nodes = nodes_of(hit);
      for (int k = 1; k < count; ++k) join(unit(nodes[0]), unit(nodes[static_cast<std::size_t>(k)]));
    }
    std::vector<std::pair<int, int>> members;  // (zone, unit)
    for (int u = 0; u < static_cast<int>(scene_.zone_of.size()); ++u)
      if (const int zone = find(u); zone != u) {
        members.emplace_back(zone, zone);
        members.emplace_back(zone, u);
      }
    std::sort(members.begin(), members.end());
    members.erase(std::unique(members.begin(), members.end()), members.end());
    for (std::size_t begin = 0; begin < members.size();) {
      std::size_t end = begin;
      std::vector<int> units;
      for (; end < members.size() && members[end].first == members[begin].first; ++end)
        units.push_back(members[end].second);
      move(units);
      begin = end;
    }
  }

 private:
  std::array<int, 5> nodes_of(const Hit& hit) const {
    const FeaturePairs& pairs = scene_.pairs;
    if (hit.kind == PairKind::node_face) {
      const Face& face = scene_.surface.face[static_cast<std::size_t>(pairs.node_face.second[hit.pair])];
      std::array<int, 5> nodes{pairs.node_face.first[hit.pair]};
      for (std::size_t k = 0; k < 4; ++k) nodes[k + 1] = scene_.surface.slave(face.node[k]);
      return nodes;
    }
    const auto& a = scene_.features.edge[static_cast<std::size_t>(pairs.edge_edge.first[hit.pair])];
    const auto& b = scene_.features.edge[static_cast<std::size_t>(pairs.edge_edge.second[hit.pair])];
    return {a.node[0], a.node[1], b.node[0], b.node[1], b.node[1]};
  }

  int unit(int slave) const {
    const int body = bodies_.empty()
                         ? -1
                         : scene_.surface.rigid_body(scene_.surface.node[static_cast<std::size_t>(slave)]);
    return body < 0 ? slave : slaves_ + body;
  }
  int find(int u) {
    int& zone = scene_.zone_of[static_cast<std::size_t>(u)];
    if (zone != u) zone = find(zone);
    return zone;
  }
  void join(int a, int b) {
    a = find(a);
    b = find(b);
    if (a != b) scene_.zone_of[static_cast<std::size_t>(std::max(a, b))] = std::min(a, b);
  }

  bool is_body(int u) const { return u >= slaves_; }
  RigidMotion& body(int u) const { return bodies_[static_cast<std::size_t>(u - slaves_)]; }
  std::size_t global(int u) const {
    return static_cast<std::size_t>(scene_.surface.node[static_cast<std::size_t>(u)]);
  }
  bool has_mass(int u) const { return is_body(u) || nodes_.record[global(u)].inverse_mass > 0; }
  Vector3d velocity_of(int u) const { return scene_.motion.displacement(u) / dt_; }

  Member member(int u) const {
    if (is_body(u)) {
      const RigidMotion& motion = body(u);
      return {motion.mass, motion.centre, motion.velocity, motion.inertia, motion.angular_velocity};
    }
    return {1 / nodes_.record[global(u)].inverse_mass, scene_.motion.start(u), velocity_of(u)};
  }

  static bool is_given(const RigidMotion& motion) {
    return motion.inverse_mass.minCoeff() == 0 || motion.inverse_inertia.diagonal().minCoeff() == 0;
  }

  void move(const std::vector<int>& units) {
    ++scene_.zones;
    const RigidMotion* leader = nullptr;
    std::vector<Member> members;
    Vector3d given = Vector3d::Zero();
    Eigen::Vector3i given_axes = Eigen::Vector3i::Zero();
    for (int u : units) {
      if (is_body(u) && is_given(body(u))) leader = &body(u);
      if (!has_mass(u)) continue;
      members.push_back(member(u));
      if (is_body(u)) continue;
      for (int axis = 0; axis < 3; ++axis)
        if (nodes_.free_inverse_mass(global(u), axis) == 0) {
          given[axis] += members.back().velocity[axis];
          ++given_axes[axis];
        }
    }
    if (members.empty()) return;
    Vector3d centre, velocity, turning = Vector3d::Zero();
    if (leader != nullptr) {
      centre = leader->centre;
      velocity = leader->velocity;
      turning = leader->angular_velocity;
    } else {
      mean_motion(members, centre, velocity);
      for (int axis = 0; axis < 3; ++axis)
        if (given_axes[axis] > 0) velocity[axis] = given[axis] / given_axes[axis];
      if (given_axes.isZero()) turning = mean_turning(members, centre, velocity);
    }
    for (int u : units) set(u, velocity + turning.cross(position(u) - centre), turning);
  }

  Vector3d position(int u) const { return is_body(u) ? body(u).centre : scene_.motion.start(u); }

  static void mean_motion(const std::vector<Member>& members, Vector3d& centre, Vector3d& velocity) {
    double mass = 0;
    centre = velocity = Vector3d::Zero();
    for (const Member& one : members) {
      mass += one.mass;
      centre += one.mass * one.position;
      velocity += one.mass * one.velocity;
    }
    centre /= mass;
    velocity /= mass;
  }

  static Vector3d mean_turning(const std::vector<Member>& members, const Vector3d& centre,
                               const Vector3d& velocity) {
    Matrix3d inertia = Matrix3d::Zero();
    Vector3d momentum = Vector3d::Zero();
    for (const Member& one : members) {
      const Vector3d arm = one.position - centre;
      momentum += one.mass * arm.cross(one.velocity - velocity) + one.inertia * one.angular_velocity;
      inertia += one.mass * (arm.squaredNorm() * Matrix3d::Identity() - arm * arm.transpose()) + one.inertia;
    }
    inertia += least_inertia * inertia.trace() * Matrix3d::Identity();
    return inertia.ldlt().solve(momentum);
  }

  void set(int u, const Vector3d& velocity, const Vector3d& turning) {
    if (is_body(u)) {
      RigidMotion& motion = body(u);
      if (is_given(motion)) return;
      motion.impulse += motion.mass * (velocity - motion.velocity);
      motion.moment += motion.inertia * (turning - motion.angular_velocity);
      motion.velocity = velocity;
      motion.angular_velocity = turning;
      return;
    }
    if (!has_mass(u)) return;
    const auto s = static_cast<std::size_t>(u);
    const Vector3d before = velocity_of(u);
    Vector3d& after = scene_.velocity[s];
    for (int axis = 0; axis < 3; ++axis)
      after[axis] = nodes_.free_inverse_mass(global(u), axis) > 0 ? velocity[axis] : before[axis];
    scene_.zone_impulse[s] += (after - before) / nodes_.record[global(u)].inverse_mass;
    scene_.in_contact.insert(u);
  }

  ContactScene& scene_;
  const Nodes& nodes_;
  double dt_;
  std::span<RigidMotion> bodies_;
  int slaves_;
};

}  // namespace

void move_zones_as_one(ContactScene& scene, const Nodes& nodes, double dt, std::span<RigidMotion> bodies) {
  Zones(scene, nodes, dt, bodies).run();
}

}  // namespace brio
