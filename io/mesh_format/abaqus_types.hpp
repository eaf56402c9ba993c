#pragma once
/// Element types of Abaqus.

#include <optional>
#include <string>
#include <vector>

#include "io/mesh_file/file_mesh.hpp"

namespace brio {

struct AbaqusType {
  ElementShape shape = ElementShape::refused;
  int nodes = 0;
  RefusedKind refused{};  ///< where the shape is
};

/// \param name in upper case. Nothing for a type that is not known.
std::optional<AbaqusType> abaqus_type(const std::string& name);

/// Sides in the numbering of Abaqus (S1 to S6, SPOS and SNEG are 1 and 2 of shells, E1 to E4 are 3 to 6), as
/// corners, from 0.
std::vector<std::vector<int>> abaqus_sides(ElementShape shape);

}  // namespace brio
