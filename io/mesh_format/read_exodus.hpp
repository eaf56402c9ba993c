#pragma once
/// Meshes in Exodus II files, through netCDF (Schoof and Yarberry 1994, "EXODUS II: A finite element data
/// model", SAND92-2137).

#include <string>

#include "io/mesh_file/file_mesh.hpp"

namespace brio {

/// Element blocks are blocks, node sets and side sets are sets, by their names, else numbers
/// (`node_set_7`, `side_set_7`). The file
/// is read in a child process (`read_apart`). \param name what messages call it \throws MeshFileError
FileMesh read_exodus(const std::string& path, const std::string& name);

}  // namespace brio
