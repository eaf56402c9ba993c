#include "src/deck/coordinate_system.hpp"

#include <cmath>

namespace brio {

namespace {

/// Sine of the smallest angle of x and y that is not rounding of what a deck says.
constexpr double least_sine = 1e-6;

Vector cross_of(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

Vector unit(const Vector& v) {
  const double size = std::hypot(v[0], v[1], v[2]);
  return {v[0] / size, v[1] / size, v[2] / size};
}

Vector arm_from_axis(const CylindricalSystem& system, const Vector& position) {
  const Vector along = unit(system.axis);
  Vector arm{position[0] - system.point[0], position[1] - system.point[1], position[2] - system.point[2]};
  const double height = arm[0] * along[0] + arm[1] * along[1] + arm[2] * along[2];
  for (std::size_t i = 0; i < 3; ++i) arm[i] -= height * along[i];
  return arm;
}

}  // namespace

std::string_view RectangularSystem::fault() const {
  if (is_zero(x) || is_zero(y))
    return "x or y has no direction; at least one component of each must differ from 0";
  const Vector across = cross_of(unit(x), unit(y));
  return std::hypot(across[0], across[1], across[2]) < least_sine
             ? "x and y are parallel; accepted are two different directions"
             : "";
}

SystemAxes axes_of(const RectangularSystem& system) {
  const Vector x = unit(system.x);
  const Vector z = unit(cross_of(x, unit(system.y)));
  return {x, unit(cross_of(z, x)), z};
}

SystemAxes axes_at(const CylindricalSystem& system, const Vector& position, double least) {
  const Vector z = unit(system.axis);
  const Vector arm = arm_from_axis(system, position);
  if (std::hypot(arm[0], arm[1], arm[2]) <= least) return {Vector{}, Vector{}, z};
  const Vector r = unit(arm);
  return {r, unit(cross_of(z, r)), z};
}

double distance_from_axis(const CylindricalSystem& system, const Vector& position) {
  const Vector arm = arm_from_axis(system, position);
  return std::hypot(arm[0], arm[1], arm[2]);
}

Vector from_components(const SystemAxes& axes, const Vector& components) {
  Vector sum{};
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (std::size_t i = 0; i < 3; ++i) sum[i] += components[axis] * axes[axis][i];
  return sum;
}

}  // namespace brio
