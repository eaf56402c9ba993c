// Logarithmic strain of elements against closed forms.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "src/fields/strain.hpp"
#include "src/output/observe.hpp"
#include "tests/core/scene.hpp"

namespace brio {
namespace {

using namespace test;
using Eigen::Matrix3d;
using Eigen::Vector3d;

Matrix3d to_matrix(const std::vector<double>& s, std::size_t first = 0) {
  const double* a = s.data() + first;
  Matrix3d matrix;
  matrix << a[0], a[3], a[5], a[3], a[1], a[4], a[5], a[4], a[2];
  return matrix;
}
Matrix3d rotation(double angle, const Vector3d& axis) {
  return Eigen::AngleAxisd(angle, axis.normalized()).toRotationMatrix();
}

/// Strains of all cells once the nodes are where the matrix takes them.
std::vector<double> strain_after(const Deck& deck, const Matrix3d& deformation) {
  Model model = build_model(deck);
  const std::vector<std::string> wanted{"strain"};
  FieldObserver observer(model, wanted);
  for (NodeRecord& node : model.nodes.record) {
    const Vector3d x = deformation * Vector3d(node.position);
    std::copy_n(x.data(), 3, node.position);
  }
  const FieldArray& field = observer.observe(model).cell_fields.back();
  EXPECT_EQ(field.name, "strain");
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

void expect_equal(const Matrix3d& a, const Matrix3d& b) {
  EXPECT_LT((a - b).cwiseAbs().maxCoeff(), 1e-13) << a << "\n\n" << b;
}

TEST(Strain, IsNoneOfARotation) {
  const Matrix3d turned = rotation(2, {1, 2, 3});
  for (const Deck& deck : {brick_deck(), plate_deck()})
    for (const double component : strain_after(deck, turned)) EXPECT_NEAR(component, 0, 1e-14);
}

// ln V of R U is R ln U R^T.
TEST(Strain, OfAStretchIsItsLogarithmOnTheAxesThatTurn) {
  const Matrix3d turned = rotation(1, {3, -1, 2});
  const Matrix3d stretch = Vector3d(1.5, 0.8, 2).asDiagonal();
  const Matrix3d expected =
      turned * Vector3d(std::log(1.5), std::log(0.8), std::log(2)).asDiagonal() * turned.transpose();
  const std::vector<double> strain = strain_after(brick_deck(), turned * stretch);
  ASSERT_EQ(strain.size(), 12U);
  expect_equal(to_matrix(strain), expected);
  expect_equal(to_matrix(strain, 6), expected);
}

// The thickness of a plate that is only moved stays: its normal keeps its length.
TEST(Strain, OfAShellHasThatOfItsThickness) {
  const Matrix3d turned = rotation(1, {3, -1, 2});
  const Matrix3d stretch = Vector3d(1.5, 0.8, 1).asDiagonal();
  const Matrix3d expected =
      turned * Vector3d(std::log(1.5), std::log(0.8), 0).asDiagonal() * turned.transpose();
  expect_equal(to_matrix(strain_after(plate_deck(), turned * stretch)), expected);
  const std::array<Vector3d, 4> corners{Vector3d(0, 0, 0), Vector3d(1, 0, 0), Vector3d(1, 1, 0),
                                        Vector3d(0, 1, 0)};
  const SymmetricTensor<double> thinner = logarithmic_strain(deformation_of_shell(corners, corners, 0.5));
  EXPECT_NEAR(thinner.zz, std::log(0.5), 1e-14);
  EXPECT_NEAR(thinner.xx, 0, 1e-14);
}

// Of simple shear g the principal stretches are g/2 +- sqrt(1 + g^2/4), and their directions are at half the
// angle whose tangent is 2/g.
TEST(Strain, OfSimpleShear) {
  for (const double g : {0.1, 1.0, 5.0}) {
    Matrix3d shear = Matrix3d::Identity();
    shear(0, 1) = g;
    const double principal = std::asinh(g / 2), angle = 0.5 * std::atan2(2, g);
    const Vector3d direction(std::cos(angle), std::sin(angle), 0),
        across(-std::sin(angle), std::cos(angle), 0);
    expect_equal(to_matrix(strain_after(brick_deck(), shear)),
                 principal * (direction * direction.transpose() - across * across.transpose()));
  }
}

TEST(Strain, IsNotANumberInBeamsAndParticles) {
  Deck deck = brick_deck();
  Beam2 beam;
  beam.section = RectangleSection{0.02, 0.05};
  beam.orientation = Triple{0, 0, 1};
  LineMesh mesh;
  mesh.start = {-5, 0, 0};
  mesh.end = {-4, 0, 0};
  mesh.elements = 1;
  deck.parts.push_back({"beam", mesh, {}, beam, "material"});
  const std::vector<double> strain = strain_after(deck, Matrix3d::Identity());
  ASSERT_EQ(strain.size(), 18U);
  for (std::size_t i = 0; i < 18; ++i) EXPECT_EQ(std::isnan(strain[i]), i >= 12) << i;
}

}  // namespace
}  // namespace brio
