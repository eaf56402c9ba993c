#pragma once
/// Meshes in keyword files of LS-DYNA: *NODE, *ELEMENT_SOLID, _SHELL, _BEAM, _SPH, *PART, *SET_NODE,
/// *SET_SEGMENT, in fixed columns (of 8 and 16) or with commas.

#include <string>
#include <string_view>

#include "io/mesh_file/file_mesh.hpp"

namespace brio {

/// Parts are blocks, by their titles, else their numbers. Sets are named by their titles (_TITLE), else
/// `node_set_7`, `side_set_7` by their numbers. Other keywords are listed in a notice. \param file what
/// messages call it \throws MeshFileError
FileMesh read_ls_dyna(std::string_view text, const std::string& file);

}  // namespace brio
