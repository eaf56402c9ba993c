#pragma once
/// What a scene is likely to get wrong, found before it runs. Only what is worth a look: a scene that is well
/// made has none.

#include <span>
#include <string>
#include <vector>

#include "src/model/model.hpp"

namespace brio {

struct SceneWarning {
  std::string subject;  ///< a part, a material, a key of the deck
  std::string what;
  std::string advice;
};

/// \pre the first step of the model is known
std::vector<SceneWarning> scene_warnings(const Deck& deck, const Model& model);

}  // namespace brio
