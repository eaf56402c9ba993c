#include "contact/detection/piercing.hpp"

#include <algorithm>
#include <optional>
#include <sstream>
#include <stdexcept>

#include "contact/exclusion.hpp"
#include "contact/face_geometry.hpp"
#include "contact/global_search.hpp"
#include "contact/velocity_check.hpp"

namespace brio {

using Eigen::Vector3d;

namespace {

template <class NodesOf>
CaptureBox box_around(const Nodes& nodes, const NodesOf& global) {
  CaptureBox box = empty_box;
  for (int node : global)
    for (int axis = 0; axis < 3; ++axis) {
      const double x = nodes.record[static_cast<std::size_t>(node)].position[axis];
      box.lower[axis] = std::min(box.lower[axis], x);
      box.upper[axis] = std::max(box.upper[axis], x);
    }
  return box;
}

std::array<int, 2> ends_of(const Surface& surface, const EdgeFeature& edge) {
  return {surface.node[static_cast<std::size_t>(edge.node[0])],
          surface.node[static_cast<std::size_t>(edge.node[1])]};
}

// Share of the edge at which it first meets the face.
std::optional<double> first_meeting(const MovingNode& way, const FaceVertices& at, bool as_hull) {
  constexpr std::size_t corner[4][3] = {{0, 1, 2}, {0, 2, 3}, {0, 1, 3}, {1, 2, 3}};
  const std::size_t triangles = is_triangle(at) ? 1 : as_hull ? 4 : 2;
  std::optional<double> first;
  for (std::size_t t = 0; t < triangles; ++t) {
    MovingFace still;
    for (std::size_t k = 0; k < 4; ++k) {
      still.start[k] = at[corner[t][std::min<std::size_t>(k, 2)]];
      still.displacement[k] = Vector3d::Zero();
    }
    const auto touch = velocity_check(way, still, 0);
    if (touch && (!first || touch->time < *first)) first = touch->time;
  }
  return first;
}

[[noreturn]] void refuse(const Surface& surface, const EdgeFeature& edge, const Face& face,
                         const Vector3d& at) {
  std::ostringstream text;
  text << "contact: part '" << surface.part_name[static_cast<std::size_t>(edge.part)]
       << (face.shell ? "' goes through part '" : "' lies in part '")
       << surface.part_name[static_cast<std::size_t>(face.part)] << "', whose surface it crosses at ("
       << at[0] << ", " << at[1] << ", " << at[2] << "); accepted are bodies that begin beside each other";
  throw std::invalid_argument(text.str());
}

}  // namespace

std::vector<Piercing> find_piercings(const SurfaceFeatures& features, const Surface& surface,
                                     const Lists& excluded, const ContactOptions& options, const Nodes& nodes,
                                     ThreadTeam& team) {
  std::vector<CaptureBox> edges(features.edge.size(), empty_box), faces(surface.face.size(), empty_box);
  for (std::size_t e = 0; e < edges.size(); ++e)
    if (!features.edge[e].is_point()) edges[e] = box_around(nodes, ends_of(surface, features.edge[e]));
  for (std::size_t f = 0; f < faces.size(); ++f)
    if (surface.face[f].alive()) faces[f] = box_around(nodes, surface.face[f].node);
  GlobalSearch search(options.search);
  CandidatePairs pairs;
  SearchCounts counts;
  search.find(SearchNodes(edges), faces, team, pairs, counts);

  std::vector<Piercing> found;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const Face& face = surface.face[f];
    if (!face.alive()) continue;
    for (int e : pairs.of_box(f)) {
      const EdgeFeature& edge = features.edge[static_cast<std::size_t>(e)];
      const std::array<int, 2> ends = ends_of(surface, edge);
      if (face.has(ends[0]) || face.has(ends[1]) || surface.pairs.parts_apart(edge.part, face.part)) continue;
      if (surface.never_touch(edge.node[0], face) || surface.never_touch(edge.node[1], face)) continue;
      const bool spaced = !is_excluded(excluded, edge.node[0], static_cast<int>(f)) &&
                          !is_excluded(excluded, edge.node[1], static_cast<int>(f));
      if (!spaced && edge.kind == EdgeKind::cross_diagonal) continue;
      const Vector3d from = position(nodes, ends[0]), along = position(nodes, ends[1]) - from;
      if (const auto share = first_meeting({from, along}, vertices(nodes, face), spaced))
        found.push_back({e, static_cast<int>(f), from + *share * along});
    }
  }
  return found;
}

void expect_nothing_crosses(const SurfaceFeatures& features, const Surface& surface, const Lists& excluded,
                            const ContactOptions& options, const Nodes& nodes, bool shells_alone,
                            ThreadTeam& team) {
  std::vector<Piercing> found = find_piercings(features, surface, excluded, options, nodes, team);
  const auto edge_of = [&](const Piercing& one) -> const EdgeFeature& {
    return features.edge[static_cast<std::size_t>(one.edge)];
  };
  const auto face_of = [&](const Piercing& one) -> const Face& {
    return surface.face[static_cast<std::size_t>(one.face)];
  };
  if (shells_alone)
    std::erase_if(found, [&](const Piercing& one) {
      return !face_of(one).shell || surface.held.one_piece(face_of(one).body, edge_of(one).body);
    });
  if (found.empty()) return;
  const Piercing& told = found.front();
  refuse(surface, edge_of(told), face_of(told), told.point);
}

}  // namespace brio
