#pragma once
/// Energy and momentum at the start of a run.

#include "src/model/model.hpp"

namespace brio {

/// Sets the balances of a model to its present velocities.
void start_balances(Model& model);

}  // namespace brio
