#include "src/domains/domain_sums.hpp"

#include <algorithm>

#include "src/base/index.hpp"
#include "src/base/lanes.hpp"

namespace brio {

namespace {

constexpr std::size_t border_nodes_per_task = 1024;

void move_row(NodeVector& from, NodeVector& to) {
  store_row(to.component, load_row(from.component));
  store_row(from.component, Row4{});
}

void add_slots(const NodeVector* first, const NodeVector* end, NodeVector& row) {
  Row4 sum = load_row(first->component);
  for (const NodeVector* slot = first + 1; slot != end; ++slot) sum = sum + load_row(slot->component);
  store_row(row.component, sum);
}

// The domain that was seen last at each node, and how many were.
std::vector<int> domains_of_nodes(std::span<const std::vector<int>> nodes_of_domain) {
  std::size_t count = 0;
  for (const std::vector<int>& nodes : nodes_of_domain)
    if (!nodes.empty()) count = std::max(count, index(nodes.back()) + 1);
  std::vector<int> domains(count, 0);
  for (const std::vector<int>& nodes : nodes_of_domain)
    for (const int n : nodes) ++domains[index(n)];
  return domains;
}

}  // namespace

DomainSums make_domain_sums(std::span<const std::vector<int>> nodes_of_domain, bool with_rotations) {
  DomainSums sums;
  const std::vector<int> domains = domains_of_nodes(nodes_of_domain);
  std::vector<int> next(domains.size(), -1);  // slot of each node on a border
  int slots = 0;
  for (std::size_t n = 0; n < domains.size(); ++n) {
    if (domains[n] < 2) continue;
    sums.node.push_back(static_cast<int>(n));
    sums.first_slot.push_back(slots);
    next[n] = slots + 1;
    slots += 1 + domains[n];
  }
  sums.first_slot.push_back(slots);
  for (const std::vector<int>& nodes : nodes_of_domain) {
    sums.domain_first.push_back(sums.slots.size());
    for (const int n : nodes)
      if (next[index(n)] >= 0) sums.slots.push_back({n, next[index(n)]++});
  }
  sums.domain_first.push_back(sums.slots.size());
  sums.linear = AlignedBuffer<NodeVector>(index(slots));
  if (with_rotations) sums.angular = AlignedBuffer<NodeVector>(index(slots));
  return sums;
}

void begin_sums(DomainSums& sums, const NodalRows& rows, ThreadTeam& team) {
  team.for_ranges(sums.node.size(), border_nodes_per_task, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const std::size_t node = index(sums.node[k]), slot = index(sums.first_slot[k]);
      move_row(rows.linear[node], sums.linear[slot]);
      if (rows.angular != nullptr) move_row(rows.angular[node], sums.angular[slot]);
    }
  });
}

void keep_sums(DomainSums& sums, std::size_t domain, const NodalRows& rows) {
  if (sums.empty()) return;
  const std::size_t end = sums.domain_first[domain + 1];
  for (std::size_t k = sums.domain_first[domain]; k < end; ++k) {
    const std::size_t node = index(sums.slots[k].node), slot = index(sums.slots[k].number);
    move_row(rows.linear[node], sums.linear[slot]);
    if (rows.angular != nullptr) move_row(rows.angular[node], sums.angular[slot]);
  }
}

void finish_sums(const DomainSums& sums, const NodalRows& rows, ThreadTeam& team) {
  team.for_ranges(sums.node.size(), border_nodes_per_task, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const std::size_t node = index(sums.node[k]);
      const std::size_t first = index(sums.first_slot[k]), last = index(sums.first_slot[k + 1]);
      add_slots(&sums.linear[first], sums.linear.data() + last, rows.linear[node]);
      if (rows.angular != nullptr)
        add_slots(&sums.angular[first], sums.angular.data() + last, rows.angular[node]);
    }
  });
}

}  // namespace brio
