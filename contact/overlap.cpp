#include "contact/overlap.hpp"

#include <algorithm>
#include <limits>
#include <sstream>
#include <stdexcept>

#include "contact/enclosed.hpp"
#include "contact/enforcement/initial_gap.hpp"
#include "contact/exclusion.hpp"
#include "contact/face_geometry.hpp"

namespace brio {

using Eigen::Vector3d;

namespace {

/// Overlaps are searched down to this many edges; a body that reaches deeper has nodes in between.
constexpr double searched_depth_share = 1.5;
/// What is left may be this share of an edge: rounding.
constexpr double resolved_share = 1e-9;
constexpr int most_rounds = 200;
constexpr int sweeps_a_round = 50;

/// Length that an overlap is measured against.
double scale_of(const ContactScene& scene, const Contact& contact) {
  if (contact.of_lines()) {
    const double touching = reach_of_node(scene.surface, scene.options, contact.node[0]) +
                            reach_of_node(scene.surface, scene.options, contact.node[2]);
    return touching > 0 ? touching : scene.candidates.smallest_edge;
  }
  const auto f = static_cast<std::size_t>(contact.face);
  const double edge = scene.candidates.edge[f];
  const double touching = touching_distance(scene.surface, scene.options, contact.face, contact.slave);
  return touching > 0 ? std::min(edge, touching) : edge;
}

int part_of(const Surface& surface, int slave) {
  const auto faces = surface.faces_of.of(slave);
  if (!faces.empty()) return surface.face[static_cast<std::size_t>(faces.front())].part;
  const int node = surface.node[static_cast<std::size_t>(slave)];
  return std::find_if(
             surface.round.begin(), surface.round.end(),
             [&](const RoundElement& element) { return element.node[0] == node || element.node[1] == node; })
      ->part;
}

const std::string& first_part(const Surface& surface, const Contact& contact) {
  return surface.part_name[static_cast<std::size_t>(part_of(surface, contact.node[0]))];
}
const std::string& second_part(const Surface& surface, const Contact& contact) {
  const int part = contact.of_lines() ? part_of(surface, contact.node[2])
                                      : surface.face[static_cast<std::size_t>(contact.face)].part;
  return surface.part_name[static_cast<std::size_t>(part)];
}

void find_anew(ContactScene& scene, const Nodes& nodes, ThreadTeam& team) {
  scene.candidates.growth[0] = -1;
  scene.travel.follow(scene.surface, nodes, {}, 0, team);
  find_contacts(scene, nodes, team);
}

// Pairs of one part that overlap from the start are how the part was drawn: corners, seams, flanges; so are
// those beside a tie.
bool exclude_within_parts(ContactScene& scene) {
  std::vector<std::pair<int, int>> found;
  for (const Contact& contact : scene.contacts)
    if (!contact.of_lines() && contact.gap < 0 &&
        scene.surface.held.one_piece(contact.body,
                                     scene.surface.body[static_cast<std::size_t>(contact.slave)]))
      found.emplace_back(contact.slave, contact.face);
  if (found.empty()) return false;
  std::sort(found.begin(), found.end());
  auto next = found.begin();
  Lists grown;
  grown.first.push_back(0);
  for (int s = 0; s < static_cast<int>(scene.surface.slaves()); ++s) {
    const auto known = scene.excluded.of(s);
    const std::ptrdiff_t begin = std::ssize(grown.item);
    grown.item.insert(grown.item.end(), known.begin(), known.end());
    for (; next != found.end() && next->first == s; ++next) grown.item.push_back(next->second);
    std::sort(grown.item.begin() + begin, grown.item.end());
    grown.first.push_back(static_cast<int>(grown.item.size()));
  }
  scene.excluded = std::move(grown);
  if (scene.erosion) scene.erosion->keeps_numbers = true;
  return true;
}

[[noreturn]] void refuse(const ContactScene& scene, const Nodes& nodes, const Contact& contact,
                         const char* why) {
  const Surface& surface = scene.surface;
  const int node = surface.node[static_cast<std::size_t>(contact.node[0])];
  const Vector3d x = position(nodes, node);
  std::ostringstream text;
  text << "contact: part '" << first_part(surface, contact) << "' overlaps part '"
       << second_part(surface, contact) << "' by " << -contact.gap << " at (" << x[0] << ", " << x[1] << ", "
       << x[2] << "), " << why;
  throw std::invalid_argument(text.str());
}

void record(const ContactScene& scene, const Contact& contact, std::vector<InitialOverlap>& report) {
  const Surface& surface = scene.surface;
  const std::string& node_part = first_part(surface, contact);
  const std::string& face_part = second_part(surface, contact);
  auto entry = std::find_if(report.begin(), report.end(), [&](const InitialOverlap& overlap) {
    return overlap.node_part == node_part && overlap.face_part == face_part;
  });
  if (entry == report.end())
    entry = report.insert(report.end(), {.node_part = node_part, .face_part = face_part});
  entry->depth = std::max(entry->depth, -contact.gap);
  ++entry->nodes;
}

// Displacements take the place of velocities, and every node weighs the same; those that are held, or of
// rigid bodies, do not move.
void bring_to_rest(ContactScene& scene, const Nodes& nodes) {
  const Surface& surface = scene.surface;
  for (std::size_t s = 0; s < surface.slaves(); ++s)
    for (int axis = 0; axis < 3; ++axis) {
      const auto node = static_cast<std::size_t>(surface.node[s]);
      const bool held = (!nodes.prescribed.empty() && (nodes.prescribed[node] >> axis & 1) != 0) ||
                        surface.rigid_body(surface.node[s]) >= 0;
      scene.motion[s].velocity[axis] = 0;
      scene.motion[s].inverse_mass[axis] = held ? 0 : 1;
    }
}

// Whether no node of either side can move along the normal.
bool is_held(const ContactScene& scene, const Contact& contact) {
  double mobility = 0;
  for (std::size_t k = 0; k < contact.node.size(); ++k)
    for (int axis = 0; axis < 3; ++axis) {
      const double share = contact.weight[k] * contact.normal[axis];
      if (share != 0)
        mobility +=
            share * share * scene.motion[static_cast<std::size_t>(contact.node[k])].inverse_mass[axis];
    }
  return !(mobility > 0);
}

void move_apart(ContactScene& scene, Nodes& nodes) {
  const Surface& surface = scene.surface;
  for (Contact& contact : scene.contacts) contact.friction_coefficient = 0;
  ContactOptions whole = scene.options;
  whole.passes = sweeps_a_round;
  whole.overlap_recovery = 1;
  whole.overlap_recovery_cap = std::numeric_limits<double>::max();
  Solver solver;
  solver.deep_share = 0;
  solve(solver, whole, scene.candidates.smallest_edge, 1, scene.contacts, scene.motion);
  for (std::size_t s = 0; s < surface.slaves(); ++s)
    for (int axis = 0; axis < 3; ++axis)
      nodes.record[static_cast<std::size_t>(surface.node[s])].position[axis] +=
          scene.motion[s].velocity[axis];
}

const Contact* deepest_unresolved(const ContactScene& scene) {
  const Contact* worst = nullptr;
  for (const Contact& contact : scene.contacts)
    if (contact.gap < -resolved_share * scale_of(scene, contact) &&
        (worst == nullptr || contact.gap < worst->gap))
      worst = &contact;
  return worst;
}

}  // namespace

std::vector<InitialOverlap> remove_initial_overlap(ContactScene& scene, Nodes& nodes, ThreadTeam& team) {
  std::vector<InitialOverlap> report;
  if (scene.surface.node.empty()) return report;
  if (scene.distance) return make_initial_gap(scene, nodes, team);
  scene.candidates.depth_share = searched_depth_share;
  find_anew(scene, nodes, team);
  while (exclude_within_parts(scene)) find_anew(scene, nodes, team);
  for (const Contact& contact : scene.contacts) {
    if (contact.gap >= -resolved_share * scale_of(scene, contact)) continue;
    if (-contact.gap > scene.options.initial_overlap_limit * scale_of(scene, contact))
      refuse(scene, nodes, contact, "deeper than initial_overlap_limit allows");
    record(scene, contact, report);
  }
  if (!report.empty()) {
    std::vector<Vector3d> start;
    for (int node : scene.surface.node) start.push_back(position(nodes, node));
    int round = 0;
    while (const Contact* deepest = deepest_unresolved(scene)) {
      bring_to_rest(scene, nodes);
      if (++round > most_rounds || is_held(scene, *deepest))
        refuse(scene, nodes, *deepest, "which moving nodes does not remove");
      move_apart(scene, nodes);
      find_anew(scene, nodes, team);
    }
    for (std::size_t s = 0; s < start.size(); ++s) {
      const double moved = (position(nodes, scene.surface.node[s]) - start[s]).norm();
      const std::string& part =
          scene.surface.part_name[static_cast<std::size_t>(part_of(scene.surface, static_cast<int>(s)))];
      for (InitialOverlap& overlap : report)
        if (overlap.node_part == part || overlap.face_part == part)
          overlap.moved = std::max(overlap.moved, moved);
    }
  }
  expect_nothing_enclosed(scene, nodes);
  scene.candidates.depth_share = followed_depth_share;
  scene.candidates.growth[0] = -1;
  scene.contacts.clear();
  scene.last.clear();
  return report;
}

}  // namespace brio
