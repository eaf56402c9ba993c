#pragma once
/// Motion of a rigid body within one time step, for contact and walls.

#include <Eigen/Dense>

namespace brio {

struct RigidMotion {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();            ///< at the beginning of the step
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();          ///< of the centre
  Eigen::Vector3d angular_velocity = Eigen::Vector3d::Zero();  ///< both over the step, as corrected so far
  /// Over the step before; the angular one is that which the angular momentum of then has at the present
  /// attitude.
  Eigen::Vector3d velocity_before = Eigen::Vector3d::Zero();
  Eigen::Vector3d angular_velocity_before = Eigen::Vector3d::Zero();
  double mass = 0;
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();          ///< about the centre, at the present attitude
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();         ///< rows: of components that are prescribed
  Eigen::Vector3d inverse_mass = Eigen::Vector3d::Zero();     ///< along each of them; 0 where prescribed
  Eigen::Matrix3d inverse_inertia = Eigen::Matrix3d::Zero();  ///< of the rotations that are free; else 0
  /// Impulse of contact and walls on the body in this step, and its moment about the centre.
  Eigen::Vector3d impulse = Eigen::Vector3d::Zero();
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();

  /// Of the point at the end of an arm from the centre.
  Eigen::Vector3d velocity_at(const Eigen::Vector3d& arm) const {
    return velocity + angular_velocity.cross(arm);
  }
  Eigen::Vector3d velocity_before_at(const Eigen::Vector3d& arm) const {
    return velocity_before + angular_velocity_before.cross(arm);
  }
  void apply_impulse(const Eigen::Vector3d& given, const Eigen::Vector3d& arm) {
    const Eigen::Vector3d turn = arm.cross(given);
    impulse += given;
    moment += turn;
    velocity += free_inverse_mass() * given;
    angular_velocity += inverse_inertia * turn;
  }
  Eigen::Matrix3d free_inverse_mass() const { return axes.transpose() * inverse_mass.asDiagonal() * axes; }
  bool translation_is_given(int axis) const { return inverse_mass[axis] == 0; }
  bool rotation_is_given(int axis) const {
    const Eigen::Vector3d along = axes.row(axis);
    return along.dot(inverse_inertia * along) <= rounding * inverse_inertia.trace();
  }
  bool has_own_axes() const { return !axes.isIdentity(0); }
  /// Change of the velocity along a direction by a unit impulse along it.
  double inverse_mass_along(const Eigen::Vector3d& direction, const Eigen::Vector3d& arm) const {
    const Eigen::Vector3d turn = arm.cross(direction);
    const Eigen::Vector3d along = axes * direction;
    const double sum = along.cwiseProduct(along).dot(inverse_mass) + turn.dot(inverse_inertia * turn);
    const double most = inverse_mass.maxCoeff() + turn.squaredNorm() * inverse_inertia.trace();
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

/// Reaction of the supports of prescribed components to an impulse and a moment on a body.
struct RigidSupport {
  Eigen::Vector3d impulse;
  Eigen::Vector3d moment;  ///< about the centre
  double work_before;      ///< with the velocities before and after the step's impulses
  double work_after;
};
inline RigidSupport support_against(const RigidMotion& body, const Eigen::Vector3d& impulse,
                                    const Eigen::Vector3d& moment) {
  RigidSupport support{};
  const Eigen::Vector3d pushed = body.axes * impulse;
  const Eigen::Vector3d left = body.axes * (body.inertia * (body.inverse_inertia * moment) - moment);
  Eigen::Vector3d held = Eigen::Vector3d::Zero(), turned = Eigen::Vector3d::Zero();
  for (int axis = 0; axis < 3; ++axis) {
    if (body.translation_is_given(axis)) held[axis] = -pushed[axis];
    if (body.rotation_is_given(axis)) turned[axis] = left[axis];
  }
  support.impulse = body.axes.transpose() * held;
  support.moment = body.axes.transpose() * turned;
  support.work_before =
      support.impulse.dot(body.velocity_before) + support.moment.dot(body.angular_velocity_before);
  support.work_after = support.impulse.dot(body.velocity) + support.moment.dot(body.angular_velocity);
  return support;
}

}  // namespace brio
