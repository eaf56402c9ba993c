#include "io/report/deck_labels.hpp"

#include <nlohmann/json.hpp>
#include <optional>

#include "io/yaml/yaml_source.hpp"
#include "src/base/index.hpp"

namespace brio {

namespace {

using nlohmann::json;

// A null pointer where there is no such key.
const YamlNode* value_of(const YamlNode* map, std::string_view key) {
  const YamlEntry* entry = map != nullptr && map->is_map() ? map->find(key) : nullptr;
  return entry != nullptr ? entry->value.get() : nullptr;
}

// Nothing for an expression, which only the reader of decks evaluates.
std::optional<double> number_in(const YamlNode& node) {
  try {
    std::size_t read = 0;
    const double value = std::stod(node.text, &read);
    if (node.is_scalar() && read == node.text.size()) return value;
  } catch (const std::logic_error&) {
  }
  return std::nullopt;
}

json section_of(const YamlNode* section) {
  if (section == nullptr || !section->is_map() || section->entries.size() != 1) return nullptr;
  const YamlEntry& kind = section->entries.front();
  json result{{"kind", kind.key}};
  for (const YamlEntry& length : kind.value->entries)
    if (const auto number = number_in(*length.value)) result[length.key] = *number;
  return result;
}

json direction_of(const YamlNode* list) {
  json result = json::array();
  if (list == nullptr || list->items.size() != 3) return nullptr;
  for (const auto& item : list->items) result.push_back(number_in(*item).value_or(0));
  return result;
}

json part_of(const YamlEntry& entry) {
  json part{{"name", entry.key}};
  const YamlNode* element = value_of(entry.value.get(), "element");
  if (const YamlNode* thickness = value_of(element, "thickness"))
    if (const auto number = number_in(*thickness)) part["thickness"] = *number;
  part["section"] = section_of(value_of(element, "section"));
  part["orientation"] = direction_of(value_of(element, "orientation"));
  return part;
}

// Nothing where the text is no YAML, as in a file that was damaged.
std::shared_ptr<const YamlNode> tree_of(const std::string& deck_text) {
  try {
    return parse_yaml(deck_text, "deck");
  } catch (const DeckError&) {
    return nullptr;
  }
}

}  // namespace

nlohmann::json parts_of_deck(const std::string& deck_text, std::int64_t count) {
  const std::shared_ptr<const YamlNode> tree = tree_of(deck_text);
  const YamlNode* map = value_of(tree.get(), "parts");
  json parts = json::array();
  for (std::int64_t i = 0; i < count; ++i) {
    const auto place = index(i);
    if (map != nullptr && place < map->entries.size())
      parts.push_back(part_of(map->entries[place]));
    else
      parts.push_back({{"name", std::to_string(i)}});
  }
  return parts;
}

nlohmann::json units_of_deck(const std::string& deck_text) {
  const std::shared_ptr<const YamlNode> tree = tree_of(deck_text);
  json units = json::object();
  if (const YamlNode* map = value_of(tree.get(), "units"))
    for (const YamlEntry& label : map->entries)
      if (label.value->is_scalar()) units[label.key] = label.value->text;
  return units;
}

}  // namespace brio
