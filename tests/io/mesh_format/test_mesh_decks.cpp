// Parts of mesh files in decks: blocks, sets, refusals with their place, and runs that do not depend on the
// format.

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "io/deck/read_deck.hpp"
#include "io/mesh/generate_mesh.hpp"
#include "io/mesh_format/read_mesh_file.hpp"
#include "io/restart/restart_file.hpp"
#include "io/results/read_result.hpp"
#include "io/run/run_deck.hpp"
#include "io/study/read_study.hpp"
#include "io/yaml/deck_error.hpp"
#include "src/base/index.hpp"
#include "tests/io/mesh_format/committed_meshes.hpp"
#include "tests/io/results/result_scene.hpp"
#include "tests/io/text_of.hpp"

namespace brio::test {
namespace {

namespace fs = std::filesystem;

constexpr const char* materials = R"(
materials:
  steel: {model: elastic_plastic, density: 7.8e-9, youngs_modulus: 2.1e5, poissons_ratio: 0.3, yield_stress: 250,
          hardening_modulus: 1000}
)";

class MeshDecks : public testing::Test {
 protected:
  void write(const std::string& name, const std::string& text) const { std::ofstream(folder / name) << text; }
  std::string deck(const std::string& body) const { return materials + body; }
  Deck read(const std::string& body) const { return parse_deck(deck(body), folder / "a.yaml"); }
  std::string fault_of(const std::string& body) const {
    try {
      build_scene(read(body));
    } catch (const DeckError& fault) {
      std::string text = fault.what();
      for (std::size_t at; (at = text.find(folder.path().string() + "/")) != std::string::npos;)
        text.erase(at, folder.path().string().size() + 1);
      return text;
    }
    return "no fault";
  }
  void copy(const std::string& name) const { fs::copy_file(folder_of_meshes + name, folder / name); }

  RunOutcome run(const std::string& name, const std::string& output, RunOptions options = {}) const {
    options.deck = folder / name;
    options.output = folder / output;
    return run_deck(options);
  }

  Folder folder;
};

constexpr const char* box_of_file = R"(
meshes: {car: {file: box.msh}}
parts:
  body: {mesh: {from: car, block: box, scale: 2}, placement: {translate: [0, 0, 1]}, element: hex8, material: steel}
boundary_conditions: [{set: car.bottom, fix: [x, y, z]}, {set: body.top, velocity: {z: -1}}]
loads: [{side_set: body.top, pressure: 3}, {side_set: car.top, pressure: 4}]
time: {end: 1e-6}
)";

TEST_F(MeshDecks, TakeBlocksAndSetsByName) {
  copy("box.msh");
  const Deck deck = read(box_of_file);
  ASSERT_EQ(deck.meshes.size(), 1u);
  EXPECT_EQ(deck.mesh_checksums.size(), 1u);
  const Model model = build_scene(deck);
  const Mesh mesh = committed("box");
  ASSERT_EQ(model.prescribed.size(), 4u);
  EXPECT_EQ(model.prescribed[0].nodes.size(), mesh.node_sets.at("bottom").size());
  for (const int node : model.prescribed[0].nodes) EXPECT_EQ(model.nodes.record[index(node)].position[2], -2);
  EXPECT_EQ(model.loads.size(), 2u);
  EXPECT_EQ(model.parts[0].node_id, mesh.node_id);
  EXPECT_NEAR(model.parts[0].mass, 8 * 6 * 7.8e-9, 1e-20);
}

