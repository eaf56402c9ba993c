#pragma once
/// Forces that are written to the history.

#include <array>
#include <string>
#include <vector>

#include "src/base/fields.hpp"
#include "src/deck/mesh_source.hpp"

namespace brio {

/// `all`, or a list of names of boundary conditions.
struct ReactionColumns {
  bool all = false;
  std::vector<std::string> names;
};

/// `all`, or a list of pairs of parts: force on the first by the second.
struct ContactColumns {
  bool all = false;
  std::vector<std::array<std::string, 2>> pairs;
  std::string place{};  ///< in the deck
};

/// A plane that cuts a part.
struct ForceSection {
  std::string name;
  std::string part;
  Vector3d point{};
  Vector3d normal{};
  std::string place{};  ///< in the deck
  static constexpr auto fields() {
    return field_table(
        required("part", &ForceSection::part, any_number, "the part that is cut, at the start"),
        required(
            "point", &ForceSection::point, any_number,
            "a point of the plane, about which moments are taken; it moves with the elements that are cut"),
        required(
            "normal", &ForceSection::normal, any_number,
            "of the plane: what lies ahead of it acts on what lies behind; tension is positive along it"));
  }
  constexpr std::string_view fault() const {
    return normal == Vector3d{} ? "the normal has no direction; at least one component must differ from 0"
                                : "";
  }
};

struct ForceOutput {
  ReactionColumns reactions;
  ContactColumns contact;
  std::vector<ForceSection> sections;
  static constexpr auto fields() {
    return field_table(
        optional(
            "reactions", &ForceOutput::reactions, any_number,
            "columns reaction.NAME_x, _y, _z: force of a boundary condition on what it supports or stops"),
        optional("contact", &ForceOutput::contact, any_number,
                 "columns contact.A.B_x, _y, _z: force on part A by part B, friction included, and of "
                 "friction alone contact.A.B.friction_x, _y, _z; of a part on itself the "
                 "sum of the sizes of the components"),
        optional(
            "sections", &ForceOutput::sections, any_number,
            "columns section.NAME_x, _y, _z and moments section.NAME_mx, _my, _mz: internal force through "
            "a plane of a part"));
  }
};

}  // namespace brio
