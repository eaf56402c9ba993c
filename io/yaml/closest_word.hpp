#pragma once
/// What someone who misspelt a word may have meant.

#include <string>
#include <string_view>
#include <vector>

namespace brio {

/// Letters to insert, delete, replace or swap with their neighbour to make one word of the other; upper and
/// lower case are the same (optimal string alignment, Damerau 1964).
int edit_distance(std::string_view a, std::string_view b);

/// The candidate that resembles the word, or nothing.
std::string_view closest_word(std::string_view word, const std::vector<std::string_view>& candidates);

/// "did you mean 'x'? accepted: x, y, z": the right half of a message about a word that is not among the
/// accepted.
std::string accepted_words(std::string_view word, const std::vector<std::string_view>& accepted);

}  // namespace brio
