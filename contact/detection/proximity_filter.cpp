#include "contact/detection/proximity_filter.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "contact/geometry/closest_segments.hpp"
#include "contact/geometry/hull_point.hpp"
#include "contact/surface/exclusion.hpp"
#include "src/base/index.hpp"

namespace brio {

namespace {

/// Neighbours that are nearer by less than this sine are ignored, so that surfaces in contact that bend keep
/// their constraints: at distance d an ignored neighbour is nearer by less than d sine^2. A face beside an
/// edge counts as perpendicular to the closest distance if it deviates by less; if that is so at both edges,
/// faces lie on each other, and nodes, and rims and diagonals where they cross, keep the distance of inner
/// edges to a quarter of the sine times their length.
constexpr double flat_sine = 1e-3;
/// The same in units in the last place of positions, over the distance.
constexpr double roundings = 8;
/// If the direction deviates from the normals of the faces at a sharp edge by this angle or more, solids are
/// in contact at a part of their skins: rounded by whole skins, an edge that stands out by a hundredth of
/// them would stop a sliding body.
constexpr double tilted_angle = 0.1;
constexpr double skin_of_sharp_edges = 0.4;
/// Faces at an angle of more than 20 degrees form a sharp edge; smaller angles are the mesh of a curved
/// surface.
constexpr double sharp_cosine = 0.94;
/// Fraction of the step at which a motion that may pass is examined.
constexpr std::array<double, 2> looked_at_shares{0.5, 1};

}  // namespace

// The normals of a face and of the sides of a node, as they were at the start of the step.
template <class Faces>
ProximityFilter::Edginess ProximityFilter::edginess(const Faces& faces, const Vector3d& direction) const {
  Edginess found;
  Vector3d first{};
  for (int f : faces) {
    if (f < 0) continue;
    const std::array<int, 4>& corner = features_.face_node[index(f)];
    const auto at = [&](std::size_t k) { return motion_.start(corner[k]); };
    const Vector3d normal = unit_or(cross(at(2) - at(0), at(3) - at(1)), Vector3d{});
    found.cosine = std::max(found.cosine, dot(normal, direction));
    if (is_zero(first)) first = normal;
    found.sharp |= dot(normal, first) < sharp_cosine;
  }
  return found;
}

// Gap from which on a passing motion is tested. Not for a resting contact, with a gap of rounding.
double ProximityFilter::passing_gap(double tilt) const {
  return tilt < tilted_angle ? band_ : 0.1 * 2 * features_.skin;
}

double ProximityFilter::tilt_of(double cosine) { return std::sqrt(2 * std::max(1 - cosine, 0.0)); }

// Reduction of the contact distance of solids at a sharp edge.
double ProximityFilter::spared_skin(double tilt) const {
  return (1 - skin_of_sharp_edges) * 2 * features_.skin * std::min(tilt / tilted_angle, 1.0);
}

// The sine of the error of directions for a distance of the closest points.
double ProximityFilter::slack_of(const Vector3d& foot, double distance) {
  return std::max(flat_sine,
                  roundings * std::numeric_limits<double>::epsilon() * maximum_norm(foot) / distance);
}

// Of parameters: nearer to a node, the direction differs by less than the sine from that of the node, which
// holds where it is a minimum itself.
double ProximityFilter::rounding_of_foot(double slack, double distance) const {
  return std::max(no_weight, slack * distance / features_.smallest_edge);
}

// Where a shell folds onto itself, neighbours towards the fold are the nearer the closer they are to it:
// those within the tightest fold are not constrained.
bool ProximityFilter::is_one_piece(int neighbour, OtherSide other) const {
  return std::any_of(other.begin(), other.end(),
                     [&](int f) { return f >= 0 && is_excluded(excluded_, neighbour, f); });
}

// Whether no neighbour in the list is nearer than the foot along the direction away from the other side: at
// the start of the step, or at its predicted end, so that a loaded constraint is not dropped in a step in
// which a neighbour is a little nearer.
template <class List, class Allowed>
bool ProximityFilter::look_away(const List& neighbours, const MovingPoint& foot, const Vector3d& away,
                                double slack, OtherSide other, const Allowed& allowed) const {
  const auto look = [&](const Vector3d& from, double share) {
    return std::all_of(neighbours.begin(), neighbours.end(), [&](int neighbour) {
      if (neighbour < 0) return true;
      const Vector3d arm = after(share, neighbour) - from;
      const double height = dot(arm, away);
      return height >= 0 || height * height <= slack * slack * squared_norm(arm) ||
             height >= -allowed(neighbour) || is_one_piece(neighbour, other);
    });
  };
  return look(foot.start, 0) || look(foot.end, 1);
}
template <class List>
bool ProximityFilter::look_away(const List& neighbours, const MovingPoint& foot, const Vector3d& away,
                                double slack, OtherSide other) const {
  return look_away(neighbours, foot, away, slack, other, [](int) { return 0.0; });
}

// Of an edge. The diagonals of a flat face are no features: if one of its corners is nearer by less than the
// allowed thickness of the face, the edge keeps the distance.
bool ProximityFilter::wings_look_away(const EdgeFeature& own, const MovingPoint& foot, const Vector3d& away,
                                      double slack, const EdgePair& pair, OtherSide other) const {
  return look_away(own.wing, foot, away, slack, other, [&](int neighbour) {
    double thickest = 0;
    for (int f : own.face) {
      if (f < 0) continue;
      const std::array<int, 4>& corner = features_.face_node[index(f)];
      if (std::find(corner.begin(), corner.end(), neighbour) != corner.end())
        thickest = std::max(thickest, pairs_.flatness().thickness_of_flat(features_, motion_, f, pair.radii,
                                                                          was_constraint(pair)));
    }
    return thickest;
  });
}

bool ProximityFilter::was_constraint(const EdgePair& pair) const {
  return has_edges(last_, pair.first, nodes_of_edges(edge(pair.first).node, edge(pair.second).node));
}

// Whether no flat shape hides one of them. Once they are a constraint they are one until they part: shapes
// whose hulls are about as thick as flat ones may be would otherwise dissipate energy at every other step.
bool ProximityFilter::are_features(const EdgePair& pair) const {
  return pairs_.flatness().are_features(features_, motion_, pair.first, pair.second, {.radii = pair.radii}) ||
         was_constraint(pair);
}

ProximityFilter::MovingPoint ProximityFilter::point_of(int node) const {
  return {motion_.start(node), motion_.start(node) + motion_.displacement(node)};
}

// Whether the foot on the face is a local minimum on the union of faces; what it lies on: a node, two nodes,
// or the face.
bool ProximityFilter::is_minimum_on_face(int f, const std::array<double, 4>& weights, const MovingPoint& foot,
                                         const Vector3d& normal, double slack, OtherSide other,
                                         std::array<int, 2>& support) const {
  const std::array<int, 4>& corner = features_.face_node[index(f)];
  std::array<std::size_t, 4> on{};
  std::size_t count = 0;
  const std::size_t corners = corner[3] == corner[2] ? 3 : 4;
  for (std::size_t k = 0; k < corners; ++k)
    if (weights[k] > no_weight) on[count++] = k;
  if (count == 1) {
    support = {corner[on[0]], -1};
    return look_away(features_.ring.of(corner[on[0]]), foot, -normal, slack, other);
  }
  support = {-2 - f, -1};
  if (count != 2 || (corners == 4 && on[1] == on[0] + 2)) return true;
  const std::size_t side = on[1] == on[0] + 1 ? on[0] : on[1];
  support = {std::min(corner[on[0]], corner[on[1]]), std::max(corner[on[0]], corner[on[1]])};
  return look_away(edge(features_.edge_of_face[index(f)][side]).wing, foot, -normal, slack, other);
}

// Both faces at a side of a face.
std::array<int, 2> ProximityFilter::faces_of_side(int f, const std::array<int, 2>& ends) const {
  const std::array<int, 4>& corner = features_.face_node[index(f)];
  for (std::size_t k = 0; k < 4; ++k) {
    const int from = corner[k], to = corner[(k + 1) % 4];
    if (std::min(from, to) == ends[0] && std::max(from, to) == ends[1])
      return edge(features_.edge_of_face[index(f)][k]).face;
  }
  return {f, -1};
}

double ProximityFilter::squared_distance_after(double share, int slave, int f, bool as_hull) const {
  const std::array<int, 4>& corner = features_.face_node[index(f)];
  const auto at = [&](std::size_t k) { return after(share, corner[k]); };
  return closest_on_face(after(share, slave), {at(0), at(1), at(2), at(3)}, as_hull).squared_distance;
}
double ProximityFilter::squared_distance_after(double share, const EdgeFeature& a,
                                               const EdgeFeature& b) const {
  const auto at = [&](const EdgeFeature& own) {
    return Segment{after(share, own.node[0]), after(share, own.node[1])};
  };
  return closest_points_of_segments(at(a), at(b)).squared_distance;
}

// Whether the gap is within the band, or the step's approach, or twice it, takes the pair there: not along
// the direction alone but by its distance then, so that no bound of paths by which a pair may not be
// examined, and no list of pairs whose boxes meet, leaves out what comes near.
template <class... Pair>
bool ProximityFilter::is_near(const Contact& contact, double distance, const Pair&... pair) const {
  if (contact.gap <= band_) return true;
  Vector3d relative{};
  for (std::size_t k = 0; k < 5; ++k) relative += contact.weight[k] * motion_.displacement(contact.node[k]);
  const double approach = -dot(contact.normal, relative);
  if (!(contact.gap <= band_ + approach_factor * approach)) return false;
  const double share = std::min((contact.gap - 0.5 * band_) / approach, approach_factor);
  return squared_distance_after(share, pair...) <= square(distance - contact.gap + band_);
}

// Whether the motion of the step passes without coming nearer than `reach`: it would be stopped along the
// direction at the start. Crossings are found by continuous collision detection.
template <class... Pair>
bool ProximityFilter::passes_by(double reach, const Pair&... pair) const {
  return std::none_of(looked_at_shares.begin(), looked_at_shares.end(),
                      [&](double share) { return squared_distance_after(share, pair...) < reach * reach; });
}

// If the direction to the rim of a face deviates from its normal by no more than the slack, the constraint is
// along the normal, and its foot is the point of the plane of the face below the node. Two rims that are
// pressed together would otherwise stand on each other as an inverted pendulum of the length of the gap.
// \returns whether it is so
bool ProximityFilter::lay_in_plane(const NearPair<4>& near, double slack, Contact& contact) const {
  const std::array<int, 4>& corner = features_.face_node[index(contact.face)];
  const std::size_t corners = corner[3] == corner[2] ? 3 : 4;
  const auto k = index(std::max_element(near.at.begin(), near.at.begin() + corners) - near.at.begin());
  const std::size_t next = (k + 1) % corners, previous = (k + corners - 1) % corners;
  const Vector3d along = motion_.start(corner[next]) - motion_.start(corner[k]);
  const Vector3d across = motion_.start(corner[previous]) - motion_.start(corner[k]);
  const Vector3d normal = unit_or(cross(along, across), Vector3d{});
  const double cosine = dot(normal, near.normal);
  const Vector3d aside = near.normal - cosine * normal;
  if (is_zero(normal) || squared_norm(aside) > slack * slack) return false;
  // The foot moves by first * along + second * across.
  const double aa = squared_norm(along), ab = dot(along, across), bb = squared_norm(across);
  const double scale = near.distance / (aa * bb - ab * ab);
  const double first = scale * (bb * dot(along, aside) - ab * dot(across, aside));
  const double second = scale * (aa * dot(across, aside) - ab * dot(along, aside));
  contact.weight[1 + next] -= first;
  contact.weight[1 + previous] -= second;
  contact.weight[1 + k] += first + second;
  contact.normal = std::copysign(1.0, cosine) * normal;
  contact.gap = near.distance * std::abs(cosine) - near.reach;
  return true;
}

// Of a node beside a side or a corner, whether it is near, may touch in this step, and is not constrained to
// another face. \param contact its gap is enlarged at sharp edges
bool ProximityFilter::is_kept_beside_rim(const NearPair<4>& near, const std::array<int, 2>& support,
                                         bool in_plane, double slack, Contact& contact) const {
  if (in_plane && contact.gap <= band_) return true;  // whatever the faces at both
  const bool as_hull = pairs_.node_face.has_radii(index(near.pair));
  const int s = contact.slave, f = contact.face;
  const std::array<int, 2> beside = support[1] >= 0 ? faces_of_side(f, support) : std::array{-1, -1};
  const std::span<const int> at_foot =
      support[1] >= 0 ? std::span<const int>(beside) : surface_.faces_of.of(support[0]);
  const Edginess of_face = edginess(at_foot, near.normal);
  const Edginess of_node = edginess(surface_.faces_of.of(s), Vector3d(-near.normal));
  // Of two nodes of which only the first has a face at right angles to the direction, the second is the one
  // that is constrained to a face: that constraint has the normal for its direction.
  if (!in_plane && support[1] < 0 && tilt_of(of_node.cosine) < slack) return false;
  const double tilt = in_plane ? 0 : tilt_of(std::max(of_face.cosine, of_node.cosine));
  const bool skins = of_face.sharp && of_node.sharp && !surface_.face[index(f)].shell &&
                     features_.node_radius[index(s)] <= features_.skin;
  if (skins) contact.gap += spared_skin(tilt);
  if (!is_near(contact, near.distance, s, f, as_hull)) return false;
  const double reach = near.reach - (skins ? spared_skin(tilted_angle) : 0);
  return contact.gap <= passing_gap(tilt) || !passes_by(reach, s, f, as_hull);
}

void ProximityFilter::node_and_face(const NearPair<4>& near, std::vector<FoundContact>& found) const {
  const auto pair = index(near.pair);
  const int s = pairs_.node_face.first(pair), f = pairs_.node_face.second(pair);
  const std::array<int, 4>& corner = features_.face_node[index(f)];
  const Face& face = surface_.face[index(f)];
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
  if (!is_near(contact, near.distance, s, f, pairs_.node_face.has_radii(pair))) return;
  std::array<int, 2> support{};
  MovingPoint foot{motion_.start(s) - near.distance * near.normal, Vector3d{}};
  foot.end = foot.start;
  for (std::size_t k = 0; k < 4; ++k) foot.end += near.at[k] * motion_.displacement(corner[k]);
  const double slack = slack_of(foot.start, near.distance);
  const bool own = face.shell && face.body == surface_.body[index(s)];
  const OtherSide faces_of_node = own ? OtherSide(surface_.faces_of.of(s)) : OtherSide();
  if (!is_minimum_on_face(f, near.at, foot, near.normal, slack, faces_of_node, support)) return;
  // Beside a side or a corner the direction is no normal of the face: a node that its own neighbours come
  // nearer than, as one of a flat surface ahead of a rim, is no minimum. Not where a shell folds onto itself:
  // the nearest towards the fold are one piece with each other and would leave the rest to come nearer than
  // they may.
  const bool inside = support[0] < -1;
  bool in_plane = false;
  if (!inside) {
    if (!own && !look_away(features_.ring.of(s), point_of(s), near.normal, slack, {})) return;
    in_plane = lay_in_plane(near, slack, contact);
    if (!is_kept_beside_rim(near, support, in_plane, slack, contact)) return;
  }
  contact.friction_coefficient =
      surface_.pairs.friction(surface_.node[index(s)], face.part, options_.friction);
  found.push_back({contact, support, in_plane});
}

// Whether the foot on an edge is a local minimum on the union of edges and faces. Ends of edges of faces are
// nodes, which have their own constraints. \param on the number of the edge, or of the end's node below -1
bool ProximityFilter::is_minimum_on_edge(int e, double parameter, const MovingPoint& foot,
                                         const Vector3d& away, double slack, double distance,
                                         const EdgePair& pair, OtherSide other, int& on) const {
  const EdgeFeature& own = edge(e);
  on = e;
  if (own.is_point()) return true;
  const int end = own.node[parameter > 0.5 ? 1 : 0];
  if (parameter > no_weight && parameter < 1 - no_weight) {
    const bool at_end = std::min(parameter, 1 - parameter) <= rounding_of_foot(slack, distance);
    if (at_end && own.of_face() && look_away(features_.ring.of(end), point_of(end), away, slack, other))
      return false;
    return own.faces > 2 || wings_look_away(own, foot, away, slack, pair, other);
  }
  if (own.of_face()) return false;
  on = -2 - end;
  return look_away(features_.ring.of(end), foot, away, slack, other);
}

// How the faces beside the edge lie in the plane at right angles to the direction.
ProximityFilter::Flatness ProximityFilter::flatness(const EdgeFeature& own, const Vector3d& foot,
                                                    const Vector3d& direction) const {
  int flat = 0, steep = 0;
  for (int neighbour : own.wing) {
    if (neighbour < 0) continue;
    const Vector3d arm = motion_.start(neighbour) - foot;
    const double height = dot(arm, direction);
    (height * height <= flat_sine * flat_sine * squared_norm(arm) ? flat : steep) += 1;
  }
  if (flat == 0) return Flatness::none;
  return steep == 0 && own.faces == 2 ? Flatness::inside : Flatness::rim;
}

// Parallel sides of faces: the ends of their common length are nodes at a side, whose constraints hold the
// part in between.
bool ProximityFilter::are_parallel(const EdgeFeature& a, const EdgeFeature& b, double sine) const {
  if (!a.of_face() || !b.of_face()) return false;
  const Vector3d along_a = motion_.start(a.node[1]) - motion_.start(a.node[0]);
  const Vector3d along_b = motion_.start(b.node[1]) - motion_.start(b.node[0]);
  return squared_norm(cross(along_a, along_b)) <= sine * sine * squared_norm(along_a) * squared_norm(along_b);
}

void ProximityFilter::edge_and_edge(const NearPair<2>& near, std::vector<FoundContact>& found) const {
  const auto pair = index(near.pair);
  const int ea = pairs_.edge_edge.first(pair), eb = pairs_.edge_edge.second(pair);
  const EdgeFeature &a = edge(ea), &b = edge(eb);
  const auto foot = [&](const EdgeFeature& own, double parameter) {
    const MovingPoint first = point_of(own.node[0]), second = point_of(own.node[1]);
    return MovingPoint{(1 - parameter) * first.start + parameter * second.start,
                       (1 - parameter) * first.end + parameter * second.end};
  };
  const MovingPoint foot_a = foot(a, near.at[0]), foot_b = foot(b, near.at[1]);
  const double slack = slack_of(foot_a.start, near.distance);
  if (are_parallel(a, b, rounding_of_foot(slack, near.distance))) return;
  const Flatness flat_a = flatness(a, foot_a.start, near.normal),
                 flat_b = flatness(b, foot_b.start, near.normal);
  const bool rims = flat_a == Flatness::rim && flat_b == Flatness::rim;
  if (flat_a != Flatness::none && flat_b != Flatness::none && !rims) return;
  int on_a = 0, on_b = 0;
  const bool own = a.shell && b.shell && a.body == b.body;
  const OtherSide faces_of_a = own ? OtherSide(a.face) : OtherSide();
  const OtherSide faces_of_b = own ? OtherSide(b.face) : OtherSide();
  const EdgePair edges{ea, eb, pairs_.edge_edge.has_radii(pair)};
  if (!is_minimum_on_edge(ea, near.at[0], foot_a, near.normal, slack, near.distance, edges, faces_of_b,
                          on_a) ||
      !is_minimum_on_edge(eb, near.at[1], foot_b, -near.normal, slack, near.distance, edges, faces_of_a,
                          on_b) ||
      !are_features(edges))
    return;

  Contact contact;
  contact.slave = first_edge_slave + (on_a >= 0 ? on_a : ea);
  contact.face = -1;
  contact.body = b.body;
  contact.own = 2;
  contact.node = nodes_of_edges(a.node, b.node);
  contact.weight = {1 - near.at[0], near.at[0], near.at[1] - 1, -near.at[1], 0};
  contact.normal = near.normal;
  contact.gap = near.distance - near.reach;
  const bool of_faces = a.of_face() && b.of_face();
  const Edginess of_a = edginess(a.face, Vector3d(-near.normal)), of_b = edginess(b.face, near.normal);
  const double tilt = of_faces ? tilt_of(std::max(of_a.cosine, of_b.cosine)) : 0;
  const bool skins = of_faces && of_a.sharp && of_b.sharp && !a.shell && !b.shell;
  if (skins) contact.gap += spared_skin(tilt);
  if (!is_near(contact, near.distance, a, b)) return;
  if (contact.gap > passing_gap(tilt) &&
      passes_by(near.reach - (skins ? spared_skin(tilted_angle) : 0), a, b))
    return;
  contact.friction_coefficient = surface_.pairs.friction_of_parts(a.part, b.part, options_.friction);
  found.push_back({contact, {on_a, on_b}});
}

}  // namespace brio
