#include "src/build/build_ties.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "contact/search/global_search.hpp"
#include "contact/surface/face_geometry.hpp"
#include "src/base/index.hpp"
#include "src/build/build.hpp"
#include "src/deck/part_index.hpp"
#include "src/motion/skew_supports.hpp"

namespace brio {

namespace {

/// What lies beyond an edge counts so many times its distance.
constexpr double beyond_weight = 2;
/// Weights below this are rounding of 0: such corners have no weight.
constexpr double held_weight = 1e-9;
/// Initial velocities of a node and its face may differ by this share of the fastest corner: rounding.
constexpr double same_velocity = 1e-9;

std::string at(const Nodes& nodes, int node) {
  const Vector3d x = position(nodes, node);
  std::ostringstream text;
  text << "at (" << x[0] << ", " << x[1] << ", " << x[2] << ")";
  return text.str();
}

/// Faces of one part and the nodes that may be near them.
struct MainSurface {
  std::size_t part;
  Surface surface;
  double half_thickness;
  bool turning;
};

MainSurface main_surface_of(std::size_t p, const Deck& deck, std::span<const Mesh> meshes,
                            std::span<const std::vector<int>> connectivity, const Model& model) {
  SurfacePart surface;
  surface.name = deck.parts[p].name;
  surface.nodes_per_element = meshes[p].nodes_per_element;
  surface.connectivity = connectivity[p];
  const Element& element = deck.parts[p].element;
  const double thickness = std::visit([](const auto& kind) { return kind.contact_thickness(); }, element);
  if (thickness > 0) surface.thickness.assign(meshes[p].element_count(), thickness);
  return {.part = p,
          .surface = make_surface(std::span(&surface, 1), model.nodes.size()),
          .half_thickness = 0.5 * thickness,
          .turning = has_rotations(element)};
}

CandidatePairs find_near(const MainSurface& main_surface, std::span<const int> slaves, double tolerance,
                         const Nodes& nodes) {
  std::vector<Vector3d> points;
  for (int node : slaves) points.push_back(position(nodes, node));
  std::vector<CaptureBox> boxes;
  for (const Face& face : main_surface.surface.face) {
    const FaceVertices corners = vertices(nodes, face);
    Vector3d lower = corners[0], upper = corners[0];
    for (const Vector3d& corner : corners) {
      lower = minimum(lower, corner);
      upper = maximum(upper, corner);
    }
    const double reach = tolerance + main_surface.half_thickness + 2 * beyond_edge * norm(upper - lower);
    CaptureBox& grown = boxes.emplace_back();
    for (int axis = 0; axis < 3; ++axis) {
      grown.lower[axis] = lower[axis] - reach;
      grown.upper[axis] = upper[axis] + reach;
    }
  }
  CandidatePairs pairs;
  SearchCounts counts;
  ThreadTeam team(1);
  GlobalSearch search;
  search.find(points, boxes, team, pairs, counts);
  return pairs;
}

struct Found {
  Tie tie;
  int face = -1;
  double distance = 0;  ///< from the surface
  double rank = 0;      ///< the same, more beyond an edge
};

// On a face with rotations the distance is an arm that rotates with it.
void take_rotations(Tie& tie, const FaceVertices& corners, const Nodes& nodes) {
  tie.turning = true;
  tie.arm = position(nodes, tie.node) - point_on(tie, corners);
  if (tie.gap == 0) tie.arm = {};
  tie.gap = 0;
}

// Of each slave: the closest face within the tolerance, the first of those as close.
std::vector<Found> closest_faces(const MainSurface& main_surface, std::span<const int> slaves,
                                 double tolerance, const Nodes& nodes) {
  std::vector<Found> closest(slaves.size());
  const CandidatePairs pairs = find_near(main_surface, slaves, tolerance, nodes);
  for (std::size_t f = 0; f < main_surface.surface.face.size(); ++f) {
    const Face& face = main_surface.surface.face[f];
    const FaceVertices corners = vertices(nodes, face);
    for (int s : pairs.of_box(f)) {
      const int node = slaves[index(s)];
      std::optional<Tie> tie = project(position(nodes, node), corners);
      if (!tie) continue;
      const double distance = std::max(std::abs(tie->gap) - main_surface.half_thickness, 0.0);
      if (!(distance <= tolerance)) continue;
      const double outside = -std::min(*std::min_element(tie->weight.begin(), tie->weight.end()), 0.0);
      const double rank = distance + beyond_weight * outside * norm(corners[2] - corners[0]);
      Found& best = closest[index(s)];
      if (best.face >= 0 && !(rank < best.rank)) continue;
      tie->node = node;
      tie->corner = face.node;
      if (main_surface.turning) take_rotations(*tie, corners, nodes);
      best = {*tie, static_cast<int>(f), distance, rank};
    }
  }
  return closest;
}

class Tying {
 public:
  Tying(const Deck& deck, std::span<const Mesh> meshes, std::span<const std::vector<int>> connectivity,
        Model& model)
      : deck_(deck), meshes_(meshes), connectivity_(connectivity), model_(model) {}

