#include <gtest/gtest.h>

#include <cmath>

#include <filesystem>
#include <fstream>

#include "io/deck/read_deck.hpp"
#include "io/yaml/closest_word.hpp"
#include "src/base/index.hpp"
#include "tests/io/deck/deck_text.hpp"

namespace brio {
namespace {

TEST(Deck, SaysWhatTheTextSays) {
  const Deck deck = parse_deck(plain_deck, "plain.yaml");
  EXPECT_EQ(deck.title, "Two boxes");
  ASSERT_EQ(deck.materials.size(), 1U);
  EXPECT_EQ(deck.materials[0].first, "steel");
  const auto& steel = std::get<Elastic>(deck.materials[0].second);
  EXPECT_EQ(steel.density, 7.34e-4);
  EXPECT_EQ(steel.youngs_modulus, 30e6);
  EXPECT_EQ(steel.poissons_ratio, 0.3);
  ASSERT_EQ(deck.parts.size(), 2U);
  EXPECT_EQ(deck.parts[0].name, "left");
  EXPECT_EQ(std::get<BoxMesh>(deck.parts[0].mesh).elements, (std::array<int, 3>{2, 2, 4}));
  EXPECT_FALSE(deck.parts[0].placement.rotate);
  const auto& tube = std::get<TubeMesh>(deck.parts[1].mesh);
  EXPECT_EQ(tube.outer_radius, 2);
  EXPECT_EQ(deck.parts[1].placement.rotate->degrees, 90);
  EXPECT_EQ(deck.parts[1].placement.translate, (Vector3d{0, 0, 19}));
  EXPECT_EQ(name_of(deck.parts[1].element), "hex8");
  ASSERT_EQ(deck.initial_conditions.size(), 2U);
  EXPECT_EQ(deck.initial_conditions[0].where.set, "left");
  EXPECT_EQ(deck.initial_conditions[0].velocity, (Vector3d{0, 0, -5000}));
  EXPECT_EQ(deck.initial_conditions[1].where.set, "right.top");
  EXPECT_EQ(deck.initial_conditions[1].spin->angular_velocity, (Vector3d{0, 0, 1}));
  EXPECT_EQ(deck.time.end, 3e-3);
  EXPECT_EQ(deck.output.fields_.every, 5e-5);
  EXPECT_EQ(deck.output.history.every, 1e-6);
  EXPECT_EQ(deck.text, plain_deck);
}

TEST(Deck, RigidPartsTakeSixComponentsByTheirName) {
  const Deck deck = parse_deck(R"(
materials:
  steel: {model: elastic, density: 1, youngs_modulus: 1, poissons_ratio: 0.3}
parts:
  blade: {mesh: {box: {size: [1, 1, 1], elements: [1, 1, 1]}}, element: rigid, material: steel}
  sheet:
    mesh: {plate: {size: [1, 1], elements: [1, 1]}}
    element: {type: rigid, thickness: 0.1, mass: 2, inertia: [1, 1, 1, 0, 0, 0.5], centre: [0, 0, 1]}
    material: steel
boundary_conditions:
  - {part: blade, fix: [x, y, rx, ry]}
  - {set: blade, velocity: {z: -900, rz: [[0, 0], [1, 2]]}}
time: {end: 1, step: 1e-3}
)",
                               "rigid.yaml");
  EXPECT_FALSE(std::get<Rigid>(deck.parts[0].element).thickness);
  const auto& sheet = std::get<Rigid>(deck.parts[1].element);
  EXPECT_EQ(sheet.thickness, 0.1);
  EXPECT_EQ(sheet.mass, 2);
  EXPECT_EQ((*sheet.inertia)[5], 0.5);
  EXPECT_EQ((*sheet.centre)[2], 1);
  const auto& held = std::get<PrescribedMotion>(deck.boundary_conditions[0]);
  EXPECT_EQ(held.where.set, "blade");
  EXPECT_EQ(held.components[3].axis, 4);
  EXPECT_EQ(std::get<PrescribedMotion>(deck.boundary_conditions[1]).components[1].curve(0.5), 1);
}

TEST(Deck, ConditionsAndLoadsKeepTheirKind) {
  const Deck deck = parse_deck(plain_deck, "plain.yaml");
  ASSERT_EQ(deck.boundary_conditions.size(), 3U);
  const auto& fixed = std::get<PrescribedMotion>(deck.boundary_conditions[0]);
  EXPECT_EQ(fixed.where.set, "left.bottom");
  ASSERT_EQ(fixed.components.size(), 3U);
  EXPECT_EQ(fixed.components[2].axis, 2);
  EXPECT_EQ(fixed.components[2].curve(0.7), 0);
  const auto& driven = std::get<PrescribedMotion>(deck.boundary_conditions[1]);
  EXPECT_EQ(driven.kind, MotionKind::velocity);
  EXPECT_EQ(std::get<PlaneRegion>(driven.where.region).tolerance, 1e-6);
  EXPECT_EQ(driven.where.part, "left");
  EXPECT_DOUBLE_EQ(driven.components[0].curve(5e-4), 2.5);
  EXPECT_EQ(std::get<RigidWall>(deck.boundary_conditions[2]).point, (Vector3d{0, 0, -3}));
  ASSERT_EQ(deck.loads.size(), 3U);
  EXPECT_EQ(std::get<Gravity>(deck.loads[0]).factor(0.25), 0.25);
  EXPECT_EQ(std::get<NodalForce>(deck.loads[1]).force, (Vector3d{1, 2, 3}));
  EXPECT_EQ(std::get<NodalForce>(deck.loads[1]).factor(7), 1);
  EXPECT_EQ(std::get<Pressure>(deck.loads[2]).side_set, "right.inside");
  EXPECT_EQ(std::get<Pressure>(deck.loads[2]).pressure(3), 100);
  ASSERT_TRUE(deck.contact);
  EXPECT_TRUE(deck.contact->surfaces.empty());
  EXPECT_EQ(deck.contact->exclude, std::vector<std::string>{"left"});
  EXPECT_EQ(deck.contact->options.friction, 0.1);
}

TEST(Deck, MotionsAndLoadsAreAlongTheAxesOfCoordinateSystems) {
  const Deck deck = parse_deck(deck_with_systems(), "systems.yaml");
  ASSERT_EQ(deck.coordinate_systems.size(), 2U);
  EXPECT_EQ(deck.coordinate_systems[1].first, "axle");
  EXPECT_EQ(std::get<CylindricalSystem>(deck.coordinate_systems[1].second).point, (Vector3d{0, 0, 19}));
  const auto& cut = std::get<PrescribedMotion>(deck.boundary_conditions[3]);
  EXPECT_EQ(cut.name, "cut");
  EXPECT_EQ(cut.system, "axle");
  ASSERT_EQ(cut.components.size(), 2U);
  EXPECT_EQ(cut.components[0].axis, 1);
  EXPECT_EQ(cut.components[1].axis, 2);
  const auto& driven = std::get<PrescribedMotion>(deck.boundary_conditions[4]);
  EXPECT_EQ(driven.system, "ramp");
  EXPECT_EQ(driven.components[0].axis, 1);
  EXPECT_EQ(std::get<PrescribedMotion>(deck.boundary_conditions[0]).system, "");
  EXPECT_EQ(std::get<NodalForce>(deck.loads[3]).system, "axle");
  EXPECT_EQ(std::get<Gravity>(deck.loads[4]).system, "ramp");
  // y counts at right angles to x; z is their cross product.
  const SystemAxes axes = axes_of(std::get<RectangularSystem>(deck.coordinate_systems[0].second));
  const double half = std::sqrt(0.5), third = std::sqrt(1.0 / 6);
  const SystemAxes wanted{{{half, 0, half},
                           {third, 2 * third, -third},
                           {-std::sqrt(1.0 / 3), std::sqrt(1.0 / 3), std::sqrt(1.0 / 3)}}};
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(axes[axis][i], wanted[axis][i], 1e-15);
}

double density_of(const Deck& deck) { return density(deck.materials.at(0).second); }

TEST(Deck, NumbersAreWrittenInManyWays) {
  const std::vector<std::pair<std::string, double>> numbers{{"30e6", 30e6}, {"1e-3", 1e-3},    {".5", 0.5},
                                                            {"+1", 1},      {"5.", 5},         {"1E+2", 100},
                                                            {"007", 7},     {"1e-310", 1e-310}};
  for (const auto& [text, value] : numbers)
    EXPECT_EQ(density_of(parse_deck(with("7.34e-4", text), "a.yaml")), value) << text;
  const Deck deck = parse_deck(with("[2, 2, 4]", "[2.0, 2e0, +4]"), "a.yaml");
  EXPECT_EQ(std::get<BoxMesh>(deck.parts[0].mesh).elements, (std::array<int, 3>{2, 2, 4}));
}

TEST(Deck, AnchorsAndMergeKeysWork) {
  const std::string text = R"(
materials:
  a: &steel {model: elastic, density: 1, youngs_modulus: 2, poissons_ratio: 0}
  b: {<<: *steel, density: 3}
  c: {density: 5, <<: [{density: 6, model: elastic}, *steel]}
parts:
  one: &one {mesh: {box: {size: &size [1, 1, 1], elements: [1, 1, 1]}}, element: hex8, material: a}
  two:
    <<: *one
    mesh: {box: {size: *size, elements: [2, 2, 2]}}
time: {end: 1}
)";
  const Deck deck = parse_deck(text, "a.yaml");
  ASSERT_EQ(deck.materials.size(), 3U);
  EXPECT_EQ(density(deck.materials[1].second), 3);
  EXPECT_EQ(std::get<Elastic>(deck.materials[1].second).youngs_modulus, 2);
  EXPECT_EQ(density(deck.materials[2].second), 5);
  EXPECT_EQ(std::get<BoxMesh>(deck.parts[1].mesh).size, (Vector3d{1, 1, 1}));
  EXPECT_EQ(std::get<BoxMesh>(deck.parts[1].mesh).elements[0], 2);
  EXPECT_EQ(deck.parts[1].material, "a");
  EXPECT_EQ(std::get<BoxMesh>(deck.parts[0].mesh).elements[0], 1);
}

