#pragma once
/// Sums of nodal rows over the elements of several domains. Of a node on a border the domain that is swept
/// first adds to what stands on the node, each other one forms a partial sum, and these are added in the
/// order of the sweep.

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
    int number;  ///< of the partial sum of this domain
    int first;   ///< of the domain that is swept first
    bool is_last;
  };
  std::vector<int> node;                  ///< on borders, ascending
  std::vector<int> first_slot;            ///< of each, in the order of the sweep, and their number at the end
  std::vector<Slot> slots;                ///< sorted by domain
  std::vector<std::size_t> domain_first;  ///< of each domain in `slots`, and their number at the end
  AlignedBuffer<NodeVector> linear, angular;  ///< by slot

  bool empty() const { return node.empty(); }
};

/// \param nodes_of_domain of each domain, ascending \param order of the sweep
DomainSums make_domain_sums(std::span<const std::vector<int>> nodes_of_domain,
                            std::span<const std::size_t> order, bool with_rotations);

/// After the sweep of a domain: its partial sums are kept and the rows cleared, but where it is the last
/// domain of a node: there the row becomes the sum.
void add_sums(DomainSums& sums, std::size_t domain, const NodalRows& rows);

/// The same for domains that are swept in several places: all partial sums are kept ...
void keep_sums(DomainSums& sums, std::size_t domain, const NodalRows& rows);
/// ... and in the end the rows become the sums.
void finish_sums(const DomainSums& sums, const NodalRows& rows, ThreadTeam& team);

}  // namespace brio
