#pragma once
/// xxHash64 with seed 0 (https://github.com/Cyan4973/xxHash/blob/dev/doc/xxhash_spec.md): 64 bits, an order
/// of magnitude faster than a disk.

#include <cstddef>
#include <cstdint>

namespace brio {

std::uint64_t checksum(const void* data, std::size_t bytes);

}  // namespace brio
