#pragma once
/// 64 bytes of numbers as the processor holds them: in one register of AVX-512, or else in two halves of 32
/// bytes, since GCC takes its own vectors of 64 bytes apart number by number at every condition and shuffle
/// where there is no such register.

#include <cmath>
#include <cstdint>
#include <cstring>
#include <type_traits>

#if defined(__AVX512F__) && defined(__AVX512DQ__)
#define BRIO_AVX512 1
#endif
#if defined(__AVX__)
#include <immintrin.h>
#endif

#include "src/base/real.hpp"

// Kernels are inlined whole into the loop over packs; for sanitizers and tests that takes long to compile.
#if defined(BRIO_KERNELS_BY_CALL)
#define BRIO_INLINE inline
#else
#define BRIO_INLINE inline __attribute__((always_inline))
#endif
/// Of a template that is long, or seldom needed, and the same in many kernels: compiled once and called.
/// Inlined into each of them such functions took half the time to compile kernels and made none faster.
#define BRIO_CALLED [[gnu::noinline]]

namespace brio {

template <class Number>
using IntegerOf = std::conditional_t<sizeof(Number) == 8, std::int64_t, std::int32_t>;

#if defined(BRIO_AVX512)

template <class Number>
struct WideOf {
  typedef Number Type __attribute__((vector_size(64)));
};
template <class Number>
using Wide = typename WideOf<Number>::Type;

template <class Number>
BRIO_INLINE Wide<Number> broadcast(Number value) {
  return value - Wide<Number>{};
}
/// Eight numbers of eight bytes.
template <class Number>
BRIO_INLINE Wide<Number> wide_of(Number a, Number b, Number c, Number d, Number e, Number f, Number g,
                                 Number h) {
  return Wide<Number>{a, b, c, d, e, f, g, h};
}
template <class Vector, class Number>
BRIO_INLINE void set_lane(Vector& wide, int lane, Number value) {
  wide[lane] = value;
}
/// The bits of one kind of numbers as those of another.
template <class To, class Vector>
BRIO_INLINE Wide<To> bits_as(Vector wide) {
  return reinterpret_cast<Wide<To>>(wide);
}
template <class Mask, class Vector>
BRIO_INLINE Vector select(Mask condition, Vector a, Vector b) {
  return condition ? a : b;
}
BRIO_INLINE Wide<double> square_root(Wide<double> a) { return _mm512_maskz_sqrt_pd(0xff, a); }
BRIO_INLINE Wide<float> square_root(Wide<float> a) { return _mm512_maskz_sqrt_ps(0xffff, a); }
template <class Mask>
BRIO_INLINE bool any_bit(Mask mask) {
  const __m512i words = reinterpret_cast<__m512i>(mask);
  return _mm512_test_epi64_mask(words, words) != 0;
}
/// Bit i: the truth in lane i.
BRIO_INLINE unsigned bits_of_lanes(Wide<std::int64_t> mask) {
  return _mm512_movepi64_mask(reinterpret_cast<__m512i>(mask));
}
BRIO_INLINE unsigned bits_of_lanes(Wide<std::int32_t> mask) {
  return _mm512_movepi32_mask(reinterpret_cast<__m512i>(mask));
}

#else

template <class Number>
struct Wide {
  typedef Number Half __attribute__((vector_size(32)));
  using Truth = Wide<IntegerOf<Number>>;
  static constexpr int half = static_cast<int>(32 / sizeof(Number));
  Half low, high;

  BRIO_INLINE Number operator[](int lane) const { return lane < half ? low[lane] : high[lane - half]; }

