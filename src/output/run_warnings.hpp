#pragma once
/// What a run shows of itself that makes its results doubtful, though it reaches its end.

#include <string>
#include <vector>

#include "src/model/model.hpp"

namespace brio {

/// Looks at the present state; called where fields are written.
void watch(Model& model);

/// Sentences for the user: what is doubtful, of which part, at what time, and what to try.
std::vector<std::string> run_warnings(const Model& model);

}  // namespace brio
