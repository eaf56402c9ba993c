#include "contact/impact_zone.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <vector>

#include "contact/geometry/eigen_conversions.hpp"
#include "contact/scene.hpp"
#include "contact/ties/ties.hpp"
#include "src/base/index.hpp"

namespace brio {

namespace {

/// Over the trace of a zone's inertia: less is that of nodes in a line about it, or rounding.
constexpr double least_inertia = 1e-12;

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

/// Over the largest eigenvalue: components prescribed twice.
constexpr double same_prescription = 1e-10;

/// Velocity at the centre of mass and angular velocity of a zone that moves as one.
class RigidFit {
 public:
  RigidFit(std::span<const ZoneMember> members, std::span<const ZoneWall> walls) {
    double mass = 0;
    Vector3d velocity{};
    for (const ZoneMember& one : members) {
      mass += one.mass;
      centre_ += one.mass * one.position;
      velocity += one.mass * one.velocity;
    }
    centre_ /= mass;
    velocity /= mass;
    Tensor<double> inertia{};
    Vector3d momentum{};
    for (const ZoneMember& one : members) {
      const Vector3d arm = one.position - centre_;
      momentum += one.mass * cross(arm, one.velocity - velocity) + one.inertia * one.angular_velocity;
      inertia += one.mass * inertia_of_point(arm) + one.inertia;
    }
    const PrincipalAxes axes = principal_axes(inertia);
    const double least = least_inertia * trace(inertia);
    Vector3d principal = axes.value, turning = transposed_times(axes.axis, momentum);
    for (int k = 0; k < 3; ++k) {
      turning[k] = principal[k] > least ? turning[k] / principal[k] : 0;
      if (principal[k] <= least) principal[k] = least > 0 ? least : mass;
    }
    motion_.head<3>() = to_eigen(velocity);
    motion_.tail<3>() = to_eigen(axes.axis * turning);
    Matrix6d matrix = Matrix6d::Zero();
    matrix.topLeftCorner<3, 3>() = mass * Eigen::Matrix3d::Identity();
    matrix.bottomRightCorner<3, 3>() = to_eigen(axes.axis * diagonal(principal) * transposed(axes.axis));
    mass_.compute(matrix);
    meet_prescriptions(members, walls);
  }

  double velocity_at(const ZoneWall& wall) const { return derivative(wall.point, wall.normal).dot(motion_); }
  double impulse_of(const ZoneWall& wall) const { return scaled(wall).dot(support_); }

  /// Less what a support gives to prescribed components.
  void give_impulses(ZoneMember& one) const {
    const Vector3d turning = to_vector(motion_.tail<3>());
    const Vector3d velocity = to_vector(motion_.head<3>()) + cross(turning, one.position - centre_);
    one.impulse = one.mass * (velocity - one.velocity);
    one.moment = one.inertia * (turning - one.angular_velocity);
    for (int c = 0; c < 6; ++c)
      if (one.prescribed[index(c)])
        (c < 3 ? one.impulse : one.moment) -= scaled(one, c).dot(support_) * one.axes.column(c % 3);
  }

 private:
  // Of the velocity of a point along an axis by the six of the zone.
  Vector6d derivative(const Vector3d& point, const Vector3d& axis) const {
    Vector6d by;
    by << to_eigen(axis), to_eigen(cross(point - centre_, axis));
    return by;
  }
  Vector6d derivative(const ZoneMember& one, int component) const {
    const Vector3d axis = one.axes.column(component % 3);
    if (component < 3) return derivative(one.position, axis);
    Vector6d by = Vector6d::Zero();
    by.tail<3>() = to_eigen(axis);
    return by;
  }
  Vector6d scaled(const Vector6d& derivative) const { return mass_.matrixL().solve(derivative); }
  Vector6d scaled(const ZoneMember& one, int component) const { return scaled(derivative(one, component)); }
  Vector6d scaled(const ZoneWall& wall) const { return scaled(derivative(wall.point, wall.normal)); }
  static double velocity(const ZoneMember& one, int component) {
    return dot(component < 3 ? one.velocity : one.angular_velocity, one.axes.column(component % 3));
  }

