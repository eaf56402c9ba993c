#pragma once
/// Deleted elements as the contact surface numbers them.

#include <span>
#include <vector>

#include "contact/scene.hpp"
#include "src/sweep/erosion.hpp"

namespace brio {

struct SurfaceNumbers {
  std::vector<int> part;                  ///< of each part: its number in the surface; -1: not in contact
  std::vector<std::vector<int>> element;  ///< of each part: element of its mesh -> element of the surface
  std::vector<SurfaceElement> deleted;    ///< in the present step
};

/// Take deleted elements out of the contact surface.
void erode(ContactScene& scene, SurfaceNumbers& numbers, std::span<const DeletedElement> deleted);

}  // namespace brio
