#pragma once
/// Order of elements and nodes in memory, domains, and the order in which chunks of elements may be swept
/// side by side.
///
/// A domain is a neighbourhood of elements that stays together for the whole run, chosen from the mesh alone.
/// Of a node on a border of domains each domain forms a partial sum, and these are added in the order in
/// which they are swept (domain_sums.hpp): results depend neither on who sweeps a domain nor on when.

#include <array>
#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "elements/block.hpp"
#include "src/domains/domain_sums.hpp"

namespace brio {

class DomainExchange;

/// What a domain has of one block: packs [first, last), where its elements stay.
struct DomainPiece {
  std::size_t domain;
  std::size_t block;
  std::size_t first_pack, last_pack;
  std::size_t element_count;  ///< not deleted
  std::size_t most_chunks;
};

/// One chunk of one block.
struct SweepTask {
  std::size_t block;
  Chunk chunk;
  std::size_t piece;
};

/// Tasks sorted by stage and colour: no two domains of a stage and no two tasks of a colour share a node, so
/// tasks of a colour may scatter at the same time, and a node's sum is formed in the order of stages, within
/// a domain in the order of colours, whatever the number of threads.
struct SweepSchedule {
  std::vector<SweepTask> tasks;
  std::vector<std::size_t> colour_first;  ///< first task of each colour, and the number of tasks at the end
  std::vector<std::size_t> stage_first;  ///< first colour of each stage, and the number of colours at the end
  std::vector<DomainPiece> pieces;       ///< sorted by block and packs, and so by domain
  std::vector<std::size_t> domain_of_stage;     ///< domains sorted by stage
  std::vector<std::size_t> stage_domain_first;  ///< of each stage in `domain_of_stage`, and their number
  DomainSums sums;
  std::shared_ptr<DomainExchange> exchange;  ///< where others sweep a share of the domains; else null

  std::size_t domain_count() const { return domain_of_stage.size(); }

  /// Saved and restored (src/base/state_archive.hpp). What is not follows from the mesh.
  template <class Archive>
  void serialize(Archive& archive) {
    archive(tasks, colour_first, stage_first, pieces);
  }
};

/// Elements sorted so that contiguous chunks are slabs across the longest extent, and neighbours inside a
/// chunk are neighbours in memory (Morton order): a chunk's nodes fit in cache and few colours are needed.
/// \return permutation: position in memory -> element of the mesh.
std::vector<int> locality_order(std::span<const Vector3d> position, std::span<const int> connectivity,
                                int nodes_per_element);

/// Elements below which a domain is not cut.
inline constexpr std::size_t least_domain_elements = 1024;

/// Domains and chunks of all blocks, with greedy colours.
SweepSchedule make_schedule(std::span<const Block> blocks, std::size_t node_count,
                            std::size_t least_elements = least_domain_elements);

/// Nodes of each domain, ascending.
std::vector<std::vector<int>> nodes_of_domains(std::span<const DomainPiece> pieces,
                                               std::span<const Block> blocks);

/// Chunks and colours anew, after the elements of each piece were moved to its first places.
void cut_chunks(SweepSchedule& schedule, std::span<const Block> blocks, std::size_t node_count);

}  // namespace brio
