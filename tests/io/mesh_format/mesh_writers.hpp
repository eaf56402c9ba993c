#pragma once
/// A mesh of a part in all formats, for tests: nodes, elements and sets in the same order, numbers to the
/// last bit.

#include <string>

#include "io/mesh_file/file_mesh.hpp"
#include "src/deck/mesh.hpp"
#include "src/deck/mesh_source.hpp"

namespace brio::test {

/// Wedges and triangles are written where elements repeat nodes as `part_mesh` makes them of these; the block
/// is called `body`. Sets but `all` are written; those that have faces as faces.
std::string as_gmsh(const Mesh& mesh, bool binary);
std::string as_abaqus(const Mesh& mesh);
std::string as_ls_dyna(const Mesh& mesh);
void write_exodus(const Mesh& mesh, const std::string& path);
/// The classic format of netCDF in place of that on HDF5.
void write_classic_exodus(const Mesh& mesh, const std::string& path);

/// In a file of the format, of the suffix that goes with it. \return its name in the folder
std::string write_mesh(const Mesh& mesh, MeshFormat format, const std::string& folder,
                       const std::string& stem);

/// What a text or a file holds, by the block that it has.
Mesh mesh_of(const FileMesh& file, const std::string& block = {}, double scale = 1);

}  // namespace brio::test
