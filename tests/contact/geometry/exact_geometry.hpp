#pragma once
/// Points, motions and times as integers, for judging geometry without rounding.

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "src/base/tensor.hpp"
#include "tests/contact/geometry/exact_polynomial.hpp"

namespace brio::exact {

using IntegerVector = std::array<Integer, 3>;
using PolynomialVector = std::array<Polynomial, 3>;

inline IntegerVector operator-(const IntegerVector& a, const IntegerVector& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
inline Integer dot(const IntegerVector& a, const IntegerVector& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline IntegerVector cross(const IntegerVector& a, const IntegerVector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

inline PolynomialVector operator-(const PolynomialVector& a, const PolynomialVector& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
inline Polynomial dot(const PolynomialVector& a, const PolynomialVector& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline PolynomialVector cross(const PolynomialVector& a, const PolynomialVector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

// All coordinates as integers: multiples of 2^unit, and four of those for the centroid's sake.
class Scaled {
 public:
  void note(double value) {
    if (value == 0) return;
    int exponent = 0;
    std::frexp(value, &exponent);
    unit_ = std::min(unit_, exponent - 53);
  }
  void note(const Vector3d& v) {
    for (int k = 0; k < 3; ++k) note(v[k]);
  }
  Integer operator()(double value) const {
    int exponent = 0;
    const double mantissa = std::frexp(value, &exponent);
    Integer integer;
    mpz_set_d(integer.get_mpz_t(), std::ldexp(mantissa, 53));
    if (integer == 0) return integer;
    mpz_mul_2exp(integer.get_mpz_t(), integer.get_mpz_t(), static_cast<unsigned>(exponent - 53 - unit_ + 2));
    return integer;
  }
  IntegerVector operator()(const Vector3d& v) const { return {(*this)(v[0]), (*this)(v[1]), (*this)(v[2])}; }

 private:
  int unit_ = 0;
};

struct Path {
  IntegerVector start;
  IntegerVector displacement;
};

inline Path operator-(const Path& a, const Path& b) {
  return {a.start - b.start, a.displacement - b.displacement};
}

inline PolynomialVector polynomial(const Path& path) {
  PolynomialVector result;
  for (std::size_t k = 0; k < 3; ++k) result[k] = Polynomial(path.start[k], path.displacement[k]);
  return result;
}

// Times 2^exponent of the time.
inline IntegerVector at(const Path& path, const Dyadic& time) {
  IntegerVector result;
  for (std::size_t k = 0; k < 3; ++k) {
    mpz_mul_2exp(result[k].get_mpz_t(), path.start[k].get_mpz_t(), time.exponent);
    result[k] += path.displacement[k] * time.numerator;
  }
  return result;
}

inline bool earlier(Number a, Number b) {
  constexpr unsigned enough = 120;  // bits; equal within them is equal here
  while (!a.dyadic && a.exponent < enough) a.refine();
  while (!b.dyadic && b.exponent < enough) b.refine();
  const unsigned exponent = std::max(a.exponent, b.exponent);
  Integer first, second;
  mpz_mul_2exp(first.get_mpz_t(), a.high.get_mpz_t(), exponent - a.exponent);
  mpz_mul_2exp(second.get_mpz_t(), b.high.get_mpz_t(), exponent - b.exponent);
  return first < second;
}

inline void offer(std::optional<Number>& best, const Number& candidate) {
  if (!best || earlier(candidate, *best)) best = candidate;
}

inline Integer square_of_scaled_distance(const Scaled& scaled, double distance, const Dyadic& time) {
  Integer length = scaled(distance);
  mpz_mul_2exp(length.get_mpz_t(), length.get_mpz_t(), time.exponent);
  return length * length;
}

inline Dyadic dyadic(double value) {
  int exponent = 0;
  const double mantissa = std::frexp(value, &exponent);
  Dyadic result;
  mpz_set_d(result.numerator.get_mpz_t(), std::ldexp(mantissa, 53));
  result.exponent = 0;
  if (result.numerator == 0) return result;
  const auto zeros = static_cast<int>(mpz_scan1(result.numerator.get_mpz_t(), 0));
  mpz_fdiv_q_2exp(result.numerator.get_mpz_t(), result.numerator.get_mpz_t(), static_cast<unsigned>(zeros));
  const int power = exponent - 53 + zeros;
  if (power > 0)
    mpz_mul_2exp(result.numerator.get_mpz_t(), result.numerator.get_mpz_t(), static_cast<unsigned>(power));
  if (power < 0) result.exponent = static_cast<unsigned>(-power);
  return result;
}

}  // namespace brio::exact
