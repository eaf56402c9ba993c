#pragma once
/// Why a run cannot go on.

#include <stdexcept>
#include <string>

namespace brio {

/// Numerical failure: an inverted element, a value that is not a number, a collapsed step, too large an
/// energy error.
struct Breakdown : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// A deck or mesh that cannot be built: `what()` names part and rule.
struct BuildError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace brio
