#pragma once
/// Polynomials with integer coefficients on [0, 1], and the sign of one at a root of another, without
/// rounding (GMP).

#include <gmpxx.h>

#include <array>
#include <vector>

#include "src/base/index.hpp"

namespace brio::exact {

using Integer = mpz_class;

/// numerator / 2^exponent
struct Dyadic {
  Integer numerator;
  unsigned exponent;
};

/// Degree at most six. The zero polynomial has degree -1.
class Polynomial {
 public:
  static constexpr int most = 6;
  std::array<Integer, most + 1> coefficients;  // of t^k at k
  int degree = -1;

  Polynomial() = default;
  explicit Polynomial(const Integer& constant);
  Polynomial(const Integer& constant, const Integer& slope);
  bool is_zero() const { return degree < 0; }
  const Integer& operator[](int k) const { return coefficients[index(k)]; }
  Integer& operator[](int k) { return coefficients[index(k)]; }
  void trim();
  Polynomial derivative() const;
  void make_primitive();  // divides by the content, keeps the sign
};

Polynomial operator+(const Polynomial& a, const Polynomial& b);
Polynomial operator-(const Polynomial& a, const Polynomial& b);
Polynomial operator*(const Polynomial& a, const Polynomial& b);

int sign_at(const Polynomial& p, const Dyadic& t);

/// A real number in [0, 1]: a dyadic one (`dyadic` true, equal to `high`), or the only root of the squarefree
/// `p` in the open interval (low, high) / 2^exponent, where p(high) is not zero.
struct Number {
  bool dyadic;
  Polynomial p;
  Integer low, high;
  unsigned exponent;
  int sign_high;
  unsigned step = 2;  // bits that the next refinement tries to gain

  void halve();
  void refine();  // by about `step` bits: quadratic interval refinement (Abbott 2014)
};

Number number(const Dyadic& t);

/// The distinct roots of p (not zero) in [0, 1], ascending.
std::vector<Number> roots(const Polynomial& p);

/// Sign of g at the number. Narrows its interval on the way.
int sign_at(const Polynomial& g, Number& number);

/// Sign of a - t. Narrows the interval of a on the way.
int compare(Number& a, const Dyadic& t);

}  // namespace brio::exact
