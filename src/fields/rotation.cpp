#include "src/fields/rotation.hpp"

#include <algorithm>
#include <cmath>

#include "src/base/index.hpp"

namespace brio {

namespace {

void rotation_of_node(const Model& model, int node, double* out) {
  const Quaternion<double>& q = model.rotations[index(node)];
  const Vector3d vector = rotation_vector(q);
  std::copy_n(vector.data(), 3, out);
}

constexpr PointVariable of_rotation{rotation_field,
                                    3,
                                    rotation_of_node,
                                    true,
                                    "radian",
                                    "rotation vector since the start, its angle at most pi; NaN at nodes of "
                                    "solids, particles, trusses and of "
                                    "rigid parts alone, whose rotations are in the history"};

}  // namespace

// A quaternion and its opposite are one rotation: the one of the smaller angle is taken.
Vector3d rotation_vector(const Quaternion<double>& rotation) {
  const double sign = rotation.w < 0 ? -1 : 1;
  const Vector3d axis = sign * vector_part(rotation);
  const double sine = norm(axis);
  const double half_angle = std::atan2(sine, sign * rotation.w);
  return sine > 0 ? (2 * half_angle / sine) * axis : 2 * axis;
}

const PointVariable& rotation_variable() { return of_rotation; }

}  // namespace brio