  friend BRIO_INLINE Wide operator+(Wide a, Wide b) { return {a.low + b.low, a.high + b.high}; }
  friend BRIO_INLINE Wide operator-(Wide a, Wide b) { return {a.low - b.low, a.high - b.high}; }
  friend BRIO_INLINE Wide operator*(Wide a, Wide b) { return {a.low * b.low, a.high * b.high}; }
  friend BRIO_INLINE Wide operator/(Wide a, Wide b) { return {a.low / b.low, a.high / b.high}; }
  friend BRIO_INLINE Wide operator-(Wide a) { return {-a.low, -a.high}; }
  friend BRIO_INLINE Wide operator+(Wide a, Number b) { return {a.low + b, a.high + b}; }
  friend BRIO_INLINE Wide operator-(Wide a, Number b) { return {a.low - b, a.high - b}; }
  friend BRIO_INLINE Wide operator&(Wide a, Wide b) { return {a.low & b.low, a.high & b.high}; }
  friend BRIO_INLINE Wide operator&(Wide a, Number b) { return {a.low & b, a.high & b}; }
  friend BRIO_INLINE Wide operator|(Wide a, Wide b) { return {a.low | b.low, a.high | b.high}; }
  friend BRIO_INLINE Wide operator~(Wide a) { return {~a.low, ~a.high}; }
  friend BRIO_INLINE Wide operator<<(Wide a, int bits) { return {a.low << bits, a.high << bits}; }
  friend BRIO_INLINE Wide operator>>(Wide a, int bits) { return {a.low >> bits, a.high >> bits}; }
  BRIO_INLINE Wide& operator+=(Wide b) { return *this = *this + b; }
  BRIO_INLINE Wide& operator-=(Wide b) { return *this = *this - b; }
  BRIO_INLINE Wide& operator*=(Wide b) { return *this = *this * b; }
  BRIO_INLINE Wide& operator/=(Wide b) { return *this = *this / b; }
  friend BRIO_INLINE Truth operator<(Wide a, Wide b) { return {a.low < b.low, a.high < b.high}; }
  friend BRIO_INLINE Truth operator>(Wide a, Wide b) { return {a.low > b.low, a.high > b.high}; }
  friend BRIO_INLINE Truth operator<=(Wide a, Wide b) { return {a.low <= b.low, a.high <= b.high}; }
  friend BRIO_INLINE Truth operator>=(Wide a, Wide b) { return {a.low >= b.low, a.high >= b.high}; }
  friend BRIO_INLINE Truth operator==(Wide a, Wide b) { return {a.low == b.low, a.high == b.high}; }
};

template <class Number>
BRIO_INLINE Wide<Number> broadcast(Number value) {
  return {value - typename Wide<Number>::Half{}, value - typename Wide<Number>::Half{}};
}
/// Eight numbers of eight bytes.
template <class Number>
BRIO_INLINE Wide<Number> wide_of(Number a, Number b, Number c, Number d, Number e, Number f, Number g,
                                 Number h) {
  using Half = typename Wide<Number>::Half;
  return {Half{a, b, c, d}, Half{e, f, g, h}};
}
template <class Number>
BRIO_INLINE void set_lane(Wide<Number>& wide, int lane, Number value) {
  if (lane < Wide<Number>::half) {
    wide.low[lane] = value;
  } else {
    wide.high[lane - Wide<Number>::half] = value;
  }
}
/// The bits of one kind of numbers as those of another.
template <class To, class Number>
BRIO_INLINE Wide<To> bits_as(Wide<Number> wide) {
  using Half = typename Wide<To>::Half;
  return {reinterpret_cast<Half>(wide.low), reinterpret_cast<Half>(wide.high)};
}
template <class Number>
BRIO_INLINE Wide<Number> select(Wide<IntegerOf<Number>> condition, Wide<Number> a, Wide<Number> b) {
  return {condition.low ? a.low : b.low, condition.high ? a.high : b.high};
}
template <class Number>
BRIO_INLINE Wide<Number> square_root(Wide<Number> a) {
#if defined(__AVX__)
  if constexpr (sizeof(Number) == 8) {
    return {_mm256_sqrt_pd(a.low), _mm256_sqrt_pd(a.high)};
  } else {
    return {_mm256_sqrt_ps(a.low), _mm256_sqrt_ps(a.high)};
  }
#else
  for (int lane = 0; lane < 2 * Wide<Number>::half; ++lane) set_lane(a, lane, std::sqrt(a[lane]));
  return a;
#endif
}
template <class Integer>
BRIO_INLINE bool any_bit(Wide<Integer> mask) {
  const auto both = mask.low | mask.high;
#if defined(__AVX__)
  const __m256i words = reinterpret_cast<__m256i>(both);
  return _mm256_testz_si256(words, words) == 0;
#else
  std::uint64_t words[4];
  std::memcpy(words, &both, sizeof words);
  return (words[0] | words[1] | words[2] | words[3]) != 0;
#endif
}
/// Bit i: the truth in lane i.
BRIO_INLINE unsigned bits_of_lanes(Wide<std::int64_t> mask) {
#if defined(__AVX__)
  const auto of = [](Wide<std::int64_t>::Half half) {
    return static_cast<unsigned>(_mm256_movemask_pd(reinterpret_cast<__m256d>(half)));
  };
  return of(mask.low) | of(mask.high) << 4;
#else
  unsigned bits = 0;
  for (int lane = 0; lane < 8; ++lane) bits |= (mask[lane] != 0 ? 1U : 0U) << lane;
  return bits;
#endif
}
BRIO_INLINE unsigned bits_of_lanes(Wide<std::int32_t> mask) {
#if defined(__AVX__)
  const auto of = [](Wide<std::int32_t>::Half half) {
    return static_cast<unsigned>(_mm256_movemask_ps(reinterpret_cast<__m256>(half)));
  };
  return of(mask.low) | of(mask.high) << 8;
#else
  unsigned bits = 0;
  for (int lane = 0; lane < 16; ++lane) bits |= (mask[lane] != 0 ? 1U : 0U) << lane;
  return bits;
#endif
}

#endif

}  // namespace brio
