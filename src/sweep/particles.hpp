#pragma once
/// Neighbours of particles.

#include <cmath>
#include <span>
#include <vector>

#include "elements/block.hpp"
#include "elements/particle/neighbour_search.hpp"

namespace brio {

/// Gives a block of particles its cloud. \param volume of each particle, by place in the block.
/// \throws std::invalid_argument naming a particle without neighbours in three directions
void find_neighbours(Block& block, std::span<const double> volume, const Nodes& nodes, ThreadTeam& team);

/// Box of the displacements of particles since the last search, and the largest growth of a smoothing length.
struct ParticleDrift {
  double lower[3] = {HUGE_VAL, HUGE_VAL, HUGE_VAL}, upper[3] = {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
  double growth = 0;

  void join(const ParticleDrift& other);
  /// By how much two particles may have come closer to each other's reach.
  double approach() const;
};

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
  std::int64_t searches = 0, steps_since = 0;
  NeighbourSearch search{};
  std::vector<ReachingPoint> points{};
  std::vector<ParticleDrift> drifts{};  ///< by ranges

  /// Saved and restored (src/base/state_archive.hpp).
  template <class Archive>
  void serialize(Archive& archive) {
    archive(paired, searches, steps_since);
  }
};

/// Places and smoothing lengths of the present time step; new lists of neighbours where particles have moved,
/// or smoothing lengths have grown, by more than the search margin.
void follow_neighbours(ParticleSearch& search, Block& block, const Nodes& nodes, ThreadTeam& team);

/// Fraction of the particles of a block with an updated-Lagrangian kernel that are closer to another than
/// half of their spacing.
double share_of_paired(const ParticleCloud& cloud, const Nodes& nodes);

}  // namespace brio
