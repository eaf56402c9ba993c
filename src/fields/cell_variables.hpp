#pragma once
/// Fields of cells that a deck chooses, `output.fields.variables`.

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "elements/base/element_kind.hpp"
#include "elements/base/element_sample.hpp"

namespace brio {

/// What follows from what an element tells of itself, or from where its nodes were and are, and their
/// velocities.
struct CellVariable {
  std::string_view name;
  int components;  ///< 1, 3, or 6 of a symmetric tensor: xx, yy, zz, xy, yz, xz
  void (*values)(const ElementSample&, double* out);  ///< null: of its nodes (strain.hpp)
  /// Of the kinds of elements that have it; null: of all. Elsewhere it is not a number.
  bool ElementTraits::*of;
  std::string_view unit, meaning;  ///< for the manual

  bool is_partial() const { return of != nullptr || values == nullptr; }
};

/// xx, yy, zz, xy, yz, xz. \param out six
void write_components(const SymmetricTensor<double>& tensor, double* out);

/// Those that a deck can name: of the stress that is written, energy, strain, and of shells and beams alone.
std::span<const CellVariable> chosen_variables();
/// Of these or of those that stand in the group `default`. \pre there is one of that name
const CellVariable& cell_variable(std::string_view name);
/// Fields that stand in the group `default`, or are written in any case.
struct DefaultField {
  std::string_view name;
  int components;
  std::string_view of, unit, meaning;  ///< for the manual
};
std::span<const DefaultField> default_fields();
/// Fields from which other runs can start; in no group. Components 0: they depend on the scene.
std::span<const DefaultField> state_fields();

/// Groups of variables.
inline constexpr std::string_view default_group = "default", all_group = "all";
/// All that elements remember, row by row as of elements/element_state.hpp; not in any group.
inline constexpr std::string_view state_variable = "state";

/// Names of a list, with `all` in place of what it stands for: `default`, variables of kinds of elements that
/// the scene has, and others: the histories, and fields of points.
std::vector<std::string> named_variables(std::span<const std::string> wanted,
                                         std::span<const std::string_view> others,
                                         const std::function<bool(const CellVariable&)>& is_had);

}  // namespace brio
