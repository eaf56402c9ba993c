#pragma once
/// Random strain paths and the invariants that the tests of all laws share.

#include <cmath>
#include <random>
#include <type_traits>

#include "materials/stress_state.hpp"

namespace brio {

/// xi = dev(stress) - back stress
template <class T, class History>
SymmetricTensor<T> relative_deviator(const SymmetricTensor<T>& stress, const History& history) {
  if constexpr (requires { history.back_stress; }) {
    return deviator(stress) - history.back_stress;
  } else {
    return deviator(stress);
  }
}
template <class T>
T von_mises(const SymmetricTensor<T>& xi) {
  return sqrt(1.5 * contract(xi, xi));
}
template <class T>
SymmetricTensor<T> in_space(const ShellTensor<T>& a, T zz = T(0.0)) {
  return {a.xx, a.yy, zz, a.xy, a.yz, a.xz};
}
template <class T>
ShellTensor<T> in_plane(const SymmetricTensor<T>& a) {
  return {a.xx, a.yy, a.xy, a.yz, a.xz};
}

/// Strain increments in random directions whose size varies over decades, with stretches of steady straining.
class RandomPath {
 public:
  explicit RandomPath(unsigned seed, double largest = 1e-2) : engine_(seed), largest_(largest) {}

  SymmetricTensor<double> next() {
    if (remaining_-- <= 0) {
      remaining_ = 1 + static_cast<int>(uniform(0, 6));
      size_ = largest_ * std::pow(10.0, uniform(-4, 0));
      for (double& d : direction_) d = uniform(-1, 1);
    }
    return {size_ * direction_[0], size_ * direction_[1], size_ * direction_[2],
            size_ * direction_[3], size_ * direction_[4], size_ * direction_[5]};
  }
  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine_);
  }

 private:
  std::mt19937 engine_;
  double largest_;
  double size_ = 0;
  double direction_[6] = {};
  int remaining_ = 0;
};

/// Rotation about a random axis by a random angle, from a unit quaternion.
inline Tensor<double> random_rotation(RandomPath& random) {
  double q[4], norm = 0;
  do {
    norm = 0;
    for (double& c : q) {
      c = random.uniform(-1, 1);
      norm += c * c;
    }
  } while (norm < 0.1);
  for (double& c : q) c /= std::sqrt(norm);
  const auto [w, x, y, z] = q;
  return {{{1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)},
           {2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)},
           {2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)}}};
}
template <class T>
SymmetricTensor<T> rotated(const Tensor<T>& rotation, const SymmetricTensor<T>& a) {
  return symmetric_part(rotation * full(a) * transposed(rotation));
}

}  // namespace brio
