#pragma once
/// A block of a mesh file as the mesh of a part.

#include <string>
#include <string_view>
#include <vector>

#include "io/mesh_file/file_mesh.hpp"
#include "src/deck/mesh.hpp"
#include "src/deck/mesh_source.hpp"

namespace brio {

/// The block of that name, else of that number; null where there is none.
const FileBlock* block_called(const FileMesh& file, std::string_view name);

/// Blocks whose elements have the highest dimension of the file.
std::vector<const FileBlock*> main_blocks(const FileMesh& file);

/// Nodes and elements in the order of the file, without nodes that the block does not use; of a block of
/// several dimensions the elements of the highest. Coordinates times the scale. Wedges become hexahedra and
/// triangles shells that repeat nodes. Sets are those of the file that reach into the block, by name, and
/// `all`; other blocks are sets of their nodes and faces.
/// \param notices what was left out is added
/// \throws MeshFileError for elements that no part can be made of: tetrahedra, elements of second order;
/// that are inverted, have no volume or repeat nodes; particles without volume
Mesh part_mesh(const FileMesh& file, const FileBlock& block, const MeshFromFile& source,
               std::vector<std::string>& notices);

}  // namespace brio
