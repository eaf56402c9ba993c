#pragma once
/// Objective rate of stress: the Green-Naghdi rate or the Jaumann rate. Both use the velocity gradient at the
/// middle of the time step and are exact for a rigid rotation of any size, of second order otherwise.
///
/// * green_naghdi: stress is kept on axes rotated by R of F = R U (the unrotated formulation of Flanagan &
/// Taylor 1987).
///   Where they integrate a rate for the left stretch, here one step of F is decomposed: see `advance`.
/// * jaumann: stress is rotated by the mean spin (Hughes & Winget 1980).
///
/// Notation: N = dt/2 L at mid-step; d = dt/2 D on material axes, so that the strain increment is 2 d.

#include <array>

#include "elements/base/quaternion.hpp"
#include "src/base/fields.hpp"
#include "src/base/tensor.hpp"

namespace brio {

enum class ObjectiveRate { green_naghdi, jaumann };
constexpr std::array<NamedValue<ObjectiveRate>, 2> named_values(ObjectiveRate) {
  return {{{"green_naghdi", ObjectiveRate::green_naghdi}, {"jaumann", ObjectiveRate::jaumann}}};
}

/// a (I - a)^-1 without cancellation for small a, and det(I - a). With a = dt/2 times the velocity gradient
/// on the end configuration this is N of the same affine motion. \pre the determinant is positive; where it
/// is not, `determinant` shows it and the result is meaningless.
template <class T>
BRIO_INLINE Tensor<T> centered(const Tensor<T>& a, T& determinant) {
  // a (I - a)^-1 = (a + adj(a) + (det a - second invariant) I) / det(I - a)
  const auto& m = a.m;
  const T c00 = m[1][1] * m[2][2] - m[1][2] * m[2][1];
  const T c11 = m[0][0] * m[2][2] - m[0][2] * m[2][0];
  const T c22 = m[0][0] * m[1][1] - m[0][1] * m[1][0];
  const T c01 = m[0][2] * m[2][1] - m[0][1] * m[2][2], c02 = m[0][1] * m[1][2] - m[0][2] * m[1][1];
  const T c10 = m[1][2] * m[2][0] - m[1][0] * m[2][2], c12 = m[1][0] * m[0][2] - m[0][0] * m[1][2];
  const T c20 = m[1][0] * m[2][1] - m[1][1] * m[2][0], c21 = m[2][0] * m[0][1] - m[0][0] * m[2][1];
  const T third = m[0][0] * c00 + m[0][1] * c10 + m[0][2] * c20;
  const T rest = third - (c00 + c11 + c22);
  determinant = 1.0 - ((m[0][0] + m[1][1] + m[2][2]) + rest);
  const T inverse = 1.0 / where(determinant > T(0.0), determinant, T(1.0));
  return {{{inverse * (m[0][0] + c00 + rest), inverse * (m[0][1] + c01), inverse * (m[0][2] + c02)},
           {inverse * (m[1][0] + c10), inverse * (m[1][1] + c11 + rest), inverse * (m[1][2] + c12)},
           {inverse * (m[2][0] + c20), inverse * (m[2][1] + c21), inverse * (m[2][2] + c22 + rest)}}};
}

/// w with skew(n) x = w cross x.
template <class T>
BRIO_INLINE Vector3<T> spin_vector(const Tensor<T>& n) {
  return {0.5 * (n.m[2][1] - n.m[1][2]), 0.5 * (n.m[0][2] - n.m[2][0]), 0.5 * (n.m[1][0] - n.m[0][1])};
}

/// r s r^T: from axes turned by r to the fixed ones.
template <class T>
BRIO_INLINE SymmetricTensor<T> turned(const Tensor<T>& r, const SymmetricTensor<T>& s) {
  T p[3][3];
  for (int i = 0; i < 3; ++i) {
    p[i][0] = r.m[i][0] * s.xx + r.m[i][1] * s.xy + r.m[i][2] * s.xz;
    p[i][1] = r.m[i][0] * s.xy + r.m[i][1] * s.yy + r.m[i][2] * s.yz;
    p[i][2] = r.m[i][0] * s.xz + r.m[i][1] * s.yz + r.m[i][2] * s.zz;
  }
  const auto entry = [&](int i, int j) {
    return p[i][0] * r.m[j][0] + p[i][1] * r.m[j][1] + p[i][2] * r.m[j][2];
  };
  return {entry(0, 0), entry(1, 1), entry(2, 2), entry(0, 1), entry(1, 2), entry(0, 2)};
}
/// r^T s r: from the fixed axes to axes turned by r.
template <class T>
BRIO_INLINE SymmetricTensor<T> turned_back(const Tensor<T>& r, const SymmetricTensor<T>& s) {
  T p[3][3];
  for (int j = 0; j < 3; ++j) {
    p[0][j] = s.xx * r.m[0][j] + s.xy * r.m[1][j] + s.xz * r.m[2][j];
    p[1][j] = s.xy * r.m[0][j] + s.yy * r.m[1][j] + s.yz * r.m[2][j];
    p[2][j] = s.xz * r.m[0][j] + s.yz * r.m[1][j] + s.zz * r.m[2][j];
  }
  const auto entry = [&](int i, int j) {
    return r.m[0][i] * p[0][j] + r.m[1][i] * p[1][j] + r.m[2][i] * p[2][j];
  };
  return {entry(0, 0), entry(1, 1), entry(2, 2), entry(0, 1), entry(1, 2), entry(0, 2)};
}
template <class T>
BRIO_INLINE Vector3<T> turned(const Tensor<T>& r, const Vector3<T>& a) {
  return {r.m[0][0] * a.x + r.m[0][1] * a.y + r.m[0][2] * a.z,
          r.m[1][0] * a.x + r.m[1][1] * a.y + r.m[1][2] * a.z,
          r.m[2][0] * a.x + r.m[2][1] * a.y + r.m[2][2] * a.z};
}
template <class T>
BRIO_INLINE Vector3<T> turned_back(const Tensor<T>& r, const Vector3<T>& a) {
  return {r.m[0][0] * a.x + r.m[1][0] * a.y + r.m[2][0] * a.z,
          r.m[0][1] * a.x + r.m[1][1] * a.y + r.m[2][1] * a.z,
          r.m[0][2] * a.x + r.m[1][2] * a.y + r.m[2][2] * a.z};
}

/// s [k] with [k] a = k cross a.
template <class T>
BRIO_INLINE Tensor<T> times_cross(const SymmetricTensor<T>& s, const Vector3<T>& k) {
  return {{{s.xy * k.z - s.xz * k.y, s.xz * k.x - s.xx * k.z, s.xx * k.y - s.xy * k.x},
           {s.yy * k.z - s.yz * k.y, s.yz * k.x - s.xy * k.z, s.xy * k.y - s.yy * k.x},
           {s.yz * k.z - s.zz * k.y, s.zz * k.x - s.xz * k.z, s.xz * k.y - s.yz * k.x}}};
}
/// s [k] - [k] s: the change of s on axes turned by the small rotation k; of s itself turned by -k.
template <class T>
BRIO_INLINE SymmetricTensor<T> commutator(const Tensor<T>& s_times_cross) {
  return T(2.0) * symmetric_part(s_times_cross);
}

/// Green-Naghdi: right stretch and rotation of F = R U.
template <class T>
struct StretchAndRotation {
  SymmetricTensor<T> stretch;
  Quaternion<T> rotation;
};

/// Result of one time step of either rate.
template <class T>
struct MaterialAxes {
  SymmetricTensor<T> half_strain;  ///< d
  Tensor<T> end;                   ///< material to fixed axes, at the end of the step
};

/// k with ([k] s + s [k]) = skew part of g, where s is its symmetric part.
template <class T>
BRIO_INLINE Vector3<T> symmetrizing_rotation(const Tensor<T>& g, const SymmetricTensor<T>& s) {
  const Vector3<T> a = spin_vector(g);
  // m = tr(s) I - s, inverted by cofactors.
  const T mxx = s.yy + s.zz, myy = s.xx + s.zz, mzz = s.xx + s.yy;
  const T cxx = myy * mzz - s.yz * s.yz, cyy = mxx * mzz - s.xz * s.xz, czz = mxx * myy - s.xy * s.xy;
  const T cxy = s.xz * s.yz + s.xy * mzz, cyz = s.xy * s.xz + s.yz * mxx, cxz = s.xy * s.yz + s.xz * myy;
  const T determinant = mxx * cxx - s.xy * cxy - s.xz * cxz;
  const T inverse = 1.0 / where(determinant > T(0.0), determinant, T(1.0));
  return {inverse * (cxx * a.x + cxy * a.y + cxz * a.z), inverse * (cxy * a.x + cyy * a.y + cyz * a.z),
          inverse * (cxz * a.x + cyz * a.y + czz * a.z)};
}

/// One step of F = R U. The spin alone turns R exactly as a rigid body (Cayley); on axes turned by half of
/// that, the step stretches U by the symmetric Cayley map of d up to third order, because the remainder is
/// odd in the step. The stretched U is not symmetric; the Cayley vector k that makes it so obeys [k] S + S
/// [k] = A - (k.a) [k] exactly, and the last term is of third order.
template <class T>
BRIO_INLINE MaterialAxes<T> advance(StretchAndRotation<T>& state, const Tensor<T>& n) {
  const Vector3<T> w = spin_vector(n);
  const T ww = dot(w, w);
  const T one(1.0);
  const T half = 0.5 - 0.125 * ww;  // tan(angle/4) from tan(angle/2), to fourth order
  const Quaternion<T> turn_half{one, half * w.x, half * w.y, half * w.z};
  MaterialAxes<T> axes;
  const Tensor<T> middle = rotation_matrix(turn_half * state.rotation, 2.0 / (1.0 + half * half * ww));
  const SymmetricTensor<T> d = turned_back(middle, symmetric_part(n));

  // g = U + 2 d (I - d)^-1 U
  const Tensor<T> d_full{{{d.xx, d.xy, d.xz}, {d.xy, d.yy, d.yz}, {d.xz, d.yz, d.zz}}};
  T determinant;
  const Tensor<T> c = centered(d_full, determinant);
  const SymmetricTensor<T>& u = state.stretch;
  const Tensor<T> u_full{{{u.xx, u.xy, u.xz}, {u.xy, u.yy, u.yz}, {u.xz, u.yz, u.zz}}};
  Tensor<T> g = c * u_full;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) g.m[i][j] = u_full.m[i][j] + 2.0 * g.m[i][j];
  const SymmetricTensor<T> s = symmetric_part(g);
  const Vector3<T> k = symmetrizing_rotation(g, s);

