#pragma once
/// Discrete springs and dashpots of a deck: `springs: {strut: {from: {...}, to: {...}, stiffness: 1e4}}`.

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "src/base/fields.hpp"
#include "src/deck/mesh_source.hpp"

namespace brio {

/// An end of a spring: the node nearest to a point at the start, or the point itself.
struct SpringEnd {
  Triple point{};
  std::optional<std::string> part{};
  bool fixed = false;
  static constexpr auto fields() {
    return field_table(
        required("point", &SpringEnd::point, any_number, "the node that is nearest to it at the start"),
        optional("part", &SpringEnd::part, any_number, "a node of this part only; default: of all"),
        optional("fixed", &SpringEnd::fixed, any_number,
                 "true: no node, but the point, which stays in place"));
  }
  std::string_view fault() const {
    return fixed && part ? "a fixed point belongs to no part; leave out 'part' or 'fixed'" : "";
  }
};

/// Acts along the line between its ends: a spring and a dashpot side by side.
struct Spring {
  std::string name{};
  SpringEnd from{}, to{};
  double stiffness = 0;
  std::vector<std::array<double, 2>> force{};  ///< of elongation; empty: linear
  double damping = 0;
  std::optional<double> length{};
  std::optional<double> strength{};
  std::string place{};  ///< in the deck
  static constexpr auto fields() {
    return field_table(
        required("from", &Spring::from, any_number, "one end"),
        required("to", &Spring::to, any_number, "the other end"),
        optional("stiffness", &Spring::stiffness, non_negative, "force per elongation"),
        optional("force", &Spring::force, any_number,
                 "instead of a stiffness a list of [elongation, force], linear between, constant beyond its "
                 "ends; tension is positive"),
        optional("damping", &Spring::damping, non_negative,
                 "force of the dashpot per rate of elongation, force time / length"),
        optional("length", &Spring::length, non_negative,
                 "without force; default: the distance of the ends at the start"),
        optional("strength", &Spring::strength, positive,
                 "tension of the spring, without the dashpot, at which both break; absent: never"));
  }
  std::string_view fault() const {
    if (stiffness > 0 && !force.empty())
      return "both 'stiffness' and 'force' are given; one of them is accepted";
    if (stiffness == 0 && force.empty() && damping == 0)
      return "it has no force; accepted: stiffness, force, damping";
    if (force.size() == 1) return "'force' is a list of two or more [elongation, force]";
    for (std::size_t i = 1; i < force.size(); ++i)
      if (!(force[i][0] > force[i - 1][0]))
        return "the elongations of 'force' do not grow; each must be larger than the one before";
    return "";
  }
};

}  // namespace brio
