#include "src/deck/part_index.hpp"

namespace brio {

BuildError no_part(const std::string& name, const std::string& place) {
  return BuildError("no part is named '" + name + "'", place);
}

std::size_t part_index(const std::string& name, const Deck& deck) {
  for (std::size_t p = 0; p < deck.parts.size(); ++p)
    if (deck.parts[p].name == name) return p;
  throw no_part(name);
}

std::vector<std::size_t> parts_called(std::string_view name, const Deck& deck) {
  std::vector<std::size_t> found;
  for (std::size_t p = 0; p < deck.parts.size(); ++p) {
    const auto* file = std::get_if<MeshFromFile>(&deck.parts[p].mesh);
    if (deck.parts[p].name == name || (file != nullptr && file->from == name && !name.empty()))
      found.push_back(p);
  }
  return found;
}

const Material* material_of(const Deck& deck, const Part& part) {
  for (const auto& [name, material] : deck.materials)
    if (name == part.material) return &material;
  return nullptr;
}

}  // namespace brio
