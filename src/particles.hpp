#pragma once
/// Neighbours of particles, by the search of contact.

#include <span>
#include <vector>

#include "contact/global_search.hpp"
#include "elements/block.hpp"

namespace brio {

/// Gives a block of particles its cloud. \param volume of each particle, by place in the block.
/// \throws std::invalid_argument naming a particle without neighbours in three directions
void find_neighbours(Block& block, std::span<const double> volume, const Nodes& nodes);

/// The search of a block whose kernel is of now, and its buffers.
struct ParticleSearch {
  std::size_t block;
  GlobalSearch search{};
  std::vector<Vector3<double>> point{};
  std::vector<CaptureBox> box{};
  CandidatePairs pairs{};
  SearchCounts counts{};
};

/// Smoothing lengths of the step that begins; new lists of neighbours where particles have moved, or lengths
/// have grown, by more than the lists allow.
void follow_neighbours(ParticleSearch& search, Block& block, const Nodes& nodes, ThreadTeam& team);

}  // namespace brio
