#pragma once
/// Fields of cells that a deck chooses, `output.fields.variables`.

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "elements/base/motion.hpp"

namespace brio {

/// A scalar that follows from what an element tells of itself.
struct DerivedVariable {
  std::string_view name;
  double (*value)(const ElementSample&);
};

/// von_mises, pressure, triaxiality of the stress that is written, and internal_energy of the element.
std::span<const DerivedVariable> derived_variables();

/// Groups of variables.
inline constexpr std::string_view default_group = "default", all_group = "all";

/// Names of a list, with `all` in place of what it stands for: `default`, derived variables, the histories.
std::vector<std::string> named_variables(std::span<const std::string> wanted,
                                         std::span<const std::string_view> histories);

}  // namespace brio