TEST_F(MeshDecks, OfAFileAndOfTheGeneratorHaveTheSameMassAndStep) {
  copy("box.msh");
  const Model file = build_scene(read(box_of_file));
  const Model generated = build_scene(read(R"(
parts: {body: {mesh: {box: {size: [4, 2, 6], elements: [4, 2, 6]}}, element: hex8, material: steel}}
time: {end: 1e-6}
)"));
  EXPECT_NEAR(file.parts[0].mass, generated.parts[0].mass, 1e-14 * generated.parts[0].mass);
  EXPECT_EQ(file.nodes.size(), generated.nodes.size());
  EXPECT_EQ(file.parts[0].element_slot.size(), generated.parts[0].element_slot.size());
}

struct Refusal {
  const char* from;
  const char* to;
  const char* message;
};

TEST_F(MeshDecks, RefuseWhatTheFileDoesNotHaveAtItsPlace) {
  copy("box.msh");
  copy("bottle.msh");
  const Refusal refusals[] = {
      {"block: box", "block: bux", "a.yaml:8:35: box.msh has no block 'bux'; did you mean 'box'? accepted: "},
      {"from: car", "from: cat",
       "a.yaml:8:23: no mesh file is called 'cat' in 'meshes'; did you mean 'car'? accepted: car"},
      {"from: car", "file: none.msh", "none.msh: cannot be opened: No such file or directory"},
      {"from: car", "file: box.stl",
       "a.yaml:8:23: the suffix of 'box.stl' tells no format; accepted are .msh, .inp"},
      {"from: car", "file: box.msh, from: car",
       "a.yaml:8:16: the mesh is not said once; accepted is one of from"},
      {"from: car, block", "from: car, blok", "a.yaml:8:28: unknown key 'blok'; did you mean 'block'?"},
      {"scale: 2", "scale: 0", "a.yaml:8:47: 'scale' is '0'; expected a number > 0"},
      {"element: hex8", "element: {type: shell4, thickness: 1}",
       "a.yaml:8:95: the block of the mesh file has elements of 8 nodes, not 'shell4'; accepted: hex8, "
       "hex8_full"},
      {"set: car.bottom", "set: car.botom",
       "a.yaml:9:29: part 'body' has no set 'botom'; did you mean 'bottom'?"},
      {"set: car.bottom", "set: cat.bottom", "a.yaml:9:29: no part is called 'cat'"},
      {"body:", "car:", "a.yaml:8:8: part 'car' has the name of a mesh file; 'car.SET' would be of either"},
      {"side_set: body.top", "side_set: body.side",
       "a.yaml:10:20: part 'body' has no set 'side'; accepted: "},
  };
  for (const auto& [from, to, message] : refusals) {
    std::string body = box_of_file;
    body.replace(body.find(from), std::string(from).size(), to);
    EXPECT_EQ(fault_of(body).substr(0, std::string(message).size()), message);
  }
}

// Two stacked pairs of cubes: nodes of a set of the file, in both of its parts that deform, on a plate below.
constexpr const char* two_cubes = R"(*NODE
1, 0, 0, 0
2, 1, 0, 0
3, 1, 1, 0
4, 0, 1, 0
5, 0, 0, 1
6, 1, 0, 1
7, 1, 1, 1
8, 0, 1, 1
11, 2, 0, 0
12, 3, 0, 0
13, 3, 1, 0
14, 2, 1, 0
15, 2, 0, 1
16, 3, 0, 1
17, 3, 1, 1
18, 2, 1, 1
*ELEMENT, TYPE=C3D8R, ELSET=left
1, 1, 2, 3, 4, 5, 6, 7, 8
*ELEMENT, TYPE=C3D8R, ELSET=right
2, 11, 12, 13, 14, 15, 16, 17, 18
*NSET, NSET=feet
1, 2, 3, 4, 11, 12, 13, 14
*NSET, NSET=heads
5, 6, 15, 16
)";
constexpr const char* tied_cubes = R"(
meshes: {cubes: {file: cubes.inp}}
parts:
  left: {mesh: {from: cubes, block: left}, element: hex8, material: steel}
  right: {mesh: {from: cubes, block: right}, element: hex8, material: steel}
  base: {mesh: {box: {size: [4, 2, 1], elements: [4, 2, 1]}}, placement: {translate: [1.5, 0.5, -0.5]}, element: hex8,
         material: steel}
connections: [{tie: [cubes.feet, base], tolerance: 1e-6}]
time: {end: 1e-6}
)";

TEST_F(MeshDecks, TieSetsOfFilesInAllTheirParts) {
  write("cubes.inp", two_cubes);
  const Model model = build_scene(read(tied_cubes));
  ASSERT_EQ(model.ties.found.size(), 1u);
  EXPECT_EQ(model.ties.found[0].nodes, "cubes.feet");
  EXPECT_EQ(model.ties.found[0].count, 8);
  // As two ties of the parts by themselves.
  std::string apart = tied_cubes;
  const std::string tie = "{tie: [cubes.feet, base], tolerance: 1e-6}";
  apart.replace(apart.find(tie), tie.size(),
                "{tie: [left.feet, base], tolerance: 1e-6}, {tie: [right.feet, base], tolerance: 1e-6}");
  const Model two = build_scene(read(apart));
  ASSERT_EQ(two.ties.node.size(), model.ties.node.size());
  for (std::size_t i = 0; i < model.nodes.size(); ++i) EXPECT_EQ(two.nodes.mass[i], model.nodes.mass[i]);
  // Of a set that reaches into the part of the faces its own nodes are not tied to it.
  std::string own = tied_cubes;
  own.replace(own.find(tie), tie.size(), "{tie: [cubes.feet, left], tolerance: 1e-6}");
  EXPECT_NE(fault_of(own).find("no node of 'cubes.feet' lies within 1e-06 of the surface of 'left'"),
            std::string::npos)
      << fault_of(own);
  std::string unknown = tied_cubes;
  unknown.replace(unknown.find("cubes.feet"), 10, "cubes.feat");
  EXPECT_NE(fault_of(unknown).find("a.yaml:12:22: part 'left' has no set 'feat'; did you mean 'feet'?"),
            std::string::npos)
      << fault_of(unknown);
}

