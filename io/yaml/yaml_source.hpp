#pragma once
/// YAML as the deck reader sees it: a tree in which everything knows its place. Aliases and merge keys (`<<`)
/// are resolved, duplicate keys are refused, and overrides of the command line are worked in.

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "io/yaml/deck_error.hpp"

namespace brio {

struct YamlNode;

struct YamlEntry {
  std::string key;
  Place place;  ///< of the key
  std::shared_ptr<const YamlNode> value;
};

struct YamlNode {
  enum class Kind { null, scalar, sequence, map };
  Kind kind = Kind::null;
  Place place;
  bool quoted = false;  ///< a scalar in quotes is text, whatever it looks like
  std::string text;     ///< of a scalar
  std::vector<std::shared_ptr<const YamlNode>> items;
  std::vector<YamlEntry> entries;  ///< in the order of the file

  bool is_null() const { return kind == Kind::null; }
  bool is_scalar() const { return kind == Kind::scalar; }
  bool is_sequence() const { return kind == Kind::sequence; }
  bool is_map() const { return kind == Kind::map; }
  /// The value of a key, or null.
  const YamlEntry* find(std::string_view key) const;
};

/// What a node is, for messages: "a map", "the text 'abc'", ...
std::string describe(const YamlNode& node);

/// The text of a file.
/// \throws DeckError if it cannot be read or is not text.
std::string read_text_file(const std::string& path);

/// \param name what messages call the text: its file, or the override that it stands in
/// \param is_override then messages name no line and column
/// \throws DeckError where the text is not YAML, or not what this reader takes.
std::shared_ptr<const YamlNode> parse_yaml(const std::string& text, const std::string& name,
                                           bool is_override = false);

/// The tree with `KEY.PATH=VALUE` worked in; maps on the way that are absent are made.
/// \throws DeckError if the path leads through a value, or past the end of a list.
std::shared_ptr<const YamlNode> override_value(const std::shared_ptr<const YamlNode>& root,
                                               const std::string& setting);

/// The tree as YAML that reads back the same.
std::string write_yaml(const YamlNode& root);
/// The same on one line.
std::string write_flow_yaml(const YamlNode& node);

}  // namespace brio
