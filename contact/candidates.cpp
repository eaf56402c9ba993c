#include "contact/candidates.hpp"

#include <algorithm>
#include <limits>

#include "contact/exclusion.hpp"
#include "contact/face_geometry.hpp"
#include "src/base/floating_point.hpp"

namespace brio {

namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

constexpr Vector3<double> nowhere{not_a_number, not_a_number, not_a_number};

void include(Spread& spread, const Eigen::Vector3d& value) {
  for (int axis = 0; axis < 3; ++axis) {
    spread.lower[axis] = std::min(spread.lower[axis], value[axis]);
    spread.upper[axis] = std::max(spread.upper[axis], value[axis]);
  }
}
constexpr Spread nothing{{infinity, infinity, infinity}, {-infinity, -infinity, -infinity}};

// Relative motion since the search, now and as far ahead as constraints look.
bool within_buffer(const Candidates& candidates, const Travel& travel) {
  if (candidates.growth[0] < 0) return false;
  for (int axis = 0; axis < 3; ++axis)
    if (!(std::max(travel.displacements().width(axis), travel.displacements_ahead().width(axis)) <=
          candidates.growth[axis]))
      return false;
  return true;
}

// Length of a beam, diameter of a particle.
double size_of(const RoundElement& element, const Nodes& nodes) {
  if (element.is_point()) return 2 * element.radius;
  return (position(nodes, element.node[1]) - position(nodes, element.node[0])).norm();
}

void measure_edges(Candidates& candidates, const Surface& surface, const Nodes& nodes) {
  candidates.edge.resize(surface.face.size());
  candidates.smallest_edge = infinity;
  double sum = 0;
  std::size_t living = 0;
  for (std::size_t f = 0; f < surface.face.size(); ++f) {
    if (!surface.face[f].alive()) continue;
    ++living;
    candidates.edge[f] = shortest_edge(nodes, surface.face[f]);
    candidates.smallest_edge = std::min(candidates.smallest_edge, candidates.edge[f]);
    sum += candidates.edge[f];
  }
  for (const RoundElement& element : surface.round) {
    if (!element.alive()) continue;
    const double length = size_of(element, nodes);
    ++living;
    candidates.smallest_edge = std::min(candidates.smallest_edge, length);
    sum += length;
  }
  candidates.mean_edge = living == 0 ? 0 : sum / static_cast<double>(living);
}

// Turn the pairs, which come face by face, into the faces of each node, without the excluded.
void sort_by_slave(Candidates& candidates, const Surface& surface, const Lists& excluded) {
  const std::size_t slaves = surface.slaves();
  Lists& lists = candidates.faces_of;
  lists.start_packed(slaves);
  candidates.face.clear();
  CandidatePairs& pairs = candidates.pairs;
  std::size_t kept = 0;
  int begin = 0;
  for (std::size_t f = 0; f < surface.face.size(); ++f) {
    const std::size_t kept_before = kept;
    const int end = pairs.first[f + 1];
    for (int i = begin; i < end; ++i) {
      const int slave = pairs.node[static_cast<std::size_t>(i)];
      if (surface.never_touch(slave, surface.face[f]) || is_excluded(excluded, slave, static_cast<int>(f)))
        continue;
      pairs.node[kept++] = slave;
      ++lists.first[static_cast<std::size_t>(slave) + 1];
    }
    begin = end;
    pairs.first[f + 1] = static_cast<int>(kept);
    if (kept > kept_before) candidates.face.push_back(static_cast<int>(f));
  }
  pairs.node.resize(kept);
  for (std::size_t s = 0; s < slaves; ++s) lists.first[s + 1] += lists.first[s];
  lists.item.resize(kept);
  candidates.fill.assign(lists.first.begin(), lists.first.end() - 1);
  for (int f : candidates.face)
    for (int slave : pairs.of_box(static_cast<std::size_t>(f)))
      lists.item[static_cast<std::size_t>(candidates.fill[static_cast<std::size_t>(slave)]++)] = f;
}

}  // namespace

CaptureBox capture_box(const Candidates& candidates, const Surface& surface, const ContactOptions& options,
                       int face) {
  Spread hull = nothing;
  for (int node : surface.face[static_cast<std::size_t>(face)].node) {
    const Vector3<double>& x = candidates.point[static_cast<std::size_t>(surface.slave(node))];
    include(hull, Eigen::Vector3d(x.x, x.y, x.z));
  }
  const double reach = influence(surface, options, candidates, face) + candidates.largest_reach;
  CaptureBox box{};
  for (int axis = 0; axis < 3; ++axis) {
    const double growth = candidates.growth[axis] + reach;
    box.lower[axis] = hull.lower[axis] - growth;
    box.upper[axis] = hull.upper[axis] + growth;
  }
  return box;
}

double influence_outside(const Surface& surface, const ContactOptions& options, const Candidates& candidates,
                         int face) {
  const auto f = static_cast<std::size_t>(face);
  return 0.5 * options.shell_thickness_scale * surface.thickness[f] + band_share * candidates.edge[f];
}

double influence(const Surface& surface, const ContactOptions& options, const Candidates& candidates,
                 int face) {
  const auto f = static_cast<std::size_t>(face);
  if (surface.face[f].shell) return influence_outside(surface, options, candidates, face);
  return std::max(band_share, candidates.depth_share) * candidates.edge[f];
}

bool refresh(Candidates& candidates, const Surface& surface, const Lists& excluded,
             const ContactOptions& options, const Nodes& nodes, Travel& travel, ThreadTeam& team) {
  if (surface.node.empty() || within_buffer(candidates, travel)) return false;
  measure_edges(candidates, surface, nodes);
  for (int axis = 0; axis < 3; ++axis)
    candidates.growth[axis] = options.reach_buffer * candidates.mean_edge +
                              approach_share * travel.dt() * travel.velocities().width(axis);
  candidates.largest_reach = options.shell_thickness_scale * candidates.radius_bound;
  for (int s = 0; s < static_cast<int>(surface.slaves()); ++s)
    candidates.largest_reach = std::max(candidates.largest_reach, reach_of_node(surface, options, s));
  candidates.point.resize(surface.slaves());
  for (std::size_t s = 0; s < surface.slaves(); ++s) {
    candidates.point[s] = nowhere;
    if (surface.node[s] < 0) continue;
    const Eigen::Vector3d x = position(nodes, surface.node[s]);
    candidates.point[s] = {x[0], x[1], x[2]};
  }
  candidates.box.resize(surface.face.size());
  for (std::size_t f = 0; f < surface.face.size(); ++f)
    candidates.box[f] =
        surface.face[f].alive() ? capture_box(candidates, surface, options, static_cast<int>(f)) : empty_box;
  candidates.search.find(candidates.point, candidates.box, team, candidates.pairs, candidates.counts);
  sort_by_slave(candidates, surface, excluded);
  candidates.renewed.clear();
  travel.restart();
  return true;
}

}  // namespace brio
