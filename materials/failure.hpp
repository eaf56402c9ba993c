#pragma once
/// When a material fails and how it lets go: what a deck says of it. The law is in failing.hpp.

#include <array>
#include <optional>
#include <string_view>
#include <tuple>

#include "src/base/fields.hpp"

namespace brio {

/// What damage is made of.
enum class DamageGrowth {
  opening,  ///< strain in the direction of the largest principal stress, once failure has set in
  plastic_strain_in_tension  ///< plastic strain while the largest principal stress is positive
};
constexpr std::array<NamedValue<DamageGrowth>, 2> named_values(DamageGrowth) {
  return {{{"opening", DamageGrowth::opening},
           {"plastic_strain_in_tension", DamageGrowth::plastic_strain_in_tension}}};
}

inline constexpr Range share_range{.lower = 0, .upper = 1, .lower_open = true};

struct Failure {
  std::optional<double> strain{};
  std::optional<double> tearing_parameter{};
  DamageGrowth damage_growth = DamageGrowth::opening;
  std::optional<double> opening_strain{};
  std::optional<double> opening_displacement{};
  double deletion_damage = 0.9;
  double failed_points = 1;

  static constexpr auto fields() {
    return std::tuple{
        optional("strain", &Failure::strain, positive,
                 "equivalent plastic strain beyond which the material fails in tension, -"),
        optional("tearing_parameter", &Failure::tearing_parameter, positive,
                 "in place of strain: tearing parameter beyond which the material fails, -"),
        optional("damage_growth", &Failure::damage_growth, any_number,
                 "what damage is made of: opening strain after failure has set in, or plastic strain in "
                 "tension over the failure strain"),
        optional("opening_strain", &Failure::opening_strain, positive,
                 "strain along the largest principal stress, after failure has set in, at which damage is 1, "
                 "-"),
        optional("opening_displacement", &Failure::opening_displacement, positive,
                 "in place of opening_strain: that strain times the size of the element, length"),
        optional("deletion_damage", &Failure::deletion_damage, share_range,
                 "damage at which a point carries nothing any more, -"),
        optional("failed_points", &Failure::failed_points, share_range,
                 "share of an element's points that must have failed for it to be deleted, -"),
    };
  }

  constexpr std::string_view fault() const {
    const bool opens = damage_growth == DamageGrowth::opening;
    if (strain.has_value() == tearing_parameter.has_value())
      return "what the material fails at is not said once; accepted is one of strain and tearing_parameter";
    if (opens && opening_strain.has_value() == opening_displacement.has_value())
      return "damage by opening grows over an opening; accepted is one of opening_strain and "
             "opening_displacement";
    if (!opens && !strain)
      return "damage by plastic strain in tension is a share of the failure strain; strain is required";
    if (!opens && (opening_strain || opening_displacement))
      return "damage by plastic strain in tension knows no opening; leave out opening_strain and "
             "opening_displacement";
    return "";
  }
};

}  // namespace brio
