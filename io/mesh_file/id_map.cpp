#include "io/mesh_file/id_map.hpp"

#include <algorithm>

#include "src/base/index.hpp"

namespace brio {

namespace {

/// A table may have so many entries for each that is used.
constexpr std::uint64_t sparse = 4;

}  // namespace

IdMap::IdMap(std::span<const std::int64_t> ids) {
  if (ids.empty()) return;
  const auto note = [&](int place) { repeated_ = repeated_ < 0 ? place : std::min(repeated_, place); };
  const auto [least, largest] = std::minmax_element(ids.begin(), ids.end());
  least_ = *least;
  const std::uint64_t span = static_cast<std::uint64_t>(*largest) - static_cast<std::uint64_t>(*least);
  if (span / sparse < ids.size()) {
    table_.assign(span + 1, -1);
    for (std::size_t i = 0; i < ids.size(); ++i) {
      int& entry = table_[index(ids[i] - least_)];
      if (entry >= 0)
        note(static_cast<int>(i));
      else
        entry = static_cast<int>(i);
    }
    return;
  }
  for (std::size_t i = 0; i < ids.size(); ++i) sorted_.emplace_back(ids[i], static_cast<int>(i));
  std::sort(sorted_.begin(), sorted_.end());
  for (std::size_t i = 1; i < sorted_.size(); ++i)
    if (sorted_[i].first == sorted_[i - 1].first) note(sorted_[i].second);
}

int IdMap::find(std::int64_t id) const {
  if (!table_.empty()) {
    const std::uint64_t place = static_cast<std::uint64_t>(id) - static_cast<std::uint64_t>(least_);
    return id >= least_ && place < table_.size() ? table_[index(place)] : -1;
  }
  const auto found = std::lower_bound(sorted_.begin(), sorted_.end(), std::pair(id, 0));
  return found != sorted_.end() && found->first == id ? found->second : -1;
}

}  // namespace brio
