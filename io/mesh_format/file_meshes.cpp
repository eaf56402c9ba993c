#include "io/mesh_format/file_meshes.hpp"

#include <fmt/format.h>

#include <filesystem>

#include "io/mesh_format/read_mesh_file.hpp"

namespace brio {

const FileMesh& FileMeshes::read(const std::string& deck, const std::string& path, MeshFormat format) {
  const auto found = meshes_.find(path);
  if (found != meshes_.end()) return found->second;
  const std::string place = (std::filesystem::path(deck).parent_path() / path).string();
  return meshes_.emplace(path, read_mesh_file(place, place, format)).first->second;
}

void FileMeshes::describe(std::vector<std::string>& checksums, std::vector<std::string>& notices) const {
  for (const auto& [path, mesh] : meshes_) {
    checksums.push_back(fmt::format("{} {:016x}", path, mesh.checksum));
    for (const std::string& notice : mesh.notices) notices.push_back(mesh.file + ": " + notice);
  }
  notices.insert(notices.end(), notices_.begin(), notices_.end());
}

}  // namespace brio
