#pragma once
/// Why a run cannot go on.

#include <stdexcept>
#include <string>
#include <utility>

namespace brio {

/// Numerical failure: an inverted element, a value that is not a number, a collapsed step, too large an
/// energy error.
struct Breakdown : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// A deck or mesh that cannot be built: `what()` names part and rule.
struct BuildError : std::runtime_error {
  explicit BuildError(const std::string& fault, std::string place_ = {})
      : std::runtime_error(fault), place(std::move(place_)) {}
  std::string place;  ///< in the deck, where it is known
};

}  // namespace brio
