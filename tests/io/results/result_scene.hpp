#pragma once
/// A small scene whose every number can be told from its place, for tests of result files: a hexahedron row,
/// two quadrilaterals, a line and a vertex; cells disappear as time goes on.

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <unistd.h>

#include "src/base/cell_type.hpp"
#include "src/output/snapshot.hpp"

namespace brio::test {

/// Removed when it goes out of scope.
class Folder {
 public:
  Folder() {
    std::string pattern = (std::filesystem::temp_directory_path() / "brio_results_XXXXXX").string();
    path_ = mkdtemp(pattern.data());
  }
  ~Folder() {
    std::error_code ignored;
    std::filesystem::permissions(path_, std::filesystem::perms::owner_all, ignored);
    std::filesystem::remove_all(path_, ignored);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

/// A value that names its dump, array, row and component; exact in single precision for small arguments.
inline double coded(int dump, int array, std::size_t row, int component) {
  return dump * 4096 + array * 512 + static_cast<double>(row) * 8 + component + 0.25;
}

inline void add_cell(Topology& topology, CellType type, const std::vector<std::int64_t>& points) {
  if (topology.offset.empty()) topology.offset.push_back(0);
  topology.cell_type.push_back(type);
  topology.connectivity.insert(topology.connectivity.end(), points.begin(), points.end());
  topology.offset.push_back(static_cast<std::int64_t>(topology.connectivity.size()));
}

/// Four hexahedra along x, two quadrilaterals, a line, a vertex over 27 points, less the first `deleted`
/// cells.
inline Topology mixed_cells(int deleted) {
  Topology all;
  int skip = deleted;
  const auto add = [&](CellType type, const std::vector<std::int64_t>& points) {
    if (skip-- <= 0) add_cell(all, type, points);
  };
  for (std::int64_t i = 0; i < 4; ++i) {
    const std::int64_t p = 4 * i;
    add(hexahedron_cell, {p, p + 1, p + 2, p + 3, p + 4, p + 5, p + 6, p + 7});
  }
  add(quadrilateral_cell, {20, 21, 22, 23});
  add(quadrilateral_cell, {21, 24, 25, 22});
  add(line_cell, {23, 26});
  add(vertex_cell, {26});
  if (all.offset.empty()) all.offset.push_back(0);
  return all;
}

inline std::vector<double> field_values(int dump, int array, std::size_t rows, int components) {
  std::vector<double> values;
  for (std::size_t row = 0; row < rows; ++row) {
    for (int c = 0; c < components; ++c) values.push_back(coded(dump, array, row, c));
  }
  return values;
}

inline std::vector<double> mixed_points(int dump) {
  const double stretch = 1 + 0.125 * dump;
  std::vector<double> points;
  for (int i = 0; i < 5; ++i) {
    for (const auto& corner : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}}) {
      points.insert(points.end(), {stretch * corner.first, 1.0 * corner.second, 1.0 * i});
    }
  }
  for (const auto& p : {std::pair{3, 0}, {4, 0}, {4, 1}, {3, 1}, {5, 0}, {5, 1}, {3, 3}}) {
    points.insert(points.end(), {stretch * p.first, 1.0 * p.second, 0.5});
  }
  return points;
}

/// \param topology_version also the number of deleted cells.
inline Snapshot mixed_snapshot(int dump, int topology_version) {
  Snapshot s;
  s.time = 1e-3 * dump;
  s.step = 100 * dump;
  s.points = mixed_points(dump);
  s.topology = mixed_cells(topology_version);
  s.topology_version = topology_version;
  const std::size_t points = s.points.size() / 3;
  const std::size_t cells = s.topology.cell_type.size();
  s.point_fields = {{"displacement", 3, field_values(dump, 0, points, 3), Storage::double_precision},
                    {"velocity", 3, field_values(dump, 1, points, 3)}};
  std::vector<double> identity;
  for (std::size_t i = 0; i < cells; ++i)
    identity.push_back(static_cast<double>(i) + topology_version + 1e15);
  s.cell_fields = {{"stress", 6, field_values(dump, 2, cells, 6)},
                   {"damage", 1, field_values(dump, 3, cells, 1)},
                   {"element_id", 1, identity, Storage::integer, true}};
  s.global_fields = {{"total_energy", 1, field_values(dump, 4, 1, 1), Storage::double_precision},
                     {"momentum", 3, field_values(dump, 5, 1, 3), Storage::double_precision}};
  return s;
}

/// The scene by parts, each of one type of cells; points of the cable are those of its neighbours too.
inline Snapshot by_parts(Snapshot scene) {
  scene.parts = {{.name = "bricks", .points = 20},
                 {.name = "plates", .first_point = 20, .points = 6},
                 {.name = "cable", .first_point = 23, .points = 4},
                 {.name = "mass", .first_point = 26, .points = 1}};
  const std::vector<unsigned char>& types = scene.topology.cell_type;
  std::int64_t first = 0;
  for (std::size_t part = 0; part < 4; ++part) {
    const CellType type = cell_with(8 >> part);
    scene.parts[part].first_cell = first;
    scene.parts[part].cells = std::count(types.begin(), types.end(), type);
    first += scene.parts[part].cells;
  }
  return scene;
}

}  // namespace brio::test
