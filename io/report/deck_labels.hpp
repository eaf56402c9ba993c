#pragma once
/// What the deck of a result says that its dumps do not: names and shapes of parts, units.

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace brio {

/// Of the parts in their order: `name`, and as far as the deck gives them as numbers `thickness` of shells,
/// `section` of beams (`kind` and its lengths) and `orientation`. Numbers of parts that the deck does not
/// have (a text that is no deck) are names. \param count of parts
nlohmann::json parts_of_deck(const std::string& deck_text, std::int64_t count);

/// Labels by quantity as the deck has them (`length`, `time` ...); empty where it has none.
nlohmann::json units_of_deck(const std::string& deck_text);

}  // namespace brio
