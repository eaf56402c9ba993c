// Deletion of elements: their order, energy balance, and free nodes.

#include "src/sweep/erosion.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <set>

#include "src/base/index.hpp"
#include "src/output/observe.hpp"
#include "tests/contact/allocation_count.hpp"
#include "tests/core/output/snapshot_parts.hpp"
#include "tests/core/sweep/erosion_scene.hpp"

namespace brio {
namespace {

using namespace test;

TEST(Erosion, ElementGoesWhenItsDamageHasReachedTheBound) {
  constexpr double failure_strain = 0.02, opening = 0.05;
  Deck deck = stretched_bar(1, brittle(failure_strain, opening), 1);
  Model model = build_model(deck);
  const double shear = 1e9 / 2.6;
  const double start = ((3 * shear + hardening) * failure_strain + yield) / (2 * shear);
  ThreadTeam team(1);
  double time_of_death = 0, damage = 0, internal = 0;
  run(model, deck, team, [&](Model& m) {
    if (!m.erosion->deleted.empty()) {
      time_of_death = m.times.time;
      return;
    }
    if (m.erosion->total_deleted() > 0) return;
    damage = m.blocks[0].kernel.sample(m.blocks[0], m.nodes, 0, true).named("damage");
    internal = m.energy.internal;
    const double strain = std::log(1 + m.times.time);
    ASSERT_NEAR(damage, std::max(strain - start, 0.0) / opening, 1e-3);
  });
  const double step = model.control.largest;
  EXPECT_NEAR(std::log(1 + time_of_death), start + 0.9 * opening, 2 * step);
  EXPECT_GT(damage, 0.85);
  EXPECT_LT(damage, 0.9);
  EXPECT_EQ(model.erosion->total_deleted(), 1);
  EXPECT_EQ(model.erosion->deleted_by_cause, (CountByCause{1, 0, 0}));
  EXPECT_EQ(model.blocks[0].element_count, 0u);
  EXPECT_EQ(model.parts[0].element_slot[0], -1);
  // Everything that the element had received is deleted, to the last half step.
  EXPECT_NEAR(model.energy.deleted, internal, 0.01 * internal);
  EXPECT_NEAR(model.energy.internal, 0, 1e-12 * model.energy.deleted);
  EXPECT_NEAR(model.energy.hourglass, 0, 1e-12 * model.energy.deleted);
  EXPECT_LT(model.energy.error_max, 1e-4);
}

TEST(Erosion, NothingGoesInCompression) {
  Deck deck = stretched_bar(2, brittle(0.02, 0.05), -1);
  Model model = build_model(deck);
  const Outcome outcome = run_all(model, deck);
  EXPECT_TRUE(outcome.deaths.empty());
  EXPECT_GT(
      model.blocks[0].kernel.sample(model.blocks[0], model.nodes, 0, true).named("equivalent_plastic_strain"),
      0.1);
}

// Half of the last step's work no longer acts and is subtracted: it is 0.6 % of the energy of the element.
TEST(Erosion, EnergyErrorDoesNotFeelADeletionUnderFullStress) {
  for (const Element& element : {Element(inviscid_hex8()), Element(Hex8{}), Element(Hex8Full{})}) {
    Deck deck = pulled_bar(1, tough(), 2);
    deck.parts[0].element = element;
    deck.parts[0].deletion.emplace();
    deck.parts[0].deletion->plastic_strain = 0.1;
    Model model = build_model(deck);
    ThreadTeam team(1);
    double before = 0, jump = HUGE_VAL;
    run(model, deck, team, [&](Model& m) {
      const double error = m.energy.sum() - m.energy.kinetic_start - m.energy.external.at_step();
      if (!m.erosion->deleted.empty()) jump = std::abs(error - before);
      before = error;
    });
    EXPECT_LT(jump, 1e-4 * model.energy.deleted) << name_of(element);
    EXPECT_EQ(model.erosion->deleted_by_cause, (CountByCause{0, 1, 0})) << name_of(element);
  }
}

TEST(Erosion, AllElementsDeletedAtOnceLeaveDebrisThatFliesOn) {
  constexpr int elements = 20;  // three packs
  Deck deck = stretched_bar(elements, brittle(0.02, 0.05), 1);
  Model model = build_model(deck);
  const double mass = total_mass(model);
  const Outcome outcome = run_all(model, deck);
  ASSERT_EQ(outcome.deaths.size(), index(elements));
  for (int e = 0; e < elements; ++e) {
    EXPECT_EQ(outcome.deaths[index(e)].step, outcome.deaths[0].step);
    EXPECT_EQ(outcome.deaths[index(e)].element, (DeletedElement{0, e}));
  }
  EXPECT_EQ(model.times.time, deck.time.end);
  EXPECT_NEAR(total_mass(model), mass, 1e-12 * mass);
  EXPECT_NEAR(mass_balance(*model.erosion, model.nodes).debris, mass, 1e-12 * mass);
  EXPECT_NEAR(model.erosion->mass_of_deleted, mass, 1e-12 * mass);
  EXPECT_LT(outcome.worst_error, 1e-3);
}

TEST(Erosion, FreedNodesAreThoseWhoseLastElementWent) {
  Deck deck = pulled_bar(3, tough());
  deck.time.end = 1e-3;
  deck.parts[0].deletion.emplace();
  deck.parts[0].deletion->plastic_strain = 1;
  Model model = build_model(deck);
  ThreadTeam team(1);
  update_velocities(model, 1, team);
  const auto give_up = [&](int element) {
    std::vector<SweepResult> results(model.schedule.tasks.size());
    results[0].lost = 1;
    model.blocks[0].lost[0] = model.parts[0].element_slot[index(element)];
    model.energy += erode(*model.erosion, model.schedule, results, model.blocks, model.parts);
    std::set<double> planes;
    for (int node : model.erosion->freed)
      planes.insert(std::round(model.nodes.record[index(node)].position[0]));
    return planes;
  };
  EXPECT_EQ(give_up(1), std::set<double>{});
  EXPECT_EQ(give_up(0), (std::set<double>{0, 1}));
  EXPECT_EQ(model.erosion->freed.size(), 8u);
  EXPECT_EQ(give_up(2), (std::set<double>{2, 3}));
  EXPECT_EQ(model.blocks[0].element_count, 0u);
}

TEST(Erosion, SameOrderAndSameBitsForAnyNumberOfThreads) {
  const Deck deck = torn_block();
  Model first = build_model(deck);
  const Outcome expected = run_all(first, deck, 1);
  EXPECT_GT(expected.deaths.size(), 60u);
  EXPECT_LT(expected.deaths.size(), 729u);
  EXPECT_GT(first.schedule.tasks.size(), 5u);
  for (const int threads : {2, 4}) {
    Model model = build_model(deck);
    const Outcome outcome = run_all(model, deck, threads);
    EXPECT_EQ(outcome.deaths, expected.deaths);
    EXPECT_EQ(std::memcmp(outcome.positions.data(), expected.positions.data(),
                          expected.positions.size() * sizeof(double)),
              0);
    EXPECT_EQ(model.energy.deleted, first.energy.deleted);
  }
}

TEST(Erosion, MassMomentumAndEnergyOfATornBlockAreKept) {
  for (const FreeNodes free_nodes : {FreeNodes::keep, FreeNodes::drop}) {
    Deck deck = torn_block(free_nodes);
    Gravity gravity;
    gravity.acceleration = {0, 0, -200};
    deck.loads = {gravity};
    Model model = build_model(deck);
    const double mass = total_mass(model);
    const Outcome outcome = run_all(model, deck);
    Deck whole = deck;
    whole.materials[0].second = brittle(1e9, 1);
    Model unbroken = build_model(whole);
    const double error_without = run_all(unbroken, whole).worst_error;
    EXPECT_GT(model.energy.deleted, 0.01 * model.energy.reference);
    EXPECT_NEAR(total_mass(model), mass, 1e-12 * mass);
    EXPECT_LT(outcome.worst_error, 1.1 * error_without + 1e-4);
    std::vector<double> row;
    observe_history(model, row);
    EXPECT_LT(model.momentum.linear_imbalance(), 1e-12);
    EXPECT_LT(model.momentum.angular_imbalance(), 1e-12);
    const Summary summary = observe_end(model);
    EXPECT_EQ(summary.elements["hex8"], 729 + 27);
    EXPECT_EQ(summary.deleted["hex8"], static_cast<std::int64_t>(outcome.deaths.size()));
    EXPECT_NEAR(summary.mass.intact + summary.mass.debris + summary.mass.deleted, summary.mass.start,
                1e-12 * mass);
    EXPECT_EQ(summary.mass.deleted > 0, free_nodes == FreeNodes::drop);
    EXPECT_EQ(summary.mass.debris > 0, free_nodes == FreeNodes::keep);
  }
}

// What nobody else touches moves in straight lines whether it is counted as debris or as deleted.
TEST(Erosion, DroppedNodesDoNotChangeTheRest) {
  const Deck keeps = torn_block(FreeNodes::keep), drops = torn_block(FreeNodes::drop);
  Model kept = build_model(keeps), dropped = build_model(drops);
  const Outcome a = run_all(kept, keeps), b = run_all(dropped, drops);
  EXPECT_EQ(a.deaths, b.deaths);
  std::size_t gone = 0;
  for (std::size_t node = 0; node < kept.nodes.size(); ++node) {
    if (dropped.nodes.mass[node] == 0) {
      ++gone;
      continue;
    }
    for (int i = 0; i < 3; ++i)
      ASSERT_EQ(kept.nodes.record[node].position[i], dropped.nodes.record[node].position[i]);
  }
  EXPECT_GT(gone, 0u);
  EXPECT_NEAR(kept.energy.sum(), dropped.energy.sum(), 1e-12 * kept.energy.sum());
}

TEST(Erosion, WhatIsSweptFallsAsElementsDie) {
  const Deck deck = torn_block();
  Model model = build_model(deck);
  ThreadTeam team(1);
  std::int64_t living = 756, updates = 0;
  run(model, deck, team, [&](Model& m) {
    ASSERT_EQ(m.element_updates - updates, living);
    updates = m.element_updates;
    living -= static_cast<std::int64_t>(m.erosion->deleted.size());
    std::size_t packs = 0, needed = 0;
    for (const SweepTask& task : m.schedule.tasks) packs += (task.chunk.element_count + 7) / 8;
    for (const Block& block : m.blocks) needed += (block.element_count + 7) / 8;
    ASSERT_LE(3 * packs, 4 * needed);
  });
  EXPECT_LT(living, 700);
}

// The middle of three cubes is deleted; the outer ones separate, rotating and vibrating without damping.
void expect_stable_debris(std::int64_t steps) {
  Deck deck = pulled_bar(3, brittle(0.01, 0.02));
  deck.boundary_conditions.clear();
  const Vector3d velocity[] = {{-20, 1, 0}, {-19, 0, 0.5}, {20, 0, 2}, {20.5, 0.5, 1}};
  for (int plane = 0; plane < 4; ++plane) {
    InitialCondition condition = moving("", velocity[plane]);
    condition.where.region = BoxRegion{{plane - 0.25, -1, -1}, {plane + 0.25, 1, 1}};
    deck.initial_conditions.push_back(condition);
  }
  deck.time.end = 1e9;
  Model model = build_model(deck);
  ThreadTeam team(1);
  make_steps(model, 0, 0.01, team);
  delete_by_hand(model, 0, [](int element) { return element == 1; });
  make_steps(model, steps, 0.01, team);
  EXPECT_EQ(model.erosion->deleted_count[0], 1);
  EXPECT_EQ(model.parts[0].element_slot[1], -1);
  EXPECT_LT(model.energy.error_max, 1e-4);
  EXPECT_GT(model.control.least, 0.9 * model.control.first);
  std::vector<double> row;
  observe_history(model, row);
  EXPECT_LT(model.momentum.linear_imbalance(), 1e-11);
}
TEST(Erosion, FreeHexahedraLeftOverFlyStably) { expect_stable_debris(10000); }
TEST(ErosionSlow, FreeHexahedraLeftOverFlyStablyForAHundredThousandSteps) { expect_stable_debris(100000); }

TEST(Erosion, NothingIsKeptWhereNothingCanBeDeleted) {
  Deck deck = pulled_bar(2, tough());
  Model model = build_model(deck);
  EXPECT_FALSE(model.erosion.has_value());
  EXPECT_TRUE(model.blocks[0].held.empty());
  EXPECT_TRUE(model.blocks[0].lost.empty());
  deck.materials[0].second = brittle(1, 1);
  const Model failing = build_model(deck);
  EXPECT_TRUE(failing.erosion.has_value());
  EXPECT_EQ(failing.blocks[0].pack_bytes, model.blocks[0].pack_bytes + 3 * 64);
}

TEST(Erosion, ResultsShowTheElementsThatLive) {
  Deck deck = torn_block();
  Model model = build_model(deck);
  FieldObserver observer(model);
  const Snapshot start = observer.observe(model);
  EXPECT_EQ(start.topology.cell_type.size(), 756u);
  ThreadTeam team(1);
  run(model, deck, team);
  const Snapshot& end = observer.observe(model);
  const std::size_t living = model.blocks[0].element_count + 27;
  EXPECT_NE(end.topology_version, start.topology_version);
  EXPECT_EQ(end.topology.cell_type.size(), living);
  EXPECT_EQ(end.points.size(), start.points.size());
  EXPECT_LT(end.parts[0].cells, start.parts[0].cells);
  EXPECT_EQ(end.parts[1].cells, 27);
  expect_parts_hold_their_cells(end);
  const auto values = [&](const std::string& name) {
    for (const FieldArray& field : end.cell_fields)
      if (field.name == name) return field.values;
    ADD_FAILURE() << name;
    return std::vector<double>();
  };
  const std::vector<double> damage = values("damage"), id = values("element_id"), part = values("part");
  ASSERT_EQ(damage.size(), living);
  for (std::size_t cell = 0; cell < living; ++cell) {
    EXPECT_LT(damage[cell], 0.9);
    if (part[cell] == 0) {
      EXPECT_GE(model.parts[0].element_slot[static_cast<std::size_t>(id[cell])], 0);
    }
  }
  EXPECT_GT(*std::max_element(damage.begin(), damage.end()), 0.0);
  // Cells still join the corners of their elements.
  const auto corner = index(end.topology.connectivity[8 * 5 + 3]);
  const auto place = static_cast<std::size_t>(model.parts[0].element_slot[static_cast<std::size_t>(id[5])]);
  const auto node = index(model.blocks[0].node(place, 3));
  EXPECT_EQ(end.points[3 * corner], model.nodes.record[node].position[0]);
}

TEST(Erosion, StepAllocatesNothingWhileElementsDie) {
  Deck deck = torn_block();
  Model model = build_model(deck);
  ThreadTeam team(2);
  std::size_t allocations = 0, deaths = 0;
  while (deaths < 40) {
    const std::size_t tasks = model.schedule.tasks.size();
    const AllocationCount count;
    make_steps(model, 1, 1, team);
    const std::size_t now = count.count();
    if (model.step > 3 && model.schedule.tasks.size() == tasks) allocations += now;
    deaths += model.erosion->deleted.size();
  }
  EXPECT_EQ(allocations, 0u);
}

}  // namespace
}  // namespace brio