TEST(Deck, LineEndsAndByteOrderMarkDoNotMatter) {
  std::string text = plain_deck;
  for (std::size_t at = 0; (at = text.find('\n', at)) != std::string::npos; at += 2)
    text.replace(at, 1, "\r\n");
  EXPECT_EQ(parse_deck(text, "a.yaml").parts.size(), 2U);
  EXPECT_EQ(parse_deck("\xEF\xBB\xBF" + std::string(plain_deck), "a.yaml").title, "Two boxes");
  EXPECT_EQ(parse_deck(with("Two boxes", "Zwei Würfel \xE2\x9C\x93"), "a.yaml").title,
            "Zwei Würfel \xE2\x9C\x93");
}

TEST(ExtremesDeckFile, IsReadFromAPathWithSpaces) {
  const auto folder = std::filesystem::temp_directory_path() / "brio deck test";
  std::filesystem::create_directories(folder);
  const std::string path = (folder / "a deck.yaml").string();
  std::ofstream(path) << plain_deck;
  EXPECT_EQ(read_deck(path).file, path);
  std::ofstream(path) << with("hex8", "hexe");
  try {
    read_deck(path);
    FAIL() << "not refused";
  } catch (const DeckError& fault) {
    EXPECT_EQ(std::string(fault.what()).find(path + ":7:14: "), 0U) << fault.what();
  }
  std::filesystem::remove_all(folder);
}

