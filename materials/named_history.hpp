#pragma once
/// Names for the history of a law. What is named can be written as a field of cells, of any element, and
/// ends in ElementSample under its name.
///
///     static constexpr auto named_history() {
///       return field_table(largest("equivalent_plastic_strain",
///       &History<double>::equivalent_plastic_strain),
///                          mean("temperature", &JohnsonCook::temperature));
///     }
///
/// A value is a number of the history, or a function of the law: double temperature(const History<double>&)
/// const.

#include <algorithm>
#include <array>
#include <functional>
#include <string_view>
#include <type_traits>

namespace brio {

/// How the values at the points of an element make that of the element.
enum class OverPoints { largest, mean };

template <class Value>
struct NamedHistory {
  std::string_view name;  ///< snake_case
  Value value;
  OverPoints over;
};
template <class Value>
constexpr NamedHistory<Value> largest(std::string_view name, Value value) {
  return {name, value, OverPoints::largest};
}
template <class Value>
constexpr NamedHistory<Value> mean(std::string_view name, Value value) {
  return {name, value, OverPoints::mean};
}

/// Names of a law, in the order of its table.
template <class Law>
constexpr std::size_t count_history() {
  std::size_t count = 0;
  if constexpr (Law::traits.named_history) Law::named_history()([&](const auto&) { ++count; });
  return count;
}
template <class Law>
inline constexpr auto history_names = [] {
  std::array<std::string_view, count_history<Law>()> names{};
  std::size_t next = 0;
  if constexpr (Law::traits.named_history)
    Law::named_history()([&](const auto& row) { names[next++] = row.name; });
  return names;
}();

/// The value of a row for the `count` points of an element, each with a `history`.
template <class Law, class Value, class Point>
double history_value(const Law& law, const NamedHistory<Value>& row, const Point* point, std::size_t count) {
  double largest = 0, sum = 0;
  for (std::size_t p = 0; p < count; ++p) {
    double value;
    if constexpr (std::is_member_object_pointer_v<Value>) {
      value = std::invoke(row.value, point[p].history);
    } else {
      value = std::invoke(row.value, law, point[p].history);
    }
    largest = p == 0 ? value : std::max(largest, value);
    sum += value;
  }
  return row.over == OverPoints::largest ? largest : sum / static_cast<double>(count);
}

}  // namespace brio
