#pragma once
/// Highest frequency of the assembled elements, by Lanczos' method with products of their elastic stiffness
/// (elements/stiffness_product.hpp).

#include <span>
#include <vector>

#include "src/domains/schedule.hpp"
#include "src/motion/motion.hpp"

namespace brio {

/// Scratch of the method; empty where it is not in use.
struct LanczosVectors {
  AlignedBuffer<NodeVector> linear[2], angular[2];  ///< of this iteration and of the next
  double length = 0;                                ///< of the scene, of the size of its motion at most
  std::vector<double> of_ranges;                    ///< one a range of nodes

  bool empty() const { return of_ranges.empty(); }
};

LanczosVectors make_lanczos_vectors(const Nodes& nodes, double length);

/// Estimate of the square of the highest frequency, with a margin for what few iterations leave; elastic,
/// with the present masses. It does not depend on the order of nodes, nor on where the scene is and how fast
/// it flies. \pre every block has kernel.multiply_stiffness \param stiffness_by_mass of nodes: where the
/// search begins
double assembled_frequency_squared(LanczosVectors& vectors, std::span<const double> stiffness_by_mass,
                                   SweepSchedule& schedule, std::span<Block> blocks, const Nodes& nodes,
                                   ThreadTeam& team);

}  // namespace brio
