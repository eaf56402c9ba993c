#include "tests/contact/geometry/exact_polynomial.hpp"

#include <algorithm>

#include "src/base/index.hpp"

namespace brio::exact {

Polynomial::Polynomial(const Integer& constant) {
  coefficients[0] = constant;
  degree = 0;
  trim();
}

Polynomial::Polynomial(const Integer& constant, const Integer& slope) {
  coefficients[0] = constant;
  coefficients[1] = slope;
  degree = 1;
  trim();
}

void Polynomial::trim() {
  while (degree >= 0 && (*this)[degree] == 0) --degree;
}

Polynomial Polynomial::derivative() const {
  Polynomial result;
  for (int k = 1; k <= degree; ++k) result[k - 1] = (*this)[k] * k;
  result.degree = std::max(degree - 1, -1);
  return result;
}

void Polynomial::make_primitive() {
  Integer content = 0;
  for (int k = 0; k <= degree; ++k) content = gcd(content, (*this)[k]);
  if (content <= 1) return;
  for (int k = 0; k <= degree; ++k) (*this)[k] /= content;
}

Polynomial operator+(const Polynomial& a, const Polynomial& b) {
  Polynomial sum;
  sum.degree = std::max(a.degree, b.degree);
  for (int k = 0; k <= sum.degree; ++k) {
    if (k <= a.degree) sum[k] = a[k];
    if (k <= b.degree) sum[k] += b[k];
  }
  sum.trim();
  return sum;
}

Polynomial operator-(const Polynomial& a, const Polynomial& b) {
  Polynomial difference;
  difference.degree = std::max(a.degree, b.degree);
  for (int k = 0; k <= difference.degree; ++k) {
    if (k <= a.degree) difference[k] = a[k];
    if (k <= b.degree) difference[k] -= b[k];
  }
  difference.trim();
  return difference;
}

Polynomial operator*(const Polynomial& a, const Polynomial& b) {
  Polynomial product;
  if (a.is_zero() || b.is_zero()) return product;
  product.degree = a.degree + b.degree;
  for (int i = 0; i <= a.degree; ++i)
    for (int j = 0; j <= b.degree; ++j)
      mpz_addmul(product[i + j].get_mpz_t(), a[i].get_mpz_t(), b[j].get_mpz_t());
  return product;
}

namespace {

// p at numerator / 2^exponent, times 2^(exponent degree).
Integer value_at(const Polynomial& p, const Integer& numerator, unsigned exponent) {
  if (p.is_zero()) return 0;
  Integer value = p[p.degree];
  Integer term;
  for (int k = p.degree - 1; k >= 0; --k) {
    value *= numerator;
    mpz_mul_2exp(term.get_mpz_t(), p[k].get_mpz_t(), exponent * static_cast<unsigned>(p.degree - k));
    value += term;
  }
  return value;
}

int sign_at(const Polynomial& p, const Integer& numerator, unsigned exponent) {
  return sgn(value_at(p, numerator, exponent));
}

// Remainder of a divided by b, multiplied by a positive number: the sign is kept.
Polynomial remainder(Polynomial a, const Polynomial& b) {
  const Integer lead = abs(b[b.degree]);
  const int lead_sign = sgn(b[b.degree]);
  while (a.degree >= b.degree) {
    const Integer factor = lead_sign * a[a.degree];
    const int shift = a.degree - b.degree;
    for (int k = 0; k <= a.degree; ++k) a[k] *= lead;
    for (int k = 0; k <= b.degree; ++k) a[k + shift] -= factor * b[k];
    a.trim();
  }
  a.make_primitive();
  return a;
}

Polynomial greatest_common_divisor(Polynomial a, Polynomial b) {
  while (!b.is_zero()) {
    Polynomial rest = remainder(std::move(a), b);
    a = std::move(b);
    b = std::move(rest);
  }
  a.make_primitive();
  return a;
}

// p / d up to a positive or negative factor, where d divides p.
Polynomial quotient(Polynomial p, const Polynomial& d) {
  Polynomial result;
  result.degree = p.degree - d.degree;
  const Integer lead = d[d.degree];
  while (p.degree >= d.degree) {
    const int shift = p.degree - d.degree;
    const Integer factor = p[p.degree];
    for (int k = 0; k <= result.degree; ++k) result[k] *= lead;
    result[shift] += factor;
    for (int k = 0; k <= p.degree; ++k) p[k] *= lead;
    for (int k = 0; k <= d.degree; ++k) p[k + shift] -= factor * d[k];
    p.trim();
  }
  result.make_primitive();
  return result;
}

Polynomial squarefree(Polynomial p) {
  p.make_primitive();
  if (p.degree < 2) return p;
  const Polynomial common = greatest_common_divisor(p, p.derivative());
  return common.degree < 1 ? p : quotient(p, common);
}

using Chain = std::vector<Polynomial>;

Chain sturm_chain(const Polynomial& p) {
  Chain chain{p, p.derivative()};
  chain[1].make_primitive();
  while (!chain.back().is_zero()) {
    Polynomial next = remainder(chain[chain.size() - 2], chain.back());
    for (int k = 0; k <= next.degree; ++k) next[k] = -next[k];
    chain.push_back(std::move(next));
  }
  chain.pop_back();
  return chain;
}

int variations(const Chain& chain, const Integer& numerator, unsigned exponent) {
  int count = 0;
  int before = 0;
  for (const Polynomial& p : chain) {
    const int sign = sign_at(p, numerator, exponent);
    if (sign == 0) continue;
    if (before != 0 && sign != before) ++count;
    before = sign;
  }
  return count;
}

using Coefficients = std::array<Integer, Polynomial::most + 1>;

// Bernstein coefficients on [0, 1] times 60.
Coefficients bernstein(const Polynomial& p) {
  static constexpr int binomial[7][7] = {
      {1}, {1, 1}, {1, 2, 1}, {1, 3, 3, 1}, {1, 4, 6, 4, 1}, {1, 5, 10, 10, 5, 1}, {1, 6, 15, 20, 15, 6, 1}};
  Coefficients b;
  for (int i = 0; i <= p.degree; ++i)
    for (int k = 0; k <= i; ++k) b[index(i)] += p[k] * (binomial[i][k] * 60 / binomial[p.degree][k]);
  return b;
}

// Isolates roots by halving intervals until the Bernstein coefficients change sign at most once (Descartes'
// rule: then there is no root, or one simple root). False where this does not end soon: a root at an end, or
// multiple roots.
bool isolated(const Polynomial& p, Coefficients b, const Integer& low, unsigned exponent,
              std::vector<Number>& found) {
  constexpr unsigned deepest = 8;
  const auto last = index(p.degree);
  const int sign_last = sgn(b[last]);
  int before = sgn(b[0]);
  if (before == 0 || sign_last == 0) return false;
  int changes = 0;
  for (std::size_t i = 1; i <= last; ++i) {
    const int here = sgn(b[i]);
    if (here != 0 && here != before) ++changes;
    if (here != 0) before = here;
  }
  if (changes == 0) return true;
  if (changes == 1) {
    found.push_back(Number{false, p, low, low + 1, exponent, sign_last});
    return true;
  }
  if (exponent == deepest) return false;
  Coefficients left;  // de Casteljau at the middle, all times 2^degree
  for (std::size_t i = 0; i <= last; ++i) {
    mpz_mul_2exp(left[i].get_mpz_t(), b[0].get_mpz_t(), last - i);
    for (std::size_t k = 0; k + i < last; ++k) b[k] += b[k + 1];
  }
  for (std::size_t i = 0; i <= last; ++i) mpz_mul_2exp(b[i].get_mpz_t(), b[i].get_mpz_t(), i);
  return isolated(p, std::move(left), 2 * low, exponent + 1, found) &&
         isolated(p, std::move(b), 2 * low + 1, exponent + 1, found);
}

struct Isolation {
  const Polynomial& p;
  const Chain& chain;
  std::vector<Number>& found;

