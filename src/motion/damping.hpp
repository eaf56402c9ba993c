#pragma once
/// Mass-proportional damping of nodes: a force -alpha m v, with the velocity as the mean of those before and
/// after the time step (Belytschko, Liu, Moran 2000, section 6.2). The central difference method stays stable
/// for the time step without damping, however large alpha is.

#include <vector>

#include "src/base/nodes.hpp"
#include "src/motion/energy_balance.hpp"

namespace brio {

struct NodalDamping {
  std::vector<double> rate;               ///< alpha of each node, 1/time; empty: nothing is damped
  std::vector<Vector3d> force, moment{};  ///< of damping, in the present step; moments where nodes turn

  bool empty() const { return rate.empty(); }
};

/// Of nodes with the given rates.
NodalDamping make_damping(std::vector<double> rate, const Nodes& nodes);

/// Adds the damping to nodes.force and nodes.moment, in which all other forces of the step stand.
/// \param mean_step time between the velocities before and after
void damp(NodalDamping& damping, double mean_step, Nodes& nodes);

/// Power of the damping at the present velocities; not positive but for impulses of contact and supports.
double power(const NodalDamping& damping, const Nodes& nodes);

/// Force and moment about the origin.
Impulse resultant(const NodalDamping& damping, const Nodes& nodes);

}  // namespace brio
