#pragma once
/// When a material fails and how it lets go: what a deck says of it. The law is in failing.hpp.

#include <array>
#include <optional>
#include <string_view>

#include "src/base/fields.hpp"

namespace brio {

/// What damage is made of.
enum class DamageGrowth {
  opening,  ///< strain in the direction of the largest principal stress, once failure has set in
  plastic_strain_in_tension,  ///< plastic strain while the largest principal stress is positive
  sudden  ///< the share of the way to failure: the stress stays whole and is dropped at once
};
constexpr std::array<NamedValue<DamageGrowth>, 3> named_values(DamageGrowth) {
  return {{{"opening", DamageGrowth::opening},
           {"plastic_strain_in_tension", DamageGrowth::plastic_strain_in_tension},
           {"sudden", DamageGrowth::sudden}}};
}

inline constexpr Range share_range{.lower = 0, .upper = 1, .lower_open = true};

/// Failure strain that depends on triaxiality, rate and temperature. The formula is in
/// johnson_cook_fracture.hpp.
struct JohnsonCookFracture {
  double d1 = 0;
  double d2 = 0;
  double d3 = 0;
  double d4 = 0;
  double d5 = 0;
  std::optional<double> least_strain{};
  std::optional<double> least_triaxiality{};

  static constexpr auto fields() {
    return field_table(
        required("d1", &JohnsonCookFracture::d1, any_number,
                 "D1 of (D1 + D2 exp(D3 triaxiality)) (1 + D4 ln rate*) (1 + D5 T*), -"),
        required("d2", &JohnsonCookFracture::d2, any_number, "D2, -"),
        required("d3", &JohnsonCookFracture::d3, any_number,
                 "D3, below 0 where tension embrittles: triaxiality is mean stress over von Mises stress, "
                 "positive "
                 "in tension, -"),
        optional("d4", &JohnsonCookFracture::d4, any_number,
                 "D4, of the plastic strain rate over the reference rate of the law, -"),
        optional("d5", &JohnsonCookFracture::d5, any_number,
                 "D5, of the temperature from the reference (0) to melting (1), -"),
        optional("least_strain", &JohnsonCookFracture::least_strain, positive,
                 "bound below which the failure strain does not fall, -"),
        optional("least_triaxiality", &JohnsonCookFracture::least_triaxiality, any_number,
                 "triaxiality at and below which nothing is damaged, such as -0.33; absent: none, -"));
  }
  constexpr std::string_view fault() const {
    if (d1 <= 0 && d2 <= 0) return "with d1 and d2 <= 0 no failure strain is positive";
    if (!least_strain && (d1 < 0 || d2 < 0 || d4 < 0 || d5 <= -1))
      return "with a negative d1, d2 or d4, or with d5 <= -1, the failure strain falls to 0 at some "
             "triaxiality, "
             "rate or temperature; least_strain is required";
    return "";
  }
};

inline constexpr Range hosford_exponent_range{.lower = 1, .upper = 2};

/// Failure strain that depends on triaxiality and Lode angle. The formula is in hosford_coulomb_fracture.hpp.
struct HosfordCoulombFracture {
  double a = 1;
  double b = 0;
  double c = 0;
  double transformation_exponent = 0.1;

  static constexpr auto fields() {
    return field_table(
        required("a", &HosfordCoulombFracture::a, hosford_exponent_range,
                 "exponent of Hosford's stress: 1 (Tresca) breaks soonest in shear and plane strain, 2 (von "
                 "Mises) "
                 "in tension, -"),
        required("b", &HosfordCoulombFracture::b, positive,
                 "failure strain in uniaxial and in equal biaxial tension, -"),
        required("c", &HosfordCoulombFracture::c, non_negative,
                 "friction: how much the sum of largest and smallest principal stress counts, -"),
        optional("transformation_exponent", &HosfordCoulombFracture::transformation_exponent, positive,
                 "n_f: the failure strain goes as stress to the power -1 / n_f, -"));
  }
};

struct Failure {
  std::optional<double> strain{};
  std::optional<double> tearing_parameter{};
  std::optional<JohnsonCookFracture> johnson_cook{};
  std::optional<HosfordCoulombFracture> hosford_coulomb{};
  DamageGrowth damage_growth = DamageGrowth::opening;
  std::optional<double> opening_strain{};
  std::optional<double> opening_displacement{};
  std::optional<double> deletion_damage{};
  double failed_points = 1;

