// Logarithmic strain and rate of deformation of elements against closed forms.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "src/fields/strain.hpp"
#include "src/output/observe.hpp"
#include "tests/core/scene.hpp"
#include "tests/rotation_about.hpp"

namespace brio {
namespace {

using namespace test;

Tensor<double> to_matrix(const std::vector<double>& s, std::size_t first = 0) {
  const double* a = s.data() + first;
  const Tensor<double> matrix{{{a[0], a[3], a[5]}, {a[3], a[1], a[4]}, {a[5], a[4], a[2]}}};
  return matrix;
}

/// Strains of all cells once the nodes are where the matrix takes them.
std::vector<double> strain_after(const Deck& deck, const Tensor<double>& deformation) {
  Model model = build_model(deck);
  const std::vector<std::string> wanted{"strain"};
  FieldObserver observer(model, wanted);
  for (NodeRecord& node : model.nodes.record) {
    const Vector3d x = deformation * vector_at(node.position);
    std::copy_n(x.data(), 3, node.position);
  }
  const FieldArray& field = observer.observe(model).cell_fields.back();
  EXPECT_EQ(field.name, "strain");
  return field.values;
}

/// Rates of all cells where nodes are where the matrix takes them, with the velocities of a gradient.
std::vector<double> strain_rate(const Deck& deck, const Tensor<double>& deformation,
                                const Tensor<double>& gradient, double step = 0) {
  Model model = build_model(deck);
  const std::vector<std::string> wanted{"strain_rate"};
  FieldObserver observer(model, wanted);
  model.times.next = step;
  for (NodeRecord& node : model.nodes.record) {
    const Vector3d x = deformation * vector_at(node.position), v = gradient * x;
    std::copy_n(x.data(), 3, node.position);
    std::copy_n(v.data(), 3, node.velocity);
  }
  const FieldArray& field = observer.observe(model).cell_fields.back();
  EXPECT_EQ(field.name, "strain_rate");
  EXPECT_TRUE(field.is_partial);
  return field.values;
}

Deck brick_deck() {
  Deck deck;
  deck.materials = {{"material", elastic(0.3)}};
  deck.parts = {box("brick", {1, 2, 3}, {1, 1, 2}, {5, 0, 1}, hex8())};
  deck.time.end = 1;
  return deck;
}
Deck plate_deck() {
  Deck deck;
  deck.materials = {{"material", elastic(0.3)}};
  Shell4 shell;
  shell.thickness = 0.1;
  PlateMesh mesh;
  mesh.size = {1, 2};
  mesh.elements = {2, 1};
  deck.parts = {{"plate", mesh, {}, shell, "material"}};
  deck.time.end = 1;
  return deck;
}

void expect_equal(const Tensor<double>& a, const Tensor<double>& b) {
  EXPECT_LT(norm(a - b), 1e-13) << testing::PrintToString(a.m) << "\n\n" << testing::PrintToString(b.m);
}

TEST(Strain, IsNoneOfARotation) {
  const Tensor<double> turned = rotation_about(2, {1, 2, 3});
  for (const Deck& deck : {brick_deck(), plate_deck()})
    for (const double component : strain_after(deck, turned)) EXPECT_NEAR(component, 0, 1e-14);
}

// ln V of R U is R ln U R^T.
TEST(Strain, OfAStretchIsItsLogarithmOnTheAxesThatTurn) {
  const Tensor<double> turned = rotation_about(1, {3, -1, 2});
  const Tensor<double> stretch = diagonal(Vector3d{1.5, 0.8, 2});
  const Tensor<double> expected =
      turned * diagonal(Vector3d{std::log(1.5), std::log(0.8), std::log(2)}) * transposed(turned);
  const std::vector<double> strain = strain_after(brick_deck(), turned * stretch);
  ASSERT_EQ(strain.size(), 12U);
  expect_equal(to_matrix(strain), expected);
  expect_equal(to_matrix(strain, 6), expected);
}

// The thickness of a plate that is only moved stays: its normal keeps its length.
TEST(Strain, OfAShellHasThatOfItsThickness) {
  const Tensor<double> turned = rotation_about(1, {3, -1, 2});
  const Tensor<double> stretch = diagonal(Vector3d{1.5, 0.8, 1});
  const Tensor<double> expected =
      turned * diagonal(Vector3d{std::log(1.5), std::log(0.8), 0}) * transposed(turned);
  expect_equal(to_matrix(strain_after(plate_deck(), turned * stretch)), expected);
  const std::array<Vector3d, 4> corners{Vector3d{0, 0, 0}, Vector3d{1, 0, 0}, Vector3d{1, 1, 0},
                                        Vector3d{0, 1, 0}};
  const SymmetricTensor<double> thinner = logarithmic_strain(deformation_of_shell(corners, corners, 0.5));
  EXPECT_NEAR(thinner.zz, std::log(0.5), 1e-14);
  EXPECT_NEAR(thinner.xx, 0, 1e-14);
}

// Of simple shear g the principal stretches are g/2 +- sqrt(1 + g^2/4), and their directions are at half the
// angle whose tangent is 2/g.
TEST(Strain, OfSimpleShear) {
  for (const double g : {0.1, 1.0, 5.0}) {
    Tensor<double> shear = identity<double>();
    shear(0, 1) = g;
    const double principal = std::asinh(g / 2), angle = 0.5 * std::atan2(2, g);
    const Vector3d direction{std::cos(angle), std::sin(angle), 0},
        across{-std::sin(angle), std::cos(angle), 0};
    expect_equal(to_matrix(strain_after(brick_deck(), shear)),
                 principal * (outer_product(direction, direction) - outer_product(across, across)));
  }
}

TEST(Strain, IsNotANumberInBeamsAndRigidParts) {
  Deck deck = brick_deck();
  Beam2 beam;
  beam.section = RectangleSection{0.02, 0.05};
  beam.orientation = Vector3d{0, 0, 1};
  LineMesh mesh;
  mesh.start = {-5, 0, 0};
  mesh.end = {-4, 0, 0};
  mesh.elements = 1;
  deck.parts.push_back({"beam", mesh, {}, beam, "material"});
  deck.parts.push_back(box("rigid", {1, 1, 1}, {1, 1, 1}, {-9, 0, 0}, Rigid{}));
  for (const std::vector<double>& values :
       {strain_after(deck, identity<double>()), strain_rate(deck, identity<double>(), Tensor<double>{})}) {
    ASSERT_EQ(values.size(), 24U);
    for (std::size_t i = 0; i < 24; ++i) EXPECT_EQ(std::isnan(values[i]), i >= 12) << i;
  }
}

// ---- rate

// D of a velocity gradient is its symmetric part, whatever the shape by then.
TEST(StrainRate, OfSimpleShearAndStretching) {
  Tensor<double> shape = diagonal(Vector3d{1.3, 0.7, 1.1}), shear{};
  shape(0, 2) = 0.4;
  shear(0, 1) = 300;
  const Tensor<double> stretching = diagonal(Vector3d{50, -20, 7});
  for (const Tensor<double>& gradient : {shear, stretching, Tensor<double>(shear + stretching)}) {
    const std::vector<double> rate = strain_rate(brick_deck(), shape, gradient);
    ASSERT_EQ(rate.size(), 12U);
    for (const std::size_t cell : {0U, 6U})
      EXPECT_LT(norm(to_matrix(rate, cell) - 0.5 * (gradient + transposed(gradient))), 1e-12 * 300);
  }
}

// In the plane of a plate that was turned; its normal turns with it and is not stretched.
TEST(StrainRate, OfAShellIsThatOfItsMiddleSurface) {
  const Tensor<double> turned = rotation_about(1, {3, -1, 2});
  Tensor<double> within = diagonal(Vector3d{50, -20, 0}), across{}, thinning{};
  within(0, 1) = within(1, 0) = 30;
  across(2, 0) = 70, across(0, 2) = -11;
  thinning(2, 2) = -90;
  const std::vector<double> rate =
      strain_rate(plate_deck(), turned, turned * (within + across + thinning) * transposed(turned));
  EXPECT_LT(norm(to_matrix(rate) - turned * within * transposed(turned)), 1e-12 * 100);
}

TEST(StrainRate, IsNoneOfARotation) {
  const Tensor<double> spin{{{0, -300, 200}, {300, 0, -100}, {-200, 100, 0}}};
  for (const Deck& deck : {brick_deck(), plate_deck()}) {
    for (const double component : strain_rate(deck, rotation_about(2, {1, 2, 3}), spin))
      EXPECT_NEAR(component, 0, 1e-12 * 300);
    // Nor of one by a step of any size: half a radian in 1e-3.
    const Tensor<double> secant = 1e3 * (rotation_about(0.5, {1, 2, 3}) - identity<double>());
    for (const double component : strain_rate(deck, identity<double>(), secant, 1e-3))
      EXPECT_NEAR(component, 0, 1e-12 * 500);
  }
}

// Of a bar whose ends part at a constant velocity v: v / l in the middle of each step, and the sum of rates
// times steps is the logarithmic strain.
TEST(StrainRate, AddsUpToTheLogarithmicStrain) {
  constexpr double rate = 10;
  Deck deck;
  deck.materials = {{"material", elastic(0)}};
  deck.parts = {box("bar", {1, 0.2, 0.2}, {1, 1, 1}, {0.5, 0, 0}, inviscid_hex8())};
  PrescribedMotion pull;
  pull.where.set = "bar.xmax";
  pull.components = {{0, Curve{{{0, rate}}}}};
  deck.boundary_conditions = {fix("bar.xmin", {0}), pull};
  deck.time.end = 1;
  Model model = build_model(deck);
  for (NodeRecord& node : model.nodes.record) node.velocity[0] = rate * node.position[0];
  const std::vector<std::string> wanted{"strain", "strain_rate"};
  FieldObserver observer(model, wanted);
  ThreadTeam team(1);
  double sum = 0;
  look_at_steps(model, 100, 1e9, team, [&](int) {
    const Snapshot& now = observer.observe(model);
    const std::vector<double>& strain = (now.cell_fields.end() - 2)->values;
    const std::vector<double>& strain_rate = now.cell_fields.back().values;
    EXPECT_NEAR(sum, strain[0], 1e-6 * strain[0]);
    EXPECT_NEAR(strain[0], std::log1p(rate * model.times.time), 1e-12);
    const double length = 1 + rate * (model.times.time + 0.5 * model.times.next);
    EXPECT_NEAR(strain_rate[0], rate / length, 1e-12 * rate);
    sum += strain_rate[0] * model.times.next;
  });
  EXPECT_GT(sum, 0.05);
}

}  // namespace
}  // namespace brio
