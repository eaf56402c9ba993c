#include "io/yaml/yaml_source.hpp"

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/parser.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <unordered_set>

#include "io/files/utf8.hpp"
#include "src/base/index.hpp"

namespace brio {

namespace {

using NodePointer = std::shared_ptr<const YamlNode>;

/// Larger than any deck written by hand or program; keeps a wrong file from filling the memory.
constexpr std::size_t largest_deck = std::size_t{256} << 20;

/// Builds the tree from the events of the YAML parser.
class TreeBuilder : public YAML::EventHandler {
 public:
  TreeBuilder(const std::string& name, bool is_override)
      : source_(std::make_shared<const std::string>(name)), is_override_(is_override) {}

  NodePointer root() const { return root_; }

  Place place_of(const YAML::Mark& mark) const {
    if (is_override_ || mark.is_null()) return {source_, 0, 0};
    return {source_, mark.line + 1, mark.column + 1};
  }

  void OnDocumentStart(const YAML::Mark&) override {}
  void OnDocumentEnd() override {}

  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    finish(std::make_shared<YamlNode>(YamlNode{YamlNode::Kind::null, place_of(mark), false, "", {}, {}}),
           anchor);
  }
  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                const std::string& value) override {
    check_tag(mark, tag);
    for (std::size_t i = 0; i < value.size(); i += utf8_length(value, i))  // escapes can say any character
      if (utf8_length(value, i) == 0 || is_control(value, i))
        throw DeckError(place_of(mark), "the text holds a control character; text without them is accepted");
    auto node = std::make_shared<YamlNode>();
    node->kind = YamlNode::Kind::scalar;
    node->place = place_of(mark);
    node->quoted = tag == "!";
    node->text = value;
    finish(node, anchor);
  }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    const auto found = anchored_.find(anchor);
    if (found == anchored_.end())
      throw DeckError(place_of(mark), "an alias stands inside of what it repeats");
    attach(found->second, place_of(mark));
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value) override {
    open(mark, tag, anchor, YamlNode::Kind::sequence);
  }
  void OnSequenceEnd() override { close(); }
  void OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value) override {
    open(mark, tag, anchor, YamlNode::Kind::map);
  }
  void OnMapEnd() override {
    merge(*open_.back().node);
    close();
  }

 private:
  struct OpenNode {
    std::shared_ptr<YamlNode> node;
    YAML::anchor_t anchor;
    bool key_is_pending = false;
    std::string key;
    Place key_place;
    std::unordered_set<std::string> keys;  ///< of a map so far
  };

  void check_tag(const YAML::Mark& mark, const std::string& tag) const {
    if (tag.empty() || tag == "?" || tag == "!") return;
    throw DeckError(place_of(mark), "the tag '" + tag + "' is not accepted; write the value alone");
  }

  void open(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor, YamlNode::Kind kind) {
    check_tag(mark, tag);
    auto node = std::make_shared<YamlNode>();
    node->kind = kind;
    node->place = place_of(mark);
    open_.push_back({std::move(node), anchor, false, {}, {}, {}});
  }
  void close() {
    const OpenNode done = std::move(open_.back());
    open_.pop_back();
    finish(done.node, done.anchor);
  }
  void finish(const std::shared_ptr<YamlNode>& node, YAML::anchor_t anchor) {
    if (anchor != 0) anchored_[anchor] = node;
    attach(node, node->place);
  }

  void attach(const NodePointer& node, const Place& place) {
    if (open_.empty()) {
      root_ = node;
      return;
    }
    OpenNode& parent = open_.back();
    if (parent.node->is_sequence()) {
      parent.node->items.push_back(node);
    } else if (parent.key_is_pending) {
      parent.node->entries.push_back({std::move(parent.key), parent.key_place, node});
      parent.key_is_pending = false;
    } else {
      start_entry(parent, *node, place);
    }
  }

  static void start_entry(OpenNode& parent, const YamlNode& key, const Place& place) {
    if (!key.is_scalar()) throw DeckError(place, "a key is " + describe(key) + "; keys are words");
    if (!parent.keys.insert(key.text).second)
      throw DeckError(place, "duplicate key '" + key.text + "'; it stands already at " +
                                 to_string(parent.node->find(key.text)->place));
    parent.key = key.text;
    parent.key_place = place;
    parent.key_is_pending = true;
  }

  /// Replaces a key `<<` by the entries of its map (or maps) that are not named beside it.
  static void merge(YamlNode& map) {
    const auto found = std::find_if(map.entries.begin(), map.entries.end(),
                                    [](const YamlEntry& entry) { return entry.key == "<<"; });
    if (found == map.entries.end()) return;
    const YamlEntry merged = *found;
    map.entries.erase(found);
    std::unordered_set<std::string> named;
    for (const YamlEntry& entry : map.entries) named.insert(entry.key);
    const auto add = [&](const YamlNode& other) {
      if (!other.is_map())
        throw DeckError(merged.place, "'<<' takes a map or a list of maps, not " + describe(other));
      for (const YamlEntry& entry : other.entries)
        if (named.insert(entry.key).second) map.entries.push_back(entry);
    };
    if (merged.value->is_sequence()) {
      for (const NodePointer& item : merged.value->items) add(*item);
    } else {
      add(*merged.value);
    }
  }

  std::shared_ptr<const std::string> source_;
  bool is_override_;
  NodePointer root_;
  std::vector<OpenNode> open_;
  std::map<YAML::anchor_t, NodePointer> anchored_;
};