TEST_F(MeshDecks, NameElementsByTheNumbersOfTheFile) {
  std::string text = text_of(folder_of_meshes + "box.msh");
  write("box.msh", text);
  const Model model = build_scene(read(box_of_file));
  EXPECT_EQ(model.parts[0].number_of_element(0), committed("box").element_id[0]);
  EXPECT_NE(model.parts[0].number_of_element(0), 0);
}

// Particles of a file: volumes of the deck where the file has none.
TEST_F(MeshDecks, TakeParticlesWithTheVolumeOfTheDeck) {
  ParticleMesh fill;
  fill.box = ParticleBox{.size = {4, 4, 4}, .spacing = 1};
  const Mesh cloud = generate_mesh(fill, {});
  write("cloud.msh", as_gmsh(cloud, true));
  const std::string body = R"(
parts: {cloud: {mesh: {file: cloud.msh, block: body, particle_volume: 1}, element: particle, material: steel}}
initial_conditions: [{set: cloud.bottom, velocity: [0, 0, 1]}]
time: {end: 1e-6}
)";
  EXPECT_NEAR(build_scene(read(body)).parts[0].mass, 64 * 7.8e-9, 1e-18);
  std::string without = body;
  without.replace(without.find(", particle_volume: 1"), 20, "");
  EXPECT_EQ(fault_of(without).substr(0, 75),
            "cloud.msh: element 1 of block 'body' is a particle without volume; accepted");
}

// Two blocks share the nodes between them; a set of the file reaches into both.
TEST_F(MeshDecks, SelectSetsOfTheFileInAllPartsOfIt) {
  Mesh bar = generate_mesh(BoxMesh{.size = {2, 1, 1}, .elements = {2, 1, 1}}, {});
  bar.node_sets = {{"zmin", bar.node_sets.at("zmin")}};
  bar.side_sets = {{"zmin", bar.side_sets.at("zmin")}};
  std::string text = as_abaqus(bar);
  text.replace(text.find("elset=body"), 10, "elset=both");
  write("bar.inp", text + "*ELSET, ELSET=left\n1\n*ELSET, ELSET=right\n2\n");
  const Model model = build_scene(read(R"(
meshes: {bar: {file: bar.inp}}
parts:
  a: {mesh: {from: bar, block: left}, element: hex8, material: steel}
  b: {mesh: {from: bar, block: right}, element: hex8, material: steel}
connections: [{merge: [a, b], tolerance: 1e-9}]
boundary_conditions: [{set: bar.zmin, fix: [z]}]
loads: [{side_set: bar.zmin, pressure: 1}]
time: {end: 1e-6}
)"));
  EXPECT_EQ(model.nodes.size(), 12u);
  ASSERT_EQ(model.prescribed.size(), 1u);
  EXPECT_EQ(model.prescribed[0].nodes.size(), 6u);
  EXPECT_EQ(model.loads.size(), 2u);
}

constexpr const char* scenes[] = {
    R"(
parts: {bracket: {mesh: {file: MESH, block: body}, element: hex8, material: steel}}
boundary_conditions: [{set: bracket.back, fix: [x, y, z]}]
loads: [{side_set: bracket.seat, pressure: 20}]
time: {end: 4e-5}
output: {fields: {every: 2e-5}}
)",
    R"(
parts: {box: {mesh: {file: MESH, block: body}, element: {type: shell4, thickness: 1.5}, material: steel}}
boundary_conditions: [{set: box.foot, fix: [x, y, z, rx, ry, rz]}, {set: box.head, velocity: {z: -1e4}}]
contact: {surfaces: all}
time: {end: 1e-4}
output: {fields: {every: 5e-5}}
)",
    R"(
