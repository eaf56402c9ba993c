#include "contact/detection/proximity.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "contact/closest_segments.hpp"
#include "contact/detection/hull_point.hpp"

namespace brio {

using Eigen::Vector3d;

namespace {

/// Constraints are formed ahead of touching, over this multiple of the approach of the step: other impulses
/// of the step may speed it up.
constexpr double approach_factor = 2;
/// A weight below this is rounding: the closest point does not lie on that corner's side.
constexpr double no_weight = 1e-9;
/// Neighbours that come nearer by less than this sine are rounding.
constexpr double nearer_by_rounding = 1e-6;
/// A face beside an edge lies in the plane at right angles to the closest distance where it leaves it by less
/// than this sine. Where that is so at both edges, faces lie on each other, and the nodes keep the distance
/// of the edges to a quarter of it times their length.
constexpr double flat_sine = 1e-3;
/// Distances below this share of the smallest edge have no direction.
constexpr double no_distance = 1e-12;

template <class First, class Second>
void select(const PairList& pairs, double surplus, const First& first, const Second& second,
            std::vector<int>& awake) {
  awake.clear();
  for (std::size_t i = 0; i < pairs.size(); ++i)
    if (!(first(pairs.first[i]) + second(pairs.second[i]) + surplus < pairs.wake[i]))
      awake.push_back(static_cast<int>(i));
}

/// What forms the constraints of one step.
class Finder {
 public:
  Finder(Proximity& proximity, const SurfaceFeatures& features, const Surface& surface,
         const ContactOptions& options, FeaturePairs& pairs, const FeatureMotion& motion)
      : proximity_(proximity),
        features_(features),
        surface_(surface),
        options_(options),
        pairs_(pairs),
        motion_(motion),
        band_(proximity_band * features.smallest_edge) {}

  void nodes_and_faces() {
    proximity_.found.clear();
    for (int pair : proximity_.node_face) node_and_face(static_cast<std::size_t>(pair));
  }
  void edges_and_edges() {
    proximity_.found.clear();
    for (int pair : proximity_.edge_edge) edge_and_edge(static_cast<std::size_t>(pair));
  }

  // In an order that depends on the surface alone, none twice.
  void take_over(std::vector<Contact>& contacts) {
    auto& found = proximity_.found;
    std::sort(found.begin(), found.end(), [](const Proximity::Found& a, const Proximity::Found& b) {
      return std::tuple(a.contact.slave, a.support, a.contact.face) <
             std::tuple(b.contact.slave, b.support, b.contact.face);
    });
    const auto last =
        std::unique(found.begin(), found.end(), [](const Proximity::Found& a, const Proximity::Found& b) {
          return a.contact.slave == b.contact.slave && a.support == b.support;
        });
    for (auto entry = found.begin(); entry != last; ++entry) contacts.push_back(entry->contact);
  }

 private:
  const Face& face(int f) const { return surface_.face[static_cast<std::size_t>(f)]; }
  const EdgeFeature& edge(int e) const { return features_.edge[static_cast<std::size_t>(e)]; }
  int slave(int global) const { return surface_.slave(global); }

  // Whether no neighbour in the list comes nearer than the foot along the direction away from the other side.
  template <class List>
  bool look_away(const List& neighbours, const Vector3d& foot, const Vector3d& away) const {
    return std::all_of(neighbours.begin(), neighbours.end(), [&](int neighbour) {
      if (neighbour < 0) return true;
      const Vector3d arm = motion_.start(neighbour) - foot;
      return arm.dot(away) >= -nearer_by_rounding * arm.norm();
    });
  }

