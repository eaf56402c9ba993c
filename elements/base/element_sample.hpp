#pragma once
/// What output asks of an element.

#include <array>
#include <cstddef>
#include <limits>
#include <span>
#include <string_view>

#include "materials/stress_state.hpp"
#include "src/base/index.hpp"

namespace brio {

/// On global axes. What an element of the kind does not have is not a number.
struct ElementSample {
  static constexpr double undefined = std::numeric_limits<double>::quiet_NaN();
  static constexpr SymmetricTensor<double> undefined_tensor{undefined, undefined, undefined,
                                                            undefined, undefined, undefined};

  SymmetricTensor<double> stress{};  ///< Cauchy stress; mean over the points
  double internal_energy = 0;
  double hourglass_energy = undefined;  ///< stored; kinds with hourglass control
  double volume = undefined;            ///< present
  double thickness = undefined;         ///< shells
  double radius = undefined;            ///< beams and particles
  double density = undefined;           ///< particles

  /// Shells: at one integration point of the thickness.
  struct Layer {
    static constexpr std::size_t none = index(-1);
    std::size_t point = none;
    SymmetricTensor<double> stress = undefined_tensor;
    double plastic_strain = undefined;  ///< the sweep fills it
  };
  Layer top{}, middle{}, bottom{};  ///< the outermost, the normal points to the top; of even rules no middle
  /// Shells: integral over the thickness of the place, from the middle to the top, times the stress; force.
  SymmetricTensor<double> bending_moment = undefined_tensor;

  /// Beams, in the middle, on axes of the section: along the beam, y and z.
  std::array<double, 3> section_force{undefined, undefined, undefined};   ///< axial force, shear forces
  std::array<double, 3> section_moment{undefined, undefined, undefined};  ///< torque, bending moments
  double twist = undefined;  ///< rotation about the axis over the initial length, where ends turn

  // Of the law, whatever the element (materials/named_history.hpp); the sweep fills it.
  static constexpr std::size_t most_named = 8;
  std::span<const std::string_view> history_names{};
  std::array<double, most_named> history{};

  /// The value of that name. \param otherwise where the law knows none
  double named(std::string_view name, double otherwise = undefined) const {
    for (std::size_t k = 0; k < history_names.size(); ++k)
      if (history_names[k] == name) return history[k];
    return otherwise;
  }
};

}  // namespace brio
