#pragma once
/// Local coordinate systems of a deck: `coordinate_systems: {ramp: {rectangular: {x: [1, 0, 1], y: [0, 1,
/// 0]}}}`. Only directions are taken from them, those at the start.

#include <array>
#include <string_view>
#include <variant>

#include "src/base/fields.hpp"
#include "src/deck/mesh_source.hpp"

namespace brio {

/// The same axes everywhere.
struct RectangularSystem {
  static constexpr std::string_view name = "rectangular";
  static constexpr std::string_view meaning = "axes x, y and z, the same everywhere";
  Vector3d x{}, y{};
  static constexpr auto fields() {
    return field_table(
        required("x", &RectangularSystem::x, any_number, "direction of its x axis"),
        required("y", &RectangularSystem::y, any_number,
                 "direction of its y axis, of which the part at right angles to x counts; z = x cross y"));
  }
  std::string_view fault() const;
};

/// Axes of each node, where it is at the start.
struct CylindricalSystem {
  static constexpr std::string_view name = "cylindrical";
  static constexpr std::string_view meaning =
      "r away from an axis, z along it, t = z cross r around it, of each node where it is at the start";
  Vector3d point{};
  Vector3d axis{};
  static constexpr auto fields() {
    return field_table(required("point", &CylindricalSystem::point, any_number, "a point of the axis"),
                       required("axis", &CylindricalSystem::axis, any_number, "direction of the axis"));
  }
  constexpr std::string_view fault() const {
    return is_zero(axis) ? "the axis has no direction; at least one component must differ from 0" : "";
  }
};

using CoordinateSystem = std::variant<RectangularSystem, CylindricalSystem>;

/// Unit vectors x, y, z, or r, t, z.
using SystemAxes = std::array<Vector3d, 3>;

SystemAxes axes_of(const RectangularSystem& system);
/// \param least distance from the axis below which r and t are 0: there is no such direction
SystemAxes axes_at(const CylindricalSystem& system, const Vector3d& position, double least);
double distance_from_axis(const CylindricalSystem& system, const Vector3d& position);

/// The vector with these components.
Vector3d from_components(const SystemAxes& axes, const Vector3d& components);

}  // namespace brio
