#pragma once
/// Logarithm, exponential and power, on lanes by polynomials of our own and on plain numbers by the standard
/// library.
///
/// Accuracy on lanes, in units in the last place of the result (measured in tests/base/test_lane_math.cpp):
///   log   1     any positive number, subnormal ones included; log(0) = -infinity, log(negative) = NaN
///   exp   1.1   any number; beyond the range 0 or infinity
///   pow   1.25 + |y|    base >= 0, |exponent| <= 1000; pow(x, 0) = 1, pow(0, y) = 0 or, for y < 0, infinity;
///                 a negative base gives NaN, whatever the exponent
/// Results that are subnormal may differ by one unit more. NaN stays NaN. The special values are chosen, not
/// computed: no argument of the domain raises an invalid operation or a division by zero.
///
/// The polynomials interpolate at Chebyshev points, with errors below a tenth of a unit in the last place.

#include <cmath>
#include <cstdint>
#include <limits>

#include "src/base/floating_point.hpp"
#include "src/base/lanes.hpp"

namespace brio {

template <Floating Real>
BRIO_INLINE Real log(Real x) {
  return std::log(x);
}
template <Floating Real>
BRIO_INLINE Real exp(Real x) {
  return std::exp(x);
}
template <Floating Real>
BRIO_INLINE Real pow(Real x, std::type_identity_t<Real> y) {
  return std::pow(x, y);
}

namespace lane_math {

template <Floating Real>
struct Format;
template <>
struct Format<double> {
  static constexpr int mantissa_bits = 52;
  static constexpr std::int64_t exponent_of_one = 1023;
  static constexpr std::int64_t root_half = 0x3fe6a09e667f3bcd;  ///< bits of sqrt(1/2)
  static constexpr std::int64_t upper_half = ~std::int64_t{0} << 27;
  static constexpr double rounder = 0x1.8p52;  ///< adding it leaves an integer in the last bits
  static constexpr double smallest_normal = 0x1p-1022;
  static constexpr double lift = 0x1p54;
  static constexpr double lift_exponent = 54;
  static constexpr double ln2_high =
      0x1.62e42fefa38p-1;  ///< 12 zero bits, so that products with exponents are exact
  static constexpr double ln2_low = 0x1.ef35793c7673p-45;
  static constexpr double exponent_limit = 1090;  ///< powers of two beyond which results are 0 or infinity
  /// (log(1+f) / s - 2) / s^2 in s^2 where s = f / (2+f)
  static constexpr double log_series[] = {0.666666666666666971, 0.399999999998988905, 0.285714286262538376,
                                          0.222222110893794962, 0.181828924325368712, 0.153316117220550079,
                                          0.14617807153417325};
  /// (exp(r) - 1 - r) / r^2 for |r| <= ln(2) / 2
  static constexpr double exp_series[] = {
      0.500000000000000113,   0.166666666666666675,    0.0416666666666206386,    0.0083333333333297935,
      0.00138888889189391678, 0.000198412698643805133, 0.0000248015186413959936, 2.75572664186123037e-6,
      2.76213386691429238e-7, 2.51013469283503402e-8};
};
template <>
struct Format<float> {
  static constexpr int mantissa_bits = 23;
  static constexpr std::int32_t exponent_of_one = 127;
  static constexpr std::int32_t root_half = 0x3f3504f3;
  static constexpr std::int32_t upper_half = ~std::int32_t{0} << 12;
  static constexpr double rounder = 0x1.8p23;
  static constexpr double smallest_normal = 0x1p-126;
  static constexpr double lift = 0x1p25;
  static constexpr double lift_exponent = 25;
  static constexpr double ln2_high = 0x1.62ep-1;
  static constexpr double ln2_low = 0x1.0bfbe8p-15;
  static constexpr double exponent_limit = 160;
  static constexpr double log_series[] = {0.666666850954290687, 0.39988757716604847, 0.295809859299744226};
  static constexpr double exp_series[] = {0.5, 0.16666573381900846, 0.0416665501103051244,
                                          0.0083637738744055735, 0.00139269266140219065};
};

template <Floating Real>
using Bits = typename LaneMask<Real>::Vector;

template <Floating Real>
BRIO_INLINE Bits<Real> bits_of(Lanes<Real> x) {
  return bits_as<IntegerOf<Real>>(x.v);
}
template <Floating Real>
BRIO_INLINE Lanes<Real> number_of(Bits<Real> bits) {
  return Lanes<Real>(bits_as<Real>(bits));
}

template <Floating Real, std::size_t N>
BRIO_INLINE Lanes<Real> polynomial(const double (&coefficient)[N], Lanes<Real> x) {
  Lanes<Real> sum(coefficient[N - 1]);
  for (std::size_t k = N - 1; k-- > 0;) sum = sum * x + coefficient[k];
  return sum;
}

/// x = 2^exponent (1 + fraction) with 1 + fraction in [sqrt(1/2), sqrt(2)).
template <Floating Real>
struct Split {
  Lanes<Real> exponent, fraction;
};
/// \pre x positive and finite; other lanes give some number.
template <Floating Real>
BRIO_INLINE Split<Real> split(Lanes<Real> x) {
  using F = Format<Real>;
  const auto is_subnormal = x < Lanes<Real>(F::smallest_normal);
  const Bits<Real> bits = bits_of(where(is_subnormal, x * F::lift, x));
  const Bits<Real> exponent = (bits - F::root_half) >> F::mantissa_bits;
  const Lanes<Real> rounder(F::rounder);
  const Lanes<Real> exponent_number = number_of<Real>(exponent + bits_of(rounder)) - rounder;
  return {exponent_number - where(is_subnormal, Lanes<Real>(F::lift_exponent), 0.0),
          number_of<Real>(bits - (exponent << F::mantissa_bits)) - 1.0};
}

/// log(1 + f) = f - (f^2/2 - s (f^2/2 + R(s^2))): half and product are what is taken from f and what is given
/// back.
template <Floating Real>
struct LogTerms {
  Lanes<Real> half, product;
};
template <Floating Real>
BRIO_INLINE LogTerms<Real> log_terms(Lanes<Real> f) {
  const Lanes<Real> s = f / (f + 2.0);
  const Lanes<Real> squared = s * s;
  const Lanes<Real> half = 0.5 * f * f;
  return {half, s * (half + squared * polynomial(Format<Real>::log_series, squared))};
}

template <Floating Real>
BRIO_INLINE Lanes<Real> nearest_integer(Lanes<Real> x) {
  const Lanes<Real> rounder(Format<Real>::rounder);
  return (x + rounder) - rounder;
}

/// exp(r) 2^n for |r| not much above ln(2)/2 and an integer n. In two factors, so that subnormal results come
/// out.
template <Floating Real>
BRIO_INLINE Lanes<Real> scaled_exp(Lanes<Real> r, Lanes<Real> n) {
  using F = Format<Real>;
  const Lanes<Real> rounder(F::rounder);
  const Lanes<Real> limited = min(max(n, -F::exponent_limit), F::exponent_limit);
  const Bits<Real> whole = bits_of(limited + rounder) - bits_of(rounder);
  const Bits<Real> first = whole >> 1;
  const Bits<Real> second = whole - first;
  const Lanes<Real> mantissa = 1.0 + (r + r * r * polynomial(F::exp_series, r));
  return mantissa * number_of<Real>((first + F::exponent_of_one) << F::mantissa_bits) *
         number_of<Real>((second + F::exponent_of_one) << F::mantissa_bits);
}

}  // namespace lane_math

template <Floating Real>
BRIO_INLINE Lanes<Real> log(Lanes<Real> x) {
  using F = lane_math::Format<Real>;
  const auto regular = (x > Lanes<Real>(0.0)) & (x < Lanes<Real>(infinity));
  const auto [k, f] = lane_math::split(where(regular, x, 1.0));
  const auto [half, product] = lane_math::log_terms(f);
  const Lanes<Real> value = k * F::ln2_high - ((half - (product + k * F::ln2_low)) - f);
  const Lanes<Real> special =
      where(x == Lanes<Real>(0.0), -infinity,
            where(x > Lanes<Real>(0.0), x, Lanes<Real>(std::numeric_limits<double>::quiet_NaN())));
  return where(regular, value, special);
}

template <Floating Real>
BRIO_INLINE Lanes<Real> exp(Lanes<Real> x) {
  using F = lane_math::Format<Real>;
  constexpr double log2_e = 1.44269504088896340736;
  const Lanes<Real> limited = min(max(x, -F::exponent_limit), F::exponent_limit);
  const Lanes<Real> n = lane_math::nearest_integer(limited * log2_e);
  const Lanes<Real> value = lane_math::scaled_exp((limited - n * F::ln2_high) - n * F::ln2_low, n);
  return where((x <= Lanes<Real>(0.0)) | (x > Lanes<Real>(0.0)), value, x);
}

/// x^y = 2^(y k) 2^(y log2(1 + f)): the product with the exponent k is split so that its whole part comes off
/// exactly.
template <Floating Real>
BRIO_INLINE Lanes<Real> pow(Lanes<Real> x, Lanes<Real> y) {
  using F = lane_math::Format<Real>;
  constexpr double log2_e = 1.44269504088896340736;
  constexpr double ln_2 = 0.69314718055994530942;
  const Lanes<Real> zero(0.0);
  const auto regular = (x > zero) & (x < Lanes<Real>(infinity));
  const auto [k, f] = lane_math::split(where(regular, x, 1.0));
  const auto [half, product] = lane_math::log_terms(f);
  const Lanes<Real> y_high = lane_math::number_of<Real>(lane_math::bits_of(y) & F::upper_half);
  const Lanes<Real> coarse = y_high * k;
  const Lanes<Real> coarse_whole = lane_math::nearest_integer(coarse);
  const Lanes<Real> fine = y * (log2_e * (f - (half - product))) + (y - y_high) * k;
  const Lanes<Real> rest = (coarse - coarse_whole) + fine;
  const Lanes<Real> rest_whole = lane_math::nearest_integer(rest);
  const Lanes<Real> value = lane_math::scaled_exp(ln_2 * (rest - rest_whole), coarse_whole + rest_whole);
  const Lanes<Real> of_zero = where(y > zero, 0.0, where(y == zero, 1.0, Lanes<Real>(infinity)));
  const Lanes<Real> of_infinity = where(y > zero, infinity, where(y == zero, Lanes<Real>(1.0), 0.0));
  const Lanes<Real> special =
      where(x == zero, of_zero,
            where(x > zero, of_infinity, Lanes<Real>(std::numeric_limits<double>::quiet_NaN())));
  return where(regular, value, special);
}
template <Floating Real>
BRIO_INLINE Lanes<Real> pow(Lanes<Real> x, std::type_identity_t<double> y) {
  return pow(x, Lanes<Real>(y));
}

/// 1 / sqrt(a) within 3e-16 of itself, a normal and positive: Newton's method from an estimate of the
/// processor, or else from half of the exponent (Lomont 2003). Faster than a root and a quotient.
BRIO_INLINE double inverse_square_root(double a) { return 1 / std::sqrt(a); }
BRIO_INLINE Lanes<double> inverse_square_root(Lanes<double> a) {
#if defined(BRIO_AVX512)
  Lanes<double> root(_mm512_maskz_rsqrt14_pd(0xff, a.v));
  constexpr int passes = 2;
#else
  Lanes<double> root(
      bits_as<double>(broadcast<std::int64_t>(0x5fe6eb50c7b537a9) - (bits_as<std::int64_t>(a.v) >> 1)));
  constexpr int passes = 4;
#endif
  const Lanes<double> half = 0.5 * a;
#pragma GCC unroll 8
  for (int pass = 0; pass < passes; ++pass) root *= 1.5 - half * root * root;
  return root;
}

}  // namespace brio
