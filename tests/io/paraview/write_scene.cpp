/// Writes the small scene of the result tests, as a whole and by parts, and beside it what a reader must find
/// in it, as JSON.
/// Usage: write_scene FOLDER

#include <cstdio>
#include <exception>
#include <fstream>
#include <nlohmann/json.hpp>
#include <vector>

#include "io/results/write_results.hpp"
#include "tests/io/results/result_scene.hpp"

namespace {

nlohmann::json expected_fields(const std::vector<brio::FieldArray>& fields) {
  nlohmann::json result = nlohmann::json::object();
  for (const brio::FieldArray& field : fields) {
    result[field.name] = {{"components", field.components}, {"values", field.values}};
  }
  return result;
}

nlohmann::json expected_parts(const brio::Snapshot& snapshot) {
  nlohmann::json result = nlohmann::json::array();
  for (const brio::SnapshotPart& part : snapshot.parts)
    result.push_back({{"name", part.name},
                      {"cells", {part.first_cell, part.cells}},
                      {"points", {part.first_point, part.points}}});
  return result;
}

nlohmann::json expected_dump(const brio::Snapshot& snapshot) {
  return {{"time", snapshot.time},
          {"parts", expected_parts(snapshot)},
          {"points", snapshot.points},
          {"types", snapshot.topology.cell_type},
          {"connectivity", snapshot.topology.connectivity},
          {"offset", snapshot.topology.offset},
          {"point_fields", expected_fields(snapshot.point_fields)},
          {"cell_fields", expected_fields(snapshot.cell_fields)},
          {"global_fields", expected_fields(snapshot.global_fields)}};
}

void write_scene(const std::filesystem::path& folder) {
  brio::ResultWriter writer(folder, "scene", {}, {"time"}),
      part_writer(folder / "by_parts", "scene", {}, {"time"});
  nlohmann::json dumps = nlohmann::json::array();
  const std::vector<int> deleted_cells{0, 0, 1, 1, 3, 3, 7};
  for (std::size_t dump = 0; dump < deleted_cells.size(); ++dump) {
    const brio::Snapshot snapshot = brio::test::mixed_snapshot(static_cast<int>(dump), deleted_cells[dump]);
    writer.write(snapshot);
    part_writer.write(brio::test::by_parts(snapshot));
    dumps.push_back(expected_dump(brio::test::by_parts(snapshot)));
  }
  std::ofstream(folder / "expected.json") << dumps;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  try {
    write_scene(argv[1]);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
