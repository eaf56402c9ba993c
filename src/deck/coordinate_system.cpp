#include "src/deck/coordinate_system.hpp"

#include <cmath>

namespace brio {

namespace {

/// Sine of the smallest angle of x and y that is not rounding of what a deck says.
constexpr double least_sine = 1e-6;

Vector3d unit(const Vector3d& v) {
  const double size = std::hypot(v[0], v[1], v[2]);
  return v / size;
}

Vector3d arm_from_axis(const CylindricalSystem& system, const Vector3d& position) {
  const Vector3d along = unit(system.axis);
  const Vector3d arm = position - system.point;
  return arm - dot(arm, along) * along;
}

}  // namespace

std::string_view RectangularSystem::fault() const {
  if (is_zero(x) || is_zero(y))
    return "x or y has no direction; at least one component of each must differ from 0";
  const Vector3d across = cross(unit(x), unit(y));
  return std::hypot(across[0], across[1], across[2]) < least_sine
             ? "x and y are parallel; accepted are two different directions"
             : "";
}

SystemAxes axes_of(const RectangularSystem& system) {
  const Vector3d x = unit(system.x);
  const Vector3d z = unit(cross(x, unit(system.y)));
  return {x, unit(cross(z, x)), z};
}

SystemAxes axes_at(const CylindricalSystem& system, const Vector3d& position, double least) {
  const Vector3d z = unit(system.axis);
  const Vector3d arm = arm_from_axis(system, position);
  if (std::hypot(arm[0], arm[1], arm[2]) <= least) return {Vector3d{}, Vector3d{}, z};
  const Vector3d r = unit(arm);
  return {r, unit(cross(z, r)), z};
}

double distance_from_axis(const CylindricalSystem& system, const Vector3d& position) {
  const Vector3d arm = arm_from_axis(system, position);
  return std::hypot(arm[0], arm[1], arm[2]);
}

Vector3d from_components(const SystemAxes& axes, const Vector3d& components) {
  return components.x * axes[0] + components.y * axes[1] + components.z * axes[2];
}

}  // namespace brio
