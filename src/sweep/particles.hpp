#pragma once
/// Neighbours of particles, by the search of contact.

#include <span>
#include <vector>

#include "contact/search/global_search.hpp"
#include "elements/block.hpp"

namespace brio {

/// Gives a block of particles its cloud. \param volume of each particle, by place in the block.
/// \throws std::invalid_argument naming a particle without neighbours in three directions
void find_neighbours(Block& block, std::span<const double> volume, const Nodes& nodes);

/// Particles that have come closer to another than half of their present spacing. In tension, and in sheets
/// that spread, particles with an updated-Lagrangian kernel gather in pairs (tensile instability; Swegle,
/// Hicks & Attaway 1995; Dehnen & Aly 2012): their stress is then too low.
struct PairedParticles {
  static constexpr double closer_than = 0.5;       ///< of the spacing
  static constexpr double worth_a_warning = 0.01;  ///< fraction of a block's particles
  double largest_share = 0;                        ///< of those not deleted, so far
  double time = 0;                                 ///< of that
};

/// The search of a block with an updated-Lagrangian kernel, and its buffers.
struct ParticleSearch {
  std::size_t block;
  PairedParticles paired{};
  GlobalSearch search{};
  std::vector<Vector3<double>> point{};
  std::vector<CaptureBox> box{};
  CandidatePairs pairs{};
  SearchCounts counts{};

  /// Saved and restored (src/base/state_archive.hpp).
  template <class Archive>
  void serialize(Archive& archive) {
    archive(paired, counts);
  }
};

/// Smoothing lengths of the present time step; new lists of neighbours where particles have moved, or
/// smoothing lengths have grown, by more than the search margin.
void follow_neighbours(ParticleSearch& search, Block& block, const Nodes& nodes, ThreadTeam& team);

/// Fraction of the particles of a block with an updated-Lagrangian kernel that are closer to another than
/// half of their spacing.
double share_of_paired(const ParticleCloud& cloud, const Nodes& nodes);

}  // namespace brio
