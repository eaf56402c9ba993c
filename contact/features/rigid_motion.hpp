#pragma once
/// Motion of a rigid body within one time step, for contact and walls.

#include <optional>

#include "src/base/tensor.hpp"

namespace brio {

struct RigidMotion {
  Vector3d centre{};            ///< at the beginning of the step
  Vector3d velocity{};          ///< of the centre
  Vector3d angular_velocity{};  ///< both over the step, as corrected so far
  /// Over the step before; the angular one is that which the angular momentum of then has at the present
  /// attitude.
  Vector3d velocity_before{};
  Vector3d angular_velocity_before{};
  double mass = 0;
  Tensor<double> inertia{};                  ///< about the centre, at the present attitude
  Tensor<double> axes = identity<double>();  ///< rows: of components that are prescribed
  Vector3d inverse_mass{};                   ///< along each of them; 0 where prescribed
  Tensor<double> inverse_inertia{};          ///< of the rotations that are free; else 0
  /// Impulse of contact and walls on the body in this step, and its moment about the centre.
  Vector3d impulse{};
  Vector3d moment{};

  /// Of the point at the end of an arm from the centre.
  Vector3d velocity_at(const Vector3d& arm) const { return velocity + cross(angular_velocity, arm); }
  Vector3d velocity_before_at(const Vector3d& arm) const {
    return velocity_before + cross(angular_velocity_before, arm);
  }
  void apply_impulse(const Vector3d& given, const Vector3d& arm) {
    const Vector3d turn = cross(arm, given);
    impulse += given;
    moment += turn;
    velocity += free_inverse_mass() * given;
    angular_velocity += inverse_inertia * turn;
  }
  Tensor<double> free_inverse_mass() const { return transposed(axes) * diagonal(inverse_mass) * axes; }
  bool translation_is_given(int axis) const { return inverse_mass[axis] == 0; }
  bool rotation_is_given(int axis) const {
    const Vector3d along = axes.row(axis);
    return dot(along, inverse_inertia * along) <= rounding * trace(inverse_inertia);
  }
  bool has_own_axes() const { return axes != identity<double>(); }
  /// Change of the velocity along a direction by a unit impulse along it.
  double inverse_mass_along(const Vector3d& direction, const Vector3d& arm) const {
    const Vector3d turn = cross(arm, direction);
    const Vector3d along = axes * direction;
    const double sum =
        dot(componentwise_product(along, along), inverse_mass) + dot(turn, inverse_inertia * turn);
    const double most = largest_component(inverse_mass) + squared_norm(turn) * trace(inverse_inertia);
    return sum > rounding * most ? sum : 0;
  }

  /// Saved and restored (src/base/state_archive.hpp).
  template <class Archive>
  void serialize(Archive& archive) {
    archive(centre, velocity, angular_velocity, velocity_before, angular_velocity_before, mass, inertia,
            inverse_mass, inverse_inertia, impulse, moment);
  }

  static constexpr double rounding = 1e-14;  ///< of what supports along any axes leave free
};

/// Inverse within the rows and columns of the free rotations about the body's axes, 0 elsewhere.
/// \param is_given whether rotation about an axis is prescribed
template <class IsGiven>
Tensor<double> free_inverse(const Tensor<double>& inertia, const Tensor<double>& axes,
                            const IsGiven& is_given) {
  if (!is_given(0) && !is_given(1) && !is_given(2)) return inverse(inertia);
  const Tensor<double> along_axes = axes * inertia * transposed(axes);
  Tensor<double> reduced = along_axes;
  for (int axis = 0; axis < 3; ++axis) {
    if (!is_given(axis)) continue;
    reduced.set_row(axis, {});
    reduced.set_column(axis, {});
    reduced(axis, axis) = along_axes(axis, axis);
  }
  Tensor<double> result = inverse(reduced);
  for (int axis = 0; axis < 3; ++axis)
    if (is_given(axis)) result(axis, axis) = 0;
  return transposed(axes) * result * axes;
}

/// The angular velocity whose given components are those of `given` and whose momentum has the free
/// components of `momentum`.
Vector3d angular_velocity_of(const RigidMotion& motion, const Vector3d& momentum, Vector3d given);

/// Rotation of a body over a step, and its angular momentum at the end.
struct RigidTurn {
  Vector3d rotation{};  ///< along the axis, with the length 2 tan(angle / 2)
  Vector3d momentum{};

  /// Rotation matrix less the identity (Cayley transform).
  Tensor<double> change_of_arms() const {
    const Tensor<double> v = cross_matrix(rotation);
    return 1 / (1 + 0.25 * squared_norm(rotation)) * (v + 0.5 * (v * v));
  }
};
/// Of a body that nothing pushes during the step. Free rotation is that of the midpoint rule for the angular
/// momentum in the body's frame; of one with prescribed components, free components of the angular momentum
/// are kept, given components of the angular velocity too, and the turn is by the mean of the angular
/// velocities at both ends. \return none: it turns too far
std::optional<RigidTurn> turn_over(const RigidMotion& motion, const Vector3d& momentum, double step);

/// Reaction of the supports of prescribed components to an impulse and a moment on a body.
struct RigidSupport {
  Vector3d impulse;
  Vector3d moment;     ///< about the centre
  double work_before;  ///< with the velocities before and after the step's impulses
  double work_after;
};
inline RigidSupport support_against(const RigidMotion& body, const Vector3d& impulse,
                                    const Vector3d& moment) {
  RigidSupport support{};
  const Vector3d pushed = body.axes * impulse;
  const Vector3d left = body.axes * (body.inertia * (body.inverse_inertia * moment) - moment);
  Vector3d held{}, turned{};
  for (int axis = 0; axis < 3; ++axis) {
    if (body.translation_is_given(axis)) held[axis] = -pushed[axis];
    if (body.rotation_is_given(axis)) turned[axis] = left[axis];
  }
  support.impulse = transposed_times(body.axes, held);
  support.moment = transposed_times(body.axes, turned);
  support.work_before =
      dot(support.impulse, body.velocity_before) + dot(support.moment, body.angular_velocity_before);
  support.work_after = dot(support.impulse, body.velocity) + dot(support.moment, body.angular_velocity);
  return support;
}

}  // namespace brio
