#include "io/files/run_record.hpp"

#include "io/files/hdf5_file.hpp"
#include "io/files/utf8.hpp"

namespace brio {

void write_record(Hdf5File& file, const RunRecord& record) {
  file.create_group("/deck");
  file.write_text("/deck/title", record.title);
  file.write_text("/deck/path", as_utf8(record.deck_path));
  file.write_text("/deck/text", record.deck_text);
  file.write_texts("/deck/overrides", record.overrides);
  file.write_text("/deck/version", record.version);
  file.write_attribute("/deck", "threads", record.threads);
  if (!record.mesh_checksums.empty()) file.write_texts("/deck/mesh_checksums", record.mesh_checksums);
}

std::string texts_of(const RunRecord& record) {
  std::string all;
  for (const std::string* text : {&record.title, &record.deck_path, &record.deck_text, &record.version})
    all.append(*text).push_back('\0');
  for (const auto* list : {&record.overrides, &record.mesh_checksums})
    for (const std::string& text : *list) all.append(text).push_back('\0');
  return all;
}

RunRecord read_record(const Hdf5File& file) {
  const bool has_meshes = file.contains("/deck/mesh_checksums");  // not written where there are none
  return {
      .title = file.read_text("/deck/title"),
      .deck_path = file.read_text("/deck/path"),
      .deck_text = file.read_text("/deck/text"),
      .overrides = file.read_texts("/deck/overrides"),
      .version = file.read_text("/deck/version"),
      .threads = static_cast<int>(file.read_integer_attribute("/deck", "threads")),
      .mesh_checksums = has_meshes ? file.read_texts("/deck/mesh_checksums") : std::vector<std::string>{}};
}

}  // namespace brio
