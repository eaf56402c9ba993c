#include "src/sweep/surface_numbers.hpp"

#include "src/base/index.hpp"

namespace brio {

void erode(ContactScene& scene, SurfaceNumbers& numbers, std::span<const DeletedElement> deleted) {
  numbers.deleted.clear();
  for (const DeletedElement& entry : deleted) {
    const auto p = index(entry.part);
    if (numbers.part[p] < 0) continue;
    numbers.deleted.push_back({numbers.part[p], numbers.element[p][index(entry.element)]});
  }
  erode(scene, numbers.deleted);
}

}  // namespace brio
