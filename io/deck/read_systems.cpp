#include "io/deck/read_systems.hpp"

namespace brio {

void read_value(const YamlNode& node, const Slot& slot, CoordinateSystem& system) {
  read_single_key_choice(node, slot, system);
}

const ComponentWords& component_words_of(const YamlNode& entry, const KnownNames& known) {
  const YamlEntry* system = entry.find("system");
  if (system == nullptr) return component_words;
  return std::holds_alternative<CylindricalSystem>(known.coordinate_system(*system->value))
             ? cylindrical_words
             : component_words;
}

void check_system(const YamlNode& name, const KnownNames& known, const Load& load) {
  const CoordinateSystem& system = known.coordinate_system(name);
  if (std::holds_alternative<Gravity>(load) && !std::holds_alternative<RectangularSystem>(system))
    throw DeckError(name.place, "'" + name.text +
                                    "' is a cylindrical system, and gravity is the same everywhere; accepted "
                                    "are rectangular ones");
}

}  // namespace brio
