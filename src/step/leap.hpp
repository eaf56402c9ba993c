#pragma once
/// Forces that throw nodes out of the scene within one step.

#include "src/motion/motion.hpp"

namespace brio {

struct Model;

/// After forces have changed velocities, before contact looks for what meets: nodes that a single step's
/// forces would carry past everything there is meet nothing rightly, and are near everything. What moves that
/// fast already, as in a frame that does, is let be.
/// \param kinetic of `accelerate`
/// \throws Breakdown naming element, node, time and the likely cause
void expect_no_leap(const Model& model, const KineticEnergy& kinetic);

/// Everything came near everything in a step: the node that moves farthest in it, relative to all, is named.
/// \throws Breakdown
[[noreturn]] void refuse_crowd(const Model& model);

}  // namespace brio
