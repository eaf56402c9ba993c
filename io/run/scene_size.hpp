#pragma once
/// How large a scene is, told from its deck before anything of it is made.

#include "src/deck/deck.hpp"

namespace brio {

/// \throws DeckError naming the largest part, where the scene has more nodes than can be numbered or wants
/// more memory than there is: how much, and how much there is.
void check_scene_size(const Deck& deck);

/// For a scene for which the system had no memory, whatever was expected.
[[noreturn]] void refuse_memory(const Deck& deck);

/// Memory that a scene takes at its peak, nearly: while it is built, in MB.
double memory_of_scene_mb(const Deck& deck);

}  // namespace brio
