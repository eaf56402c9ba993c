#pragma once
/// What fields, history and summary ask of a model alike.

#include <cstdint>
#include <vector>

#include "src/model/model.hpp"

namespace brio {

/// Whether any law of the scene has damage.
bool can_be_damaged(const Model& model);

/// Elements deleted until now.
std::int64_t deleted_so_far(const Model& model);

/// Present momenta into the balance. \param now of the nodes
void balance_momentum(Model& model, Momentum now);

/// Of each node its number in the results, by parts; -1 of those that no part names.
std::vector<std::int64_t> points_of_nodes(const Model& model);

}  // namespace brio
