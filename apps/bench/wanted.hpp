#pragma once
/// Which lines of a table a bench is asked for.

#include <algorithm>
#include <string_view>

namespace brio {

/// True where every comma-separated word stands in the line.
inline bool wanted(std::string_view words, std::string_view line) {
  while (!words.empty()) {
    const std::size_t end = std::min(words.find(','), words.size());
    if (line.find(words.substr(0, end)) == std::string_view::npos) return false;
    words.remove_prefix(std::min(end + 1, words.size()));
  }
  return true;
}

}  // namespace brio
