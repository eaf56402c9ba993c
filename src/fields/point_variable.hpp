#pragma once
/// A field of points.

#include <string_view>

#include "src/model/model.hpp"

namespace brio {

struct PointVariable {
  std::string_view name;
  int components;
  void (*values)(const Model&, int node, double* out);
  bool is_partial;                 ///< not a number where there is no such thing
  std::string_view unit, meaning;  ///< for the manual
};

}  // namespace brio
