#include "contact/audit/orientation.hpp"

#include <array>
#include <cmath>
#include <cstddef>

namespace brio {

namespace {

/// Exact sum of doubles that do not overlap, ascending in size, zeros left out. The determinant of three
/// differences has at most 192 terms.
class Expansion {
 public:
  static Expansion difference(double a, double b) {
    Expansion result;
    const double sum = a - b;
    const double virtual_b = a - sum;
    result.append((a - (sum + virtual_b)) + (virtual_b - b));
    result.append(sum);
    return result;
  }

  int sign() const { return size_ == 0 ? 0 : term_[size_ - 1] > 0 ? 1 : -1; }

  Expansion operator-() const {
    Expansion result = *this;
    for (std::size_t i = 0; i < size_; ++i) result.term_[i] = -term_[i];
    return result;
  }

  Expansion operator+(const Expansion& other) const {
    Expansion result = *this;
    for (std::size_t i = 0; i < other.size_; ++i) result.grow(other.term_[i]);
    return result;
  }

  Expansion operator*(const Expansion& other) const {
    Expansion result;
    for (std::size_t i = 0; i < size_; ++i)
      for (std::size_t j = 0; j < other.size_; ++j) {
        const double product = term_[i] * other.term_[j];
        result.grow(std::fma(term_[i], other.term_[j], -product));
        result.grow(product);
      }
    return result;
  }

 private:
  void append(double value) {
    if (value != 0) term_[size_++] = value;
  }

  // Shewchuk's GROW-EXPANSION; the sum of two doubles and its error are exact (Knuth).
  void grow(double value) {
    const std::size_t size = size_;
    size_ = 0;
    for (std::size_t i = 0; i < size; ++i) {
      const double sum = value + term_[i];
      const double virtual_term = sum - value;
      append((value - (sum - virtual_term)) + (term_[i] - virtual_term));
      value = sum;
    }
    append(value);
  }

  std::array<double, 192> term_;
  std::size_t size_ = 0;
};

using ExpansionVector = std::array<Expansion, 3>;

ExpansionVector difference(const Vector3d& a, const Vector3d& b) {
  return {Expansion::difference(a[0], b[0]), Expansion::difference(a[1], b[1]),
          Expansion::difference(a[2], b[2])};
}

Expansion minor(const ExpansionVector& u, const ExpansionVector& v, std::size_t i, std::size_t j) {
  return u[i] * v[j] + -(u[j] * v[i]);
}

}  // namespace

int exact_orientation(const Vector3d& a, const Vector3d& b, const Vector3d& c, const Vector3d& d) {
  const ExpansionVector u = difference(b, a), v = difference(c, a), w = difference(d, a);
  return (w[0] * minor(u, v, 1, 2) + w[1] * minor(u, v, 2, 0) + w[2] * minor(u, v, 0, 1)).sign();
}

int orientation(const Vector3d& a, const Vector3d& b, const Vector3d& c, const Vector3d& d) {
  const Vector3d u = b - a, v = c - a, w = d - a;
  double determinant = 0, permanent = 0;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    const double forward = u[j] * v[k], backward = u[k] * v[j];
    determinant += w[i] * (forward - backward);
    permanent += std::abs(w[i]) * (std::abs(forward) + std::abs(backward));
  }
  if (std::abs(determinant) > orientation_error * permanent) return determinant > 0 ? 1 : -1;
  return exact_orientation(a, b, c, d);
}

}  // namespace brio
