#pragma once
/// Tests of eight boxes or points, which are boxes without extent, at once that answer with one bit each.

#include "contact/search/search.hpp"
#include "src/base/lanes.hpp"

#if defined(__AVX512F__) && defined(__AVX512VL__)
#include <immintrin.h>
#endif

namespace brio {

inline constexpr int bits_lanes = 8;

#if defined(__AVX512F__) && defined(__AVX512VL__)

/// A box with its faces ready for comparison with eight points or boxes.
struct BoxLanes {
  __m512d lower[3], upper[3];
  explicit BoxLanes(const CaptureBox& box) {
    for (int axis = 0; axis < 3; ++axis) {
      lower[axis] = _mm512_set1_pd(box.lower[axis]);
      upper[axis] = _mm512_set1_pd(box.upper[axis]);
    }
  }
};

/// Bit i is set where lower[a][i] <= box.upper[a] and upper[a][i] >= box.lower[a] for every axis a.
BRIO_INLINE unsigned overlap_bits(const double* const lower[3], const double* const upper[3],
                                  const BoxLanes& box) {
  __mmask8 bits = 0xff;
  for (int axis = 0; axis < 3; ++axis) {
    bits = _mm512_mask_cmp_pd_mask(bits, _mm512_loadu_pd(lower[axis]), box.upper[axis], _CMP_LE_OQ);
    bits = _mm512_mask_cmp_pd_mask(bits, _mm512_loadu_pd(upper[axis]), box.lower[axis], _CMP_GE_OQ);
  }
  return bits;
}

/// Append source[i] where bit i is set; writes eight places of `target` whatever the bits. Returns how many
/// count.
BRIO_INLINE int append_selected(int* target, const int* source, unsigned bits) {
  const __m256i values = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(source));
  const __m256i chosen = _mm256_maskz_compress_epi32(static_cast<__mmask8>(bits), values);
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(target), chosen);
  return __builtin_popcount(bits);
}

#else

struct BoxLanes {
  Lanes<double> lower[3], upper[3];
  explicit BoxLanes(const CaptureBox& box) {
    for (int axis = 0; axis < 3; ++axis) {
      lower[axis] = Lanes<double>(box.lower[axis]);
      upper[axis] = Lanes<double>(box.upper[axis]);
    }
  }
};

BRIO_INLINE unsigned overlap_bits(const double* const lower[3], const double* const upper[3],
                                  const BoxLanes& box) {
  LaneMask<double> inside = Lanes<double>::load(lower[0]) <= box.upper[0];
  for (int axis = 0; axis < 3; ++axis)
    inside = inside & (Lanes<double>::load(lower[axis]) <= box.upper[axis]) &
             (Lanes<double>::load(upper[axis]) >= box.lower[axis]);
  return bits_of_lanes(inside.v);
}

BRIO_INLINE int append_selected(int* target, const int* source, unsigned bits) {
  int count = 0;
  for (int lane = 0; lane < bits_lanes; ++lane) {
    target[count] = source[lane];
    count += static_cast<int>((bits >> lane) & 1u);
  }
  return count;
}

#endif

}  // namespace brio
