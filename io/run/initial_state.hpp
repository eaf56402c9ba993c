#pragma once
/// Reads the states that parts of a deck begin with from results of earlier runs, element by element and node
/// by node, by the numbers of elements.

#include <span>
#include <string>
#include <vector>

#include "src/deck/deck.hpp"
#include "src/deck/initial_state.hpp"
#include "src/deck/mesh.hpp"

namespace brio {

/// Whether any part begins with the state of an earlier result.
bool has_initial_state(const Deck& deck);

/// \param meshes one a part of the deck; those whose positions are taken are moved there
/// \throws DeckError with the place of the entry where a result is damaged, or does not hold what is asked
/// for
std::vector<PartState> read_initial_states(const Deck& deck, std::span<Mesh> meshes);

/// Name and checksum of each result, as of mesh files.
std::vector<std::string> checksums_of_results(const Deck& deck);

}  // namespace brio
