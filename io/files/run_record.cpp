#include "io/files/run_record.hpp"

#include <fmt/format.h>

#include <bit>
#include <fstream>
#include <iterator>

#include "io/files/checksum.hpp"
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
  if (!record.program.empty()) file.write_text("/deck/program", record.program);
  if (!record.mesh_checksums.empty()) file.write_texts("/deck/mesh_checksums", record.mesh_checksums);
}

std::string texts_of(const RunRecord& record) {
  std::string all;
  for (const std::string* text : {&record.title, &record.deck_path, &record.deck_text, &record.version})
    all.append(*text).push_back('\0');
  for (const auto* list : {&record.overrides, &record.mesh_checksums})
    for (const std::string& text : *list) all.append(text).push_back('\0');
  if (!record.program.empty()) all.append(record.program).push_back('\0');
  return all;
}

RunRecord read_record(const Hdf5File& file) {
  const bool has_program = file.contains("/deck/program");        // nor is this
  const bool has_meshes = file.contains("/deck/mesh_checksums");  // not written where there are none
  return {.title = file.read_text("/deck/title"),
          .deck_path = file.read_text("/deck/path"),
          .deck_text = file.read_text("/deck/text"),
          .overrides = file.read_texts("/deck/overrides"),
          .version = file.read_text("/deck/version"),
          .threads = static_cast<int>(file.read_integer_attribute("/deck", "threads")),
          .mesh_checksums = has_meshes ? file.read_texts("/deck/mesh_checksums") : std::vector<std::string>{},
          .program = has_program ? file.read_text("/deck/program") : std::string()};
}

std::int64_t program_checksum() {
  static const std::int64_t sum = [] {
    std::ifstream program("/proc/self/exe", std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(program), {}};
    return std::bit_cast<std::int64_t>(checksum(bytes.data(), bytes.size()));
  }();
  return sum;
}

std::string program_checksum_text() {
  return fmt::format("{:016x}", std::bit_cast<std::uint64_t>(program_checksum()));
}

}  // namespace brio
