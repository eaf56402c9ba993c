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

/// What follows from what an element tells of itself.
struct CellVariable {
  std::string_view name;
  int components;  ///< 1, 3, or 6 of a symmetric tensor: xx, yy, zz, xy, yz, xz
  void (*values)(const ElementSample&, double* out);
  /// Of the kinds of elements that have it; null: of all. Elsewhere it is not a number.
  bool ElementTraits::*of = nullptr;
};

/// Those that a deck can name: of the stress that is written, energy, and of shells and beams alone.
std::span<const CellVariable> chosen_variables();
/// Of these or of those that stand in the group `default`. \pre there is one of that name
const CellVariable& cell_variable(std::string_view name);

/// Groups of variables.
inline constexpr std::string_view default_group = "default", all_group = "all";
/// All that elements remember, row by row as of elements/element_state.hpp; not in any group.
inline constexpr std::string_view state_variable = "state";

/// Names of a list, with `all` in place of what it stands for: `default`, variables of kinds of elements that
/// the scene has, the histories.
std::vector<std::string> named_variables(std::span<const std::string> wanted,
                                         std::span<const std::string_view> histories,
                                         const std::function<bool(const CellVariable&)>& is_had);

}  // namespace brio
