#pragma once

#include <string_view>

namespace brio {

/// The deck that `brio new` writes: first_deck.yaml, in which NAME stands for the name of the deck.
extern const std::string_view first_deck;

}  // namespace brio
