#pragma once
/// Rows of nodal records to lanes and back: whole rows are loaded and transposed in registers, which beats
/// hardware gathers. `node` lists one node a lane.
///
/// Every loop here is unrolled by order: where GCC 12 keeps such arrays of registers on the stack, at -O2 it
/// has been seen to let two of them that are in use share a place (held by the tests of the sweep;
/// -fstack-reuse=none cures it too).

#include "src/base/index.hpp"
#include "src/base/lanes.hpp"
#include "src/base/nodes.hpp"

namespace brio {

typedef double Row4 __attribute__((vector_size(32)));
using Row8 = Wide<double>;

BRIO_INLINE Row4 load_row(const double* row) {
  Row4 r;
  __builtin_memcpy(&r, __builtin_assume_aligned(row, 32), sizeof r);
  return r;
}
BRIO_INLINE void store_row(double* row, Row4 r) {
  __builtin_memcpy(__builtin_assume_aligned(row, 32), &r, sizeof r);
}

#if defined(BRIO_AVX512)

/// Eight rows (x, y, z, w), one a lane.
BRIO_INLINE void transpose_rows(const Row4 rows[8], Row8& x, Row8& y, Row8& z, Row8& w) {
  Row8 pair[4];
#pragma GCC unroll 8
  for (int k = 0; k < 4; ++k) pair[k] = __builtin_shufflevector(rows[k], rows[k + 4], 0, 1, 2, 3, 4, 5, 6, 7);
  const Row8 xz01 = __builtin_shufflevector(pair[0], pair[1], 0, 8, 2, 10, 4, 12, 6, 14);
  const Row8 xz23 = __builtin_shufflevector(pair[2], pair[3], 0, 8, 2, 10, 4, 12, 6, 14);
  const Row8 yw01 = __builtin_shufflevector(pair[0], pair[1], 1, 9, 3, 11, 5, 13, 7, 15);
  const Row8 yw23 = __builtin_shufflevector(pair[2], pair[3], 1, 9, 3, 11, 5, 13, 7, 15);
  x = __builtin_shufflevector(xz01, xz23, 0, 1, 8, 9, 4, 5, 12, 13);
  y = __builtin_shufflevector(yw01, yw23, 0, 1, 8, 9, 4, 5, 12, 13);
  z = __builtin_shufflevector(xz01, xz23, 2, 3, 10, 11, 6, 7, 14, 15);
  w = __builtin_shufflevector(yw01, yw23, 2, 3, 10, 11, 6, 7, 14, 15);
}

/// The inverse, with a fourth: eight rows (x, y, z, w).
BRIO_INLINE void transpose_lanes(Row8 x, Row8 y, Row8 z, Row8 w, Row4 rows[8]) {
  const Row8 xy_even = __builtin_shufflevector(x, y, 0, 8, 2, 10, 4, 12, 6, 14);
  const Row8 xy_odd = __builtin_shufflevector(x, y, 1, 9, 3, 11, 5, 13, 7, 15);
  const Row8 z_even = __builtin_shufflevector(z, w, 0, 8, 2, 10, 4, 12, 6, 14);
  const Row8 z_odd = __builtin_shufflevector(z, w, 1, 9, 3, 11, 5, 13, 7, 15);
  rows[0] = __builtin_shufflevector(xy_even, z_even, 0, 1, 8, 9);
  rows[1] = __builtin_shufflevector(xy_odd, z_odd, 0, 1, 8, 9);
  rows[2] = __builtin_shufflevector(xy_even, z_even, 2, 3, 10, 11);
  rows[3] = __builtin_shufflevector(xy_odd, z_odd, 2, 3, 10, 11);
  rows[4] = __builtin_shufflevector(xy_even, z_even, 4, 5, 12, 13);
  rows[5] = __builtin_shufflevector(xy_odd, z_odd, 4, 5, 12, 13);
  rows[6] = __builtin_shufflevector(xy_even, z_even, 6, 7, 14, 15);
  rows[7] = __builtin_shufflevector(xy_odd, z_odd, 6, 7, 14, 15);
}

/// Entry k: the sum over the lanes of number k.
BRIO_INLINE Row8 sums_over_lanes(const Row8 (&number)[8]) {
  Row8 two[4];
#pragma GCC unroll 8
  for (int k = 0; k < 4; ++k)
    two[k] = __builtin_shufflevector(number[2 * k], number[2 * k + 1], 0, 8, 2, 10, 4, 12, 6, 14) +
             __builtin_shufflevector(number[2 * k], number[2 * k + 1], 1, 9, 3, 11, 5, 13, 7, 15);
  Row8 four[2];
#pragma GCC unroll 8
  for (int k = 0; k < 2; ++k)
    four[k] = __builtin_shufflevector(two[2 * k], two[2 * k + 1], 0, 1, 8, 9, 4, 5, 12, 13) +
              __builtin_shufflevector(two[2 * k], two[2 * k + 1], 2, 3, 10, 11, 6, 7, 14, 15);
  return __builtin_shufflevector(four[0], four[1], 0, 1, 2, 3, 8, 9, 10, 11) +
         __builtin_shufflevector(four[0], four[1], 4, 5, 6, 7, 12, 13, 14, 15);
}

BRIO_INLINE Wide<float> narrow_pair(Row8 first, Row8 second) {
  typedef float Half __attribute__((vector_size(32)));
  const Half low = __builtin_convertvector(first, Half);
  const Half high = __builtin_convertvector(second, Half);
  return __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
}
BRIO_INLINE void widen_pair(Wide<float> lanes, Row8* wide) {
  typedef float Half __attribute__((vector_size(32)));
  const Half low = __builtin_shufflevector(lanes, lanes, 0, 1, 2, 3, 4, 5, 6, 7);
  const Half high = __builtin_shufflevector(lanes, lanes, 8, 9, 10, 11, 12, 13, 14, 15);
  wide[0] = __builtin_convertvector(low, Row8);
  wide[1] = __builtin_convertvector(high, Row8);
}

#else

BRIO_INLINE void transpose_four_rows(const Row4* rows, Row4& x, Row4& y, Row4& z, Row4& w) {
  const Row4 xz01 = __builtin_shufflevector(rows[0], rows[1], 0, 4, 2, 6);
  const Row4 xz23 = __builtin_shufflevector(rows[2], rows[3], 0, 4, 2, 6);
  const Row4 yw01 = __builtin_shufflevector(rows[0], rows[1], 1, 5, 3, 7);
  const Row4 yw23 = __builtin_shufflevector(rows[2], rows[3], 1, 5, 3, 7);
  x = __builtin_shufflevector(xz01, xz23, 0, 1, 4, 5);
  y = __builtin_shufflevector(yw01, yw23, 0, 1, 4, 5);
  z = __builtin_shufflevector(xz01, xz23, 2, 3, 6, 7);
  w = __builtin_shufflevector(yw01, yw23, 2, 3, 6, 7);
}
/// Eight rows (x, y, z, w), one a lane.
BRIO_INLINE void transpose_rows(const Row4 rows[8], Row8& x, Row8& y, Row8& z, Row8& w) {
  transpose_four_rows(rows, x.low, y.low, z.low, w.low);
  transpose_four_rows(rows + 4, x.high, y.high, z.high, w.high);
}

BRIO_INLINE void transpose_four_lanes(Row4 x, Row4 y, Row4 z, Row4 w, Row4* rows) {
  const Row4 xy_even = __builtin_shufflevector(x, y, 0, 4, 2, 6);
  const Row4 xy_odd = __builtin_shufflevector(x, y, 1, 5, 3, 7);
  const Row4 z_even = __builtin_shufflevector(z, w, 0, 4, 2, 6);
  const Row4 z_odd = __builtin_shufflevector(z, w, 1, 5, 3, 7);
  rows[0] = __builtin_shufflevector(xy_even, z_even, 0, 1, 4, 5);
  rows[1] = __builtin_shufflevector(xy_odd, z_odd, 0, 1, 4, 5);
  rows[2] = __builtin_shufflevector(xy_even, z_even, 2, 3, 6, 7);
  rows[3] = __builtin_shufflevector(xy_odd, z_odd, 2, 3, 6, 7);
}
/// The inverse, with a fourth: eight rows (x, y, z, w).
BRIO_INLINE void transpose_lanes(Row8 x, Row8 y, Row8 z, Row8 w, Row4 rows[8]) {
  transpose_four_lanes(x.low, y.low, z.low, w.low, rows);
  transpose_four_lanes(x.high, y.high, z.high, w.high, rows + 4);
}

BRIO_INLINE Row4 sums_of_four(Row4 a, Row4 b, Row4 c, Row4 d) {
  const Row4 ab = __builtin_shufflevector(a, b, 0, 4, 2, 6) + __builtin_shufflevector(a, b, 1, 5, 3, 7);
  const Row4 cd = __builtin_shufflevector(c, d, 0, 4, 2, 6) + __builtin_shufflevector(c, d, 1, 5, 3, 7);
  return __builtin_shufflevector(ab, cd, 0, 1, 4, 5) + __builtin_shufflevector(ab, cd, 2, 3, 6, 7);
}
/// Entry k: the sum over the lanes of number k.
BRIO_INLINE Row8 sums_over_lanes(const Row8 (&n)[8]) {
  return {sums_of_four(n[0].low, n[1].low, n[2].low, n[3].low) +
              sums_of_four(n[0].high, n[1].high, n[2].high, n[3].high),
          sums_of_four(n[4].low, n[5].low, n[6].low, n[7].low) +
              sums_of_four(n[4].high, n[5].high, n[6].high, n[7].high)};
}

typedef float Float4 __attribute__((vector_size(16)));
BRIO_INLINE Wide<float>::Half narrow_halves(Row8 wide) {
  return __builtin_shufflevector(__builtin_convertvector(wide.low, Float4),
                                 __builtin_convertvector(wide.high, Float4), 0, 1, 2, 3, 4, 5, 6, 7);
}
BRIO_INLINE Row8 widen_half(Wide<float>::Half half) {
  return {__builtin_convertvector(__builtin_shufflevector(half, half, 0, 1, 2, 3), Row4),
          __builtin_convertvector(__builtin_shufflevector(half, half, 4, 5, 6, 7), Row4)};
}
BRIO_INLINE Wide<float> narrow_pair(Row8 first, Row8 second) {
  return {narrow_halves(first), narrow_halves(second)};
}
BRIO_INLINE void widen_pair(Wide<float> lanes, Row8* wide) {
  wide[0] = widen_half(lanes.low);
  wide[1] = widen_half(lanes.high);
}

#endif

/// Rows of eight records, whose rows are `stride` doubles apart, one a lane.
struct LaneRows {
  Lanes<double> x, y, z, w;

