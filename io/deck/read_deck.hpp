#pragma once
/// The door for decks.

#include <string>
#include <vector>

#include "io/yaml/deck_error.hpp"
#include "src/deck/deck.hpp"

namespace brio {

/// A deck from a YAML file, fully checked.
/// \param overrides `KEY.PATH=VALUE` each, worked in before the deck is checked
/// \throws DeckError naming the place, what is wrong and what is accepted.
Deck read_deck(const std::string& path, const std::vector<std::string>& overrides = {});

/// The same from text, which messages call `name`.
Deck parse_deck(const std::string& text, const std::string& name,
                const std::vector<std::string>& overrides = {});

}  // namespace brio