TEST(Deck, ReadsManyPartsInProportionateTime) {
  std::string text =
      "materials: {m: {model: elastic, density: 1, youngs_modulus: 1, poissons_ratio: 0}}\nparts:\n";
  const int count = 10000;
  for (int i = 0; i < count; ++i)
    text += "  p" + std::to_string(i) +
            ": {mesh: {box: {size: [1, 1, 1], elements: [1, 1, 1]}}, element: hex8, material: m}\n";
  text += "initial_conditions:\n";
  for (int i = 0; i < count; ++i) text += "  - {part: p" + std::to_string(i) + ", velocity: [1, 0, 0]}\n";
  text += "time: {end: 1}\n";
  EXPECT_EQ(parse_deck(text, "a.yaml").parts.size(), index(count));
}

TEST(Override, ReplacesAnyValue) {
  const Deck deck =
      parse_deck(plain_deck, "a.yaml",
                 {"time.end=1e-2", "parts.left.mesh.box.elements=[3, 3, 3]", "boundary_conditions.0.fix=[x]",
                  "numerics.precision=float", "title=", "title='a: b'", "materials.steel.density=+.5"});
  EXPECT_EQ(deck.time.end, 1e-2);
  EXPECT_EQ(std::get<BoxMesh>(deck.parts[0].mesh).elements, (std::array<int, 3>{3, 3, 3}));
  EXPECT_EQ(std::get<PrescribedMotion>(deck.boundary_conditions[0]).components.size(), 1U);
  EXPECT_EQ(deck.numerics.precision, Precision::single_precision);
  EXPECT_EQ(density_of(deck), 0.5);
  EXPECT_EQ(deck.title, "a: b");
}

