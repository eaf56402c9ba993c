#pragma once
/// What the particles of a block know of each other: pairs, weights, gradients over them, and pair forces.
///
/// With the pair vectors X_ij = X_j - X_i at the start, symmetric weights s_ij = V_i V_j (-W'(r) / r) of the
/// cubic B-spline W, and K_i = (sum_j s_ij X_ij X_ij^T)^-1, the corrected kernel gradient (Randles &
/// Libersky 1996, Bonet & Lok 1999) gives
///
///     F_i = (sum_j s_ij x_ij X_ij^T) K_i,
///
/// exact for linear fields whatever the neighbourhood. It is at the same time the weighted least-squares fit
/// of the neighbourhood's motion, so that the residuals e_ij = x_ij - F_i X_ij, which F_i does not see, obey
/// sum_j s_ij e_ij X_ij^T = 0. Forces are the gradient of
///
///     sum_i ( V_i w(F_i) + k_i/2 sum_j s_ij e_ij.e_ij ),
///
///     f_i = sum_j s_ij ( (A_i + A_j) X_ij + (k_i + k_j) x_ij ),     A_i = V_i P_i K_i - k_i F_i,
///
/// the second term holding motions without strain energy (as in Silling 2017, eq. 25, whose correspondence
/// model this is). Pair forces are opposite, and the energy does not change in a rotation: both momenta are
/// kept to rounding.

#include <cmath>
#include <cstddef>

#include "materials/stress_state.hpp"
#include "src/base/aligned.hpp"
#include "src/base/nodes.hpp"

namespace brio {

/// s X and s of one neighbour.
struct alignas(32) ParticlePair {
  double weighted[4];
};

/// What a particle tells its neighbours: columns of A, and k in the fourth place of the first.
struct alignas(32) ParticleForce {
  double column[3][4];
};

/// What pairs of the updated-Lagrangian kernel read of a particle, in one cache line.
struct alignas(64) ParticlePlace {
  double position[3], smoothing_length;
  double velocity[3], volume;  ///< volume at the start
};

inline constexpr std::size_t particles_a_task = 1024;

/// Places of a list of so many neighbours in whole packs of eight.
constexpr std::size_t places_in_packs(std::size_t count) { return (count + 7) / 8 * 8; }

/// Edge of a cube. Volumes in units of eight times each other have edges of the same bits, which is not so of
/// std::cbrt.
inline double edge_of_cube(double volume) {
  const int exponent = volume > 0 ? std::ilogb(volume) : 0;
  const int third = (exponent - (exponent % 3 + 3) % 3) / 3;
  return std::ldexp(std::cbrt(std::ldexp(volume, -3 * third)), third);
}

struct ParticleCloud {
  int first_node = 0;                ///< particle i is node first_node + i
  AlignedBuffer<double> volume;      ///< at the start
  AlignedBuffer<double> spacing;     ///< its cube root
  AlignedBuffer<std::size_t> first;  ///< of a particle's neighbours
  AlignedBuffer<int> count;
  AlignedBuffer<int> neighbour;
  AlignedBuffer<ParticlePair> pair;
  AlignedBuffer<SymmetricTensor<double>> correction;  ///< K; 0 where a particle has lost its support
  AlignedBuffer<double> hourglass_weight;
  AlignedBuffer<double> gradient_size;  ///< sum of |s K X|, which bounds the stiffness of a particle
  AlignedBuffer<ParticleForce> force;
  double largest_gradient_size = 0;  ///< at the start
  double frequency_squared = 0;      ///< the highest, at the start

  // Of the updated-Lagrangian (eulerian) kernel, in present pair vectors and weights: empty in the other.
  double smoothing = 0;                         ///< length at the start over the spacing
  double skin = 0;                              ///< by which neighbours are searched further
  AlignedBuffer<double> smoothing_length;       ///< now
  AlignedBuffer<ParticlePlace> place;           ///< now, and one without volume, which fills up packs
  AlignedBuffer<double> next_smoothing_length;  ///< of the step that follows
  AlignedBuffer<double> weight;                 ///< s of each pair, in place of `pair`
  AlignedBuffer<ParticleForce> residual;        ///< viscosity times L, and viscosity, for residual velocities
  AlignedBuffer<NodeVector> pair_force;         ///< on each particle, of residual velocities and repulsion
  /// Positions at the last search, and the smoothing lengths; -1 where a particle has been cut.
  AlignedBuffer<NodeVector> searched_at;
  bool is_eulerian() const { return !smoothing_length.empty(); }
  int without_volume() const { return static_cast<int>(size()); }
  bool is_cut(std::size_t i) const { return searched_at[i].component[3] < 0; }

  std::size_t size() const { return volume.size(); }

  /// Saved and restored (src/base/state_archive.hpp).
  template <class Archive>
  void serialize(Archive& archive) {
    archive(first, count, neighbour, pair, correction, hourglass_weight, gradient_size, force, skin,
            smoothing_length, next_smoothing_length, weight, residual, pair_force, searched_at);
  }
};

/// Takes a particle out of its neighbours' lists.
void cut_particle(ParticleCloud& cloud, int particle);

}  // namespace brio