void check_is_text(const std::string& text, const TreeBuilder& builder) {
  YAML::Mark mark;
  for (std::size_t i = 0; i < text.size();) {
    const auto byte = static_cast<unsigned char>(text[i]);
    const std::size_t length = utf8_length(text, i);
    if (length == 0 || is_control(text, i))
      throw DeckError(builder.place_of(mark), "not a text file; a deck is YAML in UTF-8");
    i += length;
    ++mark.column;
    if (byte == '\n') {
      ++mark.line;
      mark.column = 0;
    }
  }
}

/// \param line counted from 0
bool starts_with_tab(const std::string& text, int line) {
  std::size_t start = 0;
  for (int i = 0; i < line && start != std::string::npos; ++i) {
    start = text.find('\n', start);
    if (start != std::string::npos) ++start;
  }
  if (start == std::string::npos) return false;
  const std::size_t first = text.find_first_not_of(' ', start);
  return first != std::string::npos && text[first] == '\t';
}

}  // namespace

std::string to_string(const Place& place) {
  std::string source = place.source ? *place.source : std::string("deck");
  if (place.line == 0) return source;
  return source + ":" + std::to_string(place.line) + ":" + std::to_string(place.column);
}

const YamlEntry* YamlNode::find(std::string_view key) const {
  for (const YamlEntry& entry : entries)
    if (entry.key == key) return &entry;
  return nullptr;
}

std::string describe(const YamlNode& node) {
  switch (node.kind) {
    case YamlNode::Kind::null:
      return "nothing";
    case YamlNode::Kind::sequence:
      return "a list";
    case YamlNode::Kind::map:
      return "a map";
    case YamlNode::Kind::scalar:
      break;
  }
  constexpr std::size_t longest = 60;
  const std::string shown = node.text.size() > longest ? node.text.substr(0, longest) + "..." : node.text;
  return node.quoted ? "the text \"" + shown + "\"" : "'" + shown + "'";
}

std::string read_text_file(const std::string& path) {
  if (!is_printable(std::filesystem::path(path).filename().string()))
    throw DeckError(as_utf8(path) +
                    ": the name of the file is not UTF-8 or holds control characters; results bear it");
  std::error_code failure;
  if (std::filesystem::is_directory(path, failure))
    throw DeckError(path + ": is a folder; a deck is a YAML file");
  std::ifstream file(path, std::ios::binary);
  if (!file) throw DeckError(path + ": cannot be opened: " + std::strerror(errno));
  std::string text;
  std::string piece(std::size_t{1} << 16, '\0');
  while (file.read(piece.data(), static_cast<std::streamsize>(piece.size())) || file.gcount() > 0) {
    text.append(piece, 0, index(file.gcount()));
    if (text.size() > largest_deck)
      throw DeckError(path + ": is too long for a deck; at most 256 MiB are read");
  }
  return text;
}

std::shared_ptr<const YamlNode> parse_yaml(const std::string& text, const std::string& name,
                                           bool is_override) {
  TreeBuilder builder(name, is_override);
  check_is_text(text, builder);
  std::istringstream stream(text);
  try {
    YAML::Parser parser(stream);
    if (!parser.HandleNextDocument(builder) || builder.root() == nullptr) {
      auto nothing = std::make_shared<YamlNode>();
      nothing->place = builder.place_of(YAML::Mark());
      return nothing;
    }
    TreeBuilder second(name, is_override);
    if (parser.HandleNextDocument(second))
      throw DeckError(second.root() ? second.root()->place : Place{},
                      "a second document; a deck is one document");
  } catch (const YAML::Exception& fault) {
    std::string message = "not valid YAML: " + fault.msg;
    if (starts_with_tab(text, fault.mark.line))
      message += "; the line starts with a tab, spaces are accepted";
    throw DeckError(builder.place_of(fault.mark), message);
  }
  return builder.root();
}

}  // namespace brio
