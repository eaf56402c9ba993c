#pragma once
/// Constants of double precision.

#include <limits>

namespace brio {

inline constexpr double infinity = std::numeric_limits<double>::infinity();
inline constexpr double unit_roundoff = 0x1p-53;

}  // namespace brio
