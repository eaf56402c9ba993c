#pragma once
/// Warnings of a run that reaches its end, though its results are doubtful.

#include <string>
#include <vector>

#include "src/model/model.hpp"

namespace brio {

/// Examines the present state; called where fields are written.
void watch(Model& model);

/// Sentences for the user: what is doubtful, of which part, at what time, and what to try.
std::vector<std::string> run_warnings(const Model& model);

}  // namespace brio