  // In components scaled by the root of the mass matrix: change = B+ r, and the supports' B^T change.
  void meet_prescriptions(std::span<const ZoneMember> members, std::span<const ZoneWall> walls) {
    Matrix6d normal = Matrix6d::Zero();
    Vector6d missing = Vector6d::Zero();
    const auto prescribe = [&](const Vector6d& row, double difference) {
      normal += row * row.transpose();
      missing += row * difference;
    };
    for (const ZoneMember& one : members)
      for (int c = 0; c < 6; ++c)
        if (one.prescribed[index(c)])
          prescribe(scaled(one, c), velocity(one, c) - derivative(one, c).dot(motion_));
    for (const ZoneWall& wall : walls)
      if (wall.pushes) prescribe(scaled(wall), wall.least_velocity - velocity_at(wall));
    if (normal.isZero(0)) return;
    const Eigen::SelfAdjointEigenSolver<Matrix6d> modes(normal);
    const double least = same_prescription * modes.eigenvalues()[5];
    Vector6d change = Vector6d::Zero();
    for (int k = 0; k < 6; ++k) {
      const double value = modes.eigenvalues()[k];
      if (value <= least) continue;
      const Vector6d mode = modes.eigenvectors().col(k);
      change += mode * (mode.dot(missing) / value);
      support_ += mode * (mode.dot(missing) / (value * value));
    }
    motion_ += mass_.matrixU().solve(change);
  }

  Vector3d centre_{};
  Vector6d motion_, support_ = Vector6d::Zero();
  Eigen::LLT<Matrix6d> mass_;
};

class Zones {
 public:
  Zones(ContactScene& scene, Nodes& nodes, const Ties& ties, std::span<RigidMotion> bodies)
      : scene_(scene),
        nodes_(nodes),
        ties_(ties),
        bodies_(bodies),
        slaves_(static_cast<int>(scene.surface.slaves())) {
    if (!scene_.zone_impulse.empty()) return;
    scene_.zone_impulse.assign(scene.surface.slaves(), Vector3d{});
    scene_.zone_of.resize(scene.surface.slaves() + bodies.size());
    for (std::size_t u = 0; u < scene_.zone_of.size(); ++u) scene_.zone_of[u] = static_cast<int>(u);
  }

  void run() {
    for (const Hit& hit : scene_.guard.hits) {
      const int count = hit.kind == PairKind::node_face ? 5 : 4;
      const auto nodes = nodes_of(hit);
      for (int k = 0; k < count; ++k) join_node(unit(nodes[0]), nodes[index(k)]);
    }
    std::vector<std::pair<int, int>> members;  // (zone, unit)
    for (int u = 0; u < static_cast<int>(scene_.zone_of.size()); ++u)
      if (const int zone = find(u); zone != u) {
        members.emplace_back(zone, zone);
        members.emplace_back(zone, u);
      }
    std::sort(members.begin(), members.end());
    members.erase(std::unique(members.begin(), members.end()), members.end());
    find_wall_rows();
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
      const Face& face = scene_.surface.face[index(pairs.node_face.second(hit.pair))];
      std::array<int, 5> nodes{pairs.node_face.first(hit.pair)};
      for (std::size_t k = 0; k < 4; ++k) nodes[k + 1] = scene_.surface.slave(face.node[k]);
      return nodes;
    }
    const auto& a = scene_.features.edge[index(pairs.edge_edge.first(hit.pair))];
    const auto& b = scene_.features.edge[index(pairs.edge_edge.second(hit.pair))];
    return {a.node[0], a.node[1], b.node[0], b.node[1], b.node[1]};
  }

