// What only shows when a scene is put together is refused with the place of the key that is responsible.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "io/deck/read_deck.hpp"
#include "io/run/run_deck.hpp"

namespace brio {
namespace {

constexpr const char* scene = R"(materials:
  soft: {model: elastic, density: 1000, youngs_modulus: 1e9, poissons_ratio: 0.3}
parts:
  cube: {mesh: {box: {size: [1, 1, 1], elements: [2, 2, 2]}}, element: hex8, material: soft}
  other: {mesh: {box: {size: [1, 1, 1], elements: [2, 2, 2]}}, placement: {translate: [0, 0, 2]}, element: hex8, material: soft}
  body: {mesh: {box: {size: [1, 1, 1], elements: [2, 2, 2]}}, placement: {translate: [4, 0, 0]}, element: rigid, material: soft}
boundary_conditions: [{part: cube, fix: [x]}]
initial_conditions: [{part: other, velocity: [1, 0, 0]}]
time: {end: 1e-3}
)";

/// `from` is replaced by `to`, and `more` stands at the end; ^ marks the place of the refusal.
struct Edit {
  const char* from;
  const char* to;
  const char* more;
  const char* message;
};

class RefusedScene : public testing::TestWithParam<Edit> {};

TEST_P(RefusedScene, NamesThePlaceOfWhatIsResponsible) {
  const auto& [from, to, more, message] = GetParam();
  std::string text = scene;
  const std::size_t at = text.find(from);
  ASSERT_NE(at, std::string::npos) << from;
  text.replace(at, std::string(from).size(), to) += more;
  const std::size_t marker = text.find('^');
  ASSERT_NE(marker, std::string::npos) << to;
  text.erase(marker, 1);
  const auto line = 1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(marker), '\n');
  const std::size_t column = marker - text.rfind('\n', marker - 1);
  const std::string place = "a.yaml:" + std::to_string(line) + ":" + std::to_string(column) + ": ";
  try {
    build_scene(parse_deck(text, "a.yaml"));
    ADD_FAILURE() << "not refused: " << text;
  } catch (const DeckError& fault) {
    const std::string said = fault.what();
    EXPECT_EQ(said.substr(0, place.size()), place) << said;
    EXPECT_NE(said.find(message), std::string::npos) << said;
  }
}

