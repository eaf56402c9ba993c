#pragma once
/// Shells as thick in contact as their strain has left them.

#include <vector>

#include "contact/surface.hpp"
#include "elements/block.hpp"
#include "src/erosion.hpp"

namespace brio {

/// A part of shells that is in contact and whose thickness changes.
struct ContactThickness {
  std::size_t part = 0;
  int surface_part = 0;
  std::vector<int> element;       ///< of the part's mesh -> element of the surface
  std::vector<double> thickness;  ///< by elements of the surface; of deleted ones the last
};

/// Bring the thickness of the surface up to date. Costs a pass over the part's elements and the surface: a
/// thing for the steps that search.
void follow(ContactThickness& shells, const PartInModel& part, const Block& block, const Nodes& nodes,
            Surface& surface);

}  // namespace brio
