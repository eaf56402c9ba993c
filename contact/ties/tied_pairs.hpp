#pragma once
/// Which pairs of a surface ties hold together.

#include "contact/surface/surface.hpp"
#include "contact/ties/ties.hpp"

namespace brio {

/// Pairs of a surface that ties hold together. \param part_of_surface of each part that holds: its number in
/// the surface, or -1
HeldPairs held_pairs(const Surface& surface, const Ties& ties, const std::vector<int>& part_of_surface);

/// The same after ties have ended.
void renew(HeldPairs& held, const Surface& surface, const Ties& ties);

}  // namespace brio
