// Damaged mesh files of all formats are read or refused by name; nothing else happens.

#include <gtest/gtest.h>

#include <fstream>
#include <random>

#include "io/mesh/generate_mesh.hpp"
#include "io/mesh_file/mesh_file_error.hpp"
#include "io/mesh_file/part_mesh.hpp"
#include "io/mesh_format/read_mesh_file.hpp"
#include "src/base/index.hpp"
#include "tests/io/mesh_format/mesh_writers.hpp"
#include "tests/io/results/result_scene.hpp"
#include "tests/io/text_of.hpp"

namespace brio::test {
namespace {

using Random = std::mt19937;

std::size_t below(Random& random, std::size_t count) { return random() % count; }

/// Begin and end of a word of the text.
std::pair<std::size_t, std::size_t> word_of(const std::string& text, Random& random) {
  constexpr const char* blanks = " \t\n,=";
  const std::size_t begin = text.find_first_not_of(blanks, below(random, text.size()));
  if (begin == std::string::npos) return {0, 0};
  return {begin, std::min(text.find_first_of(blanks, begin), text.size())};
}

/// One damage: a byte, a cut, words that change places, or numbers that no mesh has.
void damage(std::string& text, Random& random) {
  static constexpr std::string_view words[] = {"-1",          "0", "99999999999", "1e400",     "nan",
                                               "-2147483649", "",  "x",           "4294967297"};
  if (text.empty()) return;
  const std::size_t at = below(random, text.size());
  switch (below(random, 6)) {
    case 0:
      text[at] = static_cast<char>(text[at] ^ (1 << below(random, 8)));
      break;
    case 1:
      text[at] = static_cast<char>(random());
      break;
    case 2:
      text.erase(at, below(random, 60));
      break;
    case 3:
      text.resize(at);
      break;
    case 4: {
      const auto [begin, end] = word_of(text, random);
      text.replace(begin, end - begin, words[below(random, std::size(words))]);
      break;
    }
    default: {
      const auto [begin, end] = word_of(text, random);
      const std::string word = text.substr(begin, end - begin);
      const auto [other, other_end] = word_of(text, random);
      text.replace(other, other_end - other, word);
    }
  }
}

/// A small mesh with all that a file can have: hexahedra, wedges, sets of nodes and of faces.
Mesh small_mesh() {
  Mesh mesh = generate_mesh(
      WedgeMesh{.thickness = 1, .height = 2, .length = 1, .half_angle = 30, .elements = {2, 3, 1}}, {});
  for (int n = 0; n < static_cast<int>(mesh.position.size()); ++n) mesh.node_id.push_back(3 * n + 11);
  for (int e = 0; e < static_cast<int>(mesh.element_count()); ++e) mesh.element_id.push_back(2 * e + 5);
  mesh.node_sets["corner"] = {0, 1, 5};
  return mesh;
}

class MeshFuzz : public testing::Test {
 protected:
  /// \return whether it was refused; anything but a mesh or a MeshFileError that names the file ends the
  /// test.
  bool refused(const std::string& bytes, MeshFormat format) {
    const std::string path = folder / "damaged";
    std::ofstream(path, std::ios::binary) << bytes;
    try {
      const FileMesh file = read_mesh_file(path, "damaged", format);
      for (const FileBlock& block : file.blocks) {
        std::vector<std::string> notices;
        const Mesh mesh = part_mesh(file, block, {.particle_volume = 1}, notices);
        EXPECT_FALSE(mesh.position.empty());
        for (const int node : mesh.connectivity) EXPECT_LT(index(node), mesh.position.size());
      }
      return false;
    } catch (const MeshFileError& fault) {
      EXPECT_EQ(std::string(fault.what()).substr(0, 7), "damaged") << fault.what();
      return true;
    }
  }

  void expect_refusals(const std::string& bytes, MeshFormat format, int count, unsigned seed) {
    ASSERT_FALSE(refused(bytes, format));
    Random random(seed);
    int refusals = 0;
    for (int i = 0; i < count; ++i) {
      std::string text = bytes;
      const std::size_t times = 1 + below(random, 3);
      for (std::size_t k = 0; k < times; ++k) damage(text, random);
      if (refused(text, format)) ++refusals;
    }
    // Damage to a coordinate or to what is not read may well pass.
    EXPECT_GT(refusals, count / 4);
    EXPECT_LT(refusals, count);
  }

  Folder folder;
};

TEST_F(MeshFuzz, DamagedGmshFilesAreReadOrRefused) {
  expect_refusals(as_gmsh(small_mesh(), false), MeshFormat::gmsh, 500, 1);
}
TEST_F(MeshFuzz, DamagedBinaryGmshFilesAreReadOrRefused) {
  expect_refusals(as_gmsh(small_mesh(), true), MeshFormat::gmsh, 500, 2);
}
TEST_F(MeshFuzz, DamagedAbaqusFilesAreReadOrRefused) {
  expect_refusals(as_abaqus(small_mesh()), MeshFormat::abaqus, 400, 3);
}
TEST_F(MeshFuzz, DamagedLsDynaFilesAreReadOrRefused) {
  expect_refusals(as_ls_dyna(small_mesh()), MeshFormat::ls_dyna, 400, 4);
}
// Both formats of netCDF: classic, and on HDF5. Each file is read in a process of its own.
TEST_F(MeshFuzz, DamagedExodusFilesAreReadOrRefused) {
  write_classic_exodus(small_mesh(), folder / "classic.exo");
  expect_refusals(text_of(folder / "classic.exo"), MeshFormat::exodus, 100, 5);
  write_exodus(small_mesh(), folder / "hdf5.exo");
  expect_refusals(text_of(folder / "hdf5.exo"), MeshFormat::exodus, 100, 6);
}

}  // namespace
}  // namespace brio::test
