#pragma once
/// Columns of the history and keys of the summary, with what they mean: the writer and the manual read the
/// same tables.

#include <span>
#include <string_view>

namespace brio {

/// A column, or, with an ending for each axis, the three of a vector.
struct HistoryColumn {
  /// Capital letters stand for a name, of what the deck names: PART, SPRING ...; `_x` for all three axes.
  std::string_view name;
  std::string_view unit, meaning;
};
/// Written of every run, in this order.
std::span<const HistoryColumn> common_columns();
/// Written where the deck has such a thing, or asks for it.
std::span<const HistoryColumn> further_columns();

struct SummaryKey {
  std::string_view name;  ///< keys of maps inside of it are joined by points
  std::string_view unit, meaning;
};
std::span<const SummaryKey> summary_table();

}  // namespace brio
