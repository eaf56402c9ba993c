#pragma once
/// Words of boundary conditions.

#include <array>
#include <string_view>
#include <utility>

#include "src/deck/deck.hpp"

namespace brio {

/// Components that a boundary condition can name, in the order of their axes.
inline constexpr std::array<std::string_view, 6> component_words{"x", "y", "z", "rx", "ry", "rz"};

/// Keys of a prescribed motion.
inline constexpr std::array<std::pair<std::string_view, MotionKind>, 3> motion_keys{
    {{"displacement", MotionKind::displacement},
     {"velocity", MotionKind::velocity},
     {"acceleration", MotionKind::acceleration}}};

/// What the name of a part or material may be made of.
inline constexpr std::string_view name_letters =
    "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-";

}  // namespace brio