constexpr const char* fixed = "{part: cube, fix: [x]}";
constexpr const char* thrown = "{part: other, velocity: [1, 0, 0]}";
constexpr Edit edits[] = {
    // conditions that name no node, or not what they can act on
    {fixed, "{set: ^{box: {lower: [9, 9, 9], upper: [10, 10, 10]}}, fix: [x]}", "", "selects no node"},
    {fixed, "{set: ^{sphere: {centre: [0, 0, 9], radius: 1}}, velocity: {x: 1}}", "", "selects no node"},
    {thrown, "{set: ^{plane: {point: [0, 0, 9], normal: [0, 0, 1], tolerance: 0}}, velocity: [1, 0, 0]}", "",
     "selects no node"},
    {"", "", "loads: [{set: ^{box: {lower: [9, 9, 9], upper: [10, 10, 10]}}, force: [1, 0, 0]}]",
     "selects no node"},
    {fixed, "{set: ^body.top, fix: [x]}", "", "moves as a whole"},
    {thrown, "{set: ^body.top, velocity: [1, 0, 0]}", "", "moves as a whole"},
    {thrown, "{part: ^cube, radial: {point: [0, 0, 0], axis: [0, 0, 1], speed: 1}}", "",
     "no radial direction"},
    {thrown, "{part: ^body, radial: {point: [0, 0, 0], axis: [0, 0, 1], speed: 1}}", "", "rigid part"},
    // two motions of one component
    {fixed, "{part: cube, fix: [x]}, {set: cube.top, velocity: {x: ^1}}", "",
     "'x' of node 18 of part 'cube' at (-0.5, -0.5, 0.5) is prescribed here and, otherwise, at a.yaml:7:42"},
    {fixed, "{set: cube.top, velocity: {x: 1}}, {set: cube.xmax, velocity: {x: ^1.1}}", "",
     "of part 'cube' at (0.5,"},
    {fixed, "{set: cube.top, displacement: {z: [[0, 0], [1, 1]]}}, {part: cube, fix: [x, y, ^z]}", "",
     "'z' of node 18 of part 'cube'"},
    {fixed, "{part: cube, velocity: {y: [[0, 1], [1e-3, 1.1]]}}, {part: cube, acceleration: {y: ^100}}", "",
     "'y' of node 0 of part 'cube'"},
    {fixed, "{part: body, fix: [rz]}, {part: body, velocity: {rz: ^2}}", "",
     "'rz' of the rigid part 'body' is prescribed here and, otherwise, at a.yaml:7:42"},
    {fixed, "{part: body, velocity: {x: [[0, 0], [1e-4, 1]]}}, {part: body, fix: [^x]}", "",
     "'x' of the rigid part 'body'"},
    {fixed, "{part: cube, fix: [x]}, {part: other, velocity: {x: ^1}}",
     "connections: [{merge: [cube, other], tolerance: 1}]", "is prescribed here"},
    // elements without volume
    {"  other: {mesh: {box: {size: [1, 1, 1]", "  ^other: {mesh: {box: {size: [1e-120, 1e-120, 1e-120]", "",
     "of part 'other'"},
    {"  body: {mesh: {box: {size: [1, 1, 1]", "  ^body: {mesh: {box: {size: [1e-120, 1e-120, 1e-120]", "",
     "part 'body'"},
    // contact
    {"translate: [0, 0, 2]", "translate: [0, 0, 0.6]", "contact: ^{surfaces: all}", "contact: part '"},
    {"", "", "contact: {surfaces: [cube, other], pairs: [^{parts: [cube, body], friction: 0.1}]}",
     "is not in contact"},
    {"  other: {mesh", "  ^other: {deletion: {inverted: true, debris_radius: 0.1}, mesh", "",
     "debris_radius"},
    {"  other: {mesh: {box: {size: [1, 1, 1], elements: [2, 2, 2]}}, placement: {translate: [0, 0, 2]}, "
     "element: hex8",
     "  ^other: {mesh: {plate: {size: [1, 1], elements: [50, 50]}}, placement: {translate: [0, 0, 9]}, "
     "element: {type: "
     "shell4, thickness: 1}",
     "contact: {surfaces: all}", "times as much as the mean edge"},
    // connections
    {"", "", "connections: [^{merge: [cube, other], tolerance: 0.1}]", "no node of 'other' lies within"},
    {"", "", "connections: [^{tie: [cube.top, other], tolerance: 0.1}]", "no node of 'cube.top' lies within"},
    // time
    {"end: 1e-3}", "end: 1e-3, mass_scaling: ^{step: 1e-3}}",
     "connections: [{tie: [other.bottom, cube], tolerance: 1.1}]", "does not go with 'tie'"},
};

INSTANTIATE_TEST_SUITE_P(Edited, RefusedScene, testing::ValuesIn(edits));

// Motions that are one, however they are said, are not contradictory.
class AcceptedScene : public testing::TestWithParam<const char*> {};

TEST_P(AcceptedScene, GivesAMotionTwice) {
  std::string text = scene;
  const std::string one = "{part: cube, fix: [x]}";
  text.replace(text.find(one), one.size(), GetParam());
  EXPECT_NO_THROW(build_scene(parse_deck(text, "a.yaml")));
}

