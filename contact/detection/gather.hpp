#pragma once
/// Positions of eight nodes as lanes: whole rows are loaded and transposed in registers, which beats hardware
/// gathers. A row is the 64-byte record of a node, or x, y, z and a pad of a compact array.

#include "contact/detection/number.hpp"
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
  const auto row = [&](int lane) { return first + stride * static_cast<std::size_t>(node[lane]); };
  if constexpr (NumberTraits<T>::lanes == 1) {
    const double* only = row(0);
    return {only[0], only[1], only[2]};
  } else {
    typedef double Row __attribute__((vector_size(32)));
    typedef double Lane8 __attribute__((vector_size(64)));
    const auto load = [&](int lane) {
      Row r;
      __builtin_memcpy(&r, __builtin_assume_aligned(row(lane), 32), sizeof r);
      return r;
    };
    const auto pair = [&](int lane) {
      return __builtin_shufflevector(load(lane), load(lane + 4), 0, 1, 2, 3, 4, 5, 6, 7);
    };
    const Lane8 p0 = pair(0);
    const Lane8 p1 = pair(1);
    const Lane8 p2 = pair(2);
    const Lane8 p3 = pair(3);
    const Lane8 xz01 = __builtin_shufflevector(p0, p1, 0, 8, 2, 10, 4, 12, 6, 14);
    const Lane8 xz23 = __builtin_shufflevector(p2, p3, 0, 8, 2, 10, 4, 12, 6, 14);
    const Lane8 yw01 = __builtin_shufflevector(p0, p1, 1, 9, 3, 11, 5, 13, 7, 15);
    const Lane8 yw23 = __builtin_shufflevector(p2, p3, 1, 9, 3, 11, 5, 13, 7, 15);
    return {T(__builtin_shufflevector(xz01, xz23, 0, 1, 8, 9, 4, 5, 12, 13)),
            T(__builtin_shufflevector(yw01, yw23, 0, 1, 8, 9, 4, 5, 12, 13)),
            T(__builtin_shufflevector(xz01, xz23, 2, 3, 10, 11, 6, 7, 14, 15))};
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
}  // namespace brio
