// Fields of cells that a deck chooses.

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <map>
#include <numbers>

#include "src/fields/cell_variables.hpp"
#include "src/output/observe.hpp"
#include "tests/core/scene.hpp"

namespace brio {
namespace {

using namespace test;

double derived(const std::string& name, const SymmetricTensor<double>& stress) {
  ElementSample sample;
  sample.stress = stress;
  double value = 0;
  cell_variable(name).values(sample, &value);
  return value;
}

TEST(CellVariables, OfUniaxialShearAndBiaxialStress) {
  const SymmetricTensor<double> uniaxial{0, 300, 0, 0, 0, 0}, shear{0, 0, 0, 0, 50, 0},
      biaxial{70, 70, 0, 0, 0, 0}, hydrostatic{-9, -9, -9, 0, 0, 0};
  EXPECT_DOUBLE_EQ(derived("von_mises", uniaxial), 300);
  EXPECT_DOUBLE_EQ(derived("pressure", uniaxial), -100);
  EXPECT_DOUBLE_EQ(derived("triaxiality", uniaxial), 1.0 / 3);
  EXPECT_DOUBLE_EQ(derived("von_mises", shear), 50 * std::sqrt(3.0));
  EXPECT_EQ(derived("triaxiality", shear), 0);
  EXPECT_DOUBLE_EQ(derived("von_mises", biaxial), 70);
  EXPECT_DOUBLE_EQ(derived("triaxiality", biaxial), 2.0 / 3);
  EXPECT_DOUBLE_EQ(derived("pressure", hydrostatic), 9);
  EXPECT_EQ(derived("triaxiality", {0, 0, 0, 0, 0, 0}), 0);
}

std::vector<std::string> names_of(const Snapshot& snapshot) {
  std::vector<std::string> names;
  for (const FieldArray& field : snapshot.cell_fields) names.push_back(field.name);
  return names;
}

TEST(CellVariables, OnlyWhatIsNamedIsWritten) {
  Deck deck;
  deck.materials = {{"material", elastic(0.3)}};
  deck.parts = {box("bar", {1, 1, 1}, {1, 1, 1}, {0, 0, 0}, hex8())};
  deck.initial_conditions = {moving("bar", {0, 0, 1})};
  deck.time.end = 1e-3;
  Model model = build_model(deck);
  ThreadTeam team(1);
  make_steps(model, 3, 1, team);
  const std::vector<std::string> one{"pressure"}, more{"default", "von_mises"};
  EXPECT_EQ(names_of(FieldObserver(model, one).observe(model)),
            (std::vector<std::string>{"part", "element_id", "pressure"}));
  EXPECT_EQ(
      names_of(FieldObserver(model, more).observe(model)),
      (std::vector<std::string>{"stress", "equivalent_plastic_strain", "part", "element_id", "von_mises"}));
  EXPECT_EQ(names_of(FieldObserver(model).observe(model)),
            (std::vector<std::string>{"stress", "equivalent_plastic_strain", "part", "element_id"}));
}

TEST(CellVariables, AllStandsForTheDefaultWhatFollowsFromItAndHistories) {
  const std::vector<std::string> wanted{"pressure", "all"};
  const std::vector<std::string_view> histories{"temperature"};
  const auto of_solids = [](const CellVariable& variable) { return variable.of == nullptr; };
  EXPECT_EQ(named_variables(wanted, histories, of_solids),
            (std::vector<std::string>{"pressure", "default", "von_mises", "triaxiality", "internal_energy",
                                      "internal_energy_density", "strain", "strain_rate", "temperature"}));
  const auto of_any = [](const CellVariable&) { return true; };
  EXPECT_EQ(named_variables(wanted, histories, of_any).size(), 2 + chosen_variables().size());
}

/// Values of a cell after one step from rest, with the spins given by place.
std::vector<double> after_a_step(const Deck& deck, const std::string& name, std::size_t cell,
                                 const std::function<Vector3d(const double*)>& spin,
                                 const std::function<Vector3d(const double*)>& velocity, double& step) {
  Model model = build_model(deck);
  for (std::size_t i = 0; i < model.nodes.size(); ++i) {
    NodeRecord& node = model.nodes.record[i];
    const Vector3d w = spin(node.position), v = velocity(node.position);
    std::copy_n(w.begin(), 3, model.nodes.angular_velocity[i].component);
    std::copy_n(v.begin(), 3, node.velocity);
  }
  ThreadTeam team(1);
  make_steps(model, 1, 1e9, team);
  step = model.times.previous;
  const std::vector<std::string> wanted{name};
  FieldObserver observer(model, wanted);
  const FieldArray& field = observer.observe(model).cell_fields.back();
  EXPECT_EQ(field.name, name);
  EXPECT_TRUE(field.is_partial);
  const auto first = field.values.begin() + static_cast<std::ptrdiff_t>(cell) * field.components;
  return {first, first + field.components};
}

constexpr double young = 1e9, thickness = 0.1, curving = 1e-3;

Vector3d at_rest(const double*) { return {0, 0, 0}; }
/// Of a part that is bent about y, with a rate of curvature: fibres above are stretched along x.
Vector3d bending(const double* x) { return {0, curving * x[0], 0}; }

Deck shell_deck(int points, const Material& material = elastic(0.3)) {
  Deck deck;
  deck.materials = {{"material", material}};
  Shell4 shell;
  shell.thickness = thickness;
  shell.thickness_points = points;
  shell.linear_bulk_viscosity = 0;  // it would act before the first step
  PlateMesh mesh;
  mesh.size = {1, 1};
  mesh.elements = {1, 1};
  deck.parts = {{"plate", mesh, {}, shell, "material"}};
  deck.time.end = 1;
  return deck;
}

// sigma = E / (1 - nu^2) z kappa: at the outermost of five Gauss points z = 0.9061798 h / 2.
TEST(CellVariables, OfABentShellAreThoseOfAPlate) {
  const double stretch = young / (1 - 0.09);
  double step = 0;
  for (const auto& [name, sign] : {std::pair{"stress_top", 1.0}, std::pair{"stress_bottom", -1.0}}) {
    const auto stress = after_a_step(shell_deck(5), name, 0, bending, at_rest, step);
    const double expected = sign * stretch * 0.906179845938664 * thickness / 2 * curving * step;
    EXPECT_NEAR(stress[0], expected, 1e-6 * std::abs(expected)) << name;
    EXPECT_NEAR(stress[1], 0.3 * expected, 1e-6 * std::abs(expected)) << name;
    EXPECT_NEAR(stress[2], 0, 1e-6 * std::abs(expected)) << name;
  }
  const auto moment = after_a_step(shell_deck(5), "bending_moment", 0, bending, at_rest, step);
  const double expected = stretch * std::pow(thickness, 3) / 12 * curving * step;
  EXPECT_NEAR(moment[0], expected, 1e-6 * expected);
  EXPECT_NEAR(moment[1], 0.3 * expected, 1e-6 * expected);
  const auto pull = [](const double* x) { return Vector3d{curving * x[0], 0, 0}; };
  const auto force = after_a_step(shell_deck(5), "membrane_force", 0, at_rest, pull, step);
  EXPECT_NEAR(force[0], stretch * thickness * curving * step, 1e-5 * force[0]);
  EXPECT_NEAR(force[1], 0.3 * force[0], 1e-6 * force[0]);
}

// Of odd rules there is a point in the middle, which bending does not strain.
TEST(CellVariables, OfTheMiddleOfAShellAreThoseOfItsMembrane) {
  const auto pull = [](const double* x) { return Vector3d{curving * x[0], 0, 0}; };
  double step = 0;
  const auto middle = after_a_step(shell_deck(5), "stress_middle", 0, bending, pull, step);
  const double expected = young / (1 - 0.09) * curving * step;
  EXPECT_NEAR(middle[0], expected, 1e-5 * expected);
  EXPECT_NEAR(middle[1], 0.3 * middle[0], 1e-6 * expected);
  for (const char* name : {"stress_middle", "equivalent_plastic_strain_middle"})
    for (const double value : after_a_step(shell_deck(4), name, 0, bending, pull, step))
      EXPECT_TRUE(std::isnan(value)) << name;
}

TEST(CellVariables, PlasticStrainOfAShellIsToldBySide) {
  PowerLawHardening law;
  law.density = 1000;
  law.youngs_modulus = young;
  law.poissons_ratio = 0.3;
  law.yield_stress = 1;
  law.hardening_constant = 1e8;
  law.hardening_exponent = 1;
  // Stretched as much as bent: the middle of the bottom half is at rest.
  const auto pull = [](const double* x) { return Vector3d{0.5 * thickness * curving * x[0], 0, 0}; };
  double step = 0;
  const auto top = after_a_step(shell_deck(5, law), "equivalent_plastic_strain_top", 0, bending, pull, step);
  const auto bottom =
      after_a_step(shell_deck(5, law), "equivalent_plastic_strain_bottom", 0, bending, pull, step);
  const auto middle =
      after_a_step(shell_deck(5, law), "equivalent_plastic_strain_middle", 0, bending, pull, step);
  EXPECT_GT(top[0], 0.5 * thickness * curving * step);
  EXPECT_LT(middle[0], 0.6 * top[0]);
  EXPECT_GT(middle[0], 2 * bottom[0]);
  EXPECT_LT(bottom[0], 0.1 * top[0]);
}

Deck beam_deck() {
  Deck deck;
  deck.materials = {{"material", elastic(0.3)}};
  Beam2 beam;
  beam.section = RectangleSection{0.02, 0.05};
  beam.orientation = Vector3d{0, 0, 1};
  LineMesh mesh;
  mesh.start = {-0.5, 0, 0};
  mesh.end = {0.5, 0, 0};
  mesh.elements = 1;
  deck.parts = {{"beam", mesh, {}, beam, "material"}};
  deck.time.end = 1;
  return deck;
}

TEST(CellVariables, OfABeamAreThoseOfItsSection) {
  double step = 0;
  const auto pull = [](const double* x) { return Vector3d{curving * x[0], 0, 0}; };
  const auto force = after_a_step(beam_deck(), "beam_force", 0, at_rest, pull, step);
  EXPECT_NEAR(force[0], young * 0.02 * 0.05 * curving * step, 1e-4 * force[0]);
  EXPECT_NEAR(force[1], 0, 1e-9 * force[0]);
  const auto turn = [](const double* x) { return Vector3d{curving * x[0], curving * x[0], 0}; };
  const auto moment = after_a_step(beam_deck(), "beam_moment", 0, turn, at_rest, step);
  // Timoshenko & Goodier, torsion of a rectangle: J = a b^3 (1/3 - 0.21 b/a (1 - (b/a)^4 / 12)).
  const double second_moment = 0.02 * std::pow(0.05, 3) / 12;
  const double torsion = 0.05 * std::pow(0.02, 3) * (1.0 / 3 - 0.21 * 0.4 * (1 - std::pow(0.4, 4) / 12));
  EXPECT_NEAR(moment[0], young / 2.6 * torsion * curving * step, 0.01 * moment[0]);
  EXPECT_NEAR(moment[1], young * second_moment * curving * step, 0.01 * moment[1]);
  EXPECT_NEAR(moment[2], 0, 1e-9 * moment[1]);
  // Over one unit of length.
  const auto twist = after_a_step(beam_deck(), "beam_twist", 0, turn, at_rest, step);
  EXPECT_NEAR(twist[0], curving * step, 1e-6 * twist[0]);
}

// A field of shells is not a number in solids, and results hold it all the same; a field that all have must
// be one.
TEST(CellVariables, AreNotANumberWhereThereIsNoSuchThing) {
  Deck deck = shell_deck(3);
  deck.parts.push_back(box("cube", {1, 1, 1}, {1, 1, 1}, {0, 0, 5}, hex8()));
  Part rigid = deck.parts[0];
  rigid.name = "rigid";
  Rigid element;
  element.thickness = thickness;
  rigid.element = element;
  rigid.placement.translate = {0, 0, 9};
  deck.parts.push_back(rigid);
  Model model = build_model(deck);
  ThreadTeam team(1);
  make_steps(model, 1, 1, team);
  const std::vector<std::string> wanted{"stress_top", "membrane_force", "von_mises"};
  FieldObserver observer(model, wanted);
  Snapshot snapshot = observer.observe(model);
  const std::size_t count = snapshot.cell_fields.size();
  for (const FieldArray& field : {snapshot.cell_fields[count - 3], snapshot.cell_fields[count - 2]}) {
    ASSERT_EQ(field.values.size(), 18u);
    for (std::size_t k = 0; k < 6; ++k) {
      EXPECT_EQ(field.values[k], 0) << field.name;
      EXPECT_TRUE(std::isnan(field.values[6 + k])) << field.name;
      EXPECT_TRUE(std::isnan(field.values[12 + k])) << field.name << " of a rigid part";
    }
  }
  EXPECT_EQ(what_results_cannot_hold(snapshot), "");
  snapshot.cell_fields.back().values[1] = std::nan("");
  EXPECT_EQ(what_results_cannot_hold(snapshot), "a value of 'von_mises'");
}

JohnsonCook hot_metal() {
  JohnsonCook law{.density = 1000, .youngs_modulus = young, .poissons_ratio = 0.3, .yield_stress = 1e7};
  law.thermal =
      ThermalSoftening{.specific_heat = 400, .melting_temperature = 1000, .reference_temperature = 293};
  return law;
}

// Of a cube that is sheared without hardening all but the heat fraction of the work stays: what is not
// elastic energy, tau^2 / 2 G, is plastic work.
TEST(CellVariables, TemperatureOfAdiabaticShearIsThePlasticWork) {
  Deck deck;
  deck.materials = {{"hot", hot_metal()}};
  deck.parts = {box("cube", {1, 1, 1}, {1, 1, 1}, {0, 0, 0}, inviscid_hex8(), "hot")};
  deck.time.end = 1;
  deck.time.step_bound = StepBound::elements;
  Model model = build_model(deck);
  for (NodeRecord& node : model.nodes.record) {
    node.velocity[0] = node.position[1];
    node.inverse_mass = 0;  // it goes on so
  }
  const std::vector<std::string> wanted{"temperature", "internal_energy_density", "von_mises"};
  FieldObserver observer(model, wanted);
  ThreadTeam team(1);
  make_steps(model, 4000, 1e9, team);
  const Snapshot& snapshot = observer.observe(model);
  const auto value = [&](std::size_t field) { return snapshot.cell_fields[2 + field].values[0]; };
  const double elastic_energy = value(2) * value(2) / 6 / (young / 2.6);
  const double rise = 0.9 * (value(1) - elastic_energy) / (1000 * 400);
  EXPECT_GT(rise, 5);
  EXPECT_NEAR(value(0) - 293, rise, 1e-5 * rise);
}

// One part of each kind: what tells thickness, radius, density or temperature is where the others are not a
// number; plastic strain is 0 where nothing is plastic.
TEST(CellVariables, OfOtherKindsAndMaterialsAreNotANumber) {
  Deck deck = shell_deck(3);
  deck.materials.emplace_back("hot", hot_metal());
  deck.parts.push_back(box("cube", {1, 1, 1}, {1, 1, 1}, {0, 0, 5}, hex8(), "hot"));
  deck.parts.push_back(beam_deck().parts[0]);
  deck.parts.back().placement.translate = {0, 0, 9};
  const Model model = build_model(deck);
  const std::vector<std::string> wanted{"default", "temperature", "hourglass_energy_density", "beam_twist"};
  FieldObserver observer(model, wanted);
  const Snapshot& snapshot = observer.observe(model);
  const double none = std::nan("");
  const std::map<std::string, std::array<double, 3>> expected{
      {"thickness", {thickness, none, none}},
      {"radius", {none, none, std::sqrt(0.02 * 0.05 / std::numbers::pi)}},
      {"temperature", {none, 293, none}},
      {"equivalent_plastic_strain", {0, 0, 0}},
      {"hourglass_energy_density", {0, 0, none}},
      {"beam_twist", {none, none, 0}}};
  std::size_t found = 0;
  for (const FieldArray& field : snapshot.cell_fields) {
    const auto values = expected.find(field.name);
    if (values == expected.end()) continue;
    ++found;
    for (std::size_t part = 0; part < 3; ++part)
      if (std::isnan(values->second[part])) {
        EXPECT_TRUE(std::isnan(field.values[part])) << field.name << " of part " << part;
      } else {
        EXPECT_NEAR(field.values[part], values->second[part], 1e-12) << field.name << " of part " << part;
      }
  }
  EXPECT_EQ(found, expected.size());
  EXPECT_EQ(what_results_cannot_hold(snapshot), "");
}

std::vector<double> field_of(const Model& model, const std::string& name) {
  FieldObserver observer(model);
  const Snapshot& snapshot = observer.observe(model);
  for (const auto* list : {&snapshot.point_fields, &snapshot.cell_fields})
    for (const FieldArray& field : *list)
      if (field.name == name) return field.values;
  return {};
}

// Those of a file stay, and generated ones go on behind the largest of any file.
TEST(CellVariables, NumbersAreUniqueOverTheScene) {
  Deck deck;
  deck.materials = {{"material", elastic(0.3)}};
  deck.parts = {box("first", {1, 1, 1}, {1, 1, 2}, {0, 0, 0}, hex8()),
                box("file", {1, 1, 1}, {1, 1, 1}, {3, 0, 0}, hex8()),
                box("rigid", {1, 1, 1}, {1, 1, 1}, {6, 0, 0}, Rigid{})};
  deck.time.end = 1;
  std::vector<Mesh> meshes;
  for (const Part& part : deck.parts) meshes.push_back(generate_mesh(part.mesh, part.placement));
  EXPECT_EQ(field_of(build(deck, meshes), "element_id"), (std::vector<double>{0, 1, 2, 3}));
  meshes[1].element_id = {70};
  for (std::int64_t node = 0; node < 8; ++node) meshes[1].node_id.push_back(100 - node);
  const Model model = build(deck, meshes);
  EXPECT_EQ(field_of(model, "element_id"), (std::vector<double>{71, 72, 70, 73}));
  std::vector<double> nodes = field_of(model, "node_id");
  EXPECT_EQ(nodes[12], 100);
  std::ranges::sort(nodes);
  for (std::size_t i = 0; i < nodes.size(); ++i) EXPECT_EQ(nodes[i], 93 + static_cast<double>(i));
}

}  // namespace
}  // namespace brio
