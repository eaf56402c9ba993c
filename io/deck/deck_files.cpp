#include "io/deck/deck_files.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <filesystem>
#include <unordered_map>
#include <vector>

#include "io/yaml/closest_word.hpp"

namespace brio {

namespace {

using NodePointer = std::shared_ptr<const YamlNode>;

/// One field of a line, and its column, from 1.
struct Field {
  std::string text;
  int column;
};

std::vector<Field> fields_of(std::string_view line) {
  line = line.substr(0, line.find('#'));
  const bool has_marks = line.find_first_of(",;") != std::string_view::npos;
  const std::string_view marks = has_marks ? ",;" : " \t";
  constexpr std::string_view blanks = " \t\r\"";
  std::vector<Field> fields;
  for (std::size_t start = 0; start <= line.size();) {
    const std::size_t end = std::min(line.find_first_of(marks, start), line.size());
    const std::string_view field = line.substr(start, end - start);
    const std::size_t first = field.find_first_not_of(blanks);
    if (first != std::string_view::npos) {
      const std::size_t last = field.find_last_not_of(blanks);
      fields.push_back(
          {std::string(field.substr(first, last + 1 - first)), static_cast<int>(start + first) + 1});
    } else if (has_marks && end < line.size()) {
      fields.push_back({"", static_cast<int>(start) + 1});
    }
    start = end + 1;
  }
  return fields;
}

bool is_number(const std::string& text) {
  double value = 0;
  const char* begin = text.data() + (!text.empty() && text.front() == '+' ? 1 : 0);
  const auto [end, fault] = std::from_chars(begin, text.data() + text.size(), value);
  return fault != std::errc::invalid_argument && end == text.data() + text.size();
}

/// A row of names is one without a number.
bool is_header(const std::vector<Field>& fields) {
  return std::none_of(fields.begin(), fields.end(), [](const Field& field) { return is_number(field.text); });
}

NodePointer scalar(const Place& place, const std::string& text) {
  auto node = std::make_shared<YamlNode>();
  node->kind = YamlNode::Kind::scalar;
  node->place = place;
  node->text = text;
  return node;
}

/// A column by its number, from 1, or its name.
std::size_t column_of(const YamlNode& node, const std::vector<Field>& header) {
  std::size_t number = 0;
  const char* last = node.text.data() + node.text.size();
  const auto [end, fault] = std::from_chars(node.text.data(), last, number);
  if (node.is_scalar() && fault == std::errc() && end == last && number > 0) return number - 1;
  std::vector<std::string_view> names;
  for (std::size_t i = 0; i < header.size(); ++i) {
    if (node.is_scalar() && header[i].text == node.text) return i;
    names.push_back(header[i].text);
  }
  throw DeckError(node.place, "'columns' names " + describe(node) +
                                  "; accepted is the number of a column, from 1" +
                                  (names.empty() ? "" : ", or a name: " + accepted_words(node.text, names)));
}

/// Rows of two columns of a file.
class TableReader {
 public:
  TableReader(const YamlNode& file, const YamlEntry* columns, const std::string& path)
      : file_(file), columns_(columns), path_(path), source_(std::make_shared<const std::string>(path)) {}

  NodePointer read() {
    const std::string text = text_of_file();
    table_->kind = YamlNode::Kind::sequence;
    table_->place = {source_, 1, 1};
    int line = 0;
    bool is_first = true;
    for (std::size_t start = 0; start < text.size();) {
      const std::size_t end = std::min(text.find('\n', start), text.size());
      const std::vector<Field> fields = fields_of(std::string_view(text).substr(start, end - start));
      start = end + 1;
      ++line;
      if (fields.empty()) continue;
      const bool names = is_first && is_header(fields);
      if (is_first) choose_columns(names ? fields : std::vector<Field>());
      if (!names) add_row(fields, line);
      is_first = false;
    }
    if (table_->items.empty())
      throw DeckError(file_.place, "'" + path_ + "' has no rows; accepted are rows of two numbers");
    return table_;
  }

 private:
  std::string text_of_file() const {
    std::error_code failure;
    if (!std::filesystem::exists(path_, failure))
      throw DeckError(file_.place,
                      "there is no file '" + path_ + "'; a path is relative to the file in which it stands");
    return read_text_file(path_);
  }

  void choose_columns(const std::vector<Field>& header) {
    if (columns_ == nullptr) return;
    const YamlNode& list = *columns_->value;
    if (!list.is_sequence() || list.items.size() != 2)
      throw DeckError(list.place, "'columns' is " + describe(list) + "; expected a list of 2 columns");
    for (std::size_t i = 0; i < 2; ++i) column_[i] = column_of(*list.items[i], header);
  }

  void add_row(const std::vector<Field>& fields, int line) {
    auto row = std::make_shared<YamlNode>();
    row->kind = YamlNode::Kind::sequence;
    row->place = {source_, line, fields.front().column};
    for (const std::size_t column : column_) {
      if (column >= fields.size())
        throw DeckError(row->place, "the row has " + std::to_string(fields.size()) + " columns; column " +
                                        std::to_string(column + 1) + " is expected");
      row->items.push_back(scalar({source_, line, fields[column].column}, fields[column].text));
    }
    table_->items.push_back(std::move(row));
  }

