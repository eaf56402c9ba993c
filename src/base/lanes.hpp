#pragma once
/// Numbers side by side: `Lanes<double>` holds 8, `Lanes<float>` 16 (64 bytes). Kernels are written once on a
/// number-like `T`, which is `Lanes<Real>` in a run and plain `double` in a test. There is no branch per lane
/// but `where(condition, a, b)`; both of its values are computed, so neither may divide by zero in a lane not
/// chosen.

#include <cmath>
#include <cstdint>
#include <type_traits>

#include "src/base/wide.hpp"

namespace brio {

template <Floating Real>
inline constexpr int lane_count = static_cast<int>(64 / sizeof(Real));

/// One truth value a lane.
template <Floating Real>
struct LaneMask {
  using Vector = Wide<IntegerOf<Real>>;
  Vector v;

  friend BRIO_INLINE LaneMask operator&(LaneMask a, LaneMask b) { return {a.v & b.v}; }
  friend BRIO_INLINE LaneMask operator|(LaneMask a, LaneMask b) { return {a.v | b.v}; }
  friend BRIO_INLINE LaneMask operator!(LaneMask a) { return {~a.v}; }
};

template <Floating Real>
struct Lanes {
  using Vector = Wide<Real>;
  Vector v;

  Lanes() = default;
  BRIO_INLINE Lanes(double value)
      : v(broadcast(static_cast<Real>(value))) {}  // implicit: a number in every lane
  explicit BRIO_INLINE Lanes(Vector vector) : v(vector) {}
  /// Numbers that follow each other.
  static BRIO_INLINE Lanes load(const Real* first) {
    Lanes lanes;
    __builtin_memcpy(&lanes.v, first, sizeof lanes.v);
    return lanes;
  }

  BRIO_INLINE Real operator[](int lane) const { return v[lane]; }
  BRIO_INLINE void set(int lane, Real value) { set_lane(v, lane, value); }

  friend BRIO_INLINE Lanes operator+(Lanes a, Lanes b) { return Lanes(a.v + b.v); }
  friend BRIO_INLINE Lanes operator-(Lanes a, Lanes b) { return Lanes(a.v - b.v); }
  friend BRIO_INLINE Lanes operator*(Lanes a, Lanes b) { return Lanes(a.v * b.v); }
  friend BRIO_INLINE Lanes operator/(Lanes a, Lanes b) { return Lanes(a.v / b.v); }
  friend BRIO_INLINE Lanes operator-(Lanes a) { return Lanes(-a.v); }
  BRIO_INLINE Lanes& operator+=(Lanes b) {
    v += b.v;
    return *this;
  }
  BRIO_INLINE Lanes& operator-=(Lanes b) {
    v -= b.v;
    return *this;
  }
  BRIO_INLINE Lanes& operator*=(Lanes b) {
    v *= b.v;
    return *this;
  }
  BRIO_INLINE Lanes& operator/=(Lanes b) {
    v /= b.v;
    return *this;
  }
  friend BRIO_INLINE LaneMask<Real> operator<(Lanes a, Lanes b) { return {a.v < b.v}; }
  friend BRIO_INLINE LaneMask<Real> operator>(Lanes a, Lanes b) { return {a.v > b.v}; }
  friend BRIO_INLINE LaneMask<Real> operator<=(Lanes a, Lanes b) { return {a.v <= b.v}; }
  friend BRIO_INLINE LaneMask<Real> operator>=(Lanes a, Lanes b) { return {a.v >= b.v}; }
  friend BRIO_INLINE LaneMask<Real> operator==(Lanes a, Lanes b) { return {a.v == b.v}; }
};

/// What kernels ask of a number: its scalar type, its truth type, and how many stand side by side.
template <class T>
struct NumberTraits {
  using Real = T;
  using Mask = bool;
  static constexpr int lanes = 1;
};
template <Floating Real_>
struct NumberTraits<Lanes<Real_>> {
  using Real = Real_;
  using Mask = LaneMask<Real_>;
  static constexpr int lanes = lane_count<Real_>;
};
template <class T>
using RealOf = typename NumberTraits<T>::Real;
template <class T>
using MaskOf = typename NumberTraits<T>::Mask;

template <Floating Real>
BRIO_INLINE Lanes<Real> where(LaneMask<Real> condition, Lanes<Real> a, Lanes<Real> b) {
  return Lanes<Real>(select(condition.v, a.v, b.v));
}
template <Floating Real>
BRIO_INLINE Lanes<Real> where(LaneMask<Real> condition, Lanes<Real> a, std::type_identity_t<double> b) {
  return where(condition, a, Lanes<Real>(b));
}
template <Floating Real>
BRIO_INLINE Lanes<Real> where(LaneMask<Real> condition, std::type_identity_t<double> a, Lanes<Real> b) {
  return where(condition, Lanes<Real>(a), b);
}
template <Floating Real>
BRIO_INLINE Real where(bool condition, Real a, std::type_identity_t<Real> b) {
  return condition ? a : b;
}

template <Floating Real>
BRIO_INLINE bool any(LaneMask<Real> mask) {
  return any_bit(mask.v);
}
BRIO_INLINE bool any(bool mask) { return mask; }
template <class Mask>
BRIO_INLINE bool all(Mask mask) {
  return !any(!mask);
}

template <Floating Real>
BRIO_INLINE Lanes<Real> max(Lanes<Real> a, Lanes<Real> b) {
  return where(a > b, a, b);
}
template <Floating Real>
BRIO_INLINE Lanes<Real> min(Lanes<Real> a, Lanes<Real> b) {
  return where(a < b, a, b);
}
template <Floating Real>
BRIO_INLINE Lanes<Real> max(Lanes<Real> a, std::type_identity_t<double> b) {
  return max(a, Lanes<Real>(b));
}
template <Floating Real>
BRIO_INLINE Lanes<Real> min(Lanes<Real> a, std::type_identity_t<double> b) {
  return min(a, Lanes<Real>(b));
}
template <Floating Real>
BRIO_INLINE Real max(Real a, std::type_identity_t<Real> b) {
  return a > b ? a : b;
}
template <Floating Real>
BRIO_INLINE Real min(Real a, std::type_identity_t<Real> b) {
  return a < b ? a : b;
}

template <Floating Real>
BRIO_INLINE Lanes<Real> sqrt(Lanes<Real> a) {
  return Lanes<Real>(square_root(a.v));
}
template <Floating Real>
BRIO_INLINE Real sqrt(Real a) {
  return std::sqrt(a);
}
template <Floating Real>
BRIO_INLINE Lanes<Real> abs(Lanes<Real> a) {
  return where(a < Lanes<Real>(0.0), -a, a);
}
template <Floating Real>
BRIO_INLINE Real abs(Real a) {
  return std::abs(a);
}

/// Smallest and summed value of the first `count` lanes, in a fixed order.
template <Floating Real>
BRIO_INLINE double minimum(Lanes<Real> a, int count) {
  double least = static_cast<double>(a.v[0]);
  for (int lane = 1; lane < count; ++lane)
    least = static_cast<double>(a.v[lane]) < least ? static_cast<double>(a.v[lane]) : least;
  return least;
}
template <Floating Real>
BRIO_INLINE double sum(Lanes<Real> a, int count) {
  double total = 0;
  for (int lane = 0; lane < count; ++lane) total += static_cast<double>(a.v[lane]);
  return total;
}

template <class T>
BRIO_INLINE T square(T a) {
  return a * a;
}

}  // namespace brio
