// The same mesh in all formats is the same to the last bit: nodes, elements, numbers, sets.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>

#include "io/mesh/generate_mesh.hpp"
#include "io/mesh_format/read_abaqus.hpp"
#include "io/mesh_format/read_exodus.hpp"
#include "io/mesh_format/read_gmsh.hpp"
#include "io/mesh_format/read_ls_dyna.hpp"
#include "io/mesh_format/read_mesh_file.hpp"
#include "src/base/index.hpp"
#include "src/build/build.hpp"
#include "src/step/advance.hpp"
#include "tests/io/mesh_format/committed_meshes.hpp"
#include "tests/io/results/result_scene.hpp"

namespace brio::test {
namespace {

template <class Sides>
std::vector<std::pair<int, int>> pairs(const Sides& sides) {
  std::vector<std::pair<int, int>> found;
  for (const auto& [element, side] : sides) found.emplace_back(element, side);
  return found;
}

void expect_same(const Mesh& a, const Mesh& b, const std::string& what) {
  EXPECT_EQ(a.nodes_per_element, b.nodes_per_element) << what;
  EXPECT_TRUE(a.position == b.position) << what;
  EXPECT_EQ(a.connectivity, b.connectivity) << what;
  EXPECT_EQ(a.node_id, b.node_id) << what;
  EXPECT_EQ(a.element_id, b.element_id) << what;
  EXPECT_EQ(a.node_sets, b.node_sets) << what;
  ASSERT_EQ(a.side_sets.size(), b.side_sets.size()) << what;
  for (const auto& [name, sides] : a.side_sets)
    EXPECT_EQ(pairs(sides), pairs(b.side_sets.at(name))) << what << name;
}

/// Positions of the nodes once the first of the node sets has been pushed for fifty steps.
std::vector<double> pushed(const Mesh& mesh) {
  Deck deck;
  deck.materials = {{"steel", ElasticPlastic{}}};
  auto& law = std::get<ElasticPlastic>(deck.materials[0].second);
  law.density = 1000;
  law.youngs_modulus = 1e9;
  law.poissons_ratio = 0.3;
  law.yield_stress = 1e6;
  Element element = Hex8{};
  if (mesh.nodes_per_element == 4) {
    Shell4 shell;
    shell.thickness = 1e-3 * std::abs(mesh.position.front()[0] - mesh.position.back()[0]) + 1e-3;
    element = shell;
  }
  deck.parts = {{"part", BoxMesh{}, {}, element, "steel"}};
  InitialCondition push;
  push.where.set = "part." + mesh.node_sets.begin()->first;
  push.velocity = Vector3d{30, 20, 10};
  deck.initial_conditions = {push};
  deck.time.end = 1;
  Model model = build(deck, std::span(&mesh, 1));
  ThreadTeam team(1);
  run(model, 1e9, team, [steps = 0](Model&) mutable { return ++steps < 50; });
  EXPECT_EQ(model.step, 49);
  std::vector<double> positions;
  for (const NodeRecord& node : model.nodes.record)
    positions.insert(positions.end(), node.position, node.position + 3);
  return positions;
}

class FormatsAgree : public testing::TestWithParam<const char*> {};

TEST_P(FormatsAgree, OnEveryNodeElementAndSet) {
  const Mesh mesh = committed(GetParam());
  EXPECT_GE(mesh.node_sets.size(), 2u);
  expect_same(mesh_of(read_gmsh(as_gmsh(mesh, false), "a.msh")), mesh, "ASCII ");
  expect_same(mesh_of(read_gmsh(as_gmsh(mesh, true), "a.msh")), mesh, "binary ");
  expect_same(mesh_of(read_abaqus(as_abaqus(mesh), "a.inp")), mesh, "Abaqus ");
  expect_same(mesh_of(read_ls_dyna(as_ls_dyna(mesh), "a.k")), mesh, "LS-DYNA ");
  const Folder folder;
  write_exodus(mesh, folder / "a.exo");
  expect_same(mesh_of(read_exodus(folder / "a.exo", "a.exo")), mesh, "Exodus ");
  write_classic_exodus(mesh, folder / "b.exo");
  expect_same(mesh_of(read_exodus(folder / "b.exo", "b.exo")), mesh, "classic Exodus ");
}

TEST_P(FormatsAgree, InTheBitsOfARun) {
  const Mesh mesh = committed(GetParam());
  const std::vector<double> expected = pushed(mesh);
  std::vector<double> at_start;
  for (const auto& x : mesh.position) at_start.insert(at_start.end(), x.begin(), x.end());
  EXPECT_NE(expected, at_start);
  const Folder folder;
  write_exodus(mesh, folder / "a.exo");
  EXPECT_EQ(pushed(mesh_of(read_exodus(folder / "a.exo", "a.exo"))), expected);
  EXPECT_EQ(pushed(mesh_of(read_gmsh(as_gmsh(mesh, true), "a.msh"))), expected);
  EXPECT_EQ(pushed(mesh_of(read_abaqus(as_abaqus(mesh), "a.inp"))), expected);
  EXPECT_EQ(pushed(mesh_of(read_ls_dyna(as_ls_dyna(mesh), "a.k"))), expected);
}
INSTANTIATE_TEST_SUITE_P(Meshes, FormatsAgree, testing::Values("box", "bracket", "crash_box", "bottle"));

// Gmsh numbers nodes and elements in its own way: sorted, they are those of the generator.
TEST(MeshFormats, AgreeWithTheGeneratorOnABox) {
  const Mesh drawn = committed("box");
  const Mesh generated = generate_mesh(BoxMesh{.size = {2, 1, 3}, .elements = {4, 2, 6}}, {});
  const auto sorted_points = [](std::vector<Vector3d> points) {
    for (auto& point : points)
      for (double& x : point) x = std::round(x * 1e9) / 1e9 + 0.0;
    std::sort(points.begin(), points.end(), std::ranges::lexicographical_compare);
    return points;
  };
  EXPECT_EQ(sorted_points(drawn.position), sorted_points(generated.position));
  const auto centres = [&](const Mesh& mesh) {
    std::vector<Vector3d> points;
    for (std::size_t e = 0; e < mesh.element_count(); ++e) {
      points.emplace_back();
      for (std::size_t k = 0; k < 8; ++k)
        for (std::size_t i = 0; i < 3; ++i)
          points.back()[i] += mesh.position[index(mesh.connectivity[8 * e + k])][i] / 8;
    }
    return sorted_points(points);
  };
  EXPECT_EQ(centres(drawn), centres(generated));
  for (const char* set : {"bottom", "top", "all"}) {
    EXPECT_EQ(drawn.node_sets.at(set).size(), generated.node_sets.at(set).size()) << set;
    EXPECT_EQ(drawn.side_sets.at(set).size(), generated.side_sets.at(set).size()) << set;
  }
  for (const int node : drawn.node_sets.at("bottom")) EXPECT_EQ(drawn.position[index(node)][2], -1.5);
}

/// The same mesh with nodes and elements in another order.
Mesh renumbered(const Mesh& mesh) {
  const auto place_of = [](std::size_t i, std::size_t count) { return (i * 7919 + 13) % count; };
  Mesh other = mesh;
  const std::size_t nodes = mesh.position.size(), elements = mesh.element_count();
  for (std::size_t i = 0; i < nodes; ++i) other.position[place_of(i, nodes)] = mesh.position[i];
  const auto moved = [&](int node) { return static_cast<int>(place_of(index(node), nodes)); };
  for (std::size_t e = 0; e < elements; ++e)
    for (std::size_t k = 0; k < 8; ++k)
      other.connectivity[8 * place_of(e, elements) + k] = moved(mesh.connectivity[8 * e + k]);
  for (auto& [name, set] : other.node_sets) {
    std::transform(set.begin(), set.end(), set.begin(), moved);
    std::sort(set.begin(), set.end());
  }
  for (auto& [name, sides] : other.side_sets)
    for (ElementSide& side : sides) side.element = static_cast<int>(place_of(index(side.element), elements));
  return other;
}

/// Start and end of each node of a block that is bent by a pressure, in the order of their starts.
std::vector<std::array<double, 6>> paths_of_bent_block(const Mesh& mesh) {
  Deck deck;
  deck.materials = {{"steel", ElasticPlastic{}}};
  auto& law = std::get<ElasticPlastic>(deck.materials[0].second);
  law.density = 1000;
  law.youngs_modulus = 1e9;
  law.poissons_ratio = 0.3;
  law.yield_stress = 1e6;
  deck.parts = {{"block", BoxMesh{}, {}, Hex8{}, "steel"}};
  PrescribedMotion hold;
  hold.where.set = "block.zmin";
  for (int axis = 0; axis < 3; ++axis) hold.components.push_back({axis, Curve{{{0, 0}}}});
  deck.boundary_conditions = {hold};
  Pressure pressure;
  pressure.side_set = "block.xmin";
  pressure.pressure = Curve{{{0, 2e5}}};
  deck.loads = {pressure};
  deck.time.end = 0.02;
  Model model = build(deck, std::span(&mesh, 1));
  std::vector<std::array<double, 6>> paths(mesh.position.size());
  const auto note = [&](std::size_t first) {
    for (std::size_t i = 0; i < paths.size(); ++i)
      std::copy_n(model.nodes.record[index(model.parts[0].node[i])].position, 3,
                  paths[i].begin() + static_cast<std::ptrdiff_t>(first));
  };
  note(0);
  ThreadTeam team(1);
  run(model, 0.1, team, [](Model&) { return true; });
  note(3);
  EXPECT_GT(model.step, 100);
  std::sort(paths.begin(), paths.end());
  return paths;
}

TEST(MeshFormats, ARunOfAFileIsThatOfTheGeneratorAfterRenumbering) {
  const Mesh generated = generate_mesh(BoxMesh{.size = {0.4, 0.5, 1}, .elements = {3, 4, 7}}, {});
  const Mesh other = renumbered(generated);
  EXPECT_FALSE(other.position == generated.position);
  const std::vector<std::array<double, 6>> expected = paths_of_bent_block(generated);
  double largest = 0;
  for (const auto& path : expected) largest = std::max(largest, std::abs(path[3] - path[0]));
  EXPECT_GT(largest, 0.01);
  for (const auto& text_mesh :
       {mesh_of(read_abaqus(as_abaqus(other), "a.inp")), mesh_of(read_gmsh(as_gmsh(other, true), "a.msh")),
        mesh_of(read_ls_dyna(as_ls_dyna(other), "a.k"))}) {
    const std::vector<std::array<double, 6>> found = paths_of_bent_block(text_mesh);
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t i = 0; i < found.size(); ++i)
      for (std::size_t k = 0; k < 6; ++k) ASSERT_NEAR(found[i][k], expected[i][k], 1e-12);
  }
}

TEST(MeshFormats, AgreeOnBeamsAndParticles) {
  const Mesh line = generate_mesh(LineMesh{.start = {0, 0, 0}, .end = {1, 2, 3}, .elements = 5}, {});
  const auto expect_line = [&](const Mesh& mesh) {
    EXPECT_TRUE(mesh.position == line.position);
    EXPECT_EQ(mesh.connectivity, line.connectivity);
    EXPECT_EQ(mesh.node_sets, line.node_sets);
  };
  expect_line(mesh_of(read_gmsh(as_gmsh(line, true), "a.msh")));
  expect_line(mesh_of(read_abaqus(as_abaqus(line), "a.inp")));
  expect_line(mesh_of(read_ls_dyna(as_ls_dyna(line), "a.k")));
  const Folder folder;
  write_exodus(line, folder / "a.exo");
  expect_line(mesh_of(read_exodus(folder / "a.exo", "a.exo")));
}

}  // namespace
}  // namespace brio::test
