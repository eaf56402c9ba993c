#include "io/deck/read_fields.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

#include "io/deck/condition_words.hpp"
#include "src/deck/part_index.hpp"

namespace brio {

namespace {

bool looks_like_a_number(std::string_view text) {
  return !text.empty() && text.find_first_not_of("+-.0123456789eE") == std::string_view::npos &&
         text.find_first_of("0123456789") != std::string_view::npos;
}

bool is_infinity_or_nan(std::string_view text) {
  if (!text.empty() && (text.front() == '+' || text.front() == '-')) text.remove_prefix(1);
  if (!text.empty() && text.front() == '.') text.remove_prefix(1);
  for (const std::string_view word : {"inf", "nan", "infinity"})
    if (edit_distance(text, word) == 0) return true;
  return false;
}

/// A finite number of any locale: from_chars knows none. In quotes: an expression.
double number(const YamlNode& node, const Slot& slot, std::string_view noun) {
  const std::string wanted = accepted_numbers(slot.range, noun);
  if (!node.is_scalar()) refuse(node, slot, wanted);
  if (node.quoted) return constant_of(node, slot);
  if (is_infinity_or_nan(node.text)) refuse(node, slot, wanted + " that is finite");
  std::string_view text = node.text;
  if (!looks_like_a_number(text)) refuse(node, slot, wanted + ", or an expression in quotes");
  if (text.front() == '+') text.remove_prefix(1);
  double value = 0;
  const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (end != text.data() + text.size() || fault == std::errc::invalid_argument) refuse(node, slot, wanted);
  if (fault == std::errc::result_out_of_range)
    refuse(node, slot, wanted + " whose size is 0 or from 1e-307 to 1e308");
  return value;
}

/// Says what an expression comes to.
[[noreturn]] void refuse_number(const YamlNode& node, const Slot& slot, double value,
                                const std::string& wanted) {
  if (!node.quoted) refuse(node, slot, wanted);
  throw DeckError(node.place,
                  fmt::format("'{}' is {} = {}; expected {}", slot.key, describe(node), value, wanted));
}

}  // namespace

std::string range_text(const Range& range) {
  const bool has_lower = std::isfinite(range.lower);
  const bool has_upper = std::isfinite(range.upper);
  std::string text;
  if (has_lower) text = fmt::format("{} {}", range.lower_open ? ">" : ">=", range.lower);
  if (has_lower && has_upper) text += " and ";
  if (has_upper) text += fmt::format("{} {}", range.upper_open ? "<" : "<=", range.upper);
  return text;
}

std::string accepted_numbers(const Range& range, std::string_view noun) {
  const std::string limits = range_text(range);
  return std::string(noun) + (limits.empty() ? "" : " " + limits);
}

void refuse(const YamlNode& node, const Slot& slot, const std::string& wanted) {
  throw DeckError(node.place,
                  "'" + std::string(slot.key) + "' is " + describe(node) + "; expected " + wanted);
}

void require_map(const YamlNode& node, const Slot& slot) {
  if (!node.is_map()) refuse(node, slot, "a map of keys and values");
}

void check_name(const YamlEntry& entry, std::string_view kind) {
  if (!entry.key.empty() && entry.key.find_first_not_of(name_letters) == std::string::npos) return;
  throw DeckError(entry.place, "'" + entry.key + "' cannot be a name in '" + std::string(kind) +
                                   "'; accepted are letters, digits, _ and -");
}

void check_key(const YamlEntry& entry, const std::vector<std::string_view>& accepted) {
  if (std::find(accepted.begin(), accepted.end(), entry.key) == accepted.end())
    throw DeckError(entry.place, "unknown key '" + entry.key + "'; " + accepted_words(entry.key, accepted));
}

void check_keys(const YamlNode& map, const std::vector<std::string_view>& accepted) {
  for (const YamlEntry& entry : map.entries) check_key(entry, accepted);
}

EntryReader::EntryReader(const YamlNode& map, const Slot& slot, const std::vector<std::string_view>& accepted)
    : map_(map), slot_(slot) {
  require_map(map, slot);
  for (const YamlEntry& entry : map.entries)
    complete_ &= slot.known.attempt("", [&] { check_key(entry, accepted); });
  knows_all_keys_ = complete_;
}

void EntryReader::read(const Slot& slot, bool is_required, std::string_view meaning, void* value,
                       Read read_entry) {
  const YamlEntry* entry = map_.find(slot.key);
  if (entry == nullptr && !(is_required && knows_all_keys_)) return;
  complete_ &= slot.known.attempt("", [&] {
    if (entry == nullptr)
      throw DeckError(map_.place, "'" + std::string(slot_.key) + "' has no '" + std::string(slot.key) +
                                      "'; it is required: " + std::string(meaning));
    if (entry->value->is_null())
      throw DeckError(entry->place,
                      "'" + std::string(slot.key) + "' has no value; expected: " + std::string(meaning));
    read_entry(*entry->value, slot, value);
  });
}

void EntryReader::finish() const {
  if (!complete_) throw FaultsTold{};
}

void read_value(const YamlNode& node, const Slot& slot, double& value) {
  value = number(node, slot, "a number");
  if (!slot.range.contains(value)) refuse_number(node, slot, value, accepted_numbers(slot.range, "a number"));
}

void read_value(const YamlNode& node, const Slot& slot, int& value) {
  const std::string wanted = accepted_numbers(slot.range, "an integer");
  const double read = number(node, slot, "an integer");
  if (read != std::floor(read) || !slot.range.contains(read)) refuse_number(node, slot, read, wanted);
  if (std::abs(read) > std::numeric_limits<int>::max())
    refuse_number(node, slot, read, wanted + fmt::format(" of at most {}", std::numeric_limits<int>::max()));
  value = static_cast<int>(read);
}

void read_value(const YamlNode& node, const Slot& slot, bool& value) {
  if (!node.is_scalar() || node.quoted || (node.text != "true" && node.text != "false"))
    refuse(node, slot, "true or false");
  value = node.text == "true";
}

void read_value(const YamlNode& node, const Slot& slot, std::string& value) {
  if (!node.is_scalar()) refuse(node, slot, "a text");
  value = node.text;
}

bool KnownNames::attempt(std::string_view name, const std::function<void()>& read) const {
  if (faults_ != nullptr) return faults_->attempt(name, read);
  read();
  return true;
}

void KnownNames::expect_read(std::string_view name) const {
  if (faults_ != nullptr && faults_->concerns(name)) throw FaultsTold{};
}

void KnownNames::expect_complete(bool is_complete) const {
  if (!is_complete && faults_ != nullptr && !faults_->empty()) throw FaultsTold{};
}

const Part& KnownNames::part(const YamlNode& node, std::string_view name) const {
  expect_read(name);
  if (parts_.size() != deck_.parts.size()) {
    parts_.clear();
    for (const Part& part : deck_.parts) parts_[part.name] = &part;
  }
  if (const auto found = parts_.find(name); found != parts_.end()) return *found->second;
  expect_complete(!deck_.parts.empty());
  std::vector<std::string_view> names;
  for (const Part& part : deck_.parts) names.push_back(part.name);
  throw DeckError(node.place,
                  "no part is called '" + std::string(name) + "'; " + accepted_words(name, names));
}

double KnownNames::end_time() const {
  const YamlEntry* time = root_.find("time");
  const YamlEntry* end = time != nullptr && time->value->is_map() ? time->value->find("end") : nullptr;
  if (end == nullptr) return 1;  // refused when the section is read
  double value = 0;
  read_value(*end->value, Slot{"end", positive, *this}, value);
  return value;
}

std::vector<const Part*> KnownNames::parts_called(const YamlNode& node, std::string_view name) const {
  expect_read(name);
  std::vector<const Part*> parts;
  for (const std::size_t p : brio::parts_called(name, deck_)) {
    expect_read(deck_.parts[p].name);
    parts.push_back(&deck_.parts[p]);
  }
  if (!parts.empty()) return parts;
  for (const MeshFile& file : deck_.meshes)
    if (file.name == name)
      throw DeckError(node.place, "no part is of the mesh file '" + std::string(name) + "'");
  return {&part(node, name)};
}

const MeshFile& KnownNames::mesh_file(const YamlNode& node) const {
  expect_read(node.text);
  std::vector<std::string_view> names;
  for (const MeshFile& file : deck_.meshes) {
    if (file.name == node.text) return file;
    names.push_back(file.name);
  }
  expect_complete(!names.empty());
  throw DeckError(node.place, "no mesh file is called '" + node.text + "' in 'meshes'; " +
                                  accepted_words(node.text, names));
}

template <class T>
const T& KnownNames::named(const YamlNode& node, const std::vector<std::pair<std::string, T>>& entries,
                           std::string_view what) const {
  expect_read(node.text);
  std::vector<std::string_view> names;
  for (const auto& [name, entry] : entries) {
    if (name == node.text) return entry;
    names.push_back(name);
  }
  expect_complete(!names.empty());
  throw DeckError(node.place,
                  fmt::format("no {} is called '{}'; {}", what, node.text, accepted_words(node.text, names)));
}

const Material& KnownNames::material(const YamlNode& node) const {
  return named(node, deck_.materials, "material");
}

const CoordinateSystem& KnownNames::coordinate_system(const YamlNode& node) const {
  if (deck_.coordinate_systems.empty() && root_.find("coordinate_systems") == nullptr)
    throw DeckError(node.place,
                    "'" + node.text +
                        "' is no coordinate system: the deck has no 'coordinate_systems', a map of "
                        "names to systems such as {ramp: {rectangular: {x: [1, 0, 1], y: [0, 1, 0]}}}");
  return named(node, deck_.coordinate_systems, "coordinate system");
}

}  // namespace brio
