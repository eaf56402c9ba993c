#include "contact/surface/pair_table.hpp"

#include <algorithm>

#include "contact/surface/surface.hpp"
#include "src/base/index.hpp"

namespace brio {

PairTable::PairTable(std::span<const PairRule> rules, std::span<const SurfacePart> parts,
                     std::size_t node_count)
    : parts_(parts.size()) {
  if (rules.empty()) return;
  part_of_node_.assign(node_count, 0);
  for (std::size_t p = parts.size(); p-- > 0;)
    for (int node : parts[p].connectivity) part_of_node_[index(node)] = static_cast<int>(p);
  const std::size_t pairs = parts_ * parts_;
  for (const PairRule& rule : rules) {
    if (!rule.touch) apart_.resize(pairs, 0);
    if (rule.friction) friction_.resize(pairs);
  }
  for (const PairRule& rule : rules)
    for (const auto& [a, b] :
         {std::pair(rule.part[0], rule.part[1]), std::pair(rule.part[1], rule.part[0])}) {
      const std::size_t place = index(a) * parts_ + index(b);
      if (!apart_.empty()) apart_[place] = rule.touch ? 0 : 1;
      if (!friction_.empty()) friction_[place] = rule.friction;
    }
}

}  // namespace brio