  int unit(int slave) const {
    const int body = bodies_.empty() ? -1 : scene_.surface.rigid_body(scene_.surface.node[index(slave)]);
    return body < 0 ? slave : slaves_ + body;
  }
  int find(int u) {
    int& zone = scene_.zone_of[index(u)];
    if (zone != u) zone = find(zone);
    return zone;
  }
  void join(int a, int b) {
    a = find(a);
    b = find(b);
    if (a != b) scene_.zone_of[index(std::max(a, b))] = std::min(a, b);
  }

  // With the corners of its main face.
  void join_node(int u, int slave) {
    join(u, unit(slave));
    const int node = scene_.surface.node[index(slave)];
    if (!ties_.is_tied(node)) return;
    const Tie& tie = ties_.node[index(ties_.of_node[index(node)])].tie;
    for (int corner : tie.corner)
      if (const int other = scene_.surface.slave(corner); other >= 0) join_node(u, other);
  }

  bool is_body(int u) const { return u >= slaves_; }
  RigidMotion& body(int u) const { return bodies_[index(u - slaves_)]; }
  std::size_t global(int u) const { return index(scene_.surface.node[index(u)]); }
  bool has_mass(int u) const { return is_body(u) || nodes_.record[global(u)].inverse_mass > 0; }
  ZoneMember member(int u) const {
    ZoneMember one;
    if (is_body(u)) {
      const RigidMotion& motion = body(u);
      one = {motion.mass, motion.centre, motion.velocity, motion.inertia, motion.angular_velocity};
      for (int axis = 0; axis < 3; ++axis) {
        one.prescribed[index(axis)] = motion.translation_is_given(axis);
        one.prescribed[index(axis + 3)] = motion.rotation_is_given(axis);
      }
      one.axes = transposed(motion.axes);
      return one;
    }
    const NodeRecord& record = nodes_.record[global(u)];
    one = {1 / record.inverse_mass, vector_at(record.position), vector_at(record.velocity)};
    one.prescribed = static_cast<unsigned>(nodes_.prescribed_translations(global(u)));
    if (const SupportAxes* own = nodes_.own_axes(global(u)))
      for (int i = 0; i < 9; ++i) one.axes(i % 3, i / 3) = own->linear.m[i / 3][i % 3];
    return one;
  }

  void move(const std::vector<int>& units) {
    ++scene_.zones;
    std::vector<ZoneMember> members;
    std::vector<int> unit_of;
    for (int u : units)
      if (has_mass(u)) {
        members.push_back(member(u));
        unit_of.push_back(u);
      }
    if (members.empty()) return;
    std::vector<ZoneWall> walls = walls_of(find(units.front()));
    find_zone_impulses(members, walls);
    for (std::size_t i = 0; i < members.size(); ++i) push(unit_of[i], members[i]);
    for (const ZoneWall& wall : walls)
      if (wall.pushes) push(wall, unit_of, members);
    if (scene_.log) log_zone(unit_of, members);
    for (std::size_t i = 0; i < members.size(); ++i) account(unit_of[i], members[i]);
  }

