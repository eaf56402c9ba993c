#pragma once
/// Neighbours of particles, by the search of contact.

#include <span>

#include "elements/block.hpp"

namespace brio {

/// Gives a block of particles its cloud. \param volume of each particle, by place in the block.
/// \throws std::invalid_argument naming a particle without neighbours in three directions
void find_neighbours(Block& block, std::span<const double> volume, const Nodes& nodes);

}  // namespace brio
