#pragma once
/// Contents of the mesh files of a deck.

#include <map>
#include <string>
#include <vector>

#include "io/mesh_file/file_mesh.hpp"
#include "src/deck/mesh_source.hpp"

namespace brio {

class FileMeshes {
 public:
  /// Read at the first call. \param path relative to the folder of the deck, or absolute
  /// \throws MeshFileError
  const FileMesh& read(const std::string& deck, const std::string& path, MeshFormat format);

  /// What was left out of a block.
  std::vector<std::string>& notices() { return notices_; }

  /// \param checksums of each file "NAME CHECKSUM" is added, to \param notices what was left out
  void describe(std::vector<std::string>& checksums, std::vector<std::string>& notices) const;

 private:
  std::map<std::string, FileMesh> meshes_;  ///< by path as the deck says it
  std::vector<std::string> notices_;
};

}  // namespace brio
