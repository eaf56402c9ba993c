#pragma once
/// Forces that move nodes out of the scene within one time step.

#include "src/motion/motion.hpp"

namespace brio {

struct Model;

/// After forces have changed velocities, before contact detection: of nodes that the forces of a single time
/// step move across the whole scene contact is not detected rightly, and all features are candidates. Nodes
/// that already move that fast, as in a moving frame, are accepted. \param kinetic of `accelerate` \throws
/// Breakdown naming element, node, time and the likely cause
void expect_no_leap(Model& model, const KineticEnergy& kinetic);

/// Too many contact candidates in a time step: names the node that moves farthest in it, relative to the
/// mean. \throws Breakdown
[[noreturn]] void refuse_crowd(const Model& model);

}  // namespace brio
