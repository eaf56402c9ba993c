#pragma once
/// Features that a scene uses, the keys of the deck that ask for them, and their memory.

#include <cstddef>
#include <string>
#include <vector>

#include "src/model/model.hpp"

namespace brio {

struct BuiltFeature {
  std::string name;
  std::string because;  ///< keys of the deck
  std::string detail;
  std::size_t bytes = 0;  ///< 0: none of its own
};

/// In the order of the model. Copies what it measures, and ends the scenes of contact, which are large.
std::vector<BuiltFeature> built_features(const Deck& deck, Model&& model);

/// Names of features that are not built.
std::vector<std::string> features_not_built(const Model& model);

}  // namespace brio
