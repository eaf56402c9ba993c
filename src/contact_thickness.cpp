#include "src/contact_thickness.hpp"

namespace brio {

void follow(ContactThickness& shells, const PartInModel& part, const Block& block, const Nodes& nodes,
            Surface& surface) {
  for (std::size_t e = 0; e < part.element_slot.size(); ++e) {
    if (part.element_slot[e] < 0) continue;
    const auto place = static_cast<std::size_t>(part.element_slot[e]);
    shells.thickness[static_cast<std::size_t>(shells.element[e])] =
        block.kernel.sample(block, nodes, place).thickness;
  }
  update_thickness(surface, shells.surface_part, shells.thickness);
}

}  // namespace brio
