#pragma once
/// Eight numbers side by side, of eight shapes or pairs, that a pass takes at once, and positions of eight
/// nodes as such: whole rows are loaded and transposed in registers, which beats hardware gathers. A row is
/// the 64-byte record of a node, or x, y, z and a pad of a compact array.

#include "contact/geometry/number.hpp"
#include "src/base/gather.hpp"
#include "src/base/index.hpp"
#include "src/base/nodes.hpp"

namespace brio {

/// x, y, z and a number that is not read.
struct alignas(32) PointRow {
  double component[4];
};

/// One node a lane; `node` lists as many as T has lanes. `first` points at row 0, rows are `stride` doubles
/// apart and aligned to 32 bytes.
template <class T>
BRIO_INLINE Vector3<T> gather_points(const double* first, std::size_t stride, const int* node) {
  if constexpr (NumberTraits<T>::lanes == 1) {
    const double* only = first + stride * index(node[0]);
    return {only[0], only[1], only[2]};
  } else {
    const LaneRows rows(first, stride, node);
    return {rows.x, rows.y, rows.z};
  }
}

template <class T>
BRIO_INLINE Vector3<T> gather(const NodeRecord* first, const int* node) {
  return gather_points<T>(first->position, sizeof(NodeRecord) / sizeof(double), node);
}
template <class T>
BRIO_INLINE Vector3<T> gather(const PointRow* first, const int* node) {
  return gather_points<T>(first->component, sizeof(PointRow) / sizeof(double), node);
}

using Pack = Lanes<double>;
inline constexpr int pack_size = NumberTraits<Pack>::lanes;

/// Bit i: the truth in lane i.
BRIO_INLINE unsigned lane_bits(MaskOf<Pack> mask) { return bits_of_lanes(mask.v); }
/// Visit the lanes of set bits, ascending.
template <class Visit>
BRIO_INLINE void for_lanes(unsigned bits, const Visit& visit) {
  for (; bits != 0; bits &= bits - 1) visit(__builtin_ctz(bits));
}
constexpr unsigned first_lanes(int count) { return (1U << count) - 1; }

/// Numbers of eight features.
BRIO_INLINE Pack gather_numbers(const double* of, const int* index) {
  return Pack(wide_of<double>(of[index[0]], of[index[1]], of[index[2]], of[index[3]], of[index[4]],
                              of[index[5]], of[index[6]], of[index[7]]));
}

}  // namespace brio
