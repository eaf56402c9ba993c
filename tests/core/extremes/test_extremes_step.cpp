// A free element just below and just above its critical step.

#include <gtest/gtest.h>

#include "src/base/index.hpp"
#include "tests/core/extremes/extremes.hpp"

namespace brio {
namespace {

using namespace test;

/// One element of a kind, or the least block of particles, without viscosity.
Part single(Kind kind) {
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
  return part;
}

Deck single_element(Kind kind) {
  Deck deck;
  deck.materials = {{"material", elastic(0.3)}};
  deck.parts = {single(kind)};
  deck.time.end = 1e3;
  return deck;
}

/// A motion at a millionth of the speed of sound, in every mode.
void stir(Model& model) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> any(-1e-3, 1e-3);
  for (NodeRecord& node : model.nodes.record)
    for (double& component : node.velocity) component = any(random);
  for (std::size_t i = 0; i < (model.nodes.has_rotations() ? model.nodes.size() : 0); ++i)
    for (int axis = 0; axis < 3; ++axis) model.nodes.angular_velocity[i].component[axis] = any(random);
}

double first_energy(Model& model, ThreadTeam& team) {
  stir(model);
  update_velocities(model, 1e9, team);
  model.energy.kinetic_start = model.energy.kinetic_half;
  return model.energy.kinetic_half;
}

class ExtremesStep : public testing::TestWithParam<Kind> {};

// An oscillation sampled at omega dt / 2 = 0.99 from its start at rest peaks at v0^2 / (1 - 0.99^2) = 50
// v0^2.
TEST_P(ExtremesStep, StaysBoundedJustBelowTheCriticalOne) {
  const FloatingPointTraps traps;
  Deck deck = single_element(GetParam());
  deck.time.step_scale = 0.99;
  Model model = build_model(deck);
  ThreadTeam team(1);
  const double start = first_energy(model, team);
  double largest = 0;
  look_at_steps(model, 5001, 1e-2, team,
                [&](int) { largest = std::max(largest, model.energy.kinetic_half); });
  EXPECT_LT(largest, 60 * start);
}

TEST_P(ExtremesStep, AboveTheBoundIsRefusedByName) {
  const FloatingPointTraps traps;
  Deck deck = single_element(GetParam());
  Model probe = build_model(deck);
  ThreadTeam team(1);
  update_velocities(probe, 1, team);
  deck.time.step = 1.01 * probe.control.stable;
  Model model = build_model(deck);
  try {
    run(model, deck, team);
    FAIL() << "ran";
  } catch (const Breakdown& breakdown) {
    const std::string text = breakdown.what();
    EXPECT_NE(text.find("exceeds the stable time step"), std::string::npos) << text;
    EXPECT_NE(text.find(" of part 'body'"), std::string::npos) << text;
  }
}

// The bound is made too large by hand, as a defect of it would, until a run ends.
struct Unstable {
  double growth = 0;  ///< of the kinetic energy
  std::string cause;
};
Unstable run_above(Kind kind, double share) {
  Deck deck = single_element(kind);
  deck.time.step_scale = 1;
  Model model = build_model(deck);
  model.ties.step_share = share;
  ThreadTeam team(1);
  const double start = first_energy(model, team);
  Unstable result;
  try {
    look_at_steps(model, 10001, deck.numerics.energy_error_limit, team,
                  [&](int) { result.growth = std::max(result.growth, model.energy.kinetic_half / start); });
  } catch (const Breakdown& breakdown) {
    result.cause = breakdown.what();
  }
  return result;
}

// Bounds that are not those of the element itself are below it by some hundredths.
TEST_P(ExtremesStep, JustAboveTheCriticalOneMotionGrowsAMillionfold) {
  const FloatingPointTraps traps;
  const std::array<double, 5> share{1.01, 1.01, 1.02, 1.01, 1.06};
  EXPECT_GT(run_above(GetParam(), share[index(GetParam())]).growth, 1e6);
}

// A beam that is stretched by a hundredth swings slower by that: at 1.01 of its critical step its motion
// grows so far and no further, and energy balances. From 1.06 on every kind ends.
TEST_P(ExtremesStep, AboveTheCriticalOneTheEnergyBalanceStopsTheRun) {
  const FloatingPointTraps traps;
  const bool grows_without_end = GetParam() == Kind::hex8 || GetParam() == Kind::hex8_full;
  const Unstable result = run_above(GetParam(), grows_without_end ? 1.01 : 1.06);
  EXPECT_NE(result.cause.find("the energy error"), std::string::npos) << "ended by: " << result.cause;
}

INSTANTIATE_TEST_SUITE_P(EachKind, ExtremesStep, testing::ValuesIn(deformable_kinds),
                         [](const auto& kind) { return std::string(name_of_kind(kind.param)); });

}  // namespace
}  // namespace brio
