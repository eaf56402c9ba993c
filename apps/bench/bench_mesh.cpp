// Time and memory to read a mesh file: bench_mesh FILE, or bench_mesh --write N FILE for a cube of N^3
// hexahedra, by its suffix .msh, .bin.msh (binary), .inp or .k; apps/bench/write_exodus.py writes it as
// Exodus.

#include <fmt/format.h>
#include <sys/resource.h>

#include <array>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

#include "io/mesh_file/part_mesh.hpp"
#include "io/mesh_format/read_mesh_file.hpp"
#include "src/base/index.hpp"

namespace {

using namespace brio;

double seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

double peak_mb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

/// A node of a cube of n elements along each edge, from 1.
int node(int n, int i, int j, int k) { return 1 + i + (n + 1) * (j + (n + 1) * k); }

struct Cube {
  std::vector<Vector3d> position;
  std::vector<std::array<int, 8>> corners;  ///< from 1
};

Cube make_cube(int n) {
  Cube cube;
  for (int k = 0; k <= n; ++k)
    for (int j = 0; j <= n; ++j)
      for (int i = 0; i <= n; ++i) cube.position.push_back({i / 3.0, j / 3.0, k / 3.0});
  for (int k = 0; k < n; ++k)
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i)
        cube.corners.push_back({node(n, i, j, k), node(n, i + 1, j, k), node(n, i + 1, j + 1, k),
                                node(n, i, j + 1, k), node(n, i, j, k + 1), node(n, i + 1, j, k + 1),
                                node(n, i + 1, j + 1, k + 1), node(n, i, j + 1, k + 1)});
  return cube;
}

void write_binary_gmsh(int n, const std::string& path) {
  const Cube cube = make_cube(n);
  std::ofstream out(path, std::ios::binary);
  const auto put = [&out](auto... values) {
    (out.write(reinterpret_cast<const char*>(&values), sizeof values), ...);
  };
  const std::size_t nodes = cube.position.size(), elements = cube.corners.size(), one = 1;
  out << "$MeshFormat\n4.1 1 8\n";
  put(1);
  out << "\n$EndMeshFormat\n$Nodes\n";
  put(one, nodes, one, nodes, 3, 1, 0, nodes);
  for (std::size_t id = 1; id <= nodes; ++id) put(id);
  for (const auto& x : cube.position) put(x[0], x[1], x[2]);
  out << "\n$EndNodes\n$Elements\n";
  put(one, elements, one, elements, 3, 1, 5, elements);
  for (std::size_t e = 0; e < elements; ++e) {
    put(e + 1);
    for (const int corner : cube.corners[e]) put(index(corner));
  }
  out << "\n$EndElements\n";
}

void write_cube(int n, const std::string& path) {
  std::ofstream out(path);
  const bool abaqus = path.ends_with(".inp"), dyna = path.ends_with(".k");
  const int nodes = (n + 1) * (n + 1) * (n + 1), elements = n * n * n;
  std::string text;
  const auto flush = [&] {
    out << text;
    text.clear();
  };
  const auto each_node = [&](const auto& write) {
    for (int k = 0; k <= n; ++k, flush())
      for (int j = 0; j <= n; ++j)
        for (int i = 0; i <= n; ++i) write(node(n, i, j, k), i / 3.0, j / 3.0, k / 3.0);
  };
  const auto each_element = [&](const auto& write) {
    int element = 0;
    for (int k = 0; k < n; ++k, flush())
      for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i)
          write(++element, std::array{node(n, i, j, k), node(n, i + 1, j, k), node(n, i + 1, j + 1, k),
                                      node(n, i, j + 1, k), node(n, i, j, k + 1), node(n, i + 1, j, k + 1),
                                      node(n, i + 1, j + 1, k + 1), node(n, i, j + 1, k + 1)});
  };
  const auto lines = [&](const char* separator) {
    return [&text, separator](int element, const std::array<int, 8>& corners) {
      text += fmt::format("{}", element);
      for (const int corner : corners) text += fmt::format("{}{}", separator, corner);
      text += '\n';
    };
  };
  if (abaqus) {
    text = "*NODE\n";
    each_node(
        [&](int id, double x, double y, double z) { text += fmt::format("{}, {}, {}, {}\n", id, x, y, z); });
    text = "*ELEMENT, TYPE=C3D8R, ELSET=cube\n";
    each_element(lines(", "));
  } else if (dyna) {
    text = "*KEYWORD\n*NODE\n";
    each_node([&](int id, double x, double y, double z) {
      text += fmt::format("{:8}{:16.9}{:16.9}{:16.9}\n", id, x, y, z);
    });
    text = "*ELEMENT_SOLID\n";
    each_element([&](int element, const std::array<int, 8>& corners) {
      text += fmt::format("{:8}{:8}", element, 1);
      for (const int corner : corners) text += fmt::format("{:8}", corner);
      text += '\n';
    });
    text = "*END\n";
  } else {
    text = fmt::format("$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n1 {0} 1 {0}\n3 1 0 {0}\n", nodes);
    for (int id = 1; id <= nodes; ++id) text += fmt::format("{}\n", id);
    each_node([&](int, double x, double y, double z) { text += fmt::format("{} {} {}\n", x, y, z); });
    text = fmt::format("$EndNodes\n$Elements\n1 {0} 1 {0}\n3 1 5 {0}\n", elements);
    each_element(lines(" "));
    text = "$EndElements\n";
  }
  flush();
}

int read(const std::string& path) {
  const auto format = format_by_suffix(path);
  if (!format) return 2;
  const double start = seconds();
  const FileMesh file = read_mesh_file(path, path, *format);
  const double read = seconds();
  std::vector<std::string> notices;
  const Mesh mesh = part_mesh(file, *main_blocks(file).front(), {}, notices);
  fmt::print("{}: {} nodes, {} elements; read in {:.2f} s, made a part in {:.2f} s; peak memory {:.0f} MB\n",
             path, mesh.position.size(), mesh.element_count(), read - start, seconds() - read, peak_mb());
  return 0;
}

}  // namespace

int main(int count, char** words) {
  if (count == 4 && std::string_view(words[1]) == "--write") {
    const std::string path = words[3];
    const int n = std::atoi(words[2]);
    if (path.ends_with(".bin.msh")) {
      write_binary_gmsh(n, path);
    } else {
      write_cube(n, path);
    }
    return 0;
  }
  if (count == 2) return read(words[1]);
  fmt::print("bench_mesh FILE | --write N FILE\n");
  return 2;
}
