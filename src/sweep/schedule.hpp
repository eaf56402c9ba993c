#pragma once
/// Order of elements and nodes in memory, and the order in which chunks of elements may be swept side by
/// side.

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "elements/block.hpp"

namespace brio {

/// One chunk of one block.
struct SweepTask {
  std::size_t block;
  Chunk chunk;
};

/// Tasks sorted by colour: no two tasks of a colour share a node, so they may scatter at the same time, and a
/// node's sum is formed in colour order whatever the number of threads.
struct SweepSchedule {
  std::vector<SweepTask> tasks;
  std::vector<std::size_t> colour_first;  ///< first task of each colour, and the number of tasks at the end

  /// Saved and restored (src/base/state_archive.hpp).
  template <class Archive>
  void serialize(Archive& archive) {
    archive(tasks, colour_first);
  }
};

/// Elements sorted so that contiguous chunks are slabs across the longest extent, and neighbours inside a
/// chunk are neighbours in memory (Morton order): a chunk's nodes fit in cache and few colours are needed.
/// \return permutation: position in memory -> element of the mesh.
std::vector<int> locality_order(std::span<const std::array<double, 3>> position,
                                std::span<const int> connectivity, int nodes_per_element);

/// Chunks of every block with greedy colours.
SweepSchedule make_schedule(std::span<const Block> blocks, std::size_t node_count);

}  // namespace brio
