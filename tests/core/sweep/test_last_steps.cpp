// The end of a run, whatever number of steps leads to it.

#include <gtest/gtest.h>

#include "src/sweep/step_size.hpp"
#include "tests/core/extremes/extremes.hpp"

namespace brio {
namespace {

using namespace test;

/// One element in free vibration near its stable step, without viscosity.
Deck vibrating(Kind kind, double end) {
  Deck deck;
  deck.materials = {{"material", elastic(0.3)}};
  Part part = body(kind, "body");
  if (auto* mesh = std::get_if<BoxMesh>(&part.mesh)) mesh->elements = {1, 1, 1};
  if (auto* mesh = std::get_if<PlateMesh>(&part.mesh)) mesh->elements = {1, 1};
  if (auto* mesh = std::get_if<LineMesh>(&part.mesh)) mesh->elements = 1;
  std::visit(
      [](auto& element) {
        if constexpr (requires { element.linear_bulk_viscosity; }) element.linear_bulk_viscosity = 0;
        if constexpr (requires { element.quadratic_bulk_viscosity; }) element.quadratic_bulk_viscosity = 0;
      },
      part.element);
  deck.parts = {part};
  deck.time.end = end;
  return deck;
}

/// Largest energy error up to the last ten steps, and in them.
struct Errors {
  double before = 0, last = 0;
  double least_step = HUGE_VAL, largest_step = 0;
};
Errors errors_of(const Deck& deck) {
  Model model = build_model(deck);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> any(-1e-3, 1e-3);
  for (NodeRecord& node : model.nodes.record)
    for (double& component : node.velocity) component = any(random);
  ThreadTeam team(1);
  update_velocities(model, 1e9, team);
  model.energy.kinetic_start = 0;
  model.energy.kinetic_start = model.energy.sum();
  model.energy.error_max = 0;
  std::vector<double> error;
  Errors found;
  run(model, 1e9, team, [&](const Model& now) {
    if (now.step > 0) error.push_back(std::abs(now.energy.relative_error()));
    if (now.times.time >= deck.time.end) return false;
    found.least_step = std::min(found.least_step, now.times.next);
    found.largest_step = std::max(found.largest_step, now.times.next);
    return true;
  });
  for (std::size_t i = 0; i < error.size(); ++i)
    (i + 10 < error.size() ? found.before : found.last) =
        std::max(i + 10 < error.size() ? found.before : found.last, error[i]);
  return found;
}

class LastSteps : public testing::TestWithParam<Kind> {};

// Ends at whole and broken numbers of steps. A step that is shorter by a share s changes the energy of an
// oscillation by up to (omega d)^2 s / 2 of it, 1.62 s at 0.9 of the stable step: where there are hundred
// steps to share the change, by 1.6 %; two steps that share it, by as much as there is.
TEST_P(LastSteps, AddNoEnergyError) {
  const double step = [](Kind kind) {
    Deck deck = vibrating(kind, 1);
    Model model = build_model(deck);
    ThreadTeam team(1);
    update_velocities(model, 1, team);
    return model.control.first;
  }(GetParam());
  for (const double steps : {40.0, 40.0001, 40.3, 40.5, 40.97, 77.77, 300.0, 300.01, 300.5, 2000.2}) {
    const Errors found = errors_of(vibrating(GetParam(), steps * step));
    EXPECT_LT(found.last, 1.5 * found.before + (steps < 100 ? 1e-12 : 1.62 / 100)) << steps;
    EXPECT_GE(found.least_step, (1 - (steps < 100 ? 1e-9 : 0.0101)) * found.largest_step) << steps;
  }
}

INSTANTIATE_TEST_SUITE_P(EachKind, LastSteps, testing::ValuesIn(deformable_kinds),
                         [](const auto& kind) { return std::string(name_of_kind(kind.param)); });

// ---- the size alone

/// Steps to the end under a bound of each time. \return their sizes
std::vector<double> step_sizes(StepControl control, const std::function<double(double)>& bound) {
  std::vector<double> sizes;
  double time = 0;
  while (control.settings.end - time > 1e-12 * control.settings.end && sizes.size() < 100000) {
    const double step = whole_step(control, bound(time), control.settings.end - time);
    sizes.push_back(step);
    time += step;
  }
  EXPECT_NEAR(time, control.settings.end, 1e-11 * control.settings.end);
  return sizes;
}

TEST(WholeStep, UnderAConstantBoundIsOneAndTheSame) {
  for (const double end : {1.0, 0.999999, 1.0000001, 3.7, 41.3, 500.0}) {
    StepControl control;
    control.settings.end = end;
    const std::vector<double> sizes = step_sizes(control, [](double) { return 0.1; });
    EXPECT_EQ(static_cast<double>(sizes.size()), std::ceil(end / 0.1 * (1 - 1e-9))) << end;
    for (const double size : sizes) {
      EXPECT_LE(size, 0.1 * (1 + 1e-8));
      EXPECT_NEAR(size, sizes[0], 1e-8);
    }
  }
}

TEST(WholeStep, ThatDividesTheEndKeepsItsBits) {
  StepControl control;
  control.settings.end = 2e-3;
  EXPECT_EQ(whole_step(control, 1e-5, 2e-3), 1e-5);
  EXPECT_EQ(whole_step(control, 1e-5, 2e-3 - 1e-5), 1e-5);
}

// A bound that falls by little at every step shortens steps a little, down to the last.
TEST(WholeStep, UnderABoundThatFallsGoesDownGently) {
  StepControl control;
  control.settings.end = 1;
  const auto bound = [](double time) { return 1e-3 * (1 - 0.3 * time); };
  const std::vector<double> sizes = step_sizes(control, bound);
  double time = 0;
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    EXPECT_LE(sizes[i], 1.011 * bound(time));
    if (i > 0) {
      EXPECT_GE(sizes[i], 0.97 * sizes[i - 1]);
    }
    time += sizes[i];
  }
}

// A bound that falls by rounding at the end costs no step more.
TEST(WholeStep, NearTheEndDoesNotFollowSmallChanges) {
  StepControl control;
  control.settings.end = 1;
  const std::vector<double> sizes = step_sizes(control, [](double time) { return 0.1 * (1 - 1e-3 * time); });
  EXPECT_EQ(sizes.size(), 10U);
  for (const double size : sizes) EXPECT_NEAR(size, 0.1, 1e-12);
}

// Where the bound is the stable step itself, nothing may exceed it.
TEST(WholeStep, NeverExceedsABoundWithoutAMargin) {
  StepControl control;
  control.settings.end = 1;
  control.settings.step_scale = 1;
  const auto bound = [](double time) { return 0.1 * (1 - 0.05 * time); };
  const std::vector<double> sizes = step_sizes(control, bound);
  double time = 0;
  for (const double size : sizes) {
    EXPECT_LE(size, bound(time) * (1 + 1e-8));
    time += size;
  }
}

TEST(WholeStep, OfAnEndThatIsTooFarIsTheBound) {
  StepControl control;
  control.settings.end = 1e300;
  EXPECT_EQ(whole_step(control, 1e-20, 1e300), 1e-20);
}

}  // namespace
}  // namespace brio