  BRIO_INLINE LaneRows(const double* first, std::size_t stride, const int* record) {
    Row4 rows[8];
#pragma GCC unroll 8
    for (int lane = 0; lane < 8; ++lane) rows[lane] = load_row(first + stride * index(record[lane]));
    transpose_rows(rows, x.v, y.v, z.v, w.v);
  }
};

/// Three doubles a lane for all lanes of a pack: one group of eight for double, two for float.
template <Floating Real>
struct WideVector {
  static constexpr int groups = lane_count<Real> / 8;
  Row8 x[groups], y[groups], z[groups];

  friend BRIO_INLINE WideVector operator-(const WideVector& a, const WideVector& b) {
    WideVector c;
#pragma GCC unroll 8
    for (int group = 0; group < groups; ++group) {
      c.x[group] = a.x[group] - b.x[group];
      c.y[group] = a.y[group] - b.y[group];
      c.z[group] = a.z[group] - b.z[group];
    }
    return c;
  }
};

/// `first` points at row 0 of an array whose rows are `stride` doubles apart.
template <Floating Real>
BRIO_INLINE WideVector<Real> gather_rows(const double* first, std::size_t stride, const int* node) {
  WideVector<Real> wide;
#pragma GCC unroll 8
  for (int group = 0; group < WideVector<Real>::groups; ++group) {
    const LaneRows rows(first, stride, node + 8 * group);
    wide.x[group] = rows.x.v, wide.y[group] = rows.y.v, wide.z[group] = rows.z.v;
  }
  return wide;
}

template <Floating Real>
BRIO_INLINE Lanes<Real> narrow(const Row8* wide) {
  if constexpr (sizeof(Real) == 8) {
    return Lanes<Real>(wide[0]);
  } else {
    return Lanes<Real>(narrow_pair(wide[0], wide[1]));
  }
}
template <Floating Real>
BRIO_INLINE void widen(Lanes<Real> lanes, Row8* wide) {
  if constexpr (sizeof(Real) == 8) {
    wide[0] = lanes.v;
  } else {
    widen_pair(lanes.v, wide);
  }
}

/// Subtract four components from the rows of all lanes.
template <Floating Real>
BRIO_INLINE void subtract_from_rows(NodeVector* first, const int* node, Lanes<Real> x, Lanes<Real> y,
                                    Lanes<Real> z, Lanes<Real> w) {
  WideVector<Real> wide;
  Row8 fourth[WideVector<Real>::groups];
  widen(x, wide.x);
  widen(y, wide.y);
  widen(z, wide.z);
  widen(w, fourth);
#pragma GCC unroll 8
  for (int group = 0; group < WideVector<Real>::groups; ++group) {
    Row4 rows[8];
    transpose_lanes(wide.x[group], wide.y[group], wide.z[group], fourth[group], rows);
#pragma GCC unroll 8
    for (int lane = 0; lane < 8; ++lane) {
      double* row = first[node[8 * group + lane]].component;
      store_row(row, load_row(row) - rows[lane]);
    }
  }
}

}  // namespace brio
