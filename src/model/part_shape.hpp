#pragma once
/// Sizes of a part and of its elements, for the warnings before a run.

#include <array>
#include <vector>

#include "src/model/model.hpp"

namespace brio {

struct PartShape {
  Vector3d lower{}, upper{};      ///< of its nodes
  Vector3d velocity{};            ///< mean of its nodes
  double edge = 0;                ///< median of all edges; of particles their spacing
  double largest_aspect = 1;      ///< longest edge of an element over its shortest
  std::size_t long_elements = 0;  ///< whose aspect is above aspect_limit
  /// Of each element: a length that bounds its stable time step.
  std::vector<double> length;
  /// Along how many directions at least four fifths of the elements stand alone: between two free sides.
  int alone_directions = 0;
  double alone_thickness = 0;  ///< mean thickness along the thinnest of these

  double extent() const;  ///< longest edge of the box
};

inline constexpr double aspect_limit = 10;

/// Nodes of an element of a part, of the model; elements that are deleted have none.
std::vector<int> nodes_of_element(const Model& model, const PartInModel& part, std::size_t element);

PartShape shape_of(const Model& model, const PartInModel& part);

}  // namespace brio