  void node_and_face(std::size_t pair) {
    PairList& list = pairs_.node_face;
    const int s = list.first[pair], f = list.second[pair];
    const Face& other = face(f);
    std::array<int, 4> corner{};
    FaceVertices at;
    for (std::size_t k = 0; k < 4; ++k) {
      corner[k] = slave(other.node[k]);
      at[k] = motion_.start(corner[k]);
    }
    const Vector3d x = motion_.start(s);
    const double reach = list.spaced[pair] != 0 ? features_.node_radius[static_cast<std::size_t>(s)] +
                                                      features_.face_radius[static_cast<std::size_t>(f)]
                                                : 2 * features_.skin;
    const double path = motion_.node_path(s) + motion_.face_path(f);
    const double ahead = approach_factor * (motion_.node_step(s) + motion_.face_step(f));
    Vector3d direction = list.direction_of(pair);
    if (direction.squaredNorm() < 0.5) {
      direction = (x - 0.25 * (at[0] + at[1] + at[2] + at[3])).normalized();
      list.set_direction(pair, direction);
      direction = list.direction_of(pair);
    }
    double apart = direction.dot(x);
    apart -= std::max(std::max(direction.dot(at[0]), direction.dot(at[1])),
                      std::max(direction.dot(at[2]), direction.dot(at[3])));
    apart *= 1 - 1e-6;  // the direction is rounded to single precision
    ++proximity_.looked_at;
    list.wake[pair] = path + apart - reach - band_;
    if (apart > reach + band_ + ahead) return;
    ++proximity_.closest_points;
    const HullPoint closest = closest_on_face(x, at, list.spaced[pair] != 0);
    const double distance = std::sqrt(closest.squared_distance);
    list.wake[pair] = path + distance - reach - band_;
    if (distance < no_distance * features_.smallest_edge) return;
    const Vector3d normal = closest.offset / distance;
    list.set_direction(pair, normal);
    if (distance > reach + band_ + ahead) return;

    Contact contact;
    contact.slave = s;
    contact.face = f;
    contact.body = other.body;
    contact.own = 1;
    contact.node = {s, corner[0], corner[1], corner[2], corner[3]};
    contact.weight[0] = 1;
    for (std::size_t k = 0; k < 4; ++k) contact.weight[k + 1] = -closest.weights[k];
    contact.normal = normal;
    contact.gap = distance - reach;
    if (!is_near(contact)) return;
    std::array<int, 2> support{};
    if (!is_minimum(f, corner, closest, x - closest.offset, normal, support)) return;
    contact.friction_coefficient =
        surface_.pairs.friction(surface_.node[static_cast<std::size_t>(s)], other.part, options_.friction);
    proximity_.found.push_back({contact, support});
  }

  // Whether the step's approach, or twice it, closes the gap.
  bool is_near(const Contact& contact) const {
    Vector3d relative = Vector3d::Zero();
    for (std::size_t k = 0; k < 5; ++k) relative += contact.weight[k] * motion_.displacement(contact.node[k]);
    return contact.gap <= band_ + approach_factor * std::abs(contact.normal.dot(relative));
  }

