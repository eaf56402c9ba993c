#pragma once
/// Warnings of likely mistakes in a scene, before it runs. A well-made scene has none.

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
