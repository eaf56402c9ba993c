#include <gtest/gtest.h>

#include "materials/elastic_plastic.hpp"
#include "materials/failing.hpp"
#include "tests/elements/beam/beam_model.hpp"

namespace brio {
namespace {

constexpr double yield = 300e6;

ElasticPlastic perfectly_plastic() {
  return {.density = 7850, .youngs_modulus = 200e9, .poissons_ratio = 0.3, .yield_stress = yield};
}

SingleBeam<IsotropicElasticPlastic> plastic_beam(const BeamSection& section) {
  return {beam_of(section, {0, 0, 1}), IsotropicElasticPlastic{perfectly_plastic()},
          Pair{origin, Eigen::Vector3d(1, 0, 0)}};
}

/// Both ends turned apart, step by step, by `turn` in all.
void turn_apart(SingleBeam<IsotropicElasticPlastic>& beam, const Eigen::Vector3d& turn) {
  constexpr int steps = 400;
  for (int k = 0; k < steps; ++k) beam.move(beam.position, {-0.5 / steps * turn, 0.5 / steps * turn});
}

TEST(Beam2Plastic, TensionYieldsAtTheYieldStressTimesTheShrunkArea) {
  auto beam = plastic_beam(CircleSection{.radius = 0.1});
  for (int k = 1; k <= 100; ++k) beam.move({origin, Eigen::Vector3d(1 + 1e-3 * k, 0, 0)}, {origin, origin});
  EXPECT_NEAR(beam.force(1).x() / (yield * M_PI * 0.01 / 1.1), 1, 1e-12);
  EXPECT_NEAR(beam.plastic_strain(), std::log(1.1) - yield / 200e9, 1e-12);
}

TEST(Beam2Plastic, BendingEndsAtTheFullyPlasticMoment) {
  const double width = 0.05, height = 0.1;
  auto beam = plastic_beam(RectangleSection{.width = width, .height = height});
  // The yield curvature is 0.03; the inmost fibres flow at ten times that.
  turn_apart(beam, {0, 0.4, 0});
  EXPECT_NEAR(beam.moment(1).y() / (yield * width * height * height / 4), 1, 1e-9);
  EXPECT_LT(beam.force(1).norm(), 1e-6 * yield * width * height);

  const ISection profile{.width = 0.1, .height = 0.2, .web_thickness = 0.0056, .flange_thickness = 0.0085};
  auto i_beam = plastic_beam(profile);
  turn_apart(i_beam, {0, 0.4, 0});
  const double web = 0.2 - 2 * 0.0085;
  EXPECT_NEAR(i_beam.moment(1).y() / (yield * (0.1 * 0.0085 * (0.2 - 0.0085) + 0.0056 * web * web / 4)), 1,
              1e-9);
}

TEST(Beam2Plastic, RoundSectionsComeNearTheirPlasticMoments) {
  auto rod = plastic_beam(CircleSection{.radius = 0.05});
  turn_apart(rod, {0, 0.8, 0});
  EXPECT_NEAR(rod.moment(1).y() / (yield * 4.0 / 3 * std::pow(0.05, 3)), 1, 0.015);
  auto fine = plastic_beam(CircleSection{.radius = 0.05, .fibres = {4, 32}});
  turn_apart(fine, {0, 0.8, 0});
  EXPECT_NEAR(fine.moment(1).y() / (yield * 4.0 / 3 * std::pow(0.05, 3)), 1, 0.003);
}

TEST(Beam2Plastic, TwistEndsAtTheFullyPlasticTorque) {
  auto rod = plastic_beam(CircleSection{.radius = 0.05});
  turn_apart(rod, {1.0, 0, 0});
  EXPECT_NEAR(rod.moment(1).x() / (2 * M_PI / 3 * yield / std::sqrt(3) * std::pow(0.05, 3)), 1, 1e-9);
}

/// Force that a cantilever of length 1, or a beam held at both ends and pushed in its middle, bears in the
/// end, over what it takes for hinges at its ends (and middle).
double collapse_force(bool both_ends, int elements) {
  const double width = 0.05, height = 0.1;
  BeamModel model(origin, Eigen::Vector3d(1, 0, 0), elements,
                  beam_of(RectangleSection{.width = width, .height = height}, {0, 0, 1}),
                  perfectly_plastic());
  model.clamp(0);
  if (both_ends)
    for (int component = 1; component < 6; ++component) model.fix(elements, component);  // free to slide in
  const int pushed = both_ends ? elements / 2 : elements;
  const double deflection = both_ends ? 0.01 : 0.04;  // about four times that at first yield
  const double step = 0.9 * model.stable_step();
  const double slow = 0.02;  // about the longest period of both
  const double keep = 1 - step / slow;
  model.drive(pushed, 2, deflection / (20 * slow));
  while (model.time < 20 * slow) model.advance(step, keep);
  double sum = 0;
  int count = 0;
  for (const double end = model.time + 2 * slow; model.time < end; ++count) {
    model.advance(step, keep);
    sum -= model.force(pushed).z();
  }
  const double moment = yield * width * height * height / 4;
  return sum / count / ((both_ends ? 8 : 1) * moment);
}

TEST(Beam2PlasticSlow, HingesCarryTheLoadOfLimitAnalysis) {
  // A hinge stands at a Gauss point: 0.211 element lengths less lever for each.
  const double off = 0.5 - 0.5 / std::sqrt(3);
  for (const int elements : {10, 20}) {
    EXPECT_NEAR(collapse_force(false, elements) * (1 - off / elements), 1, 0.005) << elements;
    EXPECT_NEAR(collapse_force(true, elements) * (1 - 4 * off / elements), 1, 0.005) << elements;
  }
}

TEST(Beam2Plastic, OneSectionThatHasFailedIsEnough) {
  ElasticPlastic law = perfectly_plastic();
  law.failure.emplace();
  law.failure->strain = 0.02;
  law.failure->opening_strain = 0.01;
  law.failure->failed_points = 0.5;
  // A short cantilever: the Gauss point at its root is bent far more than the other.
  BeamModel model(origin, Eigen::Vector3d(1, 0, 0), 1,
                  beam_of(RectangleSection{.width = 0.05, .height = 0.05}, {0, 0, 1}), law);
  model.clamp(0);
  model.drive(1, 2, 20.0);
  const double step = 0.5 * model.stable_step();
  while (model.last.lost == 0 && model.time < 0.1) model.advance(step);
  ASSERT_EQ(model.last.lost, 1u);
  EXPECT_EQ(model.force(1).norm() + model.moment(0).norm(), 0);
  // The fibres at the root have failed by half; those of the other section have not.
  int failed[2] = {0, 0};
  using Law = Failing<IsotropicElasticPlastic>;
  const Beam2Kernel beam{std::get<Beam2>(model.block.element)};
  const auto* points = reinterpret_cast<const Beam2Kernel::Point<Lanes<double>, Law>*>(
      model.block.state.data() + sizeof(Beam2Kernel::Header<Lanes<double>, Law>));
  for (int p = 0; p < beam.points(); ++p)
    failed[p / beam.fibres->count] += points[p].history.damage[0] >= 0.9 ? 1 : 0;
  EXPECT_GE(2 * failed[0], beam.fibres->count);
  EXPECT_LT(2 * failed[1], beam.fibres->count);
}

}  // namespace
}  // namespace brio