  // Whether the foot on the face is a local minimum on the union of faces; what it lies on: a node, two
  // nodes, or the face.
  bool is_minimum(int f, const std::array<int, 4>& corner, const HullPoint& closest, const Vector3d& foot,
                  const Vector3d& normal, std::array<int, 2>& support) const {
    std::array<std::size_t, 4> on{};
    std::size_t count = 0;
    const auto corners = static_cast<std::size_t>(face(f).corners());
    for (std::size_t k = 0; k < corners; ++k)
      if (closest.weights[k] > no_weight) on[count++] = k;
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

  void edge_and_edge(std::size_t pair) {
    PairList& list = pairs_.edge_edge;
    const int ea = list.first[pair], eb = list.second[pair];
    const EdgeFeature &a = edge(ea), &b = edge(eb);
    const Segment sa{motion_.start(a.node[0]), motion_.start(a.node[1])};
    const Segment sb{motion_.start(b.node[0]), motion_.start(b.node[1])};
    const double reach = list.spaced[pair] != 0 ? a.radius + b.radius : 2 * features_.skin;
    const double path = motion_.edge_path(ea) + motion_.edge_path(eb);
    const double ahead = approach_factor * (motion_.edge_step(ea) + motion_.edge_step(eb));
    Vector3d direction = list.direction_of(pair);
    if (direction.squaredNorm() < 0.5) {
      direction = (sa[0] + sa[1] - sb[0] - sb[1]).normalized();
      list.set_direction(pair, direction);
      direction = list.direction_of(pair);
    }
    const double apart = (1 - 1e-6) * (std::min(direction.dot(sa[0]), direction.dot(sa[1])) -
                                       std::max(direction.dot(sb[0]), direction.dot(sb[1])));
    ++proximity_.looked_at;
    list.wake[pair] = path + apart - reach - band_;
    if (apart > reach + band_ + ahead) return;
    ++proximity_.closest_points;
    const ClosestSegments closest = closest_points_of_segments(sa, sb);
    const double distance = std::sqrt(closest.squared_distance);
    list.wake[pair] = path + distance - reach - band_;
    if (distance < no_distance * features_.smallest_edge) return;
    const Vector3d normal = closest.offset / distance;
    list.set_direction(pair, normal);
    if (distance > reach + band_ + ahead) return;
    const Vector3d foot_a = (1 - closest.parameters[0]) * sa[0] + closest.parameters[0] * sa[1];
    const Vector3d foot_b = (1 - closest.parameters[1]) * sb[0] + closest.parameters[1] * sb[1];
    int on_a = 0, on_b = 0;
    if (!is_minimum(ea, closest.parameters[0], foot_a, normal, on_a) ||
        !is_minimum(eb, closest.parameters[1], foot_b, -normal, on_b))
      return;
    if (lies_flat(a, foot_a, normal) && lies_flat(b, foot_b, normal)) return;

    Contact contact;
    contact.slave = first_line_slave + ea;
    contact.face = -1;
    contact.body = b.body;
    contact.own = 2;
    contact.node = {a.node[0], a.node[1], b.node[0], b.node[1], b.node[1]};
    contact.weight = {1 - closest.parameters[0], closest.parameters[0], closest.parameters[1] - 1,
                      -closest.parameters[1], 0};
    contact.normal = normal;
    contact.gap = distance - reach;
    if (!is_near(contact)) return;
    contact.friction_coefficient = surface_.pairs.friction_of_parts(a.part, b.part, options_.friction);
    if (on_a >= 0) contact.slave = first_line_slave + on_a;
    proximity_.found.push_back({contact, {on_a, on_b}});
  }

  // Whether the foot on an edge is a local minimum on the union of edges and faces. Ends of edges of faces
  // are nodes, which have their own constraints. \param on the number of the edge, or of the end's node below
  // -1
  bool is_minimum(int e, double parameter, const Vector3d& foot, const Vector3d& away, int& on) const {
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
  bool lies_flat(const EdgeFeature& own, const Vector3d& foot, const Vector3d& direction) const {
    return std::any_of(own.wing.begin(), own.wing.end(), [&](int neighbour) {
      if (neighbour < 0) return false;
      const Vector3d arm = motion_.start(neighbour) - foot;
      return std::abs(arm.dot(direction)) <= flat_sine * arm.norm();
    });
  }

  Proximity& proximity_;
  const SurfaceFeatures& features_;
  const Surface& surface_;
  const ContactOptions& options_;
  FeaturePairs& pairs_;
  const FeatureMotion& motion_;
  double band_;
};

}  // namespace

double allowed_surplus(const SurfaceFeatures& features) {
  return 0.25 * proximity_band * features.smallest_edge;
}

void select_awake(Proximity& proximity, const SurfaceFeatures& features, const FeaturePairs& pairs,
                  const FeatureMotion& motion) {
  const double surplus = 2 * allowed_surplus(features);
  const auto node = [&](int s) { return motion.node_path(s) + approach_factor * motion.node_step(s); };
  const auto face = [&](int f) { return motion.face_path(f) + approach_factor * motion.face_step(f); };
  const auto edge = [&](int e) { return motion.edge_path(e) + approach_factor * motion.edge_step(e); };
  select(pairs.node_face, surplus, node, face, proximity.node_face);
  select(pairs.edge_edge, surplus, edge, edge, proximity.edge_edge);
}

void find_proximities(Proximity& proximity, const SurfaceFeatures& features, const Surface& surface,
                      const ContactOptions& options, FeaturePairs& pairs, const FeatureMotion& motion,
                      std::vector<Contact>& contacts) {
  contacts.clear();
  Finder finder(proximity, features, surface, options, pairs, motion);
  finder.nodes_and_faces();
  finder.take_over(contacts);
  finder.edges_and_edges();
  finder.take_over(contacts);
}

}  // namespace brio
