// States of earlier results by the numbers of mesh files, and what is refused.

#include "tests/io/run/initial_state.hpp"

namespace brio::test {
namespace {

// ---- numbers of mesh files

constexpr const char* nodes_of_pair = R"(*NODE
11, 0, 0, 0
12, 1, 0, 0
13, 2, 0, 0
21, 0, 1, 0
22, 1, 1, 0
23, 2, 1, 0
)";
std::string pair_mesh(const std::string& elements) {
  return nodes_of_pair + std::string("*ELEMENT, TYPE=S4R, ELSET=pair\n") + elements;
}
const std::string pair_deck = steel + R"(
parts: {pair: {mesh: {file: MESH}, element: {type: shell4, thickness: 0.01}, material: steel}}
initial_conditions: [INITIAL]
boundary_conditions: [{set: {box: {lower: [-0.1, -1, -1], upper: [0.1, 2, 1]}}, fix: [x, y, z, rx, ry, rz]}]
time: {end: 1e-4}
output: {fields: {times: [1e-4], variables: [default, state]}}
)";
std::string pair(const std::string& mesh, const std::string& initial) {
  return with(with(pair_deck, "MESH", mesh), "INITIAL", initial);
}
const std::string from_before =
    "{part: pair, from: {result: before.vtkhdf, fields: [positions, state, velocity]}}";

TEST_F(InitialState, IsFoundByNumbersInAnyOrder) {
  write("a.inp", pair_mesh("5, 11, 12, 22, 21\n7, 12, 13, 23, 22\n"));
  write("b.inp", pair_mesh("7, 12, 13, 23, 22\n5, 11, 12, 22, 21\n"));
  run("before",
      pair("a.inp", "{set: {box: {lower: [1.5, -1, -1], upper: [3, 2, 1]}}, velocity: [0, 0, 20]}"));
  run("same", pair("a.inp", from_before));
  run("other", pair("b.inp", from_before));
  const std::vector<double> id = field("other", "element_id").values;
  ASSERT_EQ(id, (std::vector<double>{7, 5}));
  const ReadField same = field("same", "state"), other = field("other", "state");
  ASSERT_EQ(same.components, other.components);
  const double most = largest(same.values);
  for (std::size_t c = 0; c < same.components; ++c) {
    EXPECT_NEAR(same.values[c], other.values[same.components + c], 1e-12 * most);
    EXPECT_NEAR(same.values[same.components + c], other.values[c], 1e-12 * most);
  }
  EXPECT_GT(most, 1e7);
  // A part of it: the sheet was trimmed.
  write("trimmed.inp", pair_mesh("5, 11, 12, 22, 21\n"));
  const Model trimmed = build("trimmed", pair("trimmed.inp", from_before));
  EXPECT_EQ(trimmed.blocks[0].element_count, 1u);
}

