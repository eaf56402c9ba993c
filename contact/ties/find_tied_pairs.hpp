#pragma once
/// Pairs of a surface that are excluded from contact because they are tied.

#include "contact/surface/surface.hpp"
#include "contact/ties/ties.hpp"

namespace brio {

/// Tied pairs of a surface. \param part_of_surface of each part with a main surface: its number in the
/// surface, or -1
TiedPairs find_tied_pairs(const Surface& surface, const Ties& ties, const std::vector<int>& part_of_surface);

/// The same after ties have ended.
void renew(TiedPairs& tied, const Surface& surface, const Ties& ties);

}  // namespace brio