parts: {bottle: {mesh: {file: MESH, block: body}, element: {type: shell4, thickness: 1}, material: steel}}
boundary_conditions: [{set: bottle.mouth, fix: [x, y, z]}]
initial_conditions: [{part: bottle, velocity: [0, 5e3, 0]}]
contact: {surfaces: all}
time: {end: 1e-4}
output: {fields: {every: 5e-5}}
)"};

class MeshRuns : public MeshDecks, public testing::WithParamInterface<int> {};

TEST_P(MeshRuns, OfAllFormatsHaveTheSameBits) {
  const char* name = std::array{"bracket", "crash_box", "bottle"}[index(GetParam())];
  const Mesh mesh = committed(name);
  std::string expected, fields;
  for (const MeshFormat format :
       {MeshFormat::gmsh, MeshFormat::abaqus, MeshFormat::ls_dyna, MeshFormat::exodus}) {
    std::string body = scenes[GetParam()];
    body.replace(body.find("MESH"), 4, write_mesh(mesh, format, folder.path().string(), name));
    const std::string stem = "run" + std::to_string(static_cast<int>(format));
    write(stem + ".yaml", deck(body));
    const RunOutcome outcome = run(stem + ".yaml", stem);
    EXPECT_EQ(outcome.summary.status, "finished");
    EXPECT_GT(outcome.summary.energy.internal, 0);
    const std::string history = text_of(folder / (stem + "/" + stem + ".history.csv"));
    const ResultReader result(folder / (stem + "/" + stem + ".vtkhdf"));
    const auto stress = result.field("stress", result.times().size() - 1).values;
    const std::string bits(reinterpret_cast<const char*>(stress.data()), stress.size() * sizeof stress[0]);
    if (expected.empty()) expected = history, fields = bits;
    EXPECT_TRUE(history == expected) << static_cast<int>(format);
    EXPECT_TRUE(bits == fields) << static_cast<int>(format);
    const auto ids = result.field("node_id", 0).values;
    EXPECT_EQ(std::vector<std::int64_t>(ids.begin(), ids.end()), mesh.node_id);
  }
}
INSTANTIATE_TEST_SUITE_P(Scenes, MeshRuns, testing::Values(0, 1, 2));

constexpr const char* dropped = R"(
parts: {body: {mesh: {file: box.msh}, element: hex8, material: steel}}
initial_conditions: [{part: body, velocity: [0, 0, -100]}]
boundary_conditions: [{set: body.bottom, fix: [x, y, z]}]
time: {end: 2e-5}
output: {fields: {every: 1e-5}, restart: {every: 1e-5}}
)";

TEST_F(MeshDecks, RestartWithTheirMeshAndNoOther) {
  copy("box.msh");
  write("a.yaml", deck(dropped));
  run("a.yaml", "whole");
  fs::copy(folder / "whole", folder / "again");
  RunOptions options;
  options.restart = folder / "again/a.restart.previous.h5";
  const RunOutcome again = run("a.yaml", "again", options);
  EXPECT_EQ(again.summary.status, "finished");
  EXPECT_TRUE(text_of(folder / "whole/a.history.csv") == text_of(folder / "again/a.history.csv"));
  std::string text = text_of(folder / "box.msh");
  write("box.msh", text.replace(text.find("-0.5"), 4, "-.51"));
  try {
    run("a.yaml", "again", options);
    ADD_FAILURE() << "not refused";
  } catch (const DeckError& fault) {
    const std::string said = fault.what();
    EXPECT_NE(said.find("the file 'box.msh' has changed since "), std::string::npos) << said;
  }
}

TEST_F(MeshDecks, InAStudyOfAnotherFolderAreFoundBesideTheDeck) {
  copy("box.msh");
  write("a.yaml", deck(dropped));
  fs::create_directory(folder / "studies");
  write("studies/s.yaml", R"(title: Box
deck: ../a.yaml
reference: step.half
quantities: {sink: {field: position, component: z, take: min}}
knobs: {step: {half: {time.step_scale: 0.45}}}
)");
  const CheckedStudy study = read_study(folder / "studies/s.yaml");
  ASSERT_EQ(study.meshes.size(), 2u);
  EXPECT_EQ(study.meshes[0].substr(0, 8), "box.msh ");
}

}  // namespace
}  // namespace brio::test
