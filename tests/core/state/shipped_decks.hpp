#pragma once
/// Shipped decks in a coarse form, and the state of their runs.

#include <algorithm>
#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include "io/deck/read_deck.hpp"
#include "src/forecast/coarser.hpp"
#include "src/model/state.hpp"
#include "tests/core/scene.hpp"

namespace brio::test {

/// \param factor on the length of elements
inline Deck coarse_deck(const std::string& name, double factor) {
  return coarser(read_deck(std::filesystem::path(BRIO_SOURCE_DIR) / "inputs" / (name + ".yaml"), {}), factor);
}

/// All numbers of the state.
inline std::string state_of(const Model& model) {
  std::ostringstream out;
  save_state(model, out);
  return out.str();
}

/// Names of the decks in inputs/.
inline std::vector<std::string> shipped_decks() {
  std::vector<std::string> names;
  for (const auto& entry :
       std::filesystem::directory_iterator(std::filesystem::path(BRIO_SOURCE_DIR) / "inputs"))
    if (entry.path().extension() == ".yaml") names.push_back(entry.path().stem());
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace brio::test
