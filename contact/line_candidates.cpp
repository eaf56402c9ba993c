#include "contact/line_candidates.hpp"

#include <algorithm>
#include <limits>

#include "contact/closest_segments.hpp"
#include "contact/face_geometry.hpp"

namespace brio {

using Eigen::Vector3d;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

CaptureBox range_of(const Surface& surface, const Nodes& nodes, const Line& line, double reach) {
  const Vector3d a = position(nodes, surface.node[static_cast<std::size_t>(line.node[0])]);
  const Vector3d b = position(nodes, surface.node[static_cast<std::size_t>(line.node[1])]);
  CaptureBox box{};
  for (int axis = 0; axis < 3; ++axis) {
    box.lower[axis] = std::min(a[axis], b[axis]) - reach;
    box.upper[axis] = std::max(a[axis], b[axis]) + reach;
  }
  return box;
}

double length_of(const CaptureBox& range) {
  double square = 0;
  for (int axis = 0; axis < 3; ++axis)
    square += (range.upper[axis] - range.lower[axis]) * (range.upper[axis] - range.lower[axis]);
  return std::sqrt(square);
}

bool has(const std::vector<NodesOfPair>& pairs, const NodesOfPair& pair) {
  return std::binary_search(pairs.begin(), pairs.end(), pair);
}

bool overlap(const Surface& surface, const Nodes& nodes, const Line& a, const Line& b) {
  const auto segment = [&](const Line& line) {
    return Segment{position(nodes, surface.node[static_cast<std::size_t>(line.node[0])]),
                   position(nodes, surface.node[static_cast<std::size_t>(line.node[1])])};
  };
  const double reach = a.radius + b.radius;
  return closest_points_of_segments(segment(a), segment(b)).squared_distance < reach * reach;
}

// Keep lines apart that overlap where they come to be.
void find_overlapping(LineCandidates& candidates, const Surface& surface, const Nodes& nodes) {
  const bool first = candidates.counts.searches == 1;
  const auto is_new = [&](const Line& line) {
    const auto at = std::lower_bound(candidates.before.begin(), candidates.before.end(), line.node,
                                     [](const Line& known, const auto& of) { return known.node < of; });
    return at == candidates.before.end() || at->node != line.node;
  };
  candidates.added.clear();
  std::erase_if(candidates.found, [&](const std::pair<int, int>& pair) {
    const Line& a = candidates.line[static_cast<std::size_t>(pair.first)];
    const Line& b = candidates.line[static_cast<std::size_t>(pair.second)];
    if (a.radius + b.radius == 0) return false;
    const NodesOfPair nodes_of_both = nodes_of(surface, a, b);
    if (!first && has(candidates.drawn, nodes_of_both)) return true;
    const auto of_tear = std::lower_bound(candidates.torn.begin(), candidates.torn.end(), nodes_of_both);
    if (of_tear != candidates.torn.end() && *of_tear == nodes_of_both) {
      if (overlap(surface, nodes, a, b)) return true;
      candidates.torn.erase(of_tear);
      return false;
    }
    const bool torn = is_new(a) || is_new(b);
    if (!torn && !(first && a.body == b.body)) return false;
    if (!overlap(surface, nodes, a, b)) return false;
    (torn ? candidates.added : candidates.drawn).push_back(nodes_of_both);
    return true;
  });
  if (first) std::sort(candidates.drawn.begin(), candidates.drawn.end());
  candidates.torn.insert(candidates.torn.end(), candidates.added.begin(), candidates.added.end());
  std::sort(candidates.torn.begin(), candidates.torn.end());
}

void sort_by_line(LineCandidates& candidates, const Surface& surface, const Nodes& nodes) {
  const std::size_t lines = candidates.line.size();
  Lists& lists = candidates.partners;
  lists.start_packed(lines);
  const auto for_pairs = [&](const auto& visit) {
    for (std::size_t b = 0; b < lines; ++b)
      for (int n : candidates.pairs.of_box(b)) {
        const int own = static_cast<int>(b);
        // Nodes of faces have no box: such a pair is found once.
        const bool once = candidates.line[static_cast<std::size_t>(n)].kind == LineKind::node;
        if (n == own || (n < own && !once)) continue;
        visit(std::min(n, own), std::max(n, own));
      }
  };
  std::vector<std::pair<int, int>>& found = candidates.found;
  found.clear();
  for_pairs([&](int a, int b) {
    const Line& first = candidates.line[static_cast<std::size_t>(a)];
    const Line& second = candidates.line[static_cast<std::size_t>(b)];
    if (may_touch(surface, first, second)) found.emplace_back(a, b);
  });
  find_overlapping(candidates, surface, nodes);
  std::sort(found.begin(), found.end());
  lists.item.clear();
  for (const auto& [a, b] : found) {
    ++lists.first[static_cast<std::size_t>(a) + 1];
    lists.item.push_back(b);
  }
  for (std::size_t l = 0; l < lines; ++l) lists.first[l + 1] += lists.first[l];
}

}  // namespace

void search_lines(LineCandidates& candidates, const Candidates& faces, const Surface& surface,
                  const ContactOptions& options, const Nodes& nodes, ThreadTeam& team) {
  candidates.before.swap(candidates.line);
  collect_lines(surface, options, nodes, candidates.line, candidates.ends);
  candidates.box.clear();
  candidates.range.clear();
  for (const Line& line : candidates.line) {
    CaptureBox range = range_of(surface, nodes, line, line.radius);
    candidates.range.push_back(range);
    const double band = band_share * length_of(range);
    for (int axis = 0; axis < 3; ++axis) {
      range.lower[axis] -= faces.growth[axis] + band;
      range.upper[axis] += faces.growth[axis] + band;
    }
    candidates.box.push_back(line.kind == LineKind::node ? empty_box : range);
  }
  if (candidates.line.size() < 2) {
    candidates.partners.start_packed(candidates.line.size());
    candidates.partners.item.clear();
    return;
  }
  candidates.search.find(candidates.range, candidates.box, team, candidates.pairs, candidates.counts);
  sort_by_line(candidates, surface, nodes);
  candidates.wake.assign(candidates.partners.item.size(), -infinity);
}

void follow_lines(LineCandidates& candidates, const Travel& travel) {
  candidates.path.resize(candidates.line.size());
  candidates.ahead.resize(candidates.line.size());
  for (std::size_t l = 0; l < candidates.line.size(); ++l) {
    const auto& [first, second] = candidates.line[l].node;
    candidates.path[l] = std::max(travel.path(first), travel.path(second));
    candidates.ahead[l] = std::max(travel.own_ahead(first), travel.own_ahead(second));
  }
}

}  // namespace brio
