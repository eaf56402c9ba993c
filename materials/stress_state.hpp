#pragma once
/// What elements and materials exchange: stress, strain increments and moduli. The contract of a law is in
/// material_law.hpp.

#include "src/base/tensor.hpp"

namespace brio {

template <class T, class Mask>
BRIO_INLINE SymmetricTensor<T> where(Mask condition, const SymmetricTensor<T>& a,
                                     const SymmetricTensor<T>& b) {
  return {where(condition, a.xx, b.xx), where(condition, a.yy, b.yy), where(condition, a.zz, b.zz),
          where(condition, a.xy, b.xy), where(condition, a.yz, b.yz), where(condition, a.xz, b.xz)};
}

/// In-plane and transverse components on shell axes (zz = 0); shears are tensor components.
template <class T>
struct ShellTensor {
  T xx, yy, xy, yz, xz;

  friend BRIO_INLINE ShellTensor operator+(const ShellTensor& a, const ShellTensor& b) {
    return {a.xx + b.xx, a.yy + b.yy, a.xy + b.xy, a.yz + b.yz, a.xz + b.xz};
  }
  friend BRIO_INLINE ShellTensor operator-(const ShellTensor& a, const ShellTensor& b) {
    return {a.xx - b.xx, a.yy - b.yy, a.xy - b.xy, a.yz - b.yz, a.xz - b.xz};
  }
  friend BRIO_INLINE ShellTensor operator*(T s, const ShellTensor& a) {
    return {s * a.xx, s * a.yy, s * a.xy, s * a.yz, s * a.xz};
  }
};

template <class T, class Mask>
BRIO_INLINE ShellTensor<T> where(Mask condition, const ShellTensor<T>& a, const ShellTensor<T>& b) {
  return {where(condition, a.xx, b.xx), where(condition, a.yy, b.yy), where(condition, a.xy, b.xy),
          where(condition, a.yz, b.yz), where(condition, a.xz, b.xz)};
}

/// What a fibre of a beam carries, on axes whose x runs along the beam: zz, yy and yz of the stress are 0.
/// Shears are tensor components.
template <class T>
struct FibreTensor {
  T xx, xy, xz;

  friend BRIO_INLINE FibreTensor operator+(const FibreTensor& a, const FibreTensor& b) {
    return {a.xx + b.xx, a.xy + b.xy, a.xz + b.xz};
  }
  friend BRIO_INLINE FibreTensor operator-(const FibreTensor& a, const FibreTensor& b) {
    return {a.xx - b.xx, a.xy - b.xy, a.xz - b.xz};
  }
  friend BRIO_INLINE FibreTensor operator*(T s, const FibreTensor& a) {
    return {s * a.xx, s * a.xy, s * a.xz};
  }
};

template <class T, class Mask>
BRIO_INLINE FibreTensor<T> where(Mask condition, const FibreTensor<T>& a, const FibreTensor<T>& b) {
  return {where(condition, a.xx, b.xx), where(condition, a.xy, b.xy), where(condition, a.xz, b.xz)};
}

/// First Lame constant and shear modulus that bound wave speeds.
template <class T>
struct ElasticModuli {
  T first_lame, shear;
};

}  // namespace brio
