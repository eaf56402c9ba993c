#pragma once
/// Meshes of Gmsh in tests/io/mesh_format/meshes, made of the `.geo` beside them.

#include <string>

#include "io/mesh_format/read_mesh_file.hpp"
#include "tests/io/mesh_format/mesh_writers.hpp"

namespace brio::test {

inline const std::string folder_of_meshes = std::string(BRIO_SOURCE_DIR) + "/tests/io/mesh_format/meshes/";

/// \param name box, bracket, crash_box or bottle
inline Mesh committed(const std::string& name) {
  return mesh_of(read_mesh_file(folder_of_meshes + name + ".msh", name + ".msh", MeshFormat::gmsh));
}

}  // namespace brio::test
