#pragma once
/// What may change in a deck when a saved run goes on.

#include <string>

namespace brio {

/// Compare two decks as they were run. What may differ are `title`, `units`, `output` and `time.end`.
/// \returns what else does, by its key path, with both values; empty where nothing does
std::string deck_difference(const std::string& saved, const std::string& now);

}  // namespace brio
