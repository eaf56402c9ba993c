#include "src/sweep/surface_numbers.hpp"

namespace brio {

void erode(ContactScene& scene, SurfaceNumbers& numbers, std::span<const DeletedElement> deleted) {
  numbers.deleted.clear();
  for (const DeletedElement& entry : deleted) {
    const auto p = static_cast<std::size_t>(entry.part);
    if (numbers.part[p] < 0) continue;
    numbers.deleted.push_back({numbers.part[p], numbers.element[p][static_cast<std::size_t>(entry.element)]});
  }
  erode(scene, numbers.deleted);
}

}  // namespace brio
