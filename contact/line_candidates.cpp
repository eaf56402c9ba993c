#include "contact/line_candidates.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "contact/closest_segments.hpp"
#include "contact/face_geometry.hpp"
#include "src/base/floating_point.hpp"

namespace brio {

using Eigen::Vector3d;

namespace {

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

double distance(const Surface& surface, const Nodes& nodes, const Line& a, const Line& b) {
  const auto segment = [&](const Line& line) {
    return Segment{position(nodes, surface.node[static_cast<std::size_t>(line.node[0])]),
                   position(nodes, surface.node[static_cast<std::size_t>(line.node[1])])};
  };
  return std::sqrt(closest_points_of_segments(segment(a), segment(b)).squared_distance);
}

/// Ways over faces and beams from node to node of the surface.
class Ways {
 public:
  explicit Ways(const Surface& surface) : surface_(surface), beams_(surface.slaves()) {
    for (const RoundElement& element : surface.round) {
      if (!element.alive()) continue;
      const int ends[2] = {surface.slave(element.node[0]), surface.slave(element.node[1])};
      beams_[static_cast<std::size_t>(ends[0])].push_back(ends[1]);
      beams_[static_cast<std::size_t>(ends[1])].push_back(ends[0]);
    }
  }

  // Replace `reached` by the nodes to which one leads that nowhere is as far from a line as a limit.
  void reach(const Nodes& nodes, const Line& from, double limit, std::vector<int>& reached) const {
    reached.clear();
    for (int slave : from.node) reached.push_back(slave);
    const auto visit = [&](int slave) {
      Line point;
      point.node = {slave, slave};
      if (distance(surface_, nodes, from, point) < limit &&
          std::find(reached.begin(), reached.end(), slave) == reached.end())
        reached.push_back(slave);
    };
    for (std::size_t i = 0; i < reached.size(); ++i) {
      const int own = reached[i];
      for (int f : surface_.faces_of.of(own))
        for (int node : surface_.face[static_cast<std::size_t>(f)].node) visit(surface_.slave(node));
      for (int slave : beams_[static_cast<std::size_t>(own)]) visit(slave);
    }
  }

 private:
  const Surface& surface_;
  std::vector<std::vector<int>> beams_;  // of each slave node: the nodes at the other ends of its beams
};

bool is_new(const LineCandidates& candidates, const Line& line) {
  const auto at = std::lower_bound(candidates.before.begin(), candidates.before.end(), line.node,
                                   [](const Line& known, const auto& of) { return known.node < of; });
  return at == candidates.before.end() || at->node != line.node;
}

// Pairs that lie in the tightest fold that their body can have, of lines that are seen for the first time.
void exclude_folds(LineCandidates& candidates, const Surface& surface, const Nodes& nodes) {
  const bool first_search = candidates.counts.searches == 1;
  double largest = 0;
  std::vector<std::pair<int, int>> line_at;  // by slave node
  for (int l = 0; l < static_cast<int>(candidates.line.size()); ++l) {
    const Line& line = candidates.line[static_cast<std::size_t>(l)];
    largest = std::max(largest, line.radius);
    for (int slave : line.node) line_at.emplace_back(slave, l);
  }
  std::sort(line_at.begin(), line_at.end());
  const Ways ways(surface);
  std::vector<int> reached;
  for (const Line& a : candidates.line) {
    if (a.radius == 0 || a.is_point() || (!first_search && !is_new(candidates, a))) continue;
    ways.reach(nodes, a, 0.5 * std::numbers::pi * (a.radius + largest), reached);
    for (int slave : reached)
      for (auto at = std::lower_bound(line_at.begin(), line_at.end(), std::pair(slave, 0));
           at != line_at.end() && at->first == slave; ++at) {
        const Line& b = candidates.line[static_cast<std::size_t>(at->second)];
        if (&a == &b || distance(surface, nodes, a, b) >= 0.5 * std::numbers::pi * (a.radius + b.radius))
          continue;
        candidates.drawn.push_back(&a < &b ? nodes_of(surface, a, b) : nodes_of(surface, b, a));
      }
  }
}

// Pairs of one body, or of bodies tied together, that never meet: they overlap as drawn, or lie in a fold.
void exclude_drawn(LineCandidates& candidates, const Surface& surface, const Nodes& nodes) {
  const bool first_search = candidates.counts.searches == 1;
  const auto is_round = [&](const Line& line) {
    return line.radius > 0 && !line.is_point() && (first_search || is_new(candidates, line));
  };
  if (std::none_of(candidates.line.begin(), candidates.line.end(), is_round)) return;
  exclude_folds(candidates, surface, nodes);
  for (const auto& [first, second] : candidates.found) {
    const Line& a = candidates.line[static_cast<std::size_t>(first)];
    const Line& b = candidates.line[static_cast<std::size_t>(second)];
    if (!first_search || !surface.held.one_piece(a.body, b.body) || is_new(candidates, a) ||
        is_new(candidates, b))
      continue;
    if (distance(surface, nodes, a, b) < a.radius + b.radius)
      candidates.drawn.push_back(nodes_of(surface, a, b));
  }
  std::sort(candidates.drawn.begin(), candidates.drawn.end());
  candidates.drawn.erase(std::unique(candidates.drawn.begin(), candidates.drawn.end()),
                         candidates.drawn.end());
}

// Keep lines apart that overlap where they come to be.
void exclude_overlapping(LineCandidates& candidates, const Surface& surface, const Nodes& nodes) {
  exclude_drawn(candidates, surface, nodes);
  const auto overlap = [&](const Line& a, const Line& b) {
    return distance(surface, nodes, a, b) < a.radius + b.radius;
  };
  candidates.added.clear();
  std::erase_if(candidates.found, [&](const std::pair<int, int>& pair) {
    const Line& a = candidates.line[static_cast<std::size_t>(pair.first)];
    const Line& b = candidates.line[static_cast<std::size_t>(pair.second)];
    if (a.radius + b.radius == 0) return false;
    const NodesOfPair nodes_of_both = nodes_of(surface, a, b);
    if (has(candidates.drawn, nodes_of_both)) return true;
    const auto of_tear = std::lower_bound(candidates.torn.begin(), candidates.torn.end(), nodes_of_both);
    if (of_tear != candidates.torn.end() && *of_tear == nodes_of_both) {
      if (overlap(a, b)) return true;
      candidates.torn.erase(of_tear);
      return false;
    }
    if ((!is_new(candidates, a) && !is_new(candidates, b)) || !overlap(a, b)) return false;
    candidates.added.push_back(nodes_of_both);
    return true;
  });
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
  exclude_overlapping(candidates, surface, nodes);
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