  void add(const TieToSurface& entry) {
    if (index_of_.empty()) index_of_.assign(model_.nodes.size(), untied);
    const MainSurface main_surface =
        main_surface_of(part_index(entry.names[1], deck_), deck_, meshes_, connectivity_, model_);
    NodeSelection named;
    named.set = entry.names[0];
    named.place = entry.place;
    std::vector<int> slaves = select_nodes(named, deck_, meshes_, model_);
    std::vector<int> own = model_.parts[main_surface.part].node;
    std::sort(own.begin(), own.end());
    std::erase_if(slaves, [&](int node) { return std::binary_search(own.begin(), own.end(), node); });

    TiedParts parts{.nodes = entry.names[0], .surface = entry.names[1], .place = entry.place};
    if (entry.failure) {
      parts.normal_force = entry.failure->normal_force.value_or(parts.normal_force);
      parts.shear_force = entry.failure->shear_force.value_or(parts.shear_force);
    }
    for (const Found& found : closest_faces(main_surface, slaves, entry.tolerance, model_.nodes)) {
      if (found.face < 0) continue;
      tie_node(found, main_surface, entry);
      ++parts.count;
      parts.largest_gap = std::max(parts.largest_gap, found.distance);
    }
    if (parts.count == 0) {
      std::ostringstream fault;
      fault << "no node of '" << parts.nodes << "' lies within " << entry.tolerance << " of the surface of '"
            << parts.surface << "'; at least one is expected";
      throw BuildError(fault.str(), entry.place);
    }
    model_.ties.found.push_back(std::move(parts));
  }

  /// Tied nodes before the nodes of their main faces.
  void sort() {
    std::vector<std::uint8_t> seen(model_.ties.node.size(), 0);
    for (int i = 0; i < static_cast<int>(seen.size()); ++i) visit(i, seen);
    std::vector<TiedNode> ordered;
    for (std::size_t i = order_.size(); i-- > 0;) ordered.push_back(model_.ties.node[index(order_[i])]);
    model_.ties.node = std::move(ordered);
  }

 private:
  void tie_node(const Found& found, const MainSurface& main_surface, const TieToSurface& entry) {
    const int node = found.tie.node;
    int& number = index_of_[index(node)];
    const bool joins = model_.parts[main_surface.part].rigid >= 0;
    std::vector<TiedNode>& tied = joins ? model_.ties.joined : model_.ties.node;
    if (number != untied) {
      const TiedNode& before = number >= 0
                                   ? model_.ties.node[index(number)]
                                   : *std::ranges::find(model_.ties.joined, node,
                                                        [](const TiedNode& one) { return one.tie.node; });
      const TiedParts& first = model_.ties.found[index(before.connection)];
      throw BuildError("a node of '" + entry.names[0] + "' " + at(model_.nodes, node) + " is tied to '" +
                           first.surface + "' already; one tie is accepted per node",
                       entry.place);
    }
    number = joins ? joined : static_cast<int>(tied.size());
    const int slot = main_surface.surface.face[index(found.face)].element;
    tied.push_back({.tie = found.tie,
                    .face_part = static_cast<int>(main_surface.part),
                    .element = model_.parts[main_surface.part].element_order[index(slot)],
                    .connection = static_cast<int>(model_.ties.found.size())});
  }

  enum : std::uint8_t { unseen, open, done };

  void visit(int i, std::vector<std::uint8_t>& seen) {
    std::uint8_t& state = seen[index(i)];
    if (state == done) return;
    const TiedNode& tied = model_.ties.node[index(i)];
    if (state == open) {
      const TiedParts& parts = model_.ties.found[index(tied.connection)];
      throw BuildError(
          "a node of '" + parts.nodes + "' " + at(model_.nodes, tied.tie.node) +
              " would be tied to a face whose nodes are tied to it; accepted are ties without cycles",
          parts.place);
    }
    state = open;
    for (int corner : tied.tie.corner)
      if (const int next = index_of_[index(corner)]; next >= 0) visit(next, seen);
    seen[index(i)] = done;
    order_.push_back(i);
  }