  // U = S + S K - K S - 2 K S K up to third order
  const Tensor<T> sk = times_cross(s, k);
  const SymmetricTensor<T> change = commutator(sk);
  const SymmetricTensor<T> ksk{k.y * sk.m[2][0] - k.z * sk.m[1][0], k.z * sk.m[0][1] - k.x * sk.m[2][1],
                               k.x * sk.m[1][2] - k.y * sk.m[0][2], k.y * sk.m[2][1] - k.z * sk.m[1][1],
                               k.z * sk.m[0][2] - k.x * sk.m[2][2], k.y * sk.m[2][2] - k.z * sk.m[1][2]};
  state.stretch = s + change - T(2.0) * ksk;
  axes.half_strain = d + commutator(times_cross(d, k));

  const Quaternion<T> turn{one, w.x, w.y, w.z};
  const Quaternion<T> correction{one, k.x, k.y, k.z};
  Quaternion<T> q = (turn * state.rotation) * correction;
  const T inverse_length = 1.0 / sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
  q = {inverse_length * q.w, inverse_length * q.x, inverse_length * q.y, inverse_length * q.z};
  state.rotation = q;
  axes.end = rotation_matrix(q, T(2.0));
  return axes;
}

/// Hughes & Winget: the rotation of the step alone, and d on the axes of its end.
template <class T>
BRIO_INLINE MaterialAxes<T> turn_with_spin(const Tensor<T>& n) {
  const Vector3<T> w = spin_vector(n);
  const SymmetricTensor<T> d = symmetric_part(n);
  MaterialAxes<T> axes;
  axes.end = rotation_matrix(Quaternion<T>{T(1.0), w.x, w.y, w.z}, 2.0 / (1.0 + dot(w, w)));
  axes.half_strain = d - commutator(times_cross(d, w));
  return axes;
}

}  // namespace brio
