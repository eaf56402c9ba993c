// Forces of the history.

#include "io/deck/read_fields.hpp"

namespace brio {

namespace {

bool is_all(const YamlNode& node) { return node.is_scalar() && node.text == "all"; }

std::string_view name_of(const BoundaryCondition& condition) {
  const auto* wall = std::get_if<RigidWall>(&condition);
  return wall != nullptr ? wall->label : std::get<PrescribedMotion>(condition).name;
}

}  // namespace

void KnownNames::expect_condition(const YamlNode& node, std::string_view name) const {
  std::vector<std::string_view> names;
  for (const BoundaryCondition& condition : deck_.boundary_conditions)
    if (!name_of(condition).empty()) names.push_back(name_of(condition));
  const auto count = std::ranges::count(names, name);
  if (count == 0)
    throw DeckError(node.place, "no boundary condition is called '" + std::string(name) + "'; " +
                                    (names.empty() ? "none has a name" : accepted_words(name, names)));
  if (count > 1)
    throw DeckError(node.place, "several boundary conditions are called '" + std::string(name) +
                                    "'; a name of its own is expected");
}

void read_value(const YamlNode& node, const Slot& slot, ReactionColumns& columns) {
  columns.all = is_all(node);
  if (columns.all) return;
  if (!node.is_sequence()) refuse(node, slot, "all, or a list of names of boundary conditions");
  for (const auto& item : node.items) {
    read_value(*item, slot, columns.names.emplace_back());
    slot.known.expect_condition(*item, item->text);
  }
}

void read_value(const YamlNode& node, const Slot& slot, ContactColumns& columns) {
  columns.place = to_string(node.place);
  columns.all = is_all(node);
  if (columns.all) return;
  const std::string wanted = "all, or a list of pairs of parts, such as [[plate, can], [can, can]]";
  if (!node.is_sequence()) refuse(node, slot, wanted);
  for (const auto& item : node.items) {
    if (!item->is_sequence() || item->items.size() != 2) refuse(*item, slot, wanted);
    std::array<std::string, 2>& pair = columns.pairs.emplace_back();
    for (std::size_t k = 0; k < 2; ++k) {
      read_value(*item->items[k], slot, pair[k]);
      slot.known.part(*item->items[k], pair[k]);
    }
  }
}

void read_value(const YamlNode& node, const Slot& slot, ForceSection& section) {
  read_fields(node, slot, section);
  slot.known.part(*node.find("part")->value, section.part);
}

}  // namespace brio