  const YamlNode& file_;
  const YamlEntry* columns_;
  std::string path_;
  std::shared_ptr<const std::string> source_;
  std::array<std::size_t, 2> column_{0, 1};
  std::shared_ptr<YamlNode> table_ = std::make_shared<YamlNode>();
};

/// The node that names a file of a table, or null.
const YamlNode* file_of_table(const YamlNode& node) {
  if (!node.is_map()) return nullptr;
  const YamlEntry* file = node.find("file");
  if (file == nullptr || !file->value->is_scalar() || !file->value->text.ends_with(".csv")) return nullptr;
  for (const YamlEntry& entry : node.entries)
    if (entry.key != "file" && entry.key != "columns")
      throw DeckError(entry.place, "unknown key '" + entry.key + "' beside the file of a table; " +
                                       accepted_words(entry.key, {"file", "columns"}));
  return file->value.get();
}

}  // namespace

std::string path_from(const Place& place, const std::string& deck_file, const std::string& path) {
  const std::filesystem::path given(path);
  if (given.is_absolute()) return path;
  const std::string& file = place.line > 0 && place.source ? *place.source : deck_file;
  return (std::filesystem::path(file).parent_path() / given).lexically_normal().string();
}

namespace {

/// Puts the rows of files in place of their names. Nodes that aliases share are visited once: their number
/// can be exponential in that of the lines.
class TablePlacer {
 public:
  explicit TablePlacer(const std::string& deck_file) : deck_file_(deck_file) {}

  NodePointer place(const NodePointer& node) {
    if (const auto known = placed_.find(node.get()); known != placed_.end()) return known->second;
    const NodePointer result = place_new(node);
    placed_.emplace(node.get(), result);
    return result;
  }

 private:
  NodePointer place_new(const NodePointer& node) {
    if (const YamlNode* file = file_of_table(*node))
      return TableReader(*file, node->find("columns"), path_from(file->place, deck_file_, file->text)).read();
    std::shared_ptr<YamlNode> changed;
    const auto replace = [&](const NodePointer& old, const auto& place_in) {
      const NodePointer now = place(old);
      if (now == old) return;
      if (!changed) changed = std::make_shared<YamlNode>(*node);
      place_in(*changed) = now;
    };
    for (std::size_t i = 0; i < node->items.size(); ++i)
      replace(node->items[i], [i](YamlNode& copy) -> NodePointer& { return copy.items[i]; });
    for (std::size_t i = 0; i < node->entries.size(); ++i)
      replace(node->entries[i].value, [i](YamlNode& copy) -> NodePointer& { return copy.entries[i].value; });
    if (changed) return changed;
    return node;
  }

  const std::string& deck_file_;
  std::unordered_map<const YamlNode*, NodePointer> placed_;
};

}  // namespace

NodePointer with_tables(const NodePointer& root, const std::string& deck_file) {
  return TablePlacer(deck_file).place(root);
}

namespace {

/// Deeper than includes of includes are; a circle is found before.
constexpr int deepest_include = 16;

NodePointer with_included(const NodePointer& root, const std::string& deck_file, int depth);

NodePointer read_included(const YamlNode& name, const std::string& deck_file, int depth) {
  if (!name.is_scalar())
    throw DeckError(name.place, "'include' names " + describe(name) + "; paths are accepted");
  const std::string path = path_from(name.place, deck_file, name.text);
  if (depth > deepest_include)
    throw DeckError(name.place, "'" + path + "' is included by itself, or by more than " +
                                    std::to_string(deepest_include) + " files one in another");
  std::error_code failure;
  if (!std::filesystem::exists(path, failure))
    throw DeckError(name.place,
                    "there is no file '" + path + "'; a path is relative to the file in which it stands");
  const NodePointer tree = parse_yaml(read_text_file(path), path);
  if (!tree->is_map())
    throw DeckError(name.place,
                    "'" + path + "' is " + describe(*tree) + "; a map of keys of a deck is accepted");
  return with_included(tree, deck_file, depth);
}

[[noreturn]] void refuse_second(const YamlEntry& second, const YamlEntry& first) {
  throw DeckError(second.place,
                  "duplicate key '" + second.key + "'; it stands already at " + to_string(first.place));
}

/// A section of both: entries of maps and items of lists, those of the included file first.
NodePointer both_of(const YamlEntry& included, const YamlEntry& own) {
  if (included.value->kind != own.value->kind || included.value->is_scalar() || included.value->is_null())
    refuse_second(own, included);
  auto sum = std::make_shared<YamlNode>(*own.value);
  sum->items.insert(sum->items.begin(), included.value->items.begin(), included.value->items.end());
  for (const YamlEntry& entry : own.value->entries)
    if (const YamlEntry* other = included.value->find(entry.key)) refuse_second(entry, *other);
  sum->entries.insert(sum->entries.begin(), included.value->entries.begin(), included.value->entries.end());
  return sum;
}

NodePointer with_included(const NodePointer& root, const std::string& deck_file, int depth) {
  const YamlEntry* include = root->find("include");
  if (include == nullptr) return root;
  const YamlNode& names = *include->value;
  if (!names.is_sequence())
    throw DeckError(names.place, "'include' is " + describe(names) + "; expected a list of paths");
  auto sum = std::make_shared<YamlNode>(*root);
  std::erase_if(sum->entries, [](const YamlEntry& entry) { return entry.key == "include"; });
  for (std::size_t i = names.items.size(); i-- > 0;) {
    const NodePointer included = read_included(*names.items[i], deck_file, depth + 1);
    std::vector<YamlEntry> added;
    for (const YamlEntry& entry : included->entries) {
      const auto own = std::find_if(sum->entries.begin(), sum->entries.end(),
                                    [&](const YamlEntry& one) { return one.key == entry.key; });
      if (own != sum->entries.end()) {
        own->value = both_of(entry, *own);
      } else {
        added.push_back(entry);
      }
    }
    sum->entries.insert(sum->entries.begin(), added.begin(), added.end());
  }
  return sum;
}

}  // namespace

NodePointer with_includes(const NodePointer& root, const std::string& deck_file) {
  return with_included(root, deck_file, 0);
}

}  // namespace brio