  const Deck& deck_;
  std::span<const Mesh> meshes_;
  std::span<const std::vector<int>> connectivity_;
  Model& model_;
  static constexpr int untied = -1, joined = -2;
  std::vector<int> index_of_;  // of each node: its place in ties.node, or one of these
  std::vector<int> order_;
};

bool has_same_motion(const PrescribedNodes& given, int node, const PrescribedNodes& motion,
                     const Vector3d& direction) {
  const auto found = std::lower_bound(given.nodes.begin(), given.nodes.end(), node);
  return given.kind == motion.kind && given.turns() == motion.turns() && given.curve == motion.curve &&
         found != given.nodes.end() && *found == node &&
         is_along(given.direction_of(index(found - given.nodes.begin())), direction);
}

bool all_corners_follow(const Tie& tie, const PrescribedNodes& motion, const Vector3d& direction,
                        std::span<const PrescribedNodes> prescribed) {
  for (std::size_t k = 0; k < 4; ++k) {
    if (std::abs(tie.weight[k]) < held_weight) continue;
    const bool follows = std::any_of(prescribed.begin(), prescribed.end(), [&](const PrescribedNodes& other) {
      return has_same_motion(other, tie.corner[k], motion, direction);
    });
    if (!follows) return false;
  }
  return true;
}

// A support of a tied node overdetermines it: it is left out where the corners have the same, so that planes
// of symmetry may cut ties.
void release_supports(const Ties& ties, Model& model) {
  if (model.prescribed.empty()) return;
  const std::vector<PrescribedNodes> given = model.prescribed;
  for (const TiedNode& tied : ties.node) {
    const int node = tied.tie.node;
    for (std::size_t i = 0; i < given.size(); ++i) {
      if (given[i].turns() && !tied.tie.turning) continue;
      const auto found = std::lower_bound(given[i].nodes.begin(), given[i].nodes.end(), node);
      if (found == given[i].nodes.end() || *found != node) continue;
      const TiedParts& parts = ties.found[index(tied.connection)];
      const Vector3d along = given[i].direction_of(index(found - given[i].nodes.begin()));
      if (!all_corners_follow(tied.tie, given[i], along, given))
        throw BuildError("the motion of a node of '" + parts.nodes + "' " + at(model.nodes, node) +
                             " is prescribed, but not that of the face of '" + parts.surface +
                             "' that it is tied to; accepted: the same for both",
                         parts.place);
      release(model.prescribed[i], node);
    }
  }
  combine_supports(model.prescribed, model.nodes);
}

}  // namespace

void make_ties(const Deck& deck, std::span<const Mesh> meshes, std::span<const std::vector<int>> connectivity,
               Model& model) {
  Tying tying(deck, meshes, connectivity, model);
  for (const Connection& connection : deck.connections)
    if (const auto* entry = std::get_if<TieToSurface>(&connection)) tying.add(*entry);
  if (model.ties.empty()) return;
  tying.sort();
  number(model.ties, model.nodes.size());
  release_supports(model.ties, model);
}

Ties ties_that_last(const Ties& ties) {
  Ties lasting = ties;
  std::erase_if(lasting.node,
                [&](const TiedNode& tied) { return ties.found[index(tied.connection)].can_fail(); });
  number(lasting, ties.of_node.size());
  return lasting;
}

void tie_again(Model& model) {
  for (TiedNode& tied : model.ties.node) {
    if (!model.ties.found[index(tied.connection)].can_fail()) continue;
    const Tie before = tied.tie;
    const FaceVertices corners = corners_of(before, model.nodes);
    const std::optional<Tie> now = project(position(model.nodes, before.node), corners);
    if (!now) continue;
    tied.tie = *now;
    tied.tie.node = before.node;
    tied.tie.corner = before.corner;
    if (before.turning) take_rotations(tied.tie, corners, model.nodes);
  }
}

void start_ties(Model& model) {
  Ties& ties = model.ties;
  if (ties.empty()) return;
  Nodes& nodes = model.nodes;
  std::vector<Vector3d> given;
  for (const TiedNode& tied : ties.node) given.push_back(velocity(nodes, tied.tie.node));
  carry_velocities(ties, nodes, 0);
  for (std::size_t i = 0; i < given.size(); ++i) {
    const Tie& tie = ties.node[i].tie;
    double fastest = norm(given[i]);
    for (int corner : tie.corner) fastest = std::max(fastest, norm(velocity(nodes, corner)));
    if (norm(given[i] - velocity(nodes, tie.node)) <= same_velocity * fastest) continue;
    const TiedParts& parts = ties.found[index(ties.node[i].connection)];
    throw BuildError("a node of '" + parts.nodes + "' " + at(nodes, tie.node) +
                         " starts with another velocity than the face of '" + parts.surface +
                         "' that it is tied to; accepted: equal initial velocities",
                     parts.place);
  }
}

}  // namespace brio
