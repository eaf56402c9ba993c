#include "io/restart/deck_difference.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <string_view>

#include "io/yaml/yaml_source.hpp"

namespace brio {

namespace {

using NodePointer = std::shared_ptr<const YamlNode>;

constexpr std::array<std::string_view, 4> may_differ{"title", "units", "output", "time.end"};

bool is_same_number(const std::string& a, const std::string& b) {
  double x = 0, y = 0;
  const auto read = [](const std::string& text, double& value) {
    const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), value);
    return fault == std::errc() && end == text.data() + text.size();
  };
  return read(a, x) && read(b, y) && x == y;
}

std::string shown(const NodePointer& node) {
  if (node == nullptr) return "nothing";
  constexpr std::size_t longest = 60;
  const std::string text = write_flow_yaml(*node);
  return "'" + (text.size() > longest ? text.substr(0, longest) + "..." : text) + "'";
}

NodePointer value_of(const YamlNode& map, const std::string& key) {
  const YamlEntry* entry = map.find(key);
  return entry == nullptr ? nullptr : entry->value;
}

std::string difference(const NodePointer& saved, const NodePointer& now, const std::string& path) {
  if (std::find(may_differ.begin(), may_differ.end(), path) != may_differ.end()) return {};
  const std::string both = path + " is " + shown(now) + ", and was " + shown(saved);
  if (saved == nullptr || now == nullptr || saved->kind != now->kind) return both;
  const auto inside = [&](const std::string& key) { return path.empty() ? key : path + "." + key; };
  if (saved->is_map()) {
    for (const YamlNode* node : {saved.get(), now.get()})
      for (const YamlEntry& entry : node->entries)
        if (std::string found =
                difference(value_of(*saved, entry.key), value_of(*now, entry.key), inside(entry.key));
            !found.empty())
          return found;
    return {};
  }
  if (saved->is_sequence()) {
    if (saved->items.size() != now->items.size()) return both;
    for (std::size_t i = 0; i < saved->items.size(); ++i)
      if (std::string found = difference(saved->items[i], now->items[i], inside(std::to_string(i)));
          !found.empty())
        return found;
    return {};
  }
  return saved->text == now->text || is_same_number(saved->text, now->text) ? std::string() : both;
}

}  // namespace

std::string deck_difference(const std::string& saved, const std::string& now) {
  return difference(parse_yaml(saved, "the saved deck"), parse_yaml(now, "the deck"), "");
}

}  // namespace brio