  static constexpr auto fields() {
    return field_table(
        optional("strain", &Failure::strain, positive,
                 "equivalent plastic strain beyond which the material fails in tension, -"),
        optional("tearing_parameter", &Failure::tearing_parameter, positive,
                 "in place of strain: tearing parameter beyond which the material fails, -"),
        optional(
            "johnson_cook", &Failure::johnson_cook, any_number,
            "in place of strain: failure strain by triaxiality, rate and temperature, of which shares are "
            "summed up"),
        optional("hosford_coulomb", &Failure::hosford_coulomb, any_number,
                 "in place of strain: failure strain by triaxiality and Lode angle, of which shares are "
                 "summed up: sees shear"),
        optional("damage_growth", &Failure::damage_growth, any_number,
                 "what damage is made of: opening strain after failure has set in, plastic strain in "
                 "tension over the failure strain, or the share of the way to a sudden failure"),
        optional("opening_strain", &Failure::opening_strain, positive,
                 "strain along the largest principal stress, after failure has set in, at which damage is 1, "
                 "-"),
        optional("opening_displacement", &Failure::opening_displacement, positive,
                 "in place of opening_strain: that strain times the size of the element, length"),
        optional("deletion_damage", &Failure::deletion_damage, share_range,
                 "damage at which a point carries nothing any more; default: 0.9, or 1 where failure is "
                 "sudden, -"),
        optional("failed_points", &Failure::failed_points, share_range,
                 "share of an element's points that must have failed for it to be deleted, -"));
  }

  constexpr std::string_view fault() const {
    const bool opens = damage_growth == DamageGrowth::opening;
    if (strain.has_value() + tearing_parameter.has_value() + johnson_cook.has_value() +
            hosford_coulomb.has_value() !=
        1)
      return "what the material fails at is not said once; accepted is one of strain, tearing_parameter, "
             "johnson_cook and hosford_coulomb";
    if (opens && opening_strain.has_value() == opening_displacement.has_value())
      return "damage by opening grows over an opening; accepted is one of opening_strain and "
             "opening_displacement, or damage_growth: sudden";
    if (damage_growth == DamageGrowth::plastic_strain_in_tension && !strain)
      return "damage by plastic strain in tension is a share of the failure strain; strain is required";
    if (damage_growth == DamageGrowth::sudden && strain)
      return "sudden failure is that of tearing_parameter, johnson_cook or hosford_coulomb, which know "
             "tension from pressure; "
             "for "
             "a strain alone see deletion: {plastic_strain: P} of a part";
    if (!opens && (opening_strain || opening_displacement))
      return "only damage by opening knows an opening; leave out opening_strain and opening_displacement";
    return "";
  }

  /// Damage at which a point carries nothing.
  constexpr double end_of_damage() const {
    return deletion_damage.value_or(damage_growth == DamageGrowth::sudden ? 1 : 0.9);
  }
};

/// What is wrong with the failure of a law that knows neither rate nor temperature.
constexpr std::string_view fault_without_rate(const std::optional<Failure>& failure) {
  if (failure && failure->johnson_cook && (failure->johnson_cook->d4 != 0 || failure->johnson_cook->d5 != 0))
    return "d4 and d5 of johnson_cook act on rate and temperature, which this model does not know; accepted "
           "is 0, "
           "or the model johnson_cook";
  return "";
}

}  // namespace brio
