#pragma once
/// How far the neighbours of a particle, as they stand now, tell of the motion around it.
///
/// Neighbours all around have moments M = sum s x x^T close to V I, with the volume V of the particle; at a
/// flat surface of a body half of that in one direction. Where bodies of particles flatten out, or break up,
/// it may be any small number, and K = M^-1, with it the frequency of the particle, any large one. Along
/// principal directions a of M whose moment m_a is below a share of V, the floor, the particle strains, and
/// pulls, by the share S_a = m_a / floor only, so that a sheet or a thread of particles loses its strength
/// across smoothly:
///
///     D = sym(S L S),      A = V S P S K,      S K = 1 / max(m_a, floor).
///
/// Power is the same from both sides, and sum s x (A x)^T = V S P S is symmetric: energy and both momenta are
/// kept as they are with S = I.

#include <type_traits>

#include "elements/particle/particle_weights.hpp"
#include "materials/principal_stress.hpp"
#include "src/base/tensor.hpp"

namespace brio {

/// Moments over the volume below which a direction is poor in neighbours. A corner of a box, an octant of
/// neighbours, has 0.05 in its poorest direction.
inline constexpr double least_support = 0.02;

template <class T>
class ParticleSupport {
 public:
  /// \param volume of the particle
  BRIO_INLINE ParticleSupport(const SymmetricTensor<T>& moments, std::type_identity_t<T> volume) {
    const T floor = least_support * volume;
    const SymmetricTensor<T> cofactor = adjugate(moments);
    const T determinant = moments.xx * cofactor.xx + moments.xy * cofactor.xy + moments.xz * cofactor.xz;
    const T half_trace = 0.5 * trace(moments);
    // The product of the two larger moments is at most the square of half the trace.
    is_whole_ = determinant > floor * half_trace * half_trace;
    inverse_ = (1.0 / where(is_whole_, determinant, T(1.0))) * cofactor;
    if (all(is_whole_)) return;
    axes_ = principal_axes(moments);
    const T moment[3] = {axes_.value.x, axes_.value.y, axes_.value.z};
    for (int a = 0; a < 3; ++a) {
      share_[a] = min(max(moment[a] / floor, 0.0), 1.0);
      inverse_value_[a] = 1.0 / max(moment[a], floor);
    }
    inverse_ = of_whole(inverse_, on_axes(inverse_value_[0], inverse_value_[1], inverse_value_[2]));
  }

  /// S K
  const SymmetricTensor<T>& inverse() const { return inverse_; }
  SymmetricTensor<T> share() const {
    const SymmetricTensor<T> whole = isotropic(T(1.0));
    return all(is_whole_) ? whole : of_whole(whole, on_axes(share_[0], share_[1], share_[2]));
  }
  /// Of S S K: over the initial one, the growth of the highest frequency squared.
  T stiffness() const {
    if (all(is_whole_)) return trace(inverse_);
    return where(
        is_whole_, trace(inverse_),
        share_[0] * inverse_value_[0] + share_[1] * inverse_value_[1] + share_[2] * inverse_value_[2]);
  }
  /// The inverse of S K: M, raised to the floor.
  SymmetricTensor<T> raised(const SymmetricTensor<T>& moments) const {
    if (all(is_whole_)) return moments;
    return of_whole(moments,
                    on_axes(1.0 / inverse_value_[0], 1.0 / inverse_value_[1], 1.0 / inverse_value_[2]));
  }

  /// sym(S L S) and the spin. \param sum of s v x^T
  Tensor<T> velocity_gradient(const Tensor<T>& sum) const {
    const Tensor<T> product = sum * full(inverse_);
    if (all(is_whole_)) return product;
    Tensor<T> held = held_back(product);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) held.m[i][j] = where(is_whole_, product.m[i][j], held.m[i][j]);
    return held;
  }

 private:
  SymmetricTensor<T> of_whole(const SymmetricTensor<T>& a, const SymmetricTensor<T>& other) const {
    return {where(is_whole_, a.xx, other.xx), where(is_whole_, a.yy, other.yy),
            where(is_whole_, a.zz, other.zz), where(is_whole_, a.xy, other.xy),
            where(is_whole_, a.yz, other.yz), where(is_whole_, a.xz, other.xz)};
  }
  SymmetricTensor<T> on_axes(T a, T b, T c) const {
    const T value[3] = {a, b, c};
    const auto entry = [&](int i, int j) {
      T sum(0.0);
      for (int k = 0; k < 3; ++k) sum += value[k] * axes_.direction.m[i][k] * axes_.direction.m[j][k];
      return sum;
    };
    return {entry(0, 0), entry(1, 1), entry(2, 2), entry(0, 1), entry(1, 2), entry(0, 2)};
  }

  /// \param product L S. Of the spin about two axes each of them tells by its share; with one share of 0 the
  /// other tells it as that of a rigid rotation.
  Tensor<T> held_back(const Tensor<T>& product) const {
    const Tensor<T>& q = axes_.direction;
    const Tensor<T> b = transposed(q) * product * q;
    Tensor<T> gradient;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        const T squares = share_[i] * share_[i] + share_[j] * share_[j];
        const MaskOf<T> tells = squares > T(0.0);
        const T spin = where(
            tells, (share_[j] * b.m[i][j] - share_[i] * b.m[j][i]) / where(tells, squares, T(1.0)), T(0.0));
        gradient.m[i][j] = 0.5 * (share_[i] * b.m[i][j] + share_[j] * b.m[j][i]) + spin;
      }
    return q * gradient * transposed(q);
  }

  PrincipalAxes<T> axes_;  ///< where a lane is not whole
  T share_[3], inverse_value_[3];
  SymmetricTensor<T> inverse_;
  MaskOf<T> is_whole_;
};

}  // namespace brio
