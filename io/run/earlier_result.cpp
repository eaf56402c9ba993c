#include "io/run/earlier_result.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "io/files/hdf5_file.hpp"
#include "io/files/read_apart.hpp"
#include "io/results/read_info.hpp"

namespace brio {

namespace {

using NodePointer = std::shared_ptr<const YamlNode>;

/// A dump stands at the first step after the time for which it was asked: within this share of the interval
/// to the dumps beside it.
constexpr double same_time = 0.05;

/// The word of a thing that stands alone or under a key.
std::string word_of(const NodePointer& node, const std::string& key) {
  if (node && node->is_scalar()) return node->text;
  const NodePointer value = value_in(node, key);
  return value && value->is_scalar() ? value->text : "";
}

const std::filesystem::path& verified(const std::filesystem::path& path) {
  if (!std::filesystem::is_regular_file(path)) throw FileError(path, "there is no such file");
  read_apart(path, [&] { return verify_result(path); });
  return path;
}

}  // namespace

NodePointer value_in(const NodePointer& map, const std::string& key) {
  const YamlEntry* entry = map && map->is_map() ? map->find(key) : nullptr;
  return entry == nullptr ? nullptr : entry->value;
}

EarlierResult::EarlierResult(const std::filesystem::path& path)
    : path_(path), reader_(verified(path)), record_(read_record(Hdf5File::open_to_read(path))) {
  deck_ = parse_yaml(record_.deck_text, path.string());
}

std::size_t EarlierResult::dump_at(const std::optional<double>& time) const {
  if (!time) return reader_.times().size() - 1;
  const std::size_t dump = reader_.dump_at(*time);
  if (std::abs(reader_.times()[dump] - *time) > same_time * interval_at(dump))
    throw FileError(path_, fmt::format("has no dump at time {:g}; the nearest is at {:.9g}", *time,
                                       reader_.times()[dump]));
  return dump;
}

double EarlierResult::interval_at(std::size_t dump) const {
  const std::vector<double>& times = reader_.times();
  double interval = times.size() > 1 ? HUGE_VAL : times.front();
  if (dump > 0) interval = times[dump] - times[dump - 1];
  if (dump + 1 < times.size()) interval = std::min(interval, times[dump + 1] - times[dump]);
  return interval;
}

std::int64_t EarlierResult::part(const std::string& name) const {
  const NodePointer parts = value_in(deck_, "parts");
  std::string names;
  for (std::size_t p = 0; parts && p < parts->entries.size(); ++p) {
    if (parts->entries[p].key == name) return static_cast<std::int64_t>(p);
    names += (names.empty() ? "" : ", ") + parts->entries[p].key;
  }
  throw FileError(path_, "has no part '" + name + "'; accepted: " + names);
}

NodePointer EarlierResult::deck_of(const std::string& part) const {
  return value_in(value_in(deck_, "parts"), part);
}

std::string EarlierResult::element(const std::string& part) const {
  return word_of(value_in(deck_of(part), "element"), "type");
}

std::string EarlierResult::model(const std::string& part) const {
  const std::string material = word_of(value_in(deck_of(part), "material"), "");
  return word_of(value_in(value_in(deck_, "materials"), material), "model");
}

bool EarlierResult::holds(const std::string& field) const {
  const Hdf5File file = Hdf5File::open_to_read(path_);
  return file.contains("/VTKHDF/PointData/" + field) || file.contains("/VTKHDF/CellData/" + field);
}

}  // namespace brio
