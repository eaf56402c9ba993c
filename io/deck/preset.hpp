#pragma once
/// Presets: values for what a deck leaves open.

#include <memory>

#include "io/yaml/yaml_source.hpp"

namespace brio {

/// The deck with the settings of its `numerics.preset` worked in where it names none itself; the deck as it
/// is where it has no preset, or one that is not known.
std::shared_ptr<const YamlNode> with_preset(const std::shared_ptr<const YamlNode>& root);

}  // namespace brio
