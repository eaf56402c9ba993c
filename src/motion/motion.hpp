#pragma once
/// Velocities and positions of all nodes, and their kinetic energy and momentum.

#include <array>
#include <vector>

#include "src/base/nodes.hpp"
#include "src/base/parallel.hpp"
#include "src/motion/energy_balance.hpp"

namespace brio {

struct KineticEnergy {
  double half = 0;  ///< m v+.v+/2, at the half step
  double now = 0;   ///< m v-.v+/2, at the step
};

/// v += f/m times the mean of the steps before and after; stores v- where there is an array for it.
/// \param sums scratch, one a range of nodes
KineticEnergy accelerate(Nodes& nodes, double mean_step, std::vector<KineticEnergy>& sums, ThreadTeam& team);

/// Kinetic energy after supports, walls and contact have changed velocities; needs the stored v-.
KineticEnergy kinetic_energy(const Nodes& nodes, std::vector<KineticEnergy>& sums, ThreadTeam& team);

/// x += v times the step; forces are cleared for the next one.
void move(Nodes& nodes, double step, ThreadTeam& team);

/// Linear and angular momentum about the origin, and the sums of the magnitudes of the terms.
struct Momentum {
  Impulse total;
  double linear_size = 0;
  double angular_size = 0;

  Momentum& operator+=(const Momentum& other) {
    total += other.total;
    linear_size += other.linear_size;
    angular_size += other.angular_size;
    return *this;
  }
};
Momentum momentum(const Nodes& nodes);
/// Of the nodes [begin, end).
Momentum momentum(const Nodes& nodes, std::size_t begin, std::size_t end);

}  // namespace brio
