#include <gtest/gtest.h>

#include <filesystem>
#include <functional>
#include <sstream>

#include "io/deck/read_deck.hpp"
#include "tests/io/deck/deck_text.hpp"
#include "tests/io/text_of.hpp"

namespace brio {
namespace {

std::string line_and_column(const std::string& text, std::size_t at) {
  const auto before = text.substr(0, at);
  const auto line = std::count(before.begin(), before.end(), '\n');
  const std::size_t start = before.rfind('\n');
  const std::size_t column = start == std::string::npos ? at : at - start - 1;
  return std::to_string(line + 1) + ":" + std::to_string(column + 1);
}

/// A fault put into the plain deck: `from` is replaced by `to`, in which ^ marks the place of the fault.
struct Edit {
  const char* from;
  const char* to;
  const char* message;
};

class BadDeck : public testing::TestWithParam<Edit> {};

TEST_P(BadDeck, IsRefusedWithItsPlace) {
  const auto& [from, to, message] = GetParam();
  std::string text = plain_deck;
  const std::size_t at = text.find(from);
  ASSERT_NE(at, std::string::npos) << from;
  text.replace(at, std::string(from).size(), to);
  const std::size_t marker = text.find('^', at);
  ASSERT_NE(marker, std::string::npos) << to;
  text.erase(marker, 1);
  const std::string fault = fault_of([&] { parse_deck(text, "a.yaml"); });
  const std::string place = "a.yaml:" + line_and_column(text, marker) + ": ";
  EXPECT_EQ(fault.substr(0, place.size()), place) << fault;
  EXPECT_NE(fault.find(message), std::string::npos) << fault;
}

constexpr Edit edits[] = {
    // numbers
    {"7.34e-4", "^0", "'density' is '0'; expected a number > 0"},
    // springs
    {"loads:\n", "springs:\n  a: ^{from: {point: [0, 0, 0]}, to: {point: [1, 0, 0]}}\nloads:\n",
     "it has no force; accepted: stiffness, force, damping"},
    {"loads:\n",
     "springs: {a: ^{from: {point: [0, 0, 0]}, to: {point: [1, 0, 0]}, stiffness: 1, force: [[0, 0], [1, "
     "1]]}}"
     "\nloads:\n",
     "both 'stiffness' and 'force' are given"},
    {"loads:\n",
     "springs: {a: ^{from: {point: [0, 0, 0]}, to: {point: [1, 0, 0]}, force: [[0, 0], [0, 1]]}}\nloads:\n",
     "the elongations of 'force' do not grow"},
    {"loads:\n",
     "springs: {a: {from: {point: [0, 0, 0], part: ^lift}, to: {point: [1, 0, 0]}, stiffness: 1}}\nloads:\n",
     "no part is called 'lift'; did you mean 'left'?"},
    {"loads:\n",
     "springs: {a: {from: {point: [0, 0, 0]}, to: ^{point: [1, 0, 0], part: left, fixed: true}, stiffness: "
     "1}}\nloads:\n",
     "a fixed point belongs to no part"},
    {"loads:\n",
     "springs: {a: ^{from: {point: [0, 0, 0]}, to: {point: [1, 0, 0]}, axis: [0, 0, 1], force: [[0, 0], [1, "
     "1]]}}\nloads:\n",
     "'force' and 'length' of a torsional spring; accepted beside 'axis' are moment and angle"},
    {"loads:\n",
     "springs: {a: ^{from: {point: [0, 0, 0]}, to: {point: [1, 0, 0]}, moment: [[0, 0], [1, 1]]}}\nloads:\n",
     "an 'axis' is wanted beside them"},
    {"loads:\n",
     "springs: {a: ^{from: {point: [0, 0, 0]}, to: {point: [1, 0, 0]}, stiffness: 1, axis: [0, 0, "
     "0]}}\nloads:\n",
     "the axis has no direction"},
    {"loads:\n",
     "springs: {a: ^{from: {point: [0, 0, 0]}, to: {point: [1, 0, 0]}, axis: [0, 0, 1], moment: [[0, 0], [0, "
     "1]]}}\nloads:\n",
     "the angles of 'moment' do not grow"},
    {"loads:\n", "springs: {a: {from: {set: ^left.side}, to: {point: [1, 0, 0]}, stiffness: 1}}\nloads:\n",
     "part 'left' has no set 'side'"},
    {"loads:\n",
     "springs: {a: {from: ^{set: left, point: [0, 0, 0]}, to: {point: [1, 0, 0]}, stiffness: 1}}\nloads:\n",
     "an end of a spring is either a 'point' or a 'set'"},
    {"loads:\n",
     "springs: {a: ^{from: {set: left}, to: {point: [1, 0, 0]}, stiffness: 1, pairing: order}}\nloads:\n",
     "'pairing' is accepted where both ends are sets"},
    {"loads:\n", "springs: {a: {from: {set: left}, to: {set: right}, stiffness: 1, values: ^all}}\nloads:\n",
     "'values' is 'all'; accepted: each, total"},
    {"contact:", "connections: [{tie: [left, right], tolerance: 1, failure: ^{}}]\ncontact:",
     "no force is given; accepted: normal_force, shear_force"},
    {"7.34e-4", "^-0.0", "expected a number > 0"},
    {"7.34e-4", "^abc", "'density' is 'abc'; expected a number > 0"},
    {"7.34e-4", "^'-1'", "'density' is the text \"-1\" = -1; expected a number > 0"},
    {"7.34e-4", "^1e-999", "a number > 0 whose size is 0 or from"},
    {"7.34e-4", "1,^5", "unknown key '5'"},
    {"7.34e-4", "^1..5", "expected a number > 0"},
    {"7.34e-4", "^0x10", "expected a number > 0"},
    {"7.34e-4", "^1_000", "expected a number > 0"},
    {"7.34e-4", "^1 000", "expected a number > 0"},
    {"7.34e-4", "^++1", "expected a number > 0"},
    {"7.34e-4", "^+-1", "expected a number > 0"},
    {"7.34e-4", "^-", "'density' is '-'; expected a number > 0"},
    {"7.34e-4", "^e5", "expected a number > 0"},
    {"7.34e-4", "^1e", "expected a number > 0"},
    {"7.34e-4", "^NaN", "that is finite"},
    {"7.34e-4", "^+.INF", "that is finite"},
    {"7.34e-4", "^infinity", "that is finite"},
    {"7.34e-4", "^true", "expected a number > 0"},
    {"7.34e-4", "^{}", "'density' is a map; expected a number > 0"},
    {"density: 7.34e-4", "^density: ~", "'density' has no value"},
    {"density: 7.34e-4", "^density: null", "'density' has no value"},
    {"density: 7.34e-4, ", "^desity: 1, ", "unknown key 'desity'; did you mean 'density'?"},
    {"density: 7.34e-4, ", "^Density: 1, ", "unknown key 'Density'; did you mean 'density'?"},
    {"{model: elastic, density: 7.34e-4, ", "^{model: elastic, ", "'steel' has no 'density'; it is required"},
    {"poissons_ratio: 0.3", "poissons_ratio: ^0.5", "expected a number > -1 and < 0.5"},
    {"poissons_ratio: 0.3", "poissons_ratio: ^-1", "expected a number > -1 and < 0.5"},
    {"[2, 2, 4]", "[2, 2, ^0]", "expected an integer >= 1"},
    {"[2, 2, 4]", "[2, 2, ^4.5]", "expected an integer >= 1"},
    {"[2, 2, 4]", "[2, 2, ^3000000000]", "expected an integer >= 1 of at most 2147483647"},
    {"[2, 2, 4]", "^[2, 2, 4, 4]", "'elements' is a list; expected a list of 3 integers >= 1"},
    {"[2, 2, 4]", "^4", "'elements' is '4'; expected a list of 3 integers >= 1"},
    {"{size: [1, 1, 2], elements: [2, 2, 4]}", "^{size: [1, 1, 2], elements: [20000, 20000, 400]}",
     "too fine"},
    {"[2, 2, 4]", "[2, ^[2], 4]", "'elements' is a list; expected an integer >= 1"},
    // materials and parts
    {"{model: elastic, ", "^{", "'steel' has no 'model'; accepted: elastic"},
    {"model: elastic", "model: ^elastisch", "did you mean 'elastic'?"},
    {"model: elastic", "model: ^[elastic]", "'model' is a list; accepted: elastic"},
    {"  steel: {", "  ^st.eel: {", "'st.eel' cannot be a name in 'materials'"},
    {"  left:", "  ^le ft:", "accepted are letters, digits, _ and -"},
    {"material: steel", "material: ^stahl", "no material is called 'stahl'"},
    {"model: elastic, ", "model: elastic, ^failure: {strain: 1}, ", "unknown key 'failure'"},
    {"model: elastic, ", "model: elastic_plastic, yield_stress: 1, failure: ^{}, ",
     "accepted is one of strain, tearing_parameter, johnson_cook and hosford_coulomb"},
    {"model: elastic, ", "model: elastic_plastic, yield_stress: 1, failure: ^{strain: 1}, ",
     "accepted is one of opening_strain and opening_displacement"},
    {"model: elastic, ", "model: elastic_plastic, yield_stress: 1, failure: {strain: ^0}, ",
     "'strain' is '0'; expected a number > 0"},
    {"model: elastic, ",
     "model: elastic_plastic, yield_stress: 1, failure: ^{johnson_cook: {d1: 1, d2: 0, d3: 0}}, ",
     "or damage_growth: sudden"},
    {"model: elastic, ",
     "model: elastic_plastic, yield_stress: 1, failure: {damage_growth: sudden, johnson_cook: ^{d1: -1, d2: "
     "2, "
     "d3: -1}}, ",
     "least_strain is required"},
    {"model: elastic, ",
     "model: elastic_plastic, yield_stress: 1, failure: {damage_growth: sudden, hosford_coulomb: {a: ^2.1, "
     "b: 1, "
     "c: 0}}, ",
     "'a' is '2.1'; expected a number >= 1 and <= 2"},
    {"{model: elastic, ",
     "^{model: elastic_plastic, yield_stress: 1, failure: {damage_growth: sudden, johnson_cook: {d1: 1, d2: "
     "0, d3: 0, "
     "d4: 0.01}}, ",
     "accepted is 0, or the model johnson_cook"},
    {"{model: elastic, ",
     "^{model: johnson_cook, yield_stress: 1, hardening_constant: 0, hardening_exponent: 1, failure: "
     "{damage_growth: sudden, johnson_cook: {d1: 1, d2: 0, d3: 0, d5: 1}}, ",
     "known with 'thermal' only"},
    {"element: hex8", "element: hex8\n    deletion: {inverted: ^1}", "expected true or false"},
    {"element: hex8", "element: hex8\n    deletion: {volume_ratio: ^1}", "expected a number > 0 and < 1"},
    {"element: hex8", "element: hex8\n    deletion: {debris_radius: ^0}", "expected a number > 0"},
    {"element: hex8", "element: hex8\n    ^deletion: {debris_radius: 1, free_nodes: drop}",
     "it is accepted with free_nodes: keep"},
    {"element: hex8", "element: hex8\n    ^deletion: {plastic_strain: 1}",
     "the material model 'elastic' has none"},
    {"element: hex8", "element: ^hex88", "did you mean 'hex8'?"},
    {"element: {type: hex8}", "element: {type: hex8, ^thickness: 1}", "unknown key 'thickness'"},
    {"element: {type: hex8}", "element: ^{}", "'element' has no 'type'; accepted: hex8"},
    {"element: {type: hex8}", "element: ^[hex8]", "'element' is a list"},
    {"mesh: {box: {size: [1, 1, 2], elements: [2, 2, 4]}}", "mesh: ^box", "'mesh' is 'box'; expected a map"},
    {"mesh: {box: {size: [1, 1, 2], elements: [2, 2, 4]}}", "mesh: ^{}", "'mesh' is not said; accepted: box"},
    {"mesh: {box: {size: [1, 1, 2], elements: [2, 2, 4]}}", "mesh: {box: ^[1]}", "'box' is a list"},
    {"mesh: {box: {size: [1, 1, 2], elements: [2, 2, 4]}}", "mesh: {^bax: {}}", "did you mean 'box'?"},
    {"{box: {size: [1, 1, 2], elements: [2, 2, 4]}}", "{rod: ^{radius: 1, length: 2, elements: [5, 2]}}",
     "is odd; it must be even"},
    {"{box: {size: [1, 1, 2], elements: [2, 2, 4]}}",
     "{rod: {radius: 1, length: 2, elements: [4, 2], keep_volume: ^yes}}",
     "'keep_volume' is 'yes'; expected true or false"},
    {"{inner_radius: 1, outer_radius: 2,", "^{inner_radius: 2, outer_radius: 2,", "outer_radius must exceed"},
    {"{inner_radius: 1, outer_radius: 2, height: 3, elements: [12",
     "^{inner_radius: 1, outer_radius: 2, height: 3, elements: [2", "does not close"},
    {"{axis: [0, 1, 0]", "^{axis: [0, 0, 0]", "the axis has no direction"},
    {"rotate: {axis: [0, 1, 0], degrees: 90}", "rotate: ^90", "'rotate' is '90'; expected a map"},
    // beams
    {"{box: {size: [1, 1, 2], elements: [2, 2, 4]}}",
     "{line: ^{start: [0, 0, 1], end: [0, 0, 1], elements: 4}}", "the line has no length"},
    {"{box: {size: [1, 1, 2], elements: [2, 2, 4]}}\n    element: hex8",
     "{line: {start: [0, 0, 0], end: [0, 0, 1], elements: 4}}\n    element: ^hex8",
     "the mesh 'line' cannot be made of 'hex8' elements; accepted: beam2"},
    {"{box: {size: [1, 1, 2], elements: [2, 2, 4]}}\n    element: hex8",
     "{line: {start: [0, 0, 0], end: [0, 0, 1], elements: 4}}\n    element: ^rigid",
     "the mesh 'line' cannot be made of 'rigid' elements; accepted: beam2"},
    {"element: hex8", "element: ^{type: beam2}", "no 'section'; it is required"},
    {"element: hex8", "element: {type: beam2, section: ^round}", "'section' is 'round'; expected a map"},
    {"element: hex8", "element: {type: beam2, section: {^cirle: {radius: 1}}}", "did you mean 'circle'?"},
    {"element: hex8", "element: {type: beam2, section: {circle: ^{radius: 1, fibres: [2, 5]}}}",
     "an even number from 4 on"},
    {"element: hex8", "element: {type: beam2, section: {tube: ^{inner_radius: 1, outer_radius: 1}}}",
     "outer_radius must exceed inner_radius"},
    {"element: hex8", "element: ^{type: beam2, section: {rectangle: {width: 1, height: 1}}}",
     "needs an 'orientation'"},
    {"element: hex8", "element: ^{type: beam2, section: {circle: {radius: 1}}, orientation: [0, 0, 0]}",
     "the orientation has no direction"},
    {"element: hex8", "element: ^{type: beam2, section: {circle: {radius: 1}}}",
     "the mesh 'box' cannot be made of 'beam2' elements"},
    // particles
    {"{box: {size: [1, 1, 2], elements: [2, 2, 4]}}", "{particles: ^{}}", "accepted is one of box, cylinder"},
    {"{box: {size: [1, 1, 2], elements: [2, 2, 4]}}",
     "{particles: ^{box: {size: [1, 1, 2], spacing: 0.1}, sphere: {radius: 1, spacing: 0.1}}}",
     "accepted is one of box, cylinder and sphere"},
    {"{box: {size: [1, 1, 2], elements: [2, 2, 4]}}", "{particles: ^{box: {size: [1, 1, 2], spacing: 0.8}}}",
     "at least two are accepted"},
    {"{box: {size: [1, 1, 2], elements: [2, 2, 4]}}",
     "{particles: ^{cylinder: {radius: 1, inner_radius: 0.9, height: 1, spacing: 0.2}}}",
     "the wall is thinner than the spacing"},
    {"{box: {size: [1, 1, 2], elements: [2, 2, 4]}}",
     "{particles: {cylinder: ^{radius: 1, inner_radius: 1, height: 1, spacing: 0.2}}}",
     "radius must exceed inner_radius"},
    {"{box: {size: [1, 1, 2], elements: [2, 2, 4]}}", "{particles: ^{box: {size: [1, 1, 2], spacing: 1e-6}}}",
     "the mesh is too fine"},
    {"{box: {size: [1, 1, 2], elements: [2, 2, 4]}}", "{particles: {sphere: {radius: 1, spacing: ^0}}}",
     "number > 0"},
    {"{box: {size: [1, 1, 2], elements: [2, 2, 4]}}\n    element: hex8",
     "{particles: {sphere: {radius: 1, spacing: 0.2}}}\n    element: ^hex8",
     "the mesh 'particles' cannot be made of 'hex8' elements; accepted: particle"},
    {"element: hex8", "element: ^particle", "the mesh 'box' cannot be made of 'particle' elements"},
    {"element: hex8", "element: {type: particle, kernel: ^lagrangian}",
     "accepted: total_lagrangian, eulerian"},
    {"element: hex8", "element: {type: particle, smoothing_length: ^0.5}", "number >= 1 and <= 2"},
    {"element: hex8", "element: ^{type: particle, artificial_stress: 0.1}", "belong to kernel: eulerian"},
    {"element: hex8", "element: ^{type: particle, kernel: eulerian, hourglass_stiffness: 0.1}",
     "belongs to kernel: total_lagrangian"},
    {"element: hex8", "element: ^{type: particle, kernel: eulerian, smoothing_bounds: [1.2, 2]}",
     "smoothing_bounds leave out 1"},
    // conditions
    {"{part: left, velocity", "{^port: left, velocity", "did you mean 'part'?"},
    {"{part: left, velocity", "{part: ^lefd, velocity", "no part is called 'lefd'; did you mean 'left'?"},
    {"{part: left, velocity", "^{velocity", "names either 'part' or 'set'"},
    {"{part: left, velocity", "^{part: left, set: left.top, velocity", "names either 'part' or 'set'"},
    {"{part: left, velocity: [0, 0, -5000]}", "^{part: left}", "nothing is given at the start"},
    {"{part: left, velocity: [0, 0, -5000]}", "^left", "'initial_conditions' is 'left'; expected a map"},
    {"set: right.top", "set: ^right.tip", "part 'right' has no set 'tip'; did you mean 'top'?"},
    {"set: right.top", "set: ^right.", "part 'right' has no set ''"},
    {"set: right.top", "set: ^.top", "no part is called ''"},
    {"set: right.top", "set: ^[right.top]", "'set' is a list; expected part.set, or a region"},
    {"fix: [x, y, z]", "fix: [x, y, ^zz]", "'zz' is not a component of a motion; "},
    {"fix: [x, y, z]", "fix: [x, y, ^rz]", "the nodes of 'left' do not turn"},
    {"fix: [x, y, z]", "fix: [x, y, ^y]", "component 'y' is given twice"},
    {"fix: [x, y, z]", "fix: ^x", "'fix' is 'x'; expected a list of components"},
    {"fix: [x, y, z]", "fix: ^[]", "expected a list of components"},
    {"fix: [x, y, z]", "fix: [x], ^velocity: {y: 1}", "both 'fix' and 'velocity'"},
    {"{set: left.bottom, fix: [x, y, z]}", "^{set: left.bottom}", "nothing is prescribed"},
    {"{set: left.bottom, fix: [x, y, z]}", "^{fix: [x, y, z]}", "names either 'part' or 'set'"},
    {"{set: left.bottom, fix: [x, y, z]}", "{set: left.bottom, ^fixed: [x]}", "did you mean 'fix'?"},
    {"velocity: {z: [[0, 0], [1e-3, 5]]}", "velocity: {z: [[0, 0], ^[0, 5]]}", "each must be later"},
    {"velocity: {z: [[0, 0], [1e-3, 5]]}", "velocity: {z: [[0, 0], ^[1e-3]]}", "a list of 2 numbers"},
    {"velocity: {z: [[0, 0], [1e-3, 5]]}", "velocity: {z: ^[]}",
     "a number, an expression in quotes or a list of [time, value]"},
    {"velocity: {z: [[0, 0], [1e-3, 5]]}", "velocity: {z: ^{a: 1}}",
     "a number, an expression in quotes or a list of [time, value]"},
    {"velocity: {z: [[0, 0], [1e-3, 5]]}", "velocity: {w: ^1}", "'w' is not a component"},
    {"velocity: {z: [[0, 0], [1e-3, 5]]}", "velocity: ^{}", "a map of components"},
    {"velocity: {z: [[0, 0], [1e-3, 5]]}", "velocity: ^[0, 0, 1]", "a map of components"},
    {"normal: [0, 0, 1], tolerance: 1e-6}", "normal: [0, 0, 1], tolerance: ^-1}", "expected a number >= 0"},
    {"{plane: {point: [0, 0, 1], normal: [0, 0, 1], tolerance: 1e-6}, part: left}",
     "{box: ^{lower: [0, 0, 1], upper: [1, 1, 0]}}", "inside out"},
    {"tolerance: 1e-6}, part: left}", "tolerance: 1e-6}, part: ^lft}", "did you mean 'left'?"},
    {"{rigid_wall: {point: [0, 0, -3], normal: [0, 0, 1]}}",
     "{rigid_wall: ^{point: [0, 0, -3], normal: [0, 0, 0]}}", "the normal has no direction"},
    {"{rigid_wall: {point", "{^rigid_wal: {point", "unknown key 'rigid_wal'"},
    // coordinate systems
    {"fix: [x, y, z]}", "fix: [x, y, z], system: ^ramp}",
     "'ramp' is no coordinate system: the deck has no 'coordinate_systems'"},
    {"boundary_conditions:\n",
     "coordinate_systems: {ramp: {rectangular: {x: [1, 0, 1], y: [0, 1, 0]}}}\nboundary_conditions:\n"
     "  - {set: left.top, fix: [x], system: ^rmap}\n",
     "no coordinate system is called 'rmap'; did you mean 'ramp'?"},
    {"boundary_conditions:\n",
     "coordinate_systems: {ramp: {rectangular: ^{x: [1, 0, 1], y: [-2, 0, -2]}}}\nboundary_conditions:\n",
     "x and y are parallel; accepted are two different directions"},
    {"boundary_conditions:\n",
     "coordinate_systems: {ramp: {rectangular: ^{x: [1, 0, 1], y: [0, 0, 0]}}}\nboundary_conditions:\n",
     "x or y has no direction"},
    {"boundary_conditions:\n",
     "coordinate_systems: {ramp: {rectangular: ^{x: [1, 0, 1]}}}\nboundary_conditions:\n",
     "'rectangular' has no 'y'; it is required"},
    {"boundary_conditions:\n",
     "coordinate_systems: {axle: {cylindrical: ^{point: [0, 0, 0], axis: [0, 0, "
     "0]}}}\nboundary_conditions:\n",
     "the axis has no direction"},
    {"boundary_conditions:\n",
     "coordinate_systems: {axle: {^cylindric: {point: [0, 0, 0], axis: [0, 0, 1]}}}\nboundary_conditions:\n",
     "did you mean 'cylindrical'?"},
    {"boundary_conditions:\n",
     "coordinate_systems: {axle: {cylindrical: {point: [0, 0, 0], axis: [0, 0, 1]}}}\nboundary_conditions:\n"
     "  - {set: left.top, fix: [^x], system: axle}\n",
     "'x' is not a component of a motion in a cylindrical system; accepted: r, t, z, rr, rt, rz"},
    {"boundary_conditions:\n",
     "coordinate_systems: {ramp: {rectangular: {x: [1, 0, 1], y: [0, 1, 0]}}}\nboundary_conditions:\n"
     "  - {set: left.top, velocity: {t: ^1}, system: ramp}\n",
     "'t' is not a component of a motion; accepted: x, y, z, rx, ry, rz"},
    {"boundary_conditions:\n",
     "coordinate_systems: {axle: {cylindrical: {point: [0, 0, 0], axis: [0, 0, 1]}}}\nboundary_conditions:\n"
     "  - {set: left.top, fix: [^rt], system: axle}\n",
     "the nodes of 'left' do not turn"},
    {"boundary_conditions:\n",
     "boundary_conditions:\n  - {rigid_wall: {point: [0, 0, -9], normal: [0, 0, 1]}, ^system: ramp}\n",
     "unknown key 'system'"},
    {"{set: left.top, force: [1, 2, 3]}", "{set: left.top, force: [1, 2, 3], system: ^ramp}",
     "'ramp' is no coordinate system"},
    {"loads:\n",
     "coordinate_systems: {axle: {cylindrical: {point: [0, 0, 0], axis: [0, 0, 1]}}}\nloads:\n"
     "  - {gravity: [0, 0, 1], system: ^axle}\n",
     "'axle' is a cylindrical system, and gravity is the same everywhere"},
    {"{side_set: right.inside, pressure: 100}", "{side_set: right.inside, pressure: 100, ^system: ramp}",
     "unknown key 'system'"},
    // loads, contact
    {"{gravity: [0, 0, -9.81]", "{gravity: ^[0, -9.81]", "a list of 3 numbers"},
    {"{gravity: [0, 0, -9.81], factor", "^{gravitation: [0, 0, -9.81], factor",
     "nothing is said about the load"},
    {"{set: left.top, force: [1, 2, 3]}", "^{force: [1, 2, 3]}", "'loads' has no 'set'; it is required"},
    {"side_set: right.inside", "side_set: ^right.insid", "did you mean 'inside'?"},
    {"side_set: right.inside, pressure", "side_set: right.inside, ^set: right.top, pressure",
     "unknown key 'set'"},
    {"contact: {surfaces: all,", "contact: {surfaces: ^al,", "'surfaces' is 'al'"},
    {"contact: {surfaces: all,", "contact: {surfaces: [left, ^rihgt],", "did you mean 'right'?"},
    {"contact: {surfaces: all, ", "contact: ^{", "'contact' has no 'surfaces'"},
    {"contact: {surfaces: all,", "contact: {pairs: [{friction: 1, parts: ^[left]}], surfaces: all,",
     "'parts' of a pair names 1; two are accepted"},
    {"time: {end", "connections: [{merge: [left, ^wright], tolerance: 1}]\ntime: {end",
     "no part is called 'wright'"},
    {"time: {end", "connections: [{merge: ^[left], tolerance: 1}]\ntime: {end",
     "'merge' takes two different parts"},
    {"time: {end", "connections: [{merge: ^[left, left], tolerance: 1}]\ntime: {end",
     "'merge' takes two different parts"},
    {"time: {end", "connections: [{merge: [left, right], tolerance: ^0}]\ntime: {end",
     "'tolerance' is '0'; expected a number > 0"},
    {"time: {end", "connections: [^{merge: [left, right]}]\ntime: {end",
     "has no 'tolerance'; it is required"},
    {"time: {end", "connections: [^{tolerance: 1}]\ntime: {end",
     "nothing is said about the connection; accepted: merge, tie"},
    {"time: {end", "connections: [^{weld: [left, right]}]\ntime: {end",
     "nothing is said about the connection; accepted: merge, tie"},
    {"time: {end", "connections: [{merge: [left, right], ^weld: 1, tolerance: 1}]\ntime: {end",
     "unknown key 'weld'"},
    {"time: {end", "connections: [{tie: [left, ^wright], tolerance: 1}]\ntime: {end",
     "no part is called 'wright'"},
    {"time: {end", "connections: [{tie: [^left.zmni, right], tolerance: 1}]\ntime: {end",
     "part 'left' has no set 'zmni'; did you mean 'zmin'?"},
    {"time: {end", "connections: [{tie: ^[left], tolerance: 1}]\ntime: {end",
     "'tie' takes a part or a set, and the part whose faces its nodes are tied to"},
    {"time: {end", "connections: [{tie: ^[left.zmin, left], tolerance: 1}]\ntime: {end",
     "'tie' takes two different parts"},
    {"time: {end", "connections: [^{tie: [left, right]}]\ntime: {end", "has no 'tolerance'; it is required"},
    {"element: {type: hex8}\n    material: steel\n",
     "element: rigid\n    material: steel\nconnections: [{tie: [^right, left], tolerance: 1}]\n",
     "part 'right' is rigid; nodes of parts that deform can be tied to it"},
    {"element: {type: hex8}\n    material: steel\n",
     "element: rigid\n    material: steel\nconnections: [{tie: [left, right], tolerance: 1, ^failure: "
     "{normal_force: 1}}]\n",
     "'failure' of a tie to a rigid part"},
    {"contact: {surfaces: all,", "contact: {pairs: [^{friction: 1}], surfaces: all,", "has no 'parts'"},
    {"contact: {surfaces: all,", "contact: {pairs: [^{parts: [left, right]}], surfaces: all,",
     "nothing is said of the pair"},
    {"contact: {surfaces: all,",
     "contact: {pairs: [^{parts: [left, right], touch: false, friction: 1}], surfaces: all,",
     "friction of parts that never touch"},
    {"exclude: [left]", "exclude: ^left", "'exclude' is 'left'; expected a list of parts"},
    {"friction: 0.1", "^frictoin: 0.1", "did you mean 'friction'?"},
    {"friction: 0.1", "friction: ^-0.1", "expected a number >= 0"},
    // time and output
    {"end: 3e-3", "end: ^0", "expected a number > 0"},
    {"{end: 3e-3, ", "^{", "'time' has no 'end'"},
    {"step_scale: 0.9", "step_scale: ^1.01", "expected a number > 0 and <= 1"},
    {"{every: 5e-5}", "{every: ^0}", "expected a number > 0"},
    {"{every: 5e-5}", "{every: ^-5e-5}", "expected a number > 0"},
    {"{every: 5e-5}", "^{every: 5e-5, times: [1e-3]}", "both 'every' and 'times' are given"},
    {"{every: 5e-5}", "{times: [^-1]}", "expected a number >= 0"},
    {"title: Two boxes", "title: ^[a]", "'title' is a list; expected a text"},
    {"title: Two boxes", "^titel: Two boxes", "did you mean 'title'?"},
    {"title: Two boxes", "numerics: {precision: ^half}", "'precision' is 'half'; accepted: double, float"},
    {"title: Two boxes", "numerics: {precision: ^[double]}",
     "'precision' is a list; expected one word of double, float"},
    {"title: Two boxes", "title: a\n^title: b", "duplicate key 'title'"},
};

TEST(BadDeckOfParticles, SinglePrecisionIsRefusedWhereItIsAskedFor) {
  const std::string text =
      "materials: {m: {model: elastic, density: 1, youngs_modulus: 1, poissons_ratio: 0}}\n"
      "parts: {p: {mesh: {particles: {sphere: {radius: 1, spacing: 0.2}}}, element: particle, material: m}}\n"
      "time: {end: 1}\n"
      "numerics:\n  precision: ";
  EXPECT_EQ(fault_of([&] { parse_deck(text + "double\n", "a.yaml"); }), "");
  const std::string fault = fault_of([&] { parse_deck(text + "float\n", "a.yaml"); });
  EXPECT_NE(fault.find("a.yaml:5:14"), std::string::npos) << fault;
  EXPECT_NE(fault.find("computed in double only"), std::string::npos) << fault;
}

/// The plain deck with a line of beams for its left part.
std::string deck_with_beams(const std::string& from = {}, const std::string& to = {}) {
  std::string text = plain_deck;
  const auto replace = [&](const std::string& what, const std::string& by) {
    const std::size_t at = text.find(what);
    EXPECT_NE(at, std::string::npos) << what;
    text.replace(at, what.size(), by);
  };
  replace("{box: {size: [1, 1, 2], elements: [2, 2, 4]}}\n    element: hex8",
          "{line: {start: [0, 0, -1], end: [0, 0, 1], elements: 4}}\n"
          "    element: {type: beam2, section: {circle: {radius: 0.1}}}");
  replace("left.bottom", "left.start");
  replace("left.top", "left.end");
  if (!from.empty()) replace(from, to);
  return text;
}

TEST(BadDeckOfBeams, BeamsHaveNoSides) {
  const auto fault = [](const std::string& from, const std::string& to) {
    return fault_of([&] { parse_deck(deck_with_beams(from, to), "a.yaml"); });
  };
  EXPECT_EQ(fault("", ""), "");
  EXPECT_NE(fault("side_set: right.inside", "side_set: left.all").find("has no sides"), std::string::npos);
  EXPECT_NE(fault("{type: beam2,", "{type: beam2, formulation: rope,").find("accepted: beam, truss, cable"),
            std::string::npos);
  EXPECT_NE(
      fault("radius: 0.1}}}\n", "radius: 0.1}}}\n    deletion: {volume_ratio: 0.1}\n").find("hexahedra"),
      std::string::npos);
}

INSTANTIATE_TEST_SUITE_P(Edited, BadDeck, testing::ValuesIn(edits));

TEST(BadDeckFile, SaysWhatItsFirstLineExpects) {
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(BRIO_SOURCE_DIR "/tests/io/bad_decks")) {
    const std::string path = entry.path().string();
    const std::string fault = fault_of([&] { read_deck(path); });
    const std::string text = test::text_of(path);
    const std::string mark = "# expect ";
    std::string expected = ":1:1: not a text file; a deck is YAML in UTF-8";
    if (text.empty()) expected = ":1:1: the deck is empty; materials, parts and time are required";
    if (path.ends_with("not_utf8.yaml")) expected = ":1:11: not a text file";
    if (text.starts_with(mark)) expected = ":" + text.substr(mark.size(), text.find('\n') - mark.size());
    EXPECT_EQ(fault.substr(0, path.size() + expected.size()), path + expected);
    ++count;
  }
  EXPECT_GT(count, 30);
}

TEST(BadDeckFile, MustHaveAPart) {
  std::string text = plain_deck;
  const std::size_t begin = text.find("  left:"), end = text.find("initial_conditions:");
  text.replace(begin - 1, end - begin, " {}");
  text.resize(text.find("initial_conditions:"));
  text += "time: {end: 1}\n";
  EXPECT_EQ(fault_of([&] { parse_deck(text, "a.yaml"); }).substr(0, 38),
            "a.yaml:4:8: 'parts' is empty; at least");
}

std::string edited(std::string text, const std::vector<std::pair<std::string, std::string>>& changes) {
  for (const auto& [from, to] : changes) {
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    text.replace(at, from.size(), to);
  }
  return text;
}

std::vector<std::string> lines_of(const std::string& text) {
  std::istringstream in(text);
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

void expect_faults(const std::string& text, const std::vector<std::string>& begins) {
  const std::string fault = fault_of([&] { parse_deck(text, "a.yaml"); });
  const std::vector<std::string> lines = lines_of(fault);
  ASSERT_EQ(lines.size(), begins.size()) << fault;
  for (std::size_t i = 0; i < lines.size(); ++i)
    EXPECT_TRUE(lines[i].starts_with(begins[i])) << lines[i] << " in place of " << begins[i];
}

// Once each, and not what follows from them: the second part has the faulty material, conditions name it.
TEST(ManyFaults, AreToldAtOnceInTheOrderOfTheirPlaces) {
  expect_faults(
      edited(plain_deck, {{"end: 3e-3, step_scale: 0.9", "end: 0, step_scale: 2"},
                          {"density: 7.34e-4, youngs_modulus: 30e6", "density: -1, youngs_modulus: x"},
                          {"material: steel", "material: steal"},
                          {"gravity: [0, 0, -9.81]", "gravity: [0, 0]"},
                          {"fix: [x, y, z]", "fix: [x, y, w]"}}),
      {"a.yaml:3:36: 'density' is '-1'", "a.yaml:3:56: 'youngs_modulus' is 'x'",
       "a.yaml:8:15: no material is called 'steal'", "a.yaml:22:15: 'gravity' is a list",
       "a.yaml:26:13: 'end' is '0'", "a.yaml:26:28: 'step_scale' is '2'"});
}

// A key that is missing is likely the unknown one.
TEST(ManyFaults, AMisspeltKeyIsOneFault) {
  expect_faults(edited(plain_deck, {{"density: 7.34e-4", "desity: 7.34e-4"}, {"end: 3e-3", "ende: 3e-3"}}),
                {"a.yaml:3:27: unknown key 'desity'", "a.yaml:26:8: unknown key 'ende'"});
}

TEST(ManyFaults, AFaultyParameterIsToldOnce) {
  expect_faults("parameters: {v: 3, w: x}\n" +
                    edited(plain_deck, {{"velocity: [0, 0, -5000]", "velocity: [0, 0, 'w * v']"},
                                        {"pressure: 100", "pressure: 'w'"}}),
                {"a.yaml:1:23: 'w' is 'x'"});
}

TEST(ManyFaults, NoMoreThanTwentyAreTold) {
  std::string parameters = "parameters: {";
  for (int i = 0; i < 25; ++i) parameters += "p" + std::to_string(i) + ": x, ";
  const std::string fault = fault_of([&] { parse_deck(parameters + "}\n" + plain_deck, "a.yaml"); });
  const std::vector<std::string> lines = lines_of(fault);
  ASSERT_EQ(lines.size(), 21u);
  EXPECT_EQ(lines.back(), "and 5 more faults");
}

TEST(BadDeckFile, MustBeAReadableFile) {
  EXPECT_EQ(fault_of([] { read_deck("no such deck.yaml"); }),
            "no such deck.yaml: cannot be opened: No such file or directory");
  EXPECT_EQ(fault_of([] { read_deck(BRIO_SOURCE_DIR); }),
            BRIO_SOURCE_DIR ": is a folder; a deck is a YAML file");
}

}  // namespace
}  // namespace brio
