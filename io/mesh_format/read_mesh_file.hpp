#pragma once
/// The door for mesh files.

#include <optional>
#include <string>

#include "io/mesh_file/file_mesh.hpp"
#include "src/deck/mesh_source.hpp"

namespace brio {

/// By the suffix of a file; nothing where it tells none.
std::optional<MeshFormat> format_by_suffix(const std::string& path);

/// A mesh file, with its checksum. \param name what messages call it
/// \throws MeshFileError where it cannot be read or is broken
FileMesh read_mesh_file(const std::string& path, const std::string& name, MeshFormat format);

}  // namespace brio
