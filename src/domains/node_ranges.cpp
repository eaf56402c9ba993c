#include "src/domains/node_ranges.hpp"

#include <algorithm>

#include "src/base/index.hpp"

namespace brio {

void exchange_nodes(Nodes& nodes) {
  if (nodes.ranks == nullptr) return;
  for (const NodeRange& range : nodes.ranges) {
    const std::size_t count = range.end - range.begin;
    nodes.ranks->note(range.rank, &nodes.record[range.begin], count);
    for (AlignedBuffer<NodeVector>* rows : {&nodes.force, &nodes.moment, &nodes.angular_velocity,
                                            &nodes.velocity_before, &nodes.angular_velocity_before})
      if (!rows->empty()) nodes.ranks->note(range.rank, &(*rows)[range.begin], count);
  }
  nodes.ranks->share(Ranks::Kind::state);
}

std::vector<NodeRange> cut_ranges(std::size_t node_count, std::span<const std::vector<int>> nodes_of_domain) {
  constexpr int nobody = -1;
  std::vector<int> owner(node_count, nobody);
  for (std::size_t d = nodes_of_domain.size(); d-- > 0;)
    for (const int node : nodes_of_domain[d]) owner[index(node)] = static_cast<int>(d);
  std::vector<NodeRange> ranges;
  for (std::size_t begin = 0; begin < node_count;) {
    const std::size_t most = std::min(begin + nodes_per_range, node_count);
    std::size_t end = begin;
    while (end < most && owner[end] == owner[begin]) ++end;
    ranges.push_back({begin, end, owner[begin], Ranks::everyone});
    begin = end;
  }
  return ranges;
}

}  // namespace brio
