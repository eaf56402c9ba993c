#include "io/mesh_format/read_mesh_file.hpp"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <utility>

#include "io/files/checksum.hpp"
#include "io/mesh_file/mesh_file_error.hpp"
#include "io/mesh_format/read_abaqus.hpp"
#include "io/mesh_format/read_exodus.hpp"
#include "io/mesh_format/read_gmsh.hpp"
#include "io/mesh_format/read_ls_dyna.hpp"
#include "src/base/index.hpp"

namespace brio {

namespace {

std::string contents_of(const std::string& path, const std::string& name) {
  std::error_code none;
  if (std::filesystem::exists(path, none) && !std::filesystem::is_regular_file(path, none))
    throw MeshFileError(name, 0, "is not a regular file");
  std::ifstream file(path, std::ios::binary);
  if (!file) throw MeshFileError(name, 0, std::string("cannot be opened: ") + std::strerror(errno));
  file.seekg(0, std::ios::end);
  const std::streamoff size = file.tellg();
  file.seekg(0);
  std::string text(index(std::max<std::streamoff>(size, 0)), '\0');
  if (!file.read(text.data(), static_cast<std::streamsize>(text.size())))
    throw MeshFileError(name, 0, "cannot be read");
  return text;
}

}  // namespace

std::optional<MeshFormat> format_by_suffix(const std::string& path) {
  constexpr std::pair<const char*, MeshFormat> suffixes[] = {
      {".msh", MeshFormat::gmsh},    {".inp", MeshFormat::abaqus},  {".k", MeshFormat::ls_dyna},
      {".key", MeshFormat::ls_dyna}, {".dyn", MeshFormat::ls_dyna}, {".e", MeshFormat::exodus},
      {".exo", MeshFormat::exodus},  {".g", MeshFormat::exodus}};
  const std::string suffix = std::filesystem::path(path).extension().string();
  for (const auto& [text, format] : suffixes)
    if (suffix == text) return format;
  return {};
}

FileMesh read_mesh_file(const std::string& path, const std::string& name, MeshFormat format) {
  std::string text = contents_of(path, name);
  const std::uint64_t sum = checksum(text.data(), text.size());
  FileMesh mesh;
  switch (format) {
    case MeshFormat::gmsh:
      mesh = read_gmsh(text, name);
      break;
    case MeshFormat::abaqus:
      mesh = read_abaqus(text, name);
      break;
    case MeshFormat::ls_dyna:
      mesh = read_ls_dyna(text, name);
      break;
    case MeshFormat::exodus:
      text = {};
      mesh = read_exodus(path, name);
      break;
  }
  mesh.checksum = sum;
  return mesh;
}

}  // namespace brio
