#pragma once
/// The size of a time step.

#include "src/model/model.hpp"

namespace brio {

/// From the stable time step of all elements, or as the deck gives it: grown by a limited factor a step, and
/// such that steps end at the end time without a remainder. \throws Breakdown where it has collapsed, or
/// where a given one exceeds the stable one
void choose_step(Model& model);

}  // namespace brio
