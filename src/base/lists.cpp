#include "src/base/lists.hpp"

#include <algorithm>

#include "src/base/index.hpp"

namespace brio {

void Lists::loosen() {
  if (!end.empty() || first.empty()) return;
  end.assign(first.begin() + 1, first.end());
  first.pop_back();
  room.assign(end.begin(), end.end());
}

void Lists::add_list() {
  const int here = static_cast<int>(item.size());
  first.push_back(here);
  end.push_back(here);
  room.push_back(here);
}

void Lists::make_room(int list, std::size_t size) {
  const auto l = index(list);
  const auto begin = index(first[l]);
  if (begin + size <= index(room[l])) return;
  const auto length = index(end[l]) - begin;
  const std::size_t to = item.size();
  item.resize(to + size + size / 2 + 2);
  std::copy_n(item.begin() + first[l], length, item.begin() + static_cast<std::ptrdiff_t>(to));
  first[l] = static_cast<int>(to);
  end[l] = static_cast<int>(to + length);
  room[l] = static_cast<int>(item.size());
}

bool Lists::insert(int list, int value) {
  const auto values = of(list);
  const auto at = std::lower_bound(values.begin(), values.end(), value) - values.begin();
  if (at != std::ssize(values) && values[index(at)] == value) return false;
  make_room(list, values.size() + 1);
  const auto l = index(list);
  const auto place = item.begin() + first[l] + at;
  std::copy_backward(place, item.begin() + end[l], item.begin() + end[l] + 1);
  *place = value;
  ++end[l];
  return true;
}

bool Lists::erase(int list, int value) {
  const auto values = of(list);
  const auto at = std::lower_bound(values.begin(), values.end(), value) - values.begin();
  if (at == std::ssize(values) || values[index(at)] != value) return false;
  const auto l = index(list);
  std::copy(item.begin() + first[l] + at + 1, item.begin() + end[l], item.begin() + first[l] + at);
  --end[l];
  return true;
}

void Lists::assign(int list, std::span<const int> values) {
  const auto l = index(list);
  end[l] = first[l];
  make_room(list, values.size());
  std::copy(values.begin(), values.end(), item.begin() + first[l]);
  end[l] = first[l] + static_cast<int>(values.size());
}

}  // namespace brio