  // Roots in (low, high] / 2^exponent, given the sign variations at both ends.
  void search(const Integer& low, int at_low, const Integer& high, int at_high, unsigned exponent) {
    const int count = at_low - at_high;
    if (count == 0) return;
    if (count == 1) {
      const int sign = sign_at(p, high, exponent);
      if (sign == 0)
        found.push_back(number({high, exponent}));
      else
        found.push_back(Number{false, p, low, high, exponent, sign});
      return;
    }
    const Integer middle = low + high;
    const int at_middle = variations(chain, middle, exponent + 1);
    search(2 * low, at_low, middle, at_middle, exponent + 1);
    search(middle, at_middle, 2 * high, at_high, exponent + 1);
  }
};

}  // namespace

int sign_at(const Polynomial& p, const Dyadic& t) { return sign_at(p, t.numerator, t.exponent); }

Number number(const Dyadic& t) { return Number{true, {}, t.numerator, t.numerator, t.exponent, 0}; }

void Number::halve() {
  if (dyadic) return;
  const Integer middle = low + high;
  low *= 2;
  high *= 2;
  ++exponent;
  const int sign = sign_at(p, middle, exponent);
  if (sign == 0) {
    dyadic = true;
    low = high = middle;
  } else if (sign == sign_high) {
    high = middle;
  } else {
    low = middle;
  }
}

void Number::refine() {
  if (dyadic) return;
  const Integer at_low = abs(value_at(p, low, exponent));
  if (at_low == 0) return halve();  // another root
  const Integer at_high = abs(value_at(p, high, exponent));
  // The interval in 2^step parts: the root is looked for in the part that the secant meets and in its
  // neighbour.
  const Integer width = high - low;
  Integer part = at_low;
  mpz_mul_2exp(part.get_mpz_t(), part.get_mpz_t(), step);
  part /= at_low + at_high;
  Integer start = low;
  mpz_mul_2exp(start.get_mpz_t(), start.get_mpz_t(), step);
  const Integer parts = Integer(1) << step;
  const auto beyond =
      [&](const Integer& mark) {  // sign relative to the high end: positive if the root is below
        if (mark <= 0) return -1;
        if (mark >= parts) return 1;
        return sign_at(p, start + mark * width, exponent + step) * sign_high;
      };
  Integer left = part;
  const int here = beyond(part);
  if (here > 0) left = part - 1;
  const int other = here > 0 ? beyond(part - 1) : beyond(part + 1);
  if (here == 0 || other == 0) {
    dyadic = true;
    high = start + (here == 0 ? part : here > 0 ? Integer(part - 1) : Integer(part + 1)) * width;
    low = high;
    exponent += step;
    return;
  }
  if (here == other) {
    step = std::max(1U, step / 2);
    return halve();
  }
  low = start + left * width;
  high = low + width;
  exponent += step;
  step *= 2;
}

std::vector<Number> roots(const Polynomial& given) {
  std::vector<Number> found;
  if (isolated(given, bernstein(given), 0, 0, found)) return found;
  found.clear();
  const Polynomial p = squarefree(given);
  if (p.degree < 1) return found;
  if (p[0] == 0) found.push_back(number({0, 0}));
  const Chain chain = sturm_chain(p);
  Isolation isolation{p, chain, found};
  isolation.search(0, variations(chain, 0, 0), 1, variations(chain, 1, 0), 0);
  return found;
}

int sign_at(const Polynomial& g, Number& at) {
  if (g.degree <= 0) return g.is_zero() ? 0 : sgn(g[0]);
  Integer slope = 0;  // bounds |g'| on [0, 1]
  for (int k = 1; k <= g.degree; ++k) slope += k * abs(g[k]);
  bool common_known = false;
  while (!at.dyadic) {
    // g(high) with the scale of the interval, against the most g can change over it.
    Integer value = g[g.degree];
    Integer term;
    for (int k = g.degree - 1; k >= 0; --k) {
      value *= at.high;
      mpz_mul_2exp(term.get_mpz_t(), g[k].get_mpz_t(), at.exponent * static_cast<unsigned>(g.degree - k));
      value += term;
    }
    Integer change = slope * (at.high - at.low);
    mpz_mul_2exp(change.get_mpz_t(), change.get_mpz_t(), at.exponent * static_cast<unsigned>(g.degree - 1));
    if (abs(value) > change) return sgn(value);
    if (at.exponent > 80 && !common_known) {
      const Polynomial common = greatest_common_divisor(at.p, g);
      if (common.degree >= 1) {
        const Chain chain = sturm_chain(common);
        if (variations(chain, at.low, at.exponent) != variations(chain, at.high, at.exponent)) return 0;
      }
      common_known = true;
    }
    at.refine();
  }
  return sign_at(g, at.high, at.exponent);
}

int compare(Number& a, const Dyadic& t) {
  Integer denominator = 1;
  mpz_mul_2exp(denominator.get_mpz_t(), denominator.get_mpz_t(), t.exponent);
  return sign_at(Polynomial(-t.numerator, denominator), a);
}

}  // namespace brio::exact
