#pragma once
/// Sums of nodal rows over the elements of several domains: of a node on a border each domain forms a partial
/// sum, and these are added in the order of domains to what stood on the node before.

#include <cstddef>
#include <span>
#include <vector>

#include "src/base/nodes.hpp"
#include "src/base/parallel.hpp"

namespace brio {

/// Empty where no two domains share a node: then nothing of this is allocated or executed.
struct DomainSums {
  struct Slot {
    int node;
    int number;  ///< of its partial sum
  };
  std::vector<int> node;                      ///< on borders, ascending
  std::vector<int> first_slot;                ///< of each what stood on it before, then the partial sums
  std::vector<Slot> slots;                    ///< sorted by domain
  std::vector<std::size_t> domain_first;      ///< of each domain in `slots`, and their number at the end
  AlignedBuffer<NodeVector> linear, angular;  ///< by slot

  bool empty() const { return node.empty(); }
};

/// \param nodes_of_domain of each domain, ascending
DomainSums make_domain_sums(std::span<const std::vector<int>> nodes_of_domain, bool with_rotations);

/// Before the sweep: rows of nodes on borders are kept and cleared.
void begin_sums(DomainSums& sums, const NodalRows& rows, ThreadTeam& team);
/// After the sweep of a domain: its partial sums are kept, and the rows cleared.
void keep_sums(DomainSums& sums, std::size_t domain, const NodalRows& rows);
/// After all domains: the rows become the sums.
void finish_sums(const DomainSums& sums, const NodalRows& rows, ThreadTeam& team);

}  // namespace brio