TEST(Override, LeavesWhatSharesAnAnchorAlone) {
  const std::string text = R"(
materials: {m: {model: elastic, density: 1, youngs_modulus: 2, poissons_ratio: 0}}
parts:
  one: &one {mesh: {box: {size: [1, 1, 1], elements: [1, 1, 1]}}, element: hex8, material: m}
  two: *one
time: {end: 1}
)";
  const Deck deck = parse_deck(text, "a.yaml", {"parts.two.mesh.box.size.1=7"});
  EXPECT_EQ(std::get<BoxMesh>(deck.parts[0].mesh).size[1], 1);
  EXPECT_EQ(std::get<BoxMesh>(deck.parts[1].mesh).size[1], 7);
}

TEST(Override, IsEchoedInTheTextOfTheDeck) {
  const std::vector<std::string> overrides{"time.end=0.25", "title=\"a \\\"b\\\" \\\\ [c]: #d\\te\"",
                                           "units.length=mm"};
  const Deck deck = parse_deck(plain_deck, "a.yaml", overrides);
  const Deck again = parse_deck(deck.text, "echo.yaml");
  EXPECT_EQ(again.title, "a \"b\" \\ [c]: #d\te");
  EXPECT_EQ(again.time.end, 0.25);
  EXPECT_EQ(again.units.at(0).second, "mm");
  EXPECT_EQ(again.parts.size(), deck.parts.size());
  EXPECT_EQ(parse_deck(deck.text, "echo.yaml", overrides).text, deck.text)
      << "writing what was written changes nothing";
}

TEST(Override, IsThePlaceOfItsFaults) {
  EXPECT_EQ(fault_of(plain_deck, {"time.end=-1"}), "--set time.end=-1: 'end' is '-1'; expected a number > 0");
  const std::vector<std::pair<std::string, std::string>> faults{
      {"time.ende=1", "unknown key 'ende'; did you mean 'end'?"},
      {"tiem.end=1", "unknown key 'tiem'; did you mean 'time'?"},
      {"time", "write KEY.PATH=VALUE"},
      {"=1", "write KEY.PATH=VALUE"},
      {"", "write KEY.PATH=VALUE"},
      {"time..end=1", "a key of the path is empty"},
      {".time=1", "a key of the path is empty"},
      {"time.=1", "a key of the path is empty"},
      {"time.end.now=1", "'now' cannot be set inside '3e-3'"},
      {"boundary_conditions.3.fix=[x]", "'3' is not an entry of the list; it has 3, counted from 0"},
      {"boundary_conditions.first.fix=[x]", "'first' is not an entry of the list"},
      {"boundary_conditions.-1.fix=[x]", "'-1' is not an entry of the list"},
      {"time.end=[1", "not valid YAML"},
      {"time.end=\x01", "not a text file"},
      {"parts.left.material=stahl", "no material is called 'stahl'"},
      {"parts.third.material=steel", "'third' has no 'mesh'"},
      {"contact={frictoin: 1}", "unknown key 'frictoin'"},
      {"time={end: 1, end: 2}", "duplicate key 'end'"}};
  for (const auto& [setting, message] : faults) {
    const std::string fault = fault_of(plain_deck, {setting});
    EXPECT_EQ(fault.find("--set " + setting + ": "), 0U) << fault;
    EXPECT_NE(fault.find(message), std::string::npos) << fault;
  }
}

TEST(ClosestWord, CountsInsertionsDeletionsReplacementsAndSwaps) {
  EXPECT_EQ(edit_distance("density", "density"), 0);
  EXPECT_EQ(edit_distance("", "abc"), 3);
  EXPECT_EQ(edit_distance("densty", "density"), 1);
  EXPECT_EQ(edit_distance("frictoin", "friction"), 1);
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3);
  EXPECT_EQ(edit_distance("Density", "density"), 0);
}

TEST(ClosestWord, IsNotSaidWhereNothingResembles) {
  EXPECT_EQ(closest_word("friktion", {"surfaces", "friction"}), "friction");
  EXPECT_TRUE(closest_word("colour", {"surfaces", "friction"}).empty());
  EXPECT_TRUE(closest_word("x", {"y", "z"}).empty());
}

}  // namespace
}  // namespace brio
