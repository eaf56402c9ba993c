// Trusses and cables: beams with axial force alone.

#include <gtest/gtest.h>

#include "materials/elastic_plastic.hpp"
#include "materials/failing.hpp"
#include "tests/elements/beam/beam_model.hpp"

namespace brio {
namespace {

const Eigen::Vector3d direction = Eigen::Vector3d(1, 2, -2) / 3;
constexpr double bar_area = 1e-4;

Beam2 bar(BeamFormulation formulation) {
  Beam2 beam;
  beam.section = RectangleSection{.width = 0.01, .height = 0.01};  // needs no orientation
  beam.formulation = formulation;
  beam.linear_bulk_viscosity = 0;
  EXPECT_EQ(beam.fault(), "");
  return beam.prepared();
}

template <class Law>
void stretch_to(SingleBeam<Law>& beam, double length) {
  beam.move({origin, length * direction}, {origin, origin});
}

TEST(Truss, CarriesAxialForceAloneAndHasTheStepOfAWave) {
  SingleBeam<> truss(bar(BeamFormulation::truss), steel(), {origin, 2 * direction});
  EXPECT_NEAR(2 * truss.mass.mass, 7850 * bar_area * 2, 1e-12);
  EXPECT_EQ(truss.mass.rotational_inertia, 0);
  stretch_to(truss, 2);
  EXPECT_NEAR(truss.increment.stable_step, 2 / std::sqrt(200e9 / 7850), 1e-12);
  for (const double length : {2.2, 1.5}) {
    stretch_to(truss, length);
    const double force = 200e9 * std::log(length / 2) * bar_area * 2 / length;
    EXPECT_LT((truss.force(1) - force * direction).norm(), 1e-12 * std::abs(force));
    EXPECT_LT((truss.force(0) + force * direction).norm(), 1e-12 * std::abs(force));
    EXPECT_EQ(truss.moment(0).norm() + truss.moment(1).norm(), 0);
    EXPECT_NEAR(truss.header.internal_energy, 0.5 * 200e9 * bar_area * 2 * square(std::log(length / 2)),
                1e-3);
  }
  // Turned about, it bears the same; spins of its ends are nothing to it.
  truss.move({origin, Eigen::Vector3d(0, 1.5, 0)}, {Eigen::Vector3d(1, 2, 3), origin});
  EXPECT_NEAR(truss.force(1).y(), 200e9 * std::log(0.75) * bar_area * 2 / 1.5, 1e-3);
  const ElementSample sample = truss.sample();
  EXPECT_NEAR(sample.stress.yy, 200e9 * std::log(0.75), 1);
  EXPECT_EQ(sample.stress.xx, 0);
}

TEST(Cable, GoesSlackAndComesTautAtTheSameLength) {
  SingleBeam<> cable(bar(BeamFormulation::cable), steel(), {origin, direction});
  for (const double length : {1.001, 0.9, 0.5, 0.8, 0.95, 1.0}) {
    stretch_to(cable, length);
    const double force = length > 1 ? 200e9 * std::log(length) * bar_area / length : 0;
    EXPECT_NEAR(cable.force(1).dot(direction), force, 1e-8 * 200e9 * bar_area) << length;
  }
  EXPECT_NEAR(cable.header.internal_energy, 0, 1e-9);
  stretch_to(cable, 1.002);
  EXPECT_NEAR(cable.force(1).dot(direction) / (200e9 * std::log(1.002) * bar_area / 1.002), 1, 1e-9);
}

TEST(Cable, KeepsThePlasticStretch) {
  const IsotropicElasticPlastic law{
      {.density = 7850, .youngs_modulus = 200e9, .poissons_ratio = 0.3, .yield_stress = 200e6}};
  SingleBeam<IsotropicElasticPlastic> cable(bar(BeamFormulation::cable), law, {origin, direction});
  for (int k = 1; k <= 50; ++k) stretch_to(cable, 1 + 2e-4 * k);  // to 1.01
  const double plastic = std::log(1.01) - 1e-3;
  EXPECT_NEAR(cable.header.internal_energy, bar_area * 200e6 * (plastic + 0.5e-3), 1e-3 * bar_area * 200e6);
  stretch_to(cable, std::exp(plastic - 0.2));
  EXPECT_EQ(cable.force(1).norm(), 0);
  stretch_to(cable, std::exp(plastic - 1e-9));
  EXPECT_EQ(cable.force(1).norm(), 0);
  stretch_to(cable, std::exp(plastic + 0.5e-3));
  EXPECT_NEAR(cable.sample().stress.xx / square(direction.x()), 100e6, 1);
}

TEST(Cable, UnloadsToNothingHoweverItsMaterialFails) {
  ElasticPlastic deck{.density = 7850, .youngs_modulus = 200e9, .poissons_ratio = 0.3, .yield_stress = 200e6};
  deck.failure.emplace();
  for (const DamageGrowth growth : {DamageGrowth::sudden, DamageGrowth::opening}) {
    deck.failure->damage_growth = growth;
    deck.failure->tearing_parameter = growth == DamageGrowth::sudden ? std::optional(0.02) : std::nullopt;
    deck.failure->strain = growth == DamageGrowth::sudden ? std::nullopt : std::optional(0.005);
    deck.failure->opening_strain = 0.01;
    SingleBeam<Failing<IsotropicElasticPlastic>> cable(
        bar(BeamFormulation::cable), Failing<IsotropicElasticPlastic>{deck}, {origin, direction});
    cable.law.start(cable.points[0].history, 1.0);
    for (int k = 1; k <= 50; ++k) stretch_to(cable, 1 + 2e-4 * k);  // damaged to the half
    EXPECT_GT(cable.points[0].history.damage, 0.3);
    EXPECT_LT(cable.points[0].history.damage, 0.7);
    EXPECT_GT(cable.points[0].stress.xx, 80e6);
    stretch_to(cable, 0.9);
    EXPECT_NEAR(cable.points[0].stress.xx, 0, 1);
    EXPECT_LT(cable.header.slack, -0.09);
  }
}

TEST(Cable, WhipsWithoutEverPushing) {
  constexpr int elements = 12;
  BeamModel model(origin, Eigen::Vector3d(1, 0, 0), elements, bar(BeamFormulation::cable), steel());
  for (int component = 0; component < 3; ++component) model.fix(0, component);
  for (int n = 0; n <= elements; ++n) {
    model.set_velocity(n, {-50.0 * n / elements, 0, 100.0 * n / elements});
    model.load(n, {0, 0, -5}, origin);
  }
  const double step = 0.9 * model.stable_step();
  double least = 0, largest = 0;
  for (int k = 0; k < 20000; ++k) {
    model.advance(step);
    for (int e = 0; e < elements; ++e) {
      const SymmetricTensor<double> stress = model.sample(e).stress;
      least = std::min(least, trace(stress));
      largest = std::max(largest, trace(stress));
    }
  }
  EXPECT_GE(least, -1e-3);
  EXPECT_GT(largest, 1e6);
}

}  // namespace
}  // namespace brio
