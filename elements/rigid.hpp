#pragma once
/// Settings of a rigid part. It has no block and no stress; its motion is in src/motion/rigid.hpp.

#include <array>
#include <optional>
#include <string_view>

#include "elements/base/element_kind.hpp"
#include "src/base/fields.hpp"
#include "src/base/tensor.hpp"

namespace brio {

struct Block;

struct Rigid {
  static constexpr std::string_view name = "rigid";
  static constexpr int nodes = 0;  ///< as many as the mesh gives its elements
  static constexpr bool rotations = false;
  static constexpr ElementTraits traits{
      .cell = hexahedron_cell, .gains_mass = false, .shares_nodes = false};  // cells as in its mesh
  template <class Law>
  static constexpr bool accepts = true;  // of a material model only the density is used

  std::optional<double> thickness;
  std::optional<double> mass;
  std::optional<std::array<double, 6>> inertia;
  std::optional<Vector3d> centre;

  double contact_thickness() const { return thickness.value_or(0); }

  static constexpr auto fields() {
    return field_table(
        optional("thickness", &Rigid::thickness, positive, "of the shells of a shell mesh, length"),
        optional("mass", &Rigid::mass, positive,
                 "mass; default: that of the mesh. The inertia of the mesh is scaled alike"),
        optional(
            "inertia", &Rigid::inertia, any_number,
            "xx yy zz xy yz xz of the inertia tensor about the centre, as it lies at the start; default: "
            "that of the mesh"),
        optional("centre", &Rigid::centre, any_number,
                 "centre of mass at the start; default: that of the mesh. Needs an inertia of its own"));
  }
  constexpr std::string_view fault() const {
    if (centre && !inertia) return "a centre of its own needs an inertia of its own; inertia is missing";
    if (!inertia) return "";
    const auto& [xx, yy, zz, xy, yz, xz] = *inertia;
    const double minor = xx * yy - xy * xy;
    const double determinant = xx * (yy * zz - yz * yz) - xy * (xy * zz - yz * xz) + xz * (xy * yz - yy * xz);
    return xx > 0 && minor > 0 && determinant > 0 ? "" : "the inertia is not positive definite";
  }
};

inline void choose_kernel(const Rigid&, Block&) {}  // nothing is swept

}  // namespace brio
