// Number and cost of steps, predicted from a timed run, and from a coarse run where the time step decreases.

#include <gtest/gtest.h>

#include <cmath>

#include "src/base/index.hpp"
#include "src/forecast/coarser.hpp"
#include "src/forecast/forecast.hpp"
#include "src/forecast/memory.hpp"
#include "src/output/output_schedule.hpp"
#include "tests/core/scene.hpp"

namespace brio {
namespace {

using namespace test;

// Two bars that meet and part; their step hardly changes.
Deck bars() {
  Deck deck;
  deck.materials = {{"material", elastic()}};
  deck.parts = {box("left", {1, 0.1, 0.1}, {10, 1, 1}, {-0.5, 0, 0}, hex8()),
                box("right", {1, 0.1, 0.1}, {10, 1, 1}, {0.5, 0, 0}, hex8())};
  deck.initial_conditions = {moving("left", {1, 0, 0}), moving("right", {-1, 0, 0})};
  deck.contact.emplace();
  deck.time.end = 0.02;
  return deck;
}

Model started(const Deck& deck, ThreadTeam& team) {
  Model model = build_model(deck);
  update_velocities(model, deck.numerics.energy_error_limit, team);
  return model;
}

TEST(Forecast, ConstantStepsAreForecastFromTheFirst) {
  const Deck deck = bars();
  ThreadTeam team(1);
  Model whole = build_model(deck);
  run(whole, deck, team);
  Model model = started(deck, team);
  TimedRun few;
  continue_run(few, model, 0.1, 0, team);
  ASSERT_EQ(few.steps.size(), 1u);
  const StepForecast forecast = forecast_steps(few, deck.time.end);
  EXPECT_FALSE(forecast.exact);
  EXPECT_EQ(forecast.most, 0);
  EXPECT_NEAR(forecast.steps, static_cast<double>(whole.step), 0.05 * static_cast<double>(whole.step));
}

TEST(Forecast, ATimedRunToTheEndIsTheRun) {
  const Deck deck = bars();
  ThreadTeam team(1);
  Model whole = build_model(deck);
  run(whole, deck, team);
  Model model = started(deck, team);
  TimedRun all;
  continue_run(all, model, 0.1, 0, team);
  continue_run(all, model, 0.1, 1e9, team);
  EXPECT_TRUE(all.reached_end);
  EXPECT_EQ(all.steps.size(), index(whole.step));
  const StepForecast forecast = forecast_steps(all, deck.time.end);
  EXPECT_TRUE(forecast.exact);
  EXPECT_EQ(forecast.steps, static_cast<double>(whole.step));
  for (std::size_t i = 0; i < whole.nodes.size(); ++i)
    for (int axis = 0; axis < 3; ++axis)
      EXPECT_EQ(model.nodes.record[i].position[axis], whole.nodes.record[i].position[axis]);
  continue_run(all, model, 0.1, 1e9, team);
  EXPECT_EQ(all.steps.size(), index(whole.step));
}

TEST(Forecast, ABreakdownEndsATimedRunAndIsNamed) {
  Deck deck = bars();
  ThreadTeam team(1);
  Model model = started(deck, team);
  TimedRun broken;
  continue_run(broken, model, 1e-300, 1e9, team);
  EXPECT_FALSE(broken.reached_end);
  EXPECT_NE(broken.breakdown.find("energy"), std::string::npos) << broken.breakdown;
}

// A timed run whose time step decreases as exp(-depth * ramp), the ramp rising from 0 to 1 by half of the
// time.
TimedRun falling(double first, double depth, double until, double seconds) {
  TimedRun run;
  while (run.time < until) {
    const double size = first * std::exp(-depth * std::min(1.0, 2 * run.time));
    run.steps.push_back({run.time, size, seconds * (1 + run.time), 0});
    run.time += size;
  }
  run.reached_end = until >= 1;
  return run;
}

TEST(Forecast, TheDecreaseInACoarseRunIsScaledByItsRatio) {
  const CoarseRun coarse{2, falling(1e-2, 2, 1, 1e-6)};
  const TimedRun own = falling(4e-3, 3, 0.4, 1e-5);
  const TimedRun truth = falling(4e-3, 3, 1, 1e-5);
  // The usual ratio, of weight 0.1, moves it a little from 1.5.
  const double seen = 4 * 4 * std::pow(0.4, 3) / 3;
  const double ratio = decrease_ratio(own, coarse.run, 1.3, 1);
  EXPECT_NEAR(ratio, (0.1 * 1.3 + 1.5 * seen) / (0.1 + seen), 0.01);
  EXPECT_NEAR(decrease_ratio(own, coarse.run, 1.5, 1), 1.5, 0.01);
  const StepForecast forecast = forecast_steps(own, coarse, 1);
  EXPECT_GT(forecast.decrease_ratio, 1.4);
  EXPECT_NEAR(forecast.steps, static_cast<double>(truth.steps.size()), 0.08 * forecast.steps);
  EXPECT_NEAR(forecast.seconds, truth.seconds(), 0.1 * truth.seconds());
  EXPECT_LT(forecast.least, static_cast<double>(truth.steps.size()));
  EXPECT_GT(forecast.most, static_cast<double>(truth.steps.size()));
  EXPECT_LT(forecast_steps(own, 1).steps, 0.7 * forecast.steps);
  const StepForecast best = forecast_steps(own, coarse.run, {1.5, 1}, 1);
  EXPECT_NEAR(best.steps, static_cast<double>(truth.steps.size()), 0.01 * best.steps);
  EXPECT_NEAR(best.seconds, truth.seconds(), 0.02 * truth.seconds());
}

TEST(Forecast, WithoutEvidenceTheRatioIsUsual) {
  const TimedRun coarse = falling(1e-3, 1, 1, 1e-6);
  const TimedRun own = falling(4e-4, 1.4, 0.001, 1e-5);  // too short to show anything
  EXPECT_NEAR(decrease_ratio(own, coarse, 1.4, 1), 1.4, 1e-6);
  EXPECT_NEAR(forecast_steps(own, CoarseRun{4, coarse}, 1).decrease_ratio, std::pow(4, 0.4), 1e-6);
}

// A decrease that the coarse run does not show decays.
TEST(Forecast, WhatTheCoarseRunMissedFades) {
  const TimedRun coarse = falling(1e-3, 0, 1, 1e-6);
  const TimedRun own = falling(4e-4, 1, 0.5, 1e-5);
  const double start = own.time, first = own.steps.front().size;
  const double missed = std::log(first / own.steps.back().size), lasting = 0.3;
  double steps = static_cast<double>(own.steps.size());
  constexpr int pieces = 10000;
  for (int i = 0; i < pieces; ++i)
    steps += (1 - start) / pieces / first *
             std::exp(missed * std::exp(-(1 - start) * (i + 0.5) / pieces / lasting));
  EXPECT_NEAR(forecast_steps(own, coarse, {1, lasting}, 1).steps, steps, 1e-3 * steps);
}

// A coarse run of constant step, where that of the scene has decreased, predicts little.
TEST(Forecast, ACoarseRunThatMissedTheDecreaseHasLessWeight) {
  const TimedRun coarse = falling(1e-3, 0, 1, 1e-6);
  const TimedRun own = falling(4e-4, 1, 0.5, 1e-5);
  const double stays = forecast_steps(own, 1).steps, read = forecast_steps(own, coarse, {1, 0.5}, 1).steps;
  const double doubt = 1 / 1.01;
  const double expected = std::pow(read, 1 - doubt) * std::pow(stays, doubt);
  EXPECT_NEAR(forecast_steps(own, CoarseRun{1, coarse}, 1).steps, expected, 2e-3 * expected);
  EXPECT_GT(std::abs(read / stays - 1), 0.05);
}

// Contact makes steps of a coarse run relatively more expensive than those of the scene, which has more
// elements.
TEST(Forecast, CostGrowsByWhatItWasSeenToGrow) {
  TimedRun coarse = falling(1e-3, 0, 1, 0), same = falling(4e-4, 0, 0.5, 0), as_coarse_run = same;
  for (TimedStep& step : coarse.steps) step.seconds = 1e-6 * (1 + 20 * step.time);
  for (TimedStep& step : same.steps) step.seconds = 1e-5;
  for (TimedStep& step : as_coarse_run.steps) step.seconds = 1e-5 * (1 + 20 * step.time);
  const double steps = 2500, all_as_coarse_run = 1e-5 * steps * 11;
  EXPECT_NEAR(forecast_steps(as_coarse_run, coarse, {1, 1}, 1).seconds, all_as_coarse_run,
              0.02 * all_as_coarse_run);
  const double seconds = forecast_steps(same, coarse, {1, 1}, 1).seconds;
  EXPECT_GT(seconds, 1e-5 * steps);
  EXPECT_LT(seconds, 1.2 * 1e-5 * steps) << "in proportion it would be 1.8";
}

TEST(Forecast, ACoarseRunOfConstantStepChangesNothing) {
  const CoarseRun coarse{2, falling(1e-3, 0, 1, 1e-6)};
  const TimedRun own = falling(4e-4, 0, 0.2, 1e-5);
  const double steps = forecast_steps(own, 1).steps;
  EXPECT_NEAR(forecast_steps(own, coarse, 1).steps, steps, 1e-6 * steps);
}

TEST(Forecast, WhereElementsAreDeletedTheStepMayComeBack) {
  CoarseRun coarse{2, falling(1e-3, 0.5, 1, 1e-6)};
  const TimedRun own = falling(4e-4, 1.2, 0.6, 1e-5);
  const double without = forecast_steps(own, coarse, 1).steps;
  coarse.run.steps.back().deleted = 1;
  const StepForecast forecast = forecast_steps(own, coarse, 1);
  EXPECT_LT(forecast.steps, 0.9 * without);
  EXPECT_GE(forecast.most, without);
  EXPECT_GT(forecast.steps, forecast.least);
}

TEST(Coarser, ElementsBecomeLongerAndShapesStay) {
  Deck deck;
  deck.materials = {{"material", elastic()}};
  RodMesh rod{.radius = 1, .length = 5, .elements = {12, 60}};
  ParticleMesh thin, thick;
  thin.box = {{1, 1, 0.2}, 0.1};
  thick.box = {{1, 1, 1}, 0.1};
  deck.parts = {box("slab", {8, 8, 1}, {8, 8, 1}, {0, 0, 0}, hex8()),
                {"rod", rod, {}, hex8(), "material"},
                {"thin", thin, {}, Particle{}, "material"},
                {"thick", thick, {}, Particle{}, "material"}};
  const Deck coarse = coarser(deck, 2);
  EXPECT_EQ(std::get<BoxMesh>(coarse.parts[0].mesh).elements, (std::array<int, 3>{4, 4, 1}));
  EXPECT_EQ(std::get<BoxMesh>(coarse.parts[0].mesh).size, (Vector3d{8, 8, 1}));
  EXPECT_EQ(std::get<RodMesh>(coarse.parts[1].mesh).elements, (std::array<int, 2>{6, 30}));
  EXPECT_EQ(std::get<ParticleMesh>(coarse.parts[2].mesh).box->spacing, 0.1);
  EXPECT_EQ(std::get<ParticleMesh>(coarse.parts[3].mesh).box->spacing, 0.2);
}

TEST(OutputSchedule, CountsHowOftenItIsDue) {
  const auto stepped = [](OutputSchedule schedule, double end) {
    double count = 0;
    constexpr int steps = 10007;
    for (int i = 0; i <= steps; ++i) count += schedule.due(end * i / steps) || i == steps;
    return count;
  };
  for (const double interval : {0.1, 0.3, 0.25, 1.0, 7.0})
    EXPECT_EQ(OutputSchedule::every(interval).count(1), stepped(OutputSchedule::every(interval), 1))
        << interval;
  for (const std::vector<double>& times : {std::vector{0.0, 0.5}, {0.2, 0.1, 0.2, 1.0}, {2.0}})
    EXPECT_EQ(OutputSchedule::at(times).count(1), stepped(OutputSchedule::at(times), 1));
}

TEST(Memory, OfAnObjectIsThatOfACopy) {
#if defined(__SANITIZE_ADDRESS__)
  GTEST_SKIP() << "the sanitizer has an allocator of its own";
#endif
  const std::vector<double> list(100000);
  const std::size_t bytes = bytes_held(list);
  EXPECT_GE(bytes, 800000u);
  EXPECT_LT(bytes, 820000u);
}

}  // namespace
}  // namespace brio
