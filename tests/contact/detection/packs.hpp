#pragma once
/// Eight points side by side, put together and taken apart, and bits compared.

#include <bit>

#include "contact/geometry/number.hpp"
#include "src/base/tensor.hpp"

namespace brio {

using Pack = Lanes<double>;

inline void put(Vector3<Pack>& to, int lane, const Vector3d& from) {
  to.x.set(lane, from[0]);
  to.y.set(lane, from[1]);
  to.z.set(lane, from[2]);
}

inline bool same_bits(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}
inline bool same_bits(const Vector3<Pack>& pack, int lane, const Vector3d& v) {
  return same_bits(pack.x[lane], v.x) && same_bits(pack.y[lane], v.y) && same_bits(pack.z[lane], v.z);
}
inline bool in_lane(LaneMask<double> mask, int lane) { return mask.v[lane] != 0; }

}  // namespace brio