constexpr const char* same_motions[] = {
    "{part: cube, fix: [x, y]}, {set: cube.top, fix: [y, z]}",
    "{part: cube, fix: [x]}, {set: cube.top, velocity: {x: 0}}",
    "{part: cube, fix: [x]}, {set: cube.top, displacement: {x: 3}}",
    "{part: cube, fix: [x]}, {set: cube.top, acceleration: {x: 0}}",
    "{part: cube, velocity: {x: 0.1}}, {set: cube.top, displacement: {x: [[0, 0.7], [3e-3, 0.7003]]}}",
    "{part: cube, velocity: {x: 2}}, {set: cube.top, velocity: {x: [[0, 2], [1e-3, 2], [2e-3, 9]]}}",
    "{part: other, velocity: {x: [[0, 1], [1e-3, 1.1]]}}, {part: other, acceleration: {x: 100}}",
    "{part: cube, fix: [x]}, {set: other.top, velocity: {x: 1}}",
    "{part: body, fix: [x]}, {part: body, velocity: {x: 0, y: 1}}",
    "{part: body, velocity: {rz: 1}}, {part: body, displacement: {rz: [[0, 0], [1, 1]]}}",
};

INSTANTIATE_TEST_SUITE_P(Equal, AcceptedScene, testing::ValuesIn(same_motions));

/// What the first step of the scene says with this section of time; nothing where it is made.
std::string fault_of_first_step(const std::string& time) {
  std::string text = scene;
  const std::string given = "{end: 1e-3}";
  text.replace(text.find(given), given.size(), time);
  const Deck deck = parse_deck(text, "a.yaml");
  Model model = build_scene(deck);
  ThreadTeam team(1);
  try {
    make_first_step(deck, model, team);
  } catch (const DeckError& fault) {
    return fault.what();
  }
  return {};
}

// An ulp of a time is 2^-53 of it: the last of so many steps are lost in rounding.
TEST(RefusedScene, WithMoreStepsThanATimeCanCountIsRefusedWhateverSetsTheStep) {
  const Deck deck = parse_deck(scene, "a.yaml", {"time.end=1"});
  Model model = build_scene(deck);
  ThreadTeam team(1);
  make_first_step(deck, model, team);
  const double step = model.times.next;
  const auto end_after = [](double steps, double of) { return "{end: " + fmt::format("{}", steps * of); };
  for (const double steps : {1.01 * 0x1p53, 1e30, 1e300})
    for (const std::string& time : {end_after(steps, step) + "}", end_after(steps, 1e-6) + ", step: 1e-6}",
                                    end_after(steps, 0.5 / 0.9 * step) + ", step_scale: 0.5}"}) {
      const std::string said = fault_of_first_step(time);
      EXPECT_EQ(said.substr(0, 21), "a.yaml:9:7: 'end' is ") << time << ": " << said;
      EXPECT_NE(said.find(" steps of "), std::string::npos) << time << ": " << said;
    }
  EXPECT_EQ(fault_of_first_step(end_after(0.99 * 0x1p53, step) + "}"), "");
  EXPECT_EQ(fault_of_first_step(end_after(0.99 * 0x1p53, 1e-6) + ", step: 1e-6}"), "");
}

TEST(RefusedScene, WithMoreNodesThanCanBeNumberedIsRefusedBeforeAnythingIsMade) {
  std::string text =
      "materials: {m: {model: elastic, density: 1, youngs_modulus: 1, poissons_ratio: 0}}\nparts:\n";
  for (int i = 0; i < 20; ++i)
    text += "  p" + std::to_string(i) +
            ": {mesh: {box: {size: [1, 1, 1], elements: [500, 500, 500]}}, element: hex8, material: m}\n";
  text += "time: {end: 1}\n";
  try {
    build_scene(parse_deck(text, "a.yaml"));
    FAIL();
  } catch (const DeckError& fault) {
    EXPECT_EQ(std::string(fault.what()),
              "a.yaml:3:3: the scene has about 2.52e+09 nodes; at most 2147483647 can be numbered; a coarser "
              "mesh is "
              "accepted, here of part 'p0', the largest");
  }
}

}  // namespace
}  // namespace brio
