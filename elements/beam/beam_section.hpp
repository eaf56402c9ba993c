#pragma once
/// Cross sections of beams, and the fibres over which stress is integrated.
///
/// Axes: x runs along the beam, z is the direction that `orientation` points to, y = z cross x. Fibres give
/// area and second moments exactly; those of rectangles and I sections stand in halves, which gives the fully
/// plastic moments as well. Twist is that of Saint-Venant, scaled to the exact torsion constant.

#include <array>
#include <cstddef>
#include <string_view>
#include <variant>

#include "src/base/fields.hpp"

namespace brio {

inline constexpr int most_fibres = 128;
constexpr std::string_view fault_of_fibres(int first, int second) {
  return first * second <= most_fibres ? "" : "there are too many fibres; at most 128 are accepted in all";
}
inline constexpr Range ring_range{.lower = 2, .upper = 9};
inline constexpr Range round_fibre_range{.lower = 2, .upper = 64};
inline constexpr Range fibre_range{.lower = 2, .upper = 18};

struct CircleSection {
  static constexpr std::string_view name = "circle";
  static constexpr std::string_view meaning = "a full circle";
  double radius = 0;
  std::array<int, 2> fibres{2, 12};
  static constexpr auto fields() {
    return field_table(required("radius", &CircleSection::radius, positive, "radius"),
                       optional("fibres", &CircleSection::fibres, round_fibre_range,
                                "rings (2 to 9), fibres around each (even)"));
  }
  constexpr std::string_view fault() const {
    if (!ring_range.contains(fibres[0])) return "fibres have 2 to 9 rings";
    if (fibres[1] < 4 || fibres[1] % 2 != 0) return "fibres around are an even number from 4 on";
    return fault_of_fibres(fibres[0], fibres[1]);
  }
};

struct TubeSection {
  static constexpr std::string_view name = "tube";
  static constexpr std::string_view meaning = "a circular ring";
  double outer_radius = 0;
  double inner_radius = 0;
  std::array<int, 2> fibres{2, 12};
  static constexpr auto fields() {
    return field_table(
        required("outer_radius", &TubeSection::outer_radius, positive, "radius of the outside"),
        required("inner_radius", &TubeSection::inner_radius, positive, "radius of the inside"),
        optional("fibres", &TubeSection::fibres, round_fibre_range,
                 "rings (2 to 9), fibres around each (even)"));
  }
  constexpr std::string_view fault() const {
    if (outer_radius <= inner_radius)
      return "the wall has no thickness; outer_radius must exceed inner_radius";
    return CircleSection{outer_radius, fibres}.fault();
  }
};

struct RectangleSection {
  static constexpr std::string_view name = "rectangle";
  static constexpr std::string_view meaning = "a rectangle";
  double width = 0;
  double height = 0;
  std::array<int, 2> fibres{4, 4};
  static constexpr auto fields() {
    return field_table(
        required("width", &RectangleSection::width, positive, "across the orientation"),
        required("height", &RectangleSection::height, positive, "along the orientation"),
        optional("fibres", &RectangleSection::fibres, fibre_range, "fibres over width and height (even)"));
  }
  constexpr std::string_view fault() const {
    if (fibres[0] % 2 != 0 || fibres[1] % 2 != 0) return "the numbers of fibres are even";
    return fault_of_fibres(fibres[0], fibres[1]);
  }
};

struct ISection {
  static constexpr std::string_view name = "i_section";
  static constexpr std::string_view meaning = "two flanges and a web, symmetric about both axes";
  double width = 0;
  double height = 0;
  double web_thickness = 0;
  double flange_thickness = 0;
  std::array<int, 2> fibres{4, 2};
  static constexpr auto fields() {
    return field_table(
        required("width", &ISection::width, positive, "of the flanges, across the orientation"),
        required("height", &ISection::height, positive, "in all, along the orientation"),
        required("web_thickness", &ISection::web_thickness, positive, "thickness of the web"),
        required("flange_thickness", &ISection::flange_thickness, positive, "thickness of each flange"),
        optional("fibres", &ISection::fibres, fibre_range,
                 "fibres along and through each of flanges and web (even)"));
  }
  constexpr std::string_view fault() const {
    if (2 * flange_thickness >= height) return "no web is left; height must exceed twice flange_thickness";
    if (web_thickness > width)
      return "the web is wider than the flanges; width must not be below web_thickness";
    if (fibres[0] % 2 != 0 || fibres[1] % 2 != 0) return "the numbers of fibres are even";
    return fault_of_fibres(3 * fibres[0], fibres[1]);
  }
};

using BeamSection = std::variant<CircleSection, TubeSection, RectangleSection, ISection>;

inline bool is_round(const BeamSection& section) {
  return std::holds_alternative<CircleSection>(section) || std::holds_alternative<TubeSection>(section);
}

struct BeamFibre {
  double y, z;
  double share;             ///< of the area
  double shear_y, shear_z;  ///< its engineering shear per mean shear of the section along y, z
  double twist_y, twist_z;  ///< its engineering shears along y, z per twist, length
};

struct FibreSection {
  double area = 0;
  double second_moment_y = 0;  ///< integral of z^2, for bending about y
  double second_moment_z = 0;  ///< integral of y^2
  double torsion_constant = 0;
  double shear_factor_y = 0;  ///< shear area over area, along y
  double shear_factor_z = 0;
  double radius = 0;  ///< outer radius; of the circle of the same area where the section is not round
  int count = 0;
  std::array<BeamFibre, most_fibres> fibre{};
};

/// \param shear_factor in place of the section's own, if positive
FibreSection fibres_of(const BeamSection& section, double shear_factor = 0);

/// Torsion constant of a rectangle.
double torsion_constant(double width, double height);

}  // namespace brio
