#pragma once
/// Mesh files of Gmsh, format 4.1, ASCII and binary
/// (https://gmsh.info/doc/texinfo/gmsh.html#MSH-file-format).

#include <string>
#include <string_view>

#include "io/mesh_file/file_mesh.hpp"

namespace brio {

/// Physical groups are blocks and sets, by their names, else `volume_7` and the like; of elements without a
/// group, those of one dimension are a block `points`, `curves`, `surfaces` or `volumes`. \param file what
/// messages call it \throws MeshFileError
FileMesh read_gmsh(std::string_view text, const std::string& file);

}  // namespace brio
