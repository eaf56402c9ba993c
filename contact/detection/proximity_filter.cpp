#include "contact/detection/proximity_filter.hpp"

#include <algorithm>
#include <cmath>

namespace brio {

using Eigen::Vector3d;

namespace {

/// Neighbours that come nearer by less than this sine are rounding.
constexpr double nearer_by_rounding = 1e-6;
/// A face beside an edge lies in the plane at right angles to the closest distance where it leaves it by less
/// than this sine. Where that is so at both edges, faces lie on each other, and the nodes keep the distance
/// of the edges to a quarter of it times their length.
constexpr double flat_sine = 1e-3;

}  // namespace

// Whether no neighbour in the list comes nearer than the foot along the direction away from the other side.
template <class List>
bool ProximityFilter::look_away(const List& neighbours, const Vector3d& foot, const Vector3d& away) const {
  return std::all_of(neighbours.begin(), neighbours.end(), [&](int neighbour) {
    if (neighbour < 0) return true;
    const Vector3d arm = motion_.start(neighbour) - foot;
    return arm.dot(away) >= -nearer_by_rounding * arm.norm();
  });
}

// Whether the step's approach, or twice it, closes the gap.
bool ProximityFilter::is_near(const Contact& contact) const {
  Vector3d relative = Vector3d::Zero();
  for (std::size_t k = 0; k < 5; ++k) relative += contact.weight[k] * motion_.displacement(contact.node[k]);
  return contact.gap <= band_ + approach_factor * std::abs(contact.normal.dot(relative));
}

// Whether the foot on the face is a local minimum on the union of faces; what it lies on: a node, two nodes,
// or the face.
bool ProximityFilter::is_minimum_on_face(int f, const std::array<double, 4>& weights, const Vector3d& foot,
                                         const Vector3d& normal, std::array<int, 2>& support) const {
  const std::array<int, 4>& corner = features_.face_node[static_cast<std::size_t>(f)];
  std::array<std::size_t, 4> on{};
  std::size_t count = 0;
  const std::size_t corners = corner[3] == corner[2] ? 3 : 4;
  for (std::size_t k = 0; k < corners; ++k)
    if (weights[k] > no_weight) on[count++] = k;
  if (count == 1) {
    support = {corner[on[0]], -1};
    return look_away(features_.ring.of(corner[on[0]]), foot, -normal);
  }
  support = {-2 - f, -1};
  if (count != 2 || (corners == 4 && on[1] == on[0] + 2)) return true;
  const std::size_t side = on[1] == on[0] + 1 ? on[0] : on[1];
  support = {std::min(corner[on[0]], corner[on[1]]), std::max(corner[on[0]], corner[on[1]])};
  return look_away(edge(features_.edge_of_face[static_cast<std::size_t>(f)][side]).wing, foot, -normal);
}

void ProximityFilter::node_and_face(const NearPair<4>& near, std::vector<FoundContact>& found) const {
  const auto pair = static_cast<std::size_t>(near.pair);
  const int s = pairs_.node_face.first[pair], f = pairs_.node_face.second[pair];
  const std::array<int, 4>& corner = features_.face_node[static_cast<std::size_t>(f)];
  const Face& face = surface_.face[static_cast<std::size_t>(f)];
  Contact contact;
  contact.slave = s;
  contact.face = f;
  contact.body = face.body;
  contact.own = 1;
  contact.node = {s, corner[0], corner[1], corner[2], corner[3]};
  contact.weight[0] = 1;
  for (std::size_t k = 0; k < 4; ++k) contact.weight[k + 1] = -near.at[k];
  contact.normal = near.normal;
  contact.gap = near.distance - near.reach;
  if (!is_near(contact)) return;
  std::array<int, 2> support{};
  const Vector3d foot = motion_.start(s) - near.distance * near.normal;
  if (!is_minimum_on_face(f, near.at, foot, near.normal, support)) return;
  // Beside a side or a corner the direction is no normal of the face: a node that its own neighbours come
  // nearer than, as one of a flat surface ahead of a rim, is no minimum.
  const bool inside = support[0] < -1;
  if (!inside && !look_away(features_.ring.of(s), motion_.start(s), near.normal)) return;
  contact.friction_coefficient =
      surface_.pairs.friction(surface_.node[static_cast<std::size_t>(s)], face.part, options_.friction);
  found.push_back({contact, support});
}

// Whether the foot on an edge is a local minimum on the union of edges and faces. Ends of edges of faces are
// nodes, which have their own constraints. \param on the number of the edge, or of the end's node below -1
bool ProximityFilter::is_minimum_on_edge(int e, double parameter, const Vector3d& foot, const Vector3d& away,
                                         int& on) const {
  const EdgeFeature& own = edge(e);
  on = e;
  if (own.is_point()) return true;
  const bool inside = parameter > no_weight && parameter < 1 - no_weight;
  if (inside) return own.faces > 2 || look_away(own.wing, foot, away);
  if (own.of_face()) return false;
  const int end = own.node[parameter > 0.5 ? 1 : 0];
  on = -2 - end;
  return look_away(features_.ring.of(end), foot, away);
}

// Whether a face beside the edge lies in the plane at right angles to the direction.
bool ProximityFilter::lies_flat(const EdgeFeature& own, const Vector3d& foot,
                                const Vector3d& direction) const {
  return std::any_of(own.wing.begin(), own.wing.end(), [&](int neighbour) {
    if (neighbour < 0) return false;
    const Vector3d arm = motion_.start(neighbour) - foot;
    return std::abs(arm.dot(direction)) <= flat_sine * arm.norm();
  });
}

void ProximityFilter::edge_and_edge(const NearPair<2>& near, std::vector<FoundContact>& found) const {
  const auto pair = static_cast<std::size_t>(near.pair);
  const int ea = pairs_.edge_edge.first[pair], eb = pairs_.edge_edge.second[pair];
  const EdgeFeature &a = edge(ea), &b = edge(eb);
  const auto foot = [&](const EdgeFeature& own, double parameter) {
    return Vector3d((1 - parameter) * motion_.start(own.node[0]) + parameter * motion_.start(own.node[1]));
  };
  const Vector3d foot_a = foot(a, near.at[0]), foot_b = foot(b, near.at[1]);
  int on_a = 0, on_b = 0;
  if (!is_minimum_on_edge(ea, near.at[0], foot_a, near.normal, on_a) ||
      !is_minimum_on_edge(eb, near.at[1], foot_b, -near.normal, on_b))
    return;
  if (lies_flat(a, foot_a, near.normal) && lies_flat(b, foot_b, near.normal)) return;

  Contact contact;
  contact.slave = first_line_slave + (on_a >= 0 ? on_a : ea);
  contact.face = -1;
  contact.body = b.body;
  contact.own = 2;
  contact.node = {a.node[0], a.node[1], b.node[0], b.node[1], b.node[1]};
  contact.weight = {1 - near.at[0], near.at[0], near.at[1] - 1, -near.at[1], 0};
  contact.normal = near.normal;
  contact.gap = near.distance - near.reach;
  if (!is_near(contact)) return;
  contact.friction_coefficient = surface_.pairs.friction_of_parts(a.part, b.part, options_.friction);
  found.push_back({contact, {on_a, on_b}});
}

}  // namespace brio
