#pragma once
/// The energy balance of a time step against its limit.

#include "src/model/model.hpp"

namespace brio {

/// Once all stages of the step are in the balance. \throws Breakdown beyond the limit
void check_energy_balance(Model& model, double energy_error_limit);

}  // namespace brio
