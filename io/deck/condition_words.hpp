#pragma once
/// Words of boundary conditions.

#include <array>
#include <string_view>
#include <utility>

#include "src/deck/deck.hpp"

namespace brio {

/// Components that a boundary condition can name, in the order of their axes.
using ComponentWords = std::array<std::string_view, 6>;
inline constexpr ComponentWords component_words{"x", "y", "z", "rx", "ry", "rz"};

/// The same along the axes of a cylindrical coordinate system.
inline constexpr ComponentWords cylindrical_words{"r", "t", "z", "rr", "rt", "rz"};

/// Keys of a prescribed motion.
inline constexpr std::array<std::pair<std::string_view, MotionKind>, 3> motion_keys{
    {{"displacement", MotionKind::displacement},
     {"velocity", MotionKind::velocity},
     {"acceleration", MotionKind::acceleration}}};

/// What the name of a part or material may be made of.
inline constexpr std::string_view name_letters =
    "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-";

}  // namespace brio