TEST_F(InitialState, IsRefusedAtItsPlaceWhereTheResultDoesNotHaveIt) {
  write("a.inp", pair_mesh("5, 11, 12, 22, 21\n7, 12, 13, 23, 22\n"));
  run("before", pair("a.inp", "{part: pair, velocity: [0, 0, 1]}"));
  const std::string good = pair("a.inp", from_before);
  EXPECT_EQ(fault_of(good), "no fault");
  const auto expect = [&](const std::string& text, const std::string& message) {
    const std::string said = fault_of(text);
    EXPECT_EQ(said.substr(0, 8), "new.yaml") << said;
    EXPECT_NE(said.find(message), std::string::npos) << said;
  };
  write("missing.inp", pair_mesh("5, 11, 12, 22, 21\n8, 12, 13, 23, 22\n"));
  expect(with(good, "a.inp", "missing.inp"),
         "new.yaml:7:41: element 8 of part 'pair' is not among the 2 of 'pair' in before.vtkhdf at time "
         "0.0001: it "
         "was deleted, or is of another mesh; accepted are parts whose elements are all there");
  write("turned.inp", pair_mesh("5, 12, 22, 21, 11\n7, 12, 13, 23, 22\n"));
  expect(with(good, "a.inp", "turned.inp"), "element 5 of part 'pair' has other nodes in before.vtkhdf");
  std::string renumbered = pair_mesh("5, 11, 12, 22, 21\n7, 12, 33, 23, 22\n");
  write("renumbered.inp", with(renumbered, "13, 2, 0, 0", "33, 2, 0, 0"));
  expect(with(good, "a.inp", "renumbered.inp"), "element 7 of part 'pair' has other nodes");
  expect(with(good, "before.vtkhdf,", "none.vtkhdf,"), "new.yaml:7:41: none.vtkhdf: there is no such file");
  expect(with(good, "before.vtkhdf,", "before.vtkhdf, time: 3e-5,"),
         "before.vtkhdf: has no dump at time 3e-05; the nearest is at");
  expect(with(good, "before.vtkhdf,", "before.vtkhdf, part: sheet,"), "has no part 'sheet'; accepted: pair");
  expect(with(good, "thickness: 0.01", "thickness: 0.02"), "element.thickness is '0.02', and was '0.01'");
  expect(with(good, "thickness: 0.01", "thickness: 0.01, thickness_points: 3"),
         "the state of part 'pair' is of other");
  expect(with(good, "hardening_modulus: 1e9", "hardening_modulus: 1e9, hardening_mix: 1"),
         "numbers an element");
  const std::string plastic = ", yield_stress: 2e8,\n          hardening_modulus: 1e9";
  expect(with(with(good, plastic, ""), "elastic_plastic", "elastic"),
         "is of material model 'elastic', and of 'elastic_plastic' in the result");
  expect(
      with(good, "[positions, state, velocity]", "[positions, stress]"),
      "has more than one integration point or other axes, which stress and plastic strain of a result do not "
      "tell; accepted is 'state'");
  expect(
      with(good, "{file: a.inp}", "{file: a.inp}, placement: {translate: [1, 0, 0]}"),
      "part 'pair' does not lie where it lay: placement is '{translate: [1, 0, 0]}', and was nothing in the "
      "result; accepted are the same mesh and placement");
  expect(with(good, "{file: a.inp}", "{file: a.inp, scale: 2}"), "scale is '2', and was nothing");
  expect(with(good, "[positions, state, velocity]", "[state]"), "'positions' is wanted beside it");
  expect(with(good, "[positions, state, velocity]", "[]"), "'fields' is empty");
  expect(with(good, "[positions, state, velocity]", "[place]"),
         "accepted: positions, velocity, state, stress");
  expect(with(good, from_before, from_before + ", " + from_before), "begins with two states");
  expect(with(good, "{part: pair, from", "{set: pair.all, from"),
         "'from' of a set of nodes; accepted is a part");
  expect(with(good, "{part: pair, from", "{part: pair, velocity: [1, 0, 0], from"), "an entry of its own");
}

TEST_F(InitialState, OfAnotherElementOrWithoutStateIsRefused) {
  run("pressing", with(with(pressing, "ELEMENT", "hex8"), ", variables: [default, state]", ""));
  std::string said = fault_of(with(held, "ELEMENT", "hex8"));
  EXPECT_NE(said.find("pressing.vtkhdf holds no 'state'; accepted is a result written with "
                      "output.fields.variables: [default, state]"),
            std::string::npos)
      << said;
  said = fault_of(with(held, "ELEMENT", "hex8_full"));
  EXPECT_NE(said.find("part 'block' is of elements 'hex8_full', and 'block' is of 'hex8' in the result"),
            std::string::npos)
      << said;
  const std::string by_stress =
      with(with(held, "ELEMENT", "hex8"), "[positions, state]", "[positions, stress]");
  said = fault_of(with(by_stress, "hardening_modulus: 1e9", "hardening_modulus: 1e9, hardening_mix: 0.5"));
  EXPECT_NE(said.find("has a material that remembers more than plastic strain"), std::string::npos) << said;
}

TEST_F(InitialState, OfADamagedFileIsRefused) {
  run("pressing", with(pressing, "ELEMENT", "hex8"));
  const fs::path file = folder / "pressing.vtkhdf";
  std::string bytes;
  {
    std::ifstream in(file, std::ios::binary);
    bytes.assign(std::istreambuf_iterator<char>(in), {});
  }
  const auto write_bytes = [&](const std::string& text) { std::ofstream(file, std::ios::binary) << text; };
  int refused = 0;
  for (std::size_t part = 1; part <= 15; ++part) {
    std::string damaged = bytes;
    const std::size_t at = part * bytes.size() / 16;
    for (std::size_t i = 0; i < 64; ++i) damaged[at + i] = static_cast<char>(damaged[at + i] ^ 0x5a);
    write_bytes(damaged);
    const std::string said = fault_of(with(held, "ELEMENT", "hex8"));
    if (said == "no fault") continue;  // unused bytes of tables
    ++refused;
    EXPECT_EQ(said.rfind("new.yaml:15:25: pressing.vtkhdf: ", 0), 0u) << said;
  }
  EXPECT_GE(refused, 4);
  write_bytes(bytes.substr(0, bytes.size() / 2));
  EXPECT_EQ(fault_of(with(held, "ELEMENT", "hex8")).rfind("new.yaml:15:25: pressing.vtkhdf: ", 0), 0u);
  write_bytes("no result");
  EXPECT_EQ(fault_of(with(held, "ELEMENT", "hex8")).rfind("new.yaml:15:25: pressing.vtkhdf: ", 0), 0u);
}

}  // namespace
}  // namespace brio::test
