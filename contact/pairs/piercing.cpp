#include "contact/pairs/piercing.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <vector>

#include "contact/geometry/velocity_check.hpp"
#include "contact/search/global_search.hpp"
#include "contact/surface/exclusion.hpp"
#include "contact/surface/face_geometry.hpp"
#include "src/base/index.hpp"

namespace brio {

namespace {

constexpr std::size_t faces_a_range = 256;

template <class NodesOf>
CaptureBox box_around(const Nodes& nodes, const NodesOf& global) {
  CaptureBox box = empty_box;
  for (int node : global) box.include(nodes.record[index(node)].position);
  return box;
}

std::array<int, 2> ends_of(const Surface& surface, const EdgeFeature& edge) {
  return {surface.node[index(edge.node[0])], surface.node[index(edge.node[1])]};
}

/// Of the largest distance between an edge and a face: far more than the rounding of `is_beyond`.
constexpr double beside_share = 1e-10;

// Whether the edge is beyond all corners of the face along a direction, whatever its rounding. \param size no
// less than the terms of which the direction was computed, \param reach than the distances
bool is_beyond(const MovingNode& way, const FaceVertices& at, const Vector3d& direction, double size,
               double reach) {
  const double start = dot(direction, way.start - at[0]), end = start + dot(direction, way.displacement);
  double lower = 0, upper = 0;
  for (const Vector3d& corner : at) {
    const double height = dot(direction, corner - at[0]);
    lower = std::min(lower, height);
    upper = std::max(upper, height);
  }
  const double surplus = beside_share * size * reach;
  return std::min(start, end) > upper + surplus || std::max(start, end) < lower - surplus;
}

double sum_of_magnitudes(const Vector3d& a) { return std::abs(a.x) + std::abs(a.y) + std::abs(a.z); }

// Whether a plane separates the edge from the face, of those that hold two of their directions (Gottschalk,
// Lin and Manocha 1996): nearly all that come near each other are told apart so.
bool is_beside(const MovingNode& way, const FaceVertices& at) {
  const Vector3d &along = way.displacement, normal = cross(at[2] - at[0], at[3] - at[1]);
  const double length = norm(along), area = norm(at[2] - at[0]) * norm(at[3] - at[1]);
  double reach = 0;
  for (const Vector3d& corner : at) reach = std::max(reach, sum_of_magnitudes(way.start - corner));
  reach += sum_of_magnitudes(along);
  if (is_beyond(way, at, normal, area, reach)) return true;
  std::array<Vector3d, 4> side;
  for (std::size_t k = 0; k < 4; ++k) side[k] = at[(k + 1) % 4] - at[k];
  const auto beyond_side = [&](const Vector3d& one) {
    const double size = norm(one);
    return is_beyond(way, at, cross(along, one), length * size, reach) ||
           is_beyond(way, at, cross(one, normal), size * area, reach);
  };
  return std::any_of(side.begin(), side.end(), beyond_side) ||
         is_beyond(way, at, cross(along, normal), length * area, reach);
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
      still.displacement[k] = Vector3d{};
    }
    const auto touch = velocity_check(way, still, 0);
    if (touch && (!first || touch->time < *first)) first = touch->time;
  }
  return first;
}

[[noreturn]] void refuse(const Surface& surface, const EdgeFeature& edge, const Face& face,
                         const Vector3d& at) {
  std::ostringstream text;
  text << "contact: part '" << surface.part_name[index(edge.part)]
       << (face.shell ? "' goes through part '" : "' lies in part '") << surface.part_name[index(face.part)]
       << "', whose surface it crosses at (" << at[0] << ", " << at[1] << ", " << at[2]
       << "); accepted are bodies that do not intersect at the start";
  throw std::invalid_argument(text.str());
}

}  // namespace

bool passes_through(const Vector3d& from, const Vector3d& to, const FaceVertices& face, bool as_hull) {
  const MovingNode way{from, to - from};
  return !is_beside(way, face) && first_meeting(way, face, as_hull).has_value();
}

std::optional<Piercing> find_piercing(const SurfaceFeatures& features, const Surface& surface,
                                      const Lists& excluded, const ContactOptions& options,
                                      const Nodes& nodes, bool shells_alone, ThreadTeam& team) {
  std::vector<CaptureBox> edges(features.edge.size(), empty_box), faces(surface.face.size(), empty_box);
  for (std::size_t e = 0; e < edges.size(); ++e)
    if (!features.edge[e].is_point()) edges[e] = box_around(nodes, ends_of(surface, features.edge[e]));
  for (std::size_t f = 0; f < faces.size(); ++f)
    if (const Face& face = surface.face[f]; face.alive() && (face.shell || !shells_alone))
      faces[f] = box_around(nodes, face.node);
  GlobalSearch search(options.search);
  CandidatePairs pairs;
  SearchCounts counts;
  search.find(SearchNodes(edges), faces, team, pairs, counts);

  const auto first_through = [&](std::size_t f) -> std::optional<Piercing> {
    const Face& face = surface.face[f];
    if (!face.alive()) return {};
    const FaceVertices at = vertices(nodes, face);
    for (int e : pairs.of_box(f)) {
      const EdgeFeature& edge = features.edge[index(e)];
      const std::array<int, 2> ends = ends_of(surface, edge);
      if (face.has(ends[0]) || face.has(ends[1]) || surface.pairs.parts_apart(edge.part, face.part)) continue;
      if (shells_alone && surface.tied.one_piece(face.body, edge.body)) continue;
      if (surface.never_touch(edge.node[0], face) || surface.never_touch(edge.node[1], face)) continue;
      const bool spaced = !is_excluded(excluded, edge.node[0], static_cast<int>(f)) &&
                          !is_excluded(excluded, edge.node[1], static_cast<int>(f));
      if (!spaced && edge.kind == EdgeKind::cross_diagonal) continue;
      const Vector3d from = position(nodes, ends[0]), along = position(nodes, ends[1]) - from;
      if (is_beside({from, along}, at)) continue;
      if (const auto share = first_meeting({from, along}, at, spaced))
        return Piercing{e, static_cast<int>(f), from + *share * along};
    }
    return {};
  };
  std::vector<std::optional<Piercing>> first((faces.size() + faces_a_range - 1) / faces_a_range);
  team.for_ranges(faces.size(), faces_a_range, [&](std::size_t begin, std::size_t end) {
    std::optional<Piercing>& own = first[begin / faces_a_range];
    for (std::size_t f = begin; f < end && !own; ++f) own = first_through(f);
  });
  const auto any = std::find_if(first.begin(), first.end(), [](const auto& one) { return one.has_value(); });
  return any == first.end() ? std::nullopt : *any;
}

void expect_nothing_crosses(const SurfaceFeatures& features, const Surface& surface, const Lists& excluded,
                            const ContactOptions& options, const Nodes& nodes, bool shells_alone,
                            ThreadTeam& team) {
  const auto found = find_piercing(features, surface, excluded, options, nodes, shells_alone, team);
  if (found)
    refuse(surface, features.edge[index(found->edge)], surface.face[index(found->face)], found->point);
}

}  // namespace brio
