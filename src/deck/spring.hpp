#pragma once
/// Discrete springs and dashpots of a deck: `springs: {strut: {from: {...}, to: {...}, stiffness: 1e4}}`.

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "src/base/fields.hpp"
#include "src/deck/conditions.hpp"
#include "src/deck/mesh_source.hpp"

namespace brio {

/// An end of a spring: the node nearest to a point at the start, or the point itself; or each node of a set.
struct SpringEnd {
  std::optional<Vector3d> point{};
  std::optional<std::string> part{};
  bool fixed = false;
  std::optional<NodeSelection> set{};
  static constexpr auto fields() {
    return field_table(
        optional("point", &SpringEnd::point, any_number, "the node that is nearest to it at the start"),
        optional("part", &SpringEnd::part, any_number, "a node of this part only; default: of all"),
        optional("fixed", &SpringEnd::fixed, any_number,
                 "true: no node, but the point, which stays in place"),
        optional("set", &SpringEnd::set, any_number, "in place of a point: every node of a set"));
  }
  std::string_view fault() const {
    if (point.has_value() == set.has_value()) return "an end of a spring is either a 'point' or a 'set'";
    if (set && (fixed || part)) return "'part' and 'fixed' are accepted beside 'point', not beside 'set'";
    return fixed && part ? "a fixed point belongs to no part; leave out 'part' or 'fixed'" : "";
  }
};

/// Which nodes of two sets are joined.
enum class SpringPairing { nearest, order };
constexpr std::array<NamedValue<SpringPairing>, 2> named_values(SpringPairing) {
  return {{{"nearest", SpringPairing::nearest}, {"order", SpringPairing::order}}};
}
/// Of what stiffness, force, damping and strength are.
enum class SpringValues { each, total };
constexpr std::array<NamedValue<SpringValues>, 2> named_values(SpringValues) {
  return {{{"each", SpringValues::each}, {"total", SpringValues::total}}};
}

/// Acts along the line between its ends, or as a moment about an axis: a spring and a dashpot side by side.
struct Spring {
  using Table = std::vector<std::array<double, 2>>;

  std::string name{};
  SpringEnd from{}, to{};
  double stiffness = 0;
  Table force{};  ///< of elongation; empty: linear
  double damping = 0;
  std::optional<double> length{};
  std::optional<double> strength{};
  std::optional<Vector3d> axis{};  ///< of a torsional spring
  Table moment{};                  ///< of the angle; empty: linear
  std::optional<double> angle{};
  std::optional<SpringPairing> pairing{};
  std::optional<SpringValues> values{};
  std::string place{};  ///< in the deck
  static constexpr auto fields() {
    return field_table(
        required("from", &Spring::from, any_number, "one end"),
        required("to", &Spring::to, any_number, "the other end"),
        optional("stiffness", &Spring::stiffness, non_negative,
                 "force per elongation; with an axis moment per angle in radians"),
        optional("force", &Spring::force, any_number,
                 "instead of a stiffness a list of [elongation, force], linear between, constant beyond its "
                 "ends; tension is positive"),
        optional("damping", &Spring::damping, non_negative,
                 "force of the dashpot per rate of elongation, force time / length; with an axis moment per "
                 "rate of the angle"),
        optional("length", &Spring::length, non_negative,
                 "without force; default: the distance of the ends at the start"),
        optional("strength", &Spring::strength, positive,
                 "tension of the spring, without the dashpot, at which both break; with an axis the moment, "
                 "in either direction; absent: never"),
        optional("axis", &Spring::axis, any_number,
                 "makes it torsional: a moment about this axis, which turns with the end 'from', by the "
                 "angle of 'to' against 'from'; ends are nodes of shells and beams, rigid parts, and fixed "
                 "points"),
        optional("moment", &Spring::moment, any_number,
                 "of a torsional spring, instead of a stiffness: a list of [angle, moment], as 'force'"),
        optional("angle", &Spring::angle, any_number,
                 "of a torsional spring at the start, in radians, by which it is wound up; default: 0"),
        optional("pairing", &Spring::pairing, any_number,
                 "of two sets: nearest, each node of 'from' with the nearest of 'to'; or order, the first "
                 "with the first by their numbers in the mesh, of sets of equal size; default: nearest"),
        optional("values", &Spring::values, any_number,
                 "of sets: stiffness, force, damping and strength are of each pair of nodes, or in total, "
                 "divided by the number of pairs; default: each"));
  }
  bool is_torsional() const { return axis.has_value(); }
  bool joins_sets() const { return from.set || to.set; }
  /// Of elongation or of angle.
  const Table& table() const { return is_torsional() ? moment : force; }

  std::string_view fault() const {
    if (is_torsional() && (!force.empty() || length))
      return "'force' and 'length' of a torsional spring; accepted beside 'axis' are moment and angle";
    if (!is_torsional() && (!moment.empty() || angle))
      return "'moment' and 'angle' are of torsional springs; an 'axis' is wanted beside them";
    if (is_torsional() && is_zero(*axis))
      return "the axis has no direction; at least one component must differ from 0";
    if (!joins_sets() && (pairing || values)) return "'pairing' and 'values' are of springs between sets";
    if (pairing && !(from.set && to.set)) return "'pairing' is accepted where both ends are sets";
    return fault_of_law();
  }

 private:
  std::string_view fault_of_law() const {
    const Table& law = table();
    if (stiffness > 0 && !law.empty())
      return is_torsional() ? "both 'stiffness' and 'moment' are given; one of them is accepted"
                            : "both 'stiffness' and 'force' are given; one of them is accepted";
    if (stiffness == 0 && law.empty() && damping == 0)
      return is_torsional() ? "it has no moment; accepted: stiffness, moment, damping"
                            : "it has no force; accepted: stiffness, force, damping";
    if (law.size() == 1)
      return is_torsional() ? "'moment' is a list of two or more [angle, moment]"
                            : "'force' is a list of two or more [elongation, force]";
    for (std::size_t i = 1; i < law.size(); ++i)
      if (!(law[i][0] > law[i - 1][0]))
        return is_torsional()
                   ? "the angles of 'moment' do not grow; each must be larger than the one before"
                   : "the elongations of 'force' do not grow; each must be larger than the one before";
    return "";
  }
};

}  // namespace brio
