#pragma once
/// Meshes in input files of Abaqus: *NODE, *ELEMENT, *NSET, *ELSET, *SURFACE.

#include <string>
#include <string_view>

#include "io/mesh_file/file_mesh.hpp"

namespace brio {

/// Element sets are blocks and sets, node sets and surfaces are sets; elements of no set form a block of the
/// name of their type. Names are compared without case and kept as they are written first. Other keywords
/// are listed in a notice. \param file what messages call it \throws MeshFileError
FileMesh read_abaqus(std::string_view text, const std::string& file);

}  // namespace brio
