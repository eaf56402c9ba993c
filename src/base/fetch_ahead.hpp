#pragma once
/// Memory asked for before it is needed.

#include <cstddef>
#include <cstdint>

#include "src/base/lanes.hpp"

namespace brio {

inline constexpr std::size_t cache_line = 64;

/// Asks for memory that will soon be read and written. The place may lie behind the end of an array.
BRIO_INLINE void fetch_ahead(std::uintptr_t place, std::size_t bytes) {
  for (std::size_t byte = 0; byte < bytes; byte += cache_line)
    __builtin_prefetch(reinterpret_cast<const void*>(place + byte), 1);  // NOLINT(performance-no-int-to-ptr)
}

}  // namespace brio
