#include "contact/features/rigid_motion.hpp"

#include <array>
#include <cmath>

#include "src/base/index.hpp"

namespace brio {

namespace {

constexpr int most_turn_iterations = 50;
// Newton's method doubles the digits: after a change below this share the next would be rounding.
constexpr double newton_share = 1e-9;
constexpr double converged_change = 1e-15;

// In the frame of the body as it stands at the start, where m' = m x (J^-1 m).
std::optional<RigidTurn> free_turn(const RigidMotion& motion, const Vector3d& momentum, double step) {
  const Tensor<double>& of_momentum = motion.inverse_inertia;
  Vector3d end = momentum + step * cross(momentum, of_momentum * momentum);
  for (int i = 0; i < most_turn_iterations; ++i) {
    const Vector3d mean = 0.5 * (momentum + end);
    const Vector3d rate = of_momentum * mean;
    const Vector3d residual = end - momentum - step * cross(mean, rate);
    const Tensor<double> slope =
        identity<double>() - 0.5 * step * (cross_matrix(mean) * of_momentum - cross_matrix(rate));
    const Vector3d change = inverse(slope) * residual;
    end -= change;
    if (norm(change) <= newton_share * norm(momentum))
      return RigidTurn{step * (of_momentum * (0.5 * (momentum + end))), momentum};
  }
  return std::nullopt;
}

std::optional<RigidTurn> given_turn(const RigidMotion& motion, const Vector3d& momentum, double step) {
  std::array<bool, 3> given;
  for (int axis = 0; axis < 3; ++axis) given[index(axis)] = motion.rotation_is_given(axis);
  RigidMotion turned = motion;
  const Vector3d start = motion.angular_velocity;
  Vector3d end = start;
  double last_change = HUGE_VAL;
  for (int i = 0; i < most_turn_iterations; ++i) {
    const Vector3d angles = 0.5 * step * (start + end);
    const double angle = norm(angles);
    RigidTurn turn{angle > 0 ? 2 * std::tan(0.5 * angle) / angle * angles : angles};
    const Tensor<double> rotation = identity<double>() + turn.change_of_arms();
    turned.inertia = rotation * motion.inertia * transposed(rotation);
    turned.inverse_inertia =
        free_inverse(turned.inertia, motion.axes, [&](int axis) { return given[index(axis)]; });
    const Vector3d next = angular_velocity_of(turned, momentum, start);
    const double change = norm(next - end);
    end = next;
    // Below the rounding of what it is computed from, a change does not get smaller.
    const bool is_rounding = change <= newton_share * norm(start) && change >= last_change;
    last_change = change;
    if (is_rounding || change <= converged_change * norm(start)) {
      turn.momentum = turned.inertia * end;
      return turn;
    }
  }
  return std::nullopt;
}

}  // namespace

Vector3d angular_velocity_of(const RigidMotion& motion, const Vector3d& momentum, Vector3d given) {
  given = motion.axes * given;
  for (int axis = 0; axis < 3; ++axis)
    if (!motion.rotation_is_given(axis)) given[axis] = 0;
  given = transposed_times(motion.axes, given);
  return given + motion.inverse_inertia * (momentum - motion.inertia * given);
}

std::optional<RigidTurn> turn_over(const RigidMotion& motion, const Vector3d& momentum, double step) {
  if (motion.rotation_is_given(0) || motion.rotation_is_given(1) || motion.rotation_is_given(2))
    return given_turn(motion, momentum, step);
  return free_turn(motion, momentum, step);
}

}  // namespace brio
