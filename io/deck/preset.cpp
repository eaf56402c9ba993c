#include "io/deck/preset.hpp"

#include <algorithm>
#include <span>

namespace brio {

namespace {

using NodePointer = std::shared_ptr<const YamlNode>;

struct Setting {
  std::string_view path;
  std::string_view value;
  bool suits_particles = true;
};
struct ElementSetting {
  std::string_view type, key, value;
  std::string_view unless = {};  ///< another key, which stands with this one
};
struct PresetValues {
  std::string_view name;
  std::span<const Setting> settings;
  std::span<const ElementSetting> elements;
};

// Their cost and accuracy: the parameter `preset` of the studies in inputs/studies.
constexpr Setting fast_settings[] = {
    {"numerics.precision", "float", false}, {"contact.passes", "4"}, {"time.step_scale", "0.95"}};
constexpr ElementSetting fast_elements[] = {{"hex8", "objective_rate", "jaumann"},
                                            {"shell4", "thickness_points", "3"}};
constexpr Setting accurate_settings[] = {{"time.step_scale", "0.95", false}};
// Bricks keep the hourglass stiffness of the default: with less they bend and touch too softly. Impacts want
// less viscosity, steps of pressure more; a step closer to the bound disperses the waves of both less, and
// pays for just so much less viscosity that fronts ring no more than by default (rod_wave; 0.05: 5.1 % for
// 3.7 %). Five Lobatto points of a shell see the yield of its surfaces (panel 1.4 % off for 2.0 %, can 0.68
// for 0.72); how few of them would do is for the deck to say. Particles gain nothing from the longer step.
constexpr ElementSetting accurate_elements[] = {{"hex8", "linear_bulk_viscosity", "0.055"},
                                                {"hex8_full", "linear_bulk_viscosity", "0.055"},
                                                {"shell4", "quadrature", "lobatto", "thickness_points"}};
constexpr PresetValues presets[] = {{"fast", fast_settings, fast_elements},
                                    {"accurate", accurate_settings, accurate_elements}};

const YamlNode* at(const YamlNode& root, std::string_view path) {
  const std::size_t dot = path.find('.');
  const YamlEntry* entry = root.is_map() ? root.find(path.substr(0, dot)) : nullptr;
  if (entry == nullptr) return nullptr;
  return dot == std::string_view::npos ? entry->value.get() : at(*entry->value, path.substr(dot + 1));
}

// Name of an element's kind, given as a word or as the `type` of a map.
std::string_view type_of(const YamlNode& element) {
  if (element.is_scalar()) return element.text;
  const YamlNode* type = at(element, "type");
  return type != nullptr && type->is_scalar() ? std::string_view(type->text) : std::string_view();
}

bool has_particles(const YamlNode& parts) {
  return std::any_of(parts.entries.begin(), parts.entries.end(), [](const YamlEntry& part) {
    const YamlNode* element = at(*part.value, "element");
    return element != nullptr && type_of(*element) == "particle";
  });
}

std::string joined(std::string_view path, std::string_view value) {
  return std::string(path) + "=" + std::string(value);
}

NodePointer with_element_setting(const NodePointer& root, const YamlEntry& part,
                                 const ElementSetting& setting) {
  const YamlNode* element = at(*part.value, "element");
  if (element == nullptr || type_of(*element) != setting.type) return root;
  const std::string path = "parts." + part.key + ".element";
  if (element->is_scalar())
    return override_value(root, path + "={type: " + element->text + ", " + std::string(setting.key) + ": " +
                                    std::string(setting.value) + "}");
  const auto is_given = [&](std::string_view key) { return !key.empty() && at(*element, key) != nullptr; };
  if (is_given(setting.key) || is_given(setting.unless)) return root;
  return override_value(root, joined(path + "." + std::string(setting.key), setting.value));
}

NodePointer with_setting(const NodePointer& root, const Setting& setting) {
  const std::string_view section = setting.path.substr(0, setting.path.find('.'));
  const YamlNode* there = at(*root, section);
  // A preset switches nothing on.
  if (there == nullptr || !there->is_map() || at(*root, setting.path) != nullptr) return root;
  const YamlNode* parts = at(*root, "parts");
  if (!setting.suits_particles && parts != nullptr && parts->is_map() && has_particles(*parts)) return root;
  if (setting.path == "time.step_scale" && at(*root, "time.step") != nullptr) return root;
  return override_value(root, joined(setting.path, setting.value));
}

}  // namespace

NodePointer with_preset(const NodePointer& root) {
  const YamlNode* name = at(*root, "numerics.preset");
  if (name == nullptr || !name->is_scalar()) return root;
  const auto preset = std::find_if(std::begin(presets), std::end(presets),
                                   [&](const PresetValues& values) { return values.name == name->text; });
  if (preset == std::end(presets)) return root;
  NodePointer result = root;
  for (const Setting& setting : preset->settings) result = with_setting(result, setting);
  const YamlNode* parts = at(*root, "parts");
  if (parts == nullptr || !parts->is_map()) return result;
  for (const ElementSetting& setting : preset->elements) {
    const NodePointer before = result;
    for (const YamlEntry& part : at(*before, "parts")->entries)
      result = with_element_setting(result, part, setting);
  }
  return result;
}

}  // namespace brio
