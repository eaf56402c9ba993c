#pragma once
/// Pairs of particles: lists of neighbours, sums over neighbours, and pair forces.

#include <span>

#include "elements/particle/neighbour_search.hpp"
#include "elements/particle/particle_cloud.hpp"
#include "src/base/gather.hpp"
#include "src/base/lanes.hpp"

namespace brio {

/// Sums over the neighbours of the particles of a pack, one a lane.
struct alignas(64) NeighbourSums {
  double position[3][3][lane_count<double>];        ///< sum of s x X^T
  double velocity[3][3][lane_count<double>];        ///< sum of s v X^T
  double position_by_velocity[lane_count<double>];  ///< sum of s x.v
  double velocity_squared[lane_count<double>];      ///< sum of s v.v
  double correction[6][lane_count<double>];         ///< K: xx yy zz xy yz xz
  double volume[lane_count<double>];                ///< at the start
  double spacing[lane_count<double>];
  double hourglass_weight[lane_count<double>];   ///< 3 / sum of s X.X, by which a modulus makes k
  double frequency_squared[lane_count<double>];  ///< bound for the initial moduli
  double weight[lane_count<double>];             ///< sum of s, updated-Lagrangian kernel
  // Of the updated-Lagrangian kernel; `position` and `correction` are then those of particle_support.hpp.
  double middle_gradient[3][3][lane_count<double>];    ///< L of the middle of the step
  double residual_gradient[3][3][lane_count<double>];  ///< L of residual velocities
  double share[6][lane_count<double>];                 ///< S of particle_support.hpp: xx yy zz xy yz xz
};

inline Lanes<double> lanes_of(const double (&row)[lane_count<double>]) { return Lanes<double>::load(row); }

/// Pairs closer than twice the mean of their smoothing lengths.
/// \param volume of each particle
/// \param smoothing smoothing length over the cube root of the volume
/// \param in_packs whether lists are whole packs of eight, as the updated-Lagrangian kernel reads them
/// \throws std::invalid_argument naming a particle without neighbours in three directions
ParticleCloud make_particle_cloud(int first_node, std::span<const double> volume, double smoothing,
                                  bool in_packs, const Nodes& nodes, ThreadTeam& team);

/// Sums for `count` particles of a pack; the lanes behind repeat the last.
void sum_over_neighbours(const ParticleCloud& cloud, const Nodes& nodes, const int* node, int count,
                         NeighbourSums& sums);

/// Sum of the pair forces on particle i, and a fourth number. \param position of particle 0; rows are
/// `stride` doubles apart
Row4 pair_forces_on(const ParticleCloud& cloud, const double* position, std::size_t stride, std::size_t i);

/// Adds the pair forces on `count` particles to nodes.force.
void add_pair_forces(const ParticleCloud& cloud, Nodes& nodes, const int* node, int count);

/// Changes the kernel of a cloud in packs to updated Lagrangian. \param smoothing smoothing length over the
/// spacing
void start_eulerian(ParticleCloud& cloud, double smoothing, const Nodes& nodes);

/// New lists of neighbours, closer than their smoothing lengths and the skin together.
void set_neighbours(ParticleCloud& cloud, const NeighbourSearch& found, const Nodes& nodes, ThreadTeam& team);

/// Where particles are, and their smoothing lengths, in the present time step. \param begin, end of particles
void place_particles(ParticleCloud& cloud, const Nodes& nodes, std::size_t begin, std::size_t end);

/// As sum_over_neighbours and add_pair_forces, for the updated-Lagrangian kernel: F = I. \param step that led
/// here
void sum_over_neighbours_now(ParticleCloud& cloud, const int* node, int count, double step,
                             NeighbourSums& sums);
/// \param repulsion fraction of the tension of a pair \returns work of forces that are not those of stress
double add_pair_forces_now(ParticleCloud& cloud, Nodes& nodes, const int* node, int count, double repulsion,
                           double step);

/// The highest frequency, squared, of the linear elastic cloud at the start, by Lanczos' method, with a
/// margin for what that has not found.
double highest_frequency_squared(ParticleCloud& cloud, const Nodes& nodes,
                                 const ElasticModuli<double>& moduli, double hourglass_modulus);

}  // namespace brio