  // Of nodes of zones. One whose impulse would turn nodes is left out.
  void find_wall_rows() {
    wall_rows_.clear();
    auto touch = scene_.walls.touch.begin();
    for (std::size_t r = 0; r < scene_.rows.rows.size(); ++r) {
      const ConstraintRow& row = scene_.rows.rows.row[r];
      if (row.wall < 0) continue;
      const int own = unit(touch++->slave), zone = find(own);
      const bool turns_nodes = row.rotation.size() > 0 && !is_body(own);
      if (turns_nodes || !(RowMap(scene_.rows.rows, row).inverse_mass(row.normal, scene_.rows.block) > 0))
        continue;
      wall_rows_.emplace_back(zone, r);
    }
    std::sort(wall_rows_.begin(), wall_rows_.end());
  }
  std::vector<ZoneWall> walls_of(int zone) const {
    std::vector<ZoneWall> walls;
    for (auto it = std::lower_bound(wall_rows_.begin(), wall_rows_.end(), std::pair(zone, std::size_t{0}));
         it != wall_rows_.end() && it->first == zone; ++it) {
      const ConstraintRow& row = scene_.rows.rows.row[it->second];
      walls.push_back({.row = it->second,
                       .point = row.point,
                       .normal = row.normal,
                       .least_velocity = row.target_velocity + dot(row.normal, row.wall_velocity)});
    }
    return walls;
  }
  // The impulse of a wall is that of its row, and not of the zone.
  void push(const ZoneWall& wall, const std::vector<int>& units, std::span<ZoneMember> members) {
    ConstraintRow& row = scene_.rows.rows.row[wall.row];
    row.impulse += wall.impulse;
    RowMap(scene_.rows.rows, row).spread(wall.impulse * wall.normal, [&](int block, const Vector3d& given) {
      const BlockOwner& owner = scene_.rows.owner[index(block)];
      const bool of_body =
          owner.kind == BlockOwner::Kind::body || owner.kind == BlockOwner::Kind::rotation_of_body;
      const int own = of_body ? slaves_ + owner.index : scene_.surface.slave(owner.index);
      const auto found = std::lower_bound(units.begin(), units.end(), own);
      if (found == units.end() || *found != own) return;
      ZoneMember& one = members[index(found - units.begin())];
      (owner.kind == BlockOwner::Kind::rotation_of_body ? one.moment : one.impulse) -= given;
    });
  }

  void log_zone(const std::vector<int>& units, const std::vector<ZoneMember>& members) {
    std::map<int, Vector3d> impulse_of_part;
    for (std::size_t i = 0; i < units.size(); ++i) {
      const int u = units[i];
      const int part =
          is_body(u) ? scene_.log->part_of_body[index(u - slaves_)] : scene_.log->part_of_node[global(u)];
      impulse_of_part.try_emplace(part, Vector3d{}).first->second += members[i].impulse;
    }
    scene_.log->add(impulse_of_part);
  }

  void push(int u, const ZoneMember& one) {
    if (is_body(u)) {
      RigidMotion& motion = body(u);
      motion.velocity += motion.free_inverse_mass() * one.impulse;
      motion.angular_velocity += motion.inverse_inertia * one.moment;
      return;
    }
    const auto s = index(u);
    double* velocity = nodes_.record[global(u)].velocity;
    const Vector3d change = nodes_.free_inverse_mass(global(u)) * one.impulse;
    velocity[0] += change.x;
    velocity[1] += change.y;
    velocity[2] += change.z;
    scene_.velocity[s] = vector_at(velocity);
    scene_.in_contact.insert(u);
  }
  void account(int u, const ZoneMember& one) {
    if (is_body(u)) {
      body(u).impulse += one.impulse;
      body(u).moment += one.moment;
    } else {
      scene_.zone_impulse[index(u)] += one.impulse;
    }
  }

  ContactScene& scene_;
  Nodes& nodes_;
  const Ties& ties_;
  std::span<RigidMotion> bodies_;
  int slaves_;
  std::vector<std::pair<int, std::size_t>> wall_rows_;  ///< (zone, row)
};

}  // namespace

void find_zone_impulses(std::span<ZoneMember> members, std::span<ZoneWall> walls) {
  for (;;) {
    const RigidFit fit(members, walls);
    bool passes = false;
    for (ZoneWall& wall : walls)
      if (!wall.pushes && fit.velocity_at(wall) < wall.least_velocity) wall.pushes = passes = true;
    if (passes) continue;
    for (ZoneMember& one : members) fit.give_impulses(one);
    for (ZoneWall& wall : walls)
      if (wall.pushes) wall.impulse = fit.impulse_of(wall);
    return;
  }
}

void move_zones_as_one(ContactScene& scene, Nodes& nodes, const Ties& ties, std::span<RigidMotion> bodies) {
  Zones(scene, nodes, ties, bodies).run();
}

}  // namespace brio
