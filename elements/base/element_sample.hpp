#pragma once
/// What output asks of an element.

#include <array>
#include <cstddef>
#include <limits>
#include <span>
#include <string_view>

#include "materials/stress_state.hpp"

namespace brio {

/// On global axes. What an element of the kind does not have is not a number.
struct ElementSample {
  static constexpr double undefined = std::numeric_limits<double>::quiet_NaN();
  static constexpr SymmetricTensor<double> undefined_tensor{undefined, undefined, undefined,
                                                            undefined, undefined, undefined};

  SymmetricTensor<double> stress{};  ///< Cauchy stress; mean over the points
  double internal_energy = 0;
  double thickness = 0;  ///< shells; 0 for others
  double radius = 0;     ///< beams and particles; 0 for others
  double density = 0;    ///< particles; 0 for others

  /// Shells: at the outermost integration point on one side.
  struct Side {
    std::size_t point = 0;
    SymmetricTensor<double> stress = undefined_tensor;
    double plastic_strain = undefined;  ///< the sweep fills it
  };
  Side top{}, bottom{};  ///< the normal points to the top
  /// Shells: integral over the thickness of the place, from the middle to the top, times the stress; force.
  SymmetricTensor<double> bending_moment = undefined_tensor;

  /// Beams, in the middle, on axes of the section: along the beam, y and z.
  std::array<double, 3> section_force{undefined, undefined, undefined};   ///< axial force, shear forces
  std::array<double, 3> section_moment{undefined, undefined, undefined};  ///< torque, bending moments

  // Of the law, whatever the element (materials/named_history.hpp); the sweep fills it.
  static constexpr std::size_t most_named = 8;
  std::span<const std::string_view> history_names{};
  std::array<double, most_named> history{};

  /// The value of that name; 0 where the law knows none.
  double named(std::string_view name) const {
    for (std::size_t k = 0; k < history_names.size(); ++k)
      if (history_names[k] == name) return history[k];
    return 0;
  }
};

}  // namespace brio
