#include "src/domains/domain_sums.hpp"

#include <algorithm>

#include "src/base/gather.hpp"
#include "src/base/index.hpp"
#include "src/base/lanes.hpp"

namespace brio {

namespace {

constexpr std::size_t border_nodes_per_task = 1024;

void move_row(NodeVector& from, NodeVector& to) {
  store_row(to.component, load_row(from.component));
  store_row(from.component, Row4{});
}

/// \param last partial sum
void add_slots(const NodeVector* first, const NodeVector* end, NodeVector& last) {
  Row4 sum = load_row(first->component);
  for (const NodeVector* slot = first + 1; slot != end; ++slot) sum = sum + load_row(slot->component);
  store_row(last.component, sum + load_row(last.component));
}

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

DomainSums make_domain_sums(std::span<const std::vector<int>> nodes_of_domain,
                            std::span<const std::size_t> order, bool with_rotations) {
  DomainSums sums;
  const std::vector<int> domains = domains_of_nodes(nodes_of_domain);
  std::vector<int> first(domains.size(), -1), next(domains.size());  // slots of each node on a border
  int slots = 0;
  for (std::size_t n = 0; n < domains.size(); ++n) {
    if (domains[n] < 2) continue;
    sums.node.push_back(static_cast<int>(n));
    sums.first_slot.push_back(slots);
    first[n] = next[n] = slots;
    slots += domains[n];
  }
  sums.first_slot.push_back(slots);
  std::vector<std::vector<DomainSums::Slot>> of_domain(nodes_of_domain.size());
  for (const std::size_t d : order)
    for (const int entry : nodes_of_domain[d]) {
      const std::size_t n = index(entry);
      if (first[n] < 0) continue;
      const int slot = next[n]++;
      of_domain[d].push_back({entry, slot, first[n], next[n] == first[n] + domains[n]});
    }
  for (const std::vector<DomainSums::Slot>& own : of_domain) {
    sums.domain_first.push_back(sums.slots.size());
    sums.slots.insert(sums.slots.end(), own.begin(), own.end());
  }
  sums.domain_first.push_back(sums.slots.size());
  sums.linear = AlignedBuffer<NodeVector>(index(slots));
  if (with_rotations) sums.angular = AlignedBuffer<NodeVector>(index(slots));
  return sums;
}

void add_sums(DomainSums& sums, std::size_t domain, const NodalRows& rows) {
  const auto add = [](const DomainSums::Slot& slot, AlignedBuffer<NodeVector>& kept, NodeVector& row) {
    if (slot.is_last)
      add_slots(&kept[index(slot.first)], &kept[index(slot.number)], row);
    else
      move_row(row, kept[index(slot.number)]);
  };
  for (std::size_t k = sums.domain_first[domain]; k < sums.domain_first[domain + 1]; ++k) {
    const DomainSums::Slot& slot = sums.slots[k];
    add(slot, sums.linear, rows.linear[slot.node]);
    if (rows.angular != nullptr) add(slot, sums.angular, rows.angular[slot.node]);
  }
}

void keep_sums(DomainSums& sums, std::size_t domain, const NodalRows& rows) {
  for (std::size_t k = sums.domain_first[domain]; k < sums.domain_first[domain + 1]; ++k) {
    const DomainSums::Slot& slot = sums.slots[k];
    move_row(rows.linear[slot.node], sums.linear[index(slot.number)]);
    if (rows.angular != nullptr) move_row(rows.angular[slot.node], sums.angular[index(slot.number)]);
  }
}

void finish_sums(const DomainSums& sums, const NodalRows& rows, ThreadTeam& team) {
  const auto finish = [](const AlignedBuffer<NodeVector>& kept, std::size_t first, std::size_t last,
                         NodeVector& row) {
    row = kept[last];
    add_slots(&kept[first], &kept[last], row);
  };
  team.for_ranges(sums.node.size(), border_nodes_per_task, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const std::size_t first = index(sums.first_slot[k]), last = index(sums.first_slot[k + 1]) - 1;
      finish(sums.linear, first, last, rows.linear[sums.node[k]]);
      if (rows.angular != nullptr) finish(sums.angular, first, last, rows.angular[sums.node[k]]);
    }
  });
}

}  // namespace brio
