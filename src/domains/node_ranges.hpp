#pragma once
/// Loops over nodes by ranges. Sums are formed range by range and added in the order of ranges, whatever the
/// number of threads and ranks; a rank goes through the nodes of its domains, and those that it follows.

#include <cstddef>
#include <span>
#include <vector>

#include "src/base/nodes.hpp"
#include "src/base/parallel.hpp"
#include "src/domains/ranks.hpp"

namespace brio {

/// Run `of_range(begin, end)` for all ranges of nodes that this rank knows.
template <class OfRange>
void for_node_ranges(const Nodes& nodes, ThreadTeam& team, OfRange&& of_range) {
  const std::size_t ranges = nodes.ranges.size();
  team.for_each(ranges + nodes.followed.size(), [&](std::size_t k) {
    const NodeRange& range = k < ranges ? nodes.ranges[k] : nodes.followed[k - ranges];
    if (nodes.ranks == nullptr || k >= ranges || nodes.ranks->is_own(range.rank))
      of_range(range.begin, range.end);
  });
}

/// The same with a sum of each range: `of_range` returns it. \param sums one a range of `nodes`
template <class Sum, class OfRange>
void sum_node_ranges(const Nodes& nodes, std::vector<Sum>& sums, ThreadTeam& team, OfRange&& of_range) {
  const std::size_t ranges = nodes.ranges.size();
  sums.resize(ranges);
  team.for_each(ranges + nodes.followed.size(), [&](std::size_t k) {
    if (k >= ranges) {
      of_range(nodes.followed[k - ranges].begin, nodes.followed[k - ranges].end);
      return;
    }
    const NodeRange& range = nodes.ranges[k];
    if (nodes.ranks == nullptr || nodes.ranks->is_own(range.rank)) sums[k] = of_range(range.begin, range.end);
  });
  if (nodes.ranks == nullptr) return;
  for (std::size_t k = 0; k < ranges; ++k) nodes.ranks->note(nodes.ranges[k].rank, &sums[k], 1);
  nodes.ranks->share(Ranks::Kind::sums);
}

/// Motion and forces of all nodes, where they are read beyond those that a rank knows.
void exchange_nodes(Nodes& nodes);

/// Ranges of nodes, cut where the nodes end that a domain is the first to have.
std::vector<NodeRange> cut_ranges(std::size_t node_count, std::span<const std::vector<int>> nodes_of_domain);

}  // namespace brio
