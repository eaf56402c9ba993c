#include "io/deck/read_mesh_from_file.hpp"

#include "io/mesh_file/mesh_file_error.hpp"
#include "io/mesh_file/part_mesh.hpp"
#include "io/mesh_format/read_mesh_file.hpp"

namespace brio {

namespace {

MeshFormat format_of(const std::string& path, const std::optional<MeshFormat>& said, const Place& place) {
  if (said) return *said;
  if (const auto format = format_by_suffix(path)) return *format;
  throw DeckError(place, "the suffix of '" + path +
                             "' tells no format; accepted are .msh, .inp, .k, .key, .dyn, .e, .exo, .g, or "
                             "'format' beside the file");
}

std::vector<std::string_view> names_of_blocks(const std::vector<const FileBlock*>& blocks) {
  std::vector<std::string_view> names;
  for (const FileBlock* block : blocks) names.push_back(block->name);
  return names;
}

const FileBlock& chosen_block(const FileMesh& file, const YamlNode& node, const MeshFromFile& source) {
  if (!source.block.empty()) {
    if (const FileBlock* block = block_called(file, source.block)) return *block;
    std::vector<const FileBlock*> all;
    for (const FileBlock& block : file.blocks) all.push_back(&block);
    throw DeckError(node.find("block")->value->place, file.file + " has no block '" + source.block + "'; " +
                                                          accepted_words(source.block, names_of_blocks(all)));
  }
  const std::vector<const FileBlock*> blocks = main_blocks(file);
  if (blocks.size() == 1) return *blocks.front();
  throw DeckError(node.place,
                  file.file + " has " + std::to_string(blocks.size()) +
                      " blocks; 'block' is required: " + accepted_words("", names_of_blocks(blocks)));
}

}  // namespace

void read_mesh_from_file(const YamlNode& node, const Slot& slot, MeshFromFile& source) {
  read_fields(node, slot, source);
  std::string path = source.file;
  std::optional<MeshFormat> format = source.format;
  const YamlNode& name = *node.find(path.empty() ? "from" : "file")->value;
  if (path.empty()) {
    const MeshFile& file = slot.known.mesh_file(name);
    path = file.file;
    format = file.format;
  }
  FileMeshes& meshes = slot.known.file_meshes();
  try {
    const FileMesh& file = meshes.read(slot.known.deck().file, path, format_of(path, format, name.place));
    const FileBlock& block = chosen_block(file, node, source);
    source.mesh = std::make_shared<const Mesh>(part_mesh(file, block, source, meshes.notices()));
  } catch (const MeshFileError& fault) {
    throw DeckError(fault.what());
  }
}

}  // namespace brio
