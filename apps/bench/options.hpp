#pragma once
/// Options of the benches of elements.

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <string>
#include <string_view>

namespace brio {

struct BenchOptions {
  int size;
  int repeats;
  bool csv = false;
  std::string only{};  ///< lines that hold these words, separated by commas

  /// True where every word stands in the line.
  bool wants(std::string_view line) const {
    std::string_view words = only;
    while (!words.empty()) {
      const std::size_t end = std::min(words.find(','), words.size());
      if (line.find(words.substr(0, end)) == std::string_view::npos) return false;
      words.remove_prefix(std::min(end + 1, words.size()));
    }
    return true;
  }
};

/// Ends the program with its usage where a word is none of the options. \param options defaults
inline BenchOptions bench_options(std::string_view program, BenchOptions options, int count, char** words) {
  for (int i = 1; i < count; ++i) {
    const std::string_view word = words[i];
    if (word == "--csv") {
      options.csv = true;
    } else if (word == "--size" && i + 1 < count) {
      options.size = std::max(1, std::atoi(words[++i]));
    } else if (word == "--repeats" && i + 1 < count) {
      options.repeats = std::max(1, std::atoi(words[++i]));
    } else if (word == "--only" && i + 1 < count) {
      options.only = words[++i];
    } else {
      fmt::print(stderr, "usage: {} [--size N] [--repeats R] [--only WORD,WORD] [--csv]\n", program);
      std::exit(2);
    }
  }
  return options;
}

}  // namespace brio
