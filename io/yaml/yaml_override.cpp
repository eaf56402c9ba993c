#include <algorithm>
#include <charconv>

#include "io/yaml/yaml_source.hpp"
#include "src/base/index.hpp"

namespace brio {

namespace {

using NodePointer = std::shared_ptr<const YamlNode>;

/// More than a deck is deep: what works it in calls itself once a key.
constexpr std::size_t deepest_path = 64;

/// A key path and what is set there, as `--set` names them.
struct Override {
  Place place;
  std::vector<std::string> path;
  NodePointer value;
};

Override parse_override(const std::string& setting) {
  Override result;
  constexpr std::size_t longest = 200;
  const std::string name =
      "--set " + (setting.size() > longest ? setting.substr(0, longest) + "..." : setting);
  result.place = {std::make_shared<const std::string>(name), 0, 0};
  const std::size_t equals = setting.find('=');
  if (equals == std::string::npos || equals == 0)
    throw DeckError(result.place, "not an override; write KEY.PATH=VALUE, for example time.end=1e-3");
  for (std::size_t start = 0; start <= equals;) {
    const std::size_t end = std::min(setting.find('.', start), equals);
    if (end == start) throw DeckError(result.place, "a key of the path is empty; write KEY.PATH=VALUE");
    result.path.push_back(setting.substr(start, end - start));
    start = end + 1;
  }
  if (result.path.size() > deepest_path)
    throw DeckError(result.place, "a path of " + std::to_string(result.path.size()) +
                                      " keys leads nowhere in a deck; at most " +
                                      std::to_string(deepest_path) + " are accepted");
  result.value = parse_yaml(setting.substr(equals + 1), name, true);
  return result;
}

/// The node with the rest of the path worked in, its unchanged parts shared with the old one.
NodePointer overridden(const NodePointer& node, const Override& change, std::size_t depth) {
  if (depth == change.path.size()) return change.value;
  const std::string& key = change.path[depth];
  auto copy = node ? std::make_shared<YamlNode>(*node) : std::make_shared<YamlNode>();
  if (node == nullptr || node->is_null()) {
    copy->kind = YamlNode::Kind::map;
    copy->place = change.place;
  }
  if (copy->is_sequence()) {
    std::size_t index = 0;
    const auto [end, fault] = std::from_chars(key.data(), key.data() + key.size(), index);
    if (fault != std::errc() || end != key.data() + key.size() || index >= copy->items.size())
      throw DeckError(change.place, "'" + key + "' is not an entry of the list; it has " +
                                        std::to_string(copy->items.size()) + ", counted from 0");
    copy->items[index] = overridden(copy->items[index], change, depth + 1);
    return copy;
  }
  if (!copy->is_map())
    throw DeckError(change.place,
                    "'" + key + "' cannot be set inside " + describe(*copy) + "; set the map as a whole");
  for (YamlEntry& entry : copy->entries)
    if (entry.key == key) {
      entry.value = overridden(entry.value, change, depth + 1);
      return copy;
    }
  copy->entries.push_back({key, change.place, overridden(nullptr, change, depth + 1)});
  return copy;
}

bool reads_back_plain(std::string_view text) {
  constexpr std::string_view letters = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_.+-";
  if (text.empty() || text.find_first_not_of(letters) != std::string_view::npos) return false;
  if (text == "null" || text == "Null" || text == "NULL") return false;
  // A number may start with a minus sign; alone, or before another, it is a mark of YAML.
  return text.front() != '-' ||
         (text.size() > 1 && std::string_view(".0123456789").find(text[1]) != std::string_view::npos);
}

void write_scalar(const std::string& text, bool quoted, std::string& out) {
  if (!quoted && reads_back_plain(text)) {
    out += text;
    return;
  }
  constexpr std::string_view hexadecimal = "0123456789abcdef";
  out += '"';
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x20 || byte == 0x7F) {
      out += "\\x";
      out += hexadecimal[byte >> 4];
      out += hexadecimal[byte & 15];
      continue;
    }
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  out += '"';
}

void write_flow(const YamlNode& node, std::string& out) {
  switch (node.kind) {
    case YamlNode::Kind::null:
      out += "~";
      return;
    case YamlNode::Kind::scalar:
      write_scalar(node.text, node.quoted, out);
      return;
    case YamlNode::Kind::sequence: {
      out += '[';
      for (std::size_t i = 0; i < node.items.size(); ++i) {
        if (i != 0) out += ", ";
        write_flow(*node.items[i], out);
      }
      out += ']';
      return;
    }
    case YamlNode::Kind::map: {
      out += '{';
      for (std::size_t i = 0; i < node.entries.size(); ++i) {
        if (i != 0) out += ", ";
        write_scalar(node.entries[i].key, false, out);
        out += ": ";
        write_flow(*node.entries[i].value, out);
      }
      out += '}';
    }
  }
}

/// Maps down to this depth are written with a line an entry, what is below on one line.
constexpr int block_depth = 3;

void write_block(const YamlNode& map, int depth, std::string& out) {
  for (const YamlEntry& entry : map.entries) {
    out.append(2 * index(depth), ' ');
    write_scalar(entry.key, false, out);
    out += ':';
    const YamlNode& value = *entry.value;
    if (value.is_map() && !value.entries.empty() && depth + 1 < block_depth) {
      out += '\n';
      write_block(value, depth + 1, out);
    } else {
      out += ' ';
      write_flow(value, out);
      out += '\n';
    }
  }
}

}  // namespace

std::shared_ptr<const YamlNode> override_value(const std::shared_ptr<const YamlNode>& root,
                                               const std::string& setting) {
  return overridden(root, parse_override(setting), 0);
}

std::string write_flow_yaml(const YamlNode& node) {
  std::string out;
  write_flow(node, out);
  return out;
}

std::string write_yaml(const YamlNode& root) {
  std::string out;
  if (root.is_map() && !root.entries.empty()) {
    write_block(root, 0, out);
  } else {
    write_flow(root, out);
    out += '\n';
  }
  return out;
}

}  // namespace brio
