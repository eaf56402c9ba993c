#include "io/yaml/closest_word.hpp"

#include <algorithm>

namespace brio {

namespace {

/// Longer words than this are not compared: a deck's own words are shorter.
constexpr std::size_t longest_word = 64;
/// More words than this are not listed in a message.
constexpr std::size_t longest_list = 30;

char lower_case(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

}  // namespace

int edit_distance(std::string_view a, std::string_view b) {
  const std::size_t width = b.size() + 1;
  std::vector<int> row(width), last(width), before_last(width);
  for (std::size_t j = 0; j < width; ++j) row[j] = static_cast<int>(j);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::swap(before_last, last);
    std::swap(last, row);
    row[0] = static_cast<int>(i);
    for (std::size_t j = 1; j < width; ++j) {
      const bool same = lower_case(a[i - 1]) == lower_case(b[j - 1]);
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (same ? 0 : 1)});
      const bool swapped = i > 1 && j > 1 && lower_case(a[i - 1]) == lower_case(b[j - 2]) &&
                           lower_case(a[i - 2]) == lower_case(b[j - 1]);
      if (swapped) row[j] = std::min(row[j], before_last[j - 2] + 1);
    }
  }
  return row.back();
}

std::string_view closest_word(std::string_view word, const std::vector<std::string_view>& candidates) {
  if (word.size() > longest_word) return {};
  std::string_view best;
  // A third of the letters may be wrong; words of one letter resemble nothing.
  int smallest = 1 + static_cast<int>(word.size() + 1) / 3;
  for (const std::string_view candidate : candidates) {
    if (candidate.size() > longest_word) continue;
    const int distance = edit_distance(word, candidate);
    if (distance >= smallest || distance >= static_cast<int>(candidate.size())) continue;
    smallest = distance;
    best = candidate;
  }
  return best;
}

std::string accepted_words(std::string_view word, const std::vector<std::string_view>& accepted) {
  std::string text;
  if (const std::string_view meant = closest_word(word, accepted); !meant.empty())
    text = "did you mean '" + std::string(meant) + "'? ";
  if (accepted.empty()) return text + "none is accepted here";
  text += "accepted: ";
  for (std::size_t i = 0; i < std::min(accepted.size(), longest_list); ++i) {
    if (i != 0) text += ", ";
    text += accepted[i];
  }
  if (accepted.size() > longest_list)
    text += ", and " + std::to_string(accepted.size() - longest_list) + " more";
  return text;
}

}  // namespace brio
