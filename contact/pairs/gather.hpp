#pragma once
/// Positions of eight nodes as lanes: whole rows are loaded and transposed in registers, which beats hardware
/// gathers. A row is the 64-byte record of a node, or x, y, z and a pad of a compact array.

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
  const auto row = [&](int lane) { return first + stride * index(node[lane]); };
  if constexpr (NumberTraits<T>::lanes == 1) {
    const double* only = row(0);
    return {only[0], only[1], only[2]};
  } else {
    Row4 rows[8];
#pragma GCC unroll 8
    for (int lane = 0; lane < 8; ++lane) rows[lane] = load_row(row(lane));
    Row8 x, y, z;
    transpose_rows(rows, x, y, z);
    return {T(x), T(y), T(z)};
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
