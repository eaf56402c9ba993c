#pragma once
/// Nodes in messages.

#include <cstddef>
#include <string>

#include "src/model/model.hpp"

namespace brio {

/// "node 3 of part 'cube' at (0, 0, 1)", by its number in the first part that has it.
std::string name_of_node(const Model& model, std::size_t node);

}  // namespace brio
