// Deletion of elements: when, in which order, what the books say, and how much is touched.

#include "src/erosion.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <set>

#include "src/observe.hpp"
#include "tests/contact/allocation_count.hpp"
#include "tests/core/scene.hpp"

namespace brio {
namespace {

using namespace test;

constexpr double yield = 1e6;
constexpr double hardening = 1e7;

ElasticPlastic tough() {
  return {.density = 1000,
          .youngs_modulus = 1e9,
          .poissons_ratio = 0.3,
          .yield_stress = yield,
          .hardening_modulus = hardening};
}
ElasticPlastic brittle(double strain, double opening) {
  ElasticPlastic law = tough();
  law.failure.emplace();
  law.failure->strain = strain;
  law.failure->opening_strain = opening;
  return law;
}

PrescribedMotion pull(std::string set, int axis, double velocity) {
  PrescribedMotion motion;
  motion.where.set = std::move(set);
  motion.components.push_back({axis, Curve{{{0, velocity}}}});
  return motion;
}

// Cubes of edge 1 along x, held at one end and pulled at the other.
Deck pulled_bar(int elements, const Material& material, double velocity = 1) {
  Deck deck;
  deck.materials = {{"material", material}};
  deck.parts = {
      box("bar", {1.0 * elements, 1, 1}, {elements, 1, 1}, {0.5 * elements, 0, 0}, inviscid_hex8())};
  deck.boundary_conditions = {pull("bar.xmin", 0, 0), pull("bar.xmax", 0, velocity)};
  deck.time.end = 0.2;
  return deck;
}

// Every node follows the same affine motion: uniaxial strain, all elements alike.
Deck stretched_bar(int elements, const Material& material, double rate) {
  Deck deck = pulled_bar(elements, material);
  deck.boundary_conditions = {fix("bar.all", {1, 2})};
  for (int i = 0; i <= elements; ++i) {
    PrescribedMotion motion = pull("", 0, rate * i);
    motion.where.region = BoxRegion{{i - 0.25, -9, -9}, {i + 0.25, 9, 9}};
    deck.boundary_conditions.push_back(motion);
  }
  return deck;
}

struct Death {
  std::int64_t step;
  DeletedElement element;
  friend bool operator==(const Death&, const Death&) = default;
};

struct Outcome {
  std::vector<Death> deaths;
  std::vector<double> positions;
  double worst_error = 0;
};

Outcome run_all(Model& model, const Deck& deck, int threads = 1) {
  ThreadTeam team(threads);
  Outcome outcome;
  run(model, deck, team, [&](Model& m) {
    for (const DeletedElement& element : m.erosion->deleted) outcome.deaths.push_back({m.step, element});
    outcome.worst_error = std::max(outcome.worst_error, std::abs(m.energy.relative_error()));
  });
  for (const NodeRecord& record : model.nodes.record)
    outcome.positions.insert(outcome.positions.end(), record.position, record.position + 3);
  return outcome;
}

double total_mass(const Model& model) {
  const MassBalance balance = mass_balance(*model.erosion, model.nodes);
  return balance.intact + balance.debris + model.erosion->dropped_mass;
}

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
    damage = m.blocks[0].kernel.sample(m.blocks[0], m.nodes, 0).damage;
    internal = m.energy.internal;
    const double strain = std::log(1 + m.times.time);
    ASSERT_NEAR(damage, std::max(strain - start, 0.0) / opening, 1e-3);
  });
  const double step = model.control.largest;
  EXPECT_NEAR(std::log(1 + time_of_death), start + 0.9 * opening, 2 * step);
  EXPECT_GT(damage, 0.85);
  EXPECT_LT(damage, 0.9);
  EXPECT_EQ(model.erosion->total_deleted(), 1);
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
  EXPECT_GT(model.blocks[0].kernel.sample(model.blocks[0], model.nodes, 0).equivalent_plastic_strain, 0.1);
}

// Half of the last step's work no longer acts and is taken back: it is 0.6 % of what the element holds.
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
  }
}

TEST(Erosion, AllElementsDeletedAtOnceLeaveDebrisThatFliesOn) {
  constexpr int elements = 20;  // three packs
  Deck deck = stretched_bar(elements, brittle(0.02, 0.05), 1);
  Model model = build_model(deck);
  const double mass = total_mass(model);
  const Outcome outcome = run_all(model, deck);
  ASSERT_EQ(outcome.deaths.size(), static_cast<std::size_t>(elements));
  for (int e = 0; e < elements; ++e) {
    EXPECT_EQ(outcome.deaths[static_cast<std::size_t>(e)].step, outcome.deaths[0].step);
    EXPECT_EQ(outcome.deaths[static_cast<std::size_t>(e)].element, (DeletedElement{0, e}));
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
    model.blocks[0].lost[0] = model.parts[0].element_slot[static_cast<std::size_t>(element)];
    erode(*model.erosion, model.schedule, results, model.blocks, model.parts, model.energy);
    std::set<double> planes;
    for (int node : model.erosion->freed)
      planes.insert(std::round(model.nodes.record[static_cast<std::size_t>(node)].position[0]));
    return planes;
  };
  EXPECT_EQ(give_up(1), std::set<double>{});
  EXPECT_EQ(give_up(0), (std::set<double>{0, 1}));
  EXPECT_EQ(model.erosion->freed.size(), 8u);
  EXPECT_EQ(give_up(2), (std::set<double>{2, 3}));
  EXPECT_EQ(model.blocks[0].element_count, 0u);
}

// A block that is torn in a velocity field: deaths spread over many steps and chunks.
Deck torn_block(FreeNodes free_nodes = FreeNodes::keep) {
  Deck deck;
  deck.materials = {{"material", brittle(0.01, 0.02)}, {"other", tough()}};
  deck.parts = {box("block", {1, 1, 1}, {9, 9, 9}, {0, 0, 0}, hex8()),
                box("whole", {1, 1, 1}, {3, 3, 3}, {5, 0, 0}, hex8(), "other")};
  deck.parts[0].deletion.emplace();
  deck.parts[0].deletion->free_nodes = free_nodes;
  InitialCondition left = moving("", {-30, 0, 3});
  left.where.region = BoxRegion{{-1, -1, -1}, {-0.05, 1, 1}};
  InitialCondition right = moving("", {25, 5, 0});
  right.where.region = BoxRegion{{0.05, -1, -1}, {1, 1, 1}};
  deck.initial_conditions = {left, right};
  deck.time.end = 8e-3;
  return deck;
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
    EXPECT_EQ(summary.elements.hex8, 729 + 27);
    EXPECT_EQ(summary.deleted.hex8, static_cast<std::int64_t>(outcome.deaths.size()));
    EXPECT_NEAR(summary.mass.intact + summary.mass.debris + summary.mass.deleted, summary.mass.start,
                1e-12 * mass);
    EXPECT_EQ(summary.mass.deleted > 0, free_nodes == FreeNodes::drop);
    EXPECT_EQ(summary.mass.debris > 0, free_nodes == FreeNodes::keep);
  }
}

// What nobody else touches moves in straight lines whether it is booked as debris or as gone.
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

/// Deletes the elements of a part for which `dies` holds, as a sweep would have asked for it.
template <class Dies>
void delete_by_hand(Model& model, std::size_t part, const Dies& dies) {
  std::vector<SweepResult> results(model.schedule.tasks.size());
  for (std::size_t t = 0; t < results.size(); ++t) {
    const SweepTask& task = model.schedule.tasks[t];
    if (task.block != part) continue;
    Block& block = model.blocks[part];
    const std::size_t first = task.chunk.first_pack * static_cast<std::size_t>(block.lanes);
    for (std::size_t place = first; place < first + task.chunk.element_count; ++place)
      if (dies(model.parts[part].element_order[place]))
        block.lost[first + results[t].lost++] = static_cast<int>(place);
  }
  erode(*model.erosion, model.schedule, results, model.blocks, model.parts, model.energy);
}

Model living_block(std::array<int, 3> elements, const Deck& base) {
  Deck deck = base;
  deck.parts.resize(1);
  std::get<BoxMesh>(deck.parts[0].mesh).elements = elements;
  deck.parts[0].deletion->inverted = true;
  Model model = build_model(deck);
  ThreadTeam team(1);
  for (int step = 0; step < 5; ++step) {
    update_velocities(model, 1, team);
    update_positions(model, team);
  }
  return model;
}

/// Each living element of the model is where the part says, with the state and nodes it has in `before`.
void expect_same_elements(const Model& model, const Model& before) {
  const PartInModel& part = model.parts[0];
  std::size_t living = 0;
  for (std::size_t e = 0; e < part.element_slot.size(); ++e) {
    if (part.element_slot[e] < 0) continue;
    ++living;
    const auto place = static_cast<std::size_t>(part.element_slot[e]);
    const auto old_place = static_cast<std::size_t>(before.parts[0].element_slot[e]);
    ASSERT_EQ(part.element_order[place], static_cast<int>(e));
    for (int corner = 0; corner < 8; ++corner)
      ASSERT_EQ(model.blocks[0].node(place, corner), before.blocks[0].node(old_place, corner));
    const ElementSample now = model.blocks[0].kernel.sample(model.blocks[0], model.nodes, place);
    const ElementSample then = before.blocks[0].kernel.sample(before.blocks[0], before.nodes, old_place);
    ASSERT_EQ(now.stress.xx, then.stress.xx);
    ASSERT_EQ(now.internal_energy, then.internal_energy);
    ASSERT_EQ(held_energy(model.blocks[0], place).internal,
              held_energy(before.blocks[0], old_place).internal);
  }
  EXPECT_EQ(living, model.blocks[0].element_count);
  std::size_t scheduled = 0;
  for (const SweepTask& task : model.schedule.tasks) scheduled += task.chunk.element_count;
  EXPECT_EQ(living, scheduled);
}

TEST(Erosion, ElementsKeepTheirStateThroughDeletionAndPackingAnew) {
  for (const Precision precision : {Precision::double_precision, Precision::single_precision}) {
    Deck deck = torn_block();
    deck.numerics.precision = precision;
    const Model before = living_block({13, 12, 11}, deck);
    Model model = before;
    const auto sum = [&] { return model.energy.internal + model.energy.hourglass + model.energy.deleted; };
    const double energy = sum();
    for (int round = 2; round < 40; ++round) {
      delete_by_hand(model, 0, [&](int e) { return (e * 7919 + round) % 5 == 0; });
      EXPECT_NEAR(sum(), energy, 1e-12 * energy);
      expect_same_elements(model, before);
      if (!is_sparse(model.schedule, model.blocks)) continue;
      model.schedule = repack(model.schedule, model.blocks, model.parts, model.nodes.size());
      expect_same_elements(model, before);
      EXPECT_FALSE(is_sparse(model.schedule, model.blocks));
    }
    EXPECT_LT(model.blocks[0].element_count, 200u);
    delete_by_hand(model, 0, [](int) { return true; });
    EXPECT_EQ(model.blocks[0].element_count, 0u);
    model.schedule = repack(model.schedule, model.blocks, model.parts, model.nodes.size());
    EXPECT_TRUE(model.schedule.tasks.empty());
  }
}

TEST(Erosion, SweepAfterDeletionGivesTheForcesOfTheElementsThatAreLeft) {
  Model model = living_block({9, 9, 9}, torn_block());
  delete_by_hand(model, 0, [](int e) { return e % 3 != 0; });
  // Forces of each element alone.
  std::vector<Vector> expected(model.nodes.size());
  const Model still = model;
  for (std::size_t e = 0; e < 729; e += 3) {
    Model alone = still;
    delete_by_hand(alone, 0, [&](int other) { return other != static_cast<int>(e); });
    for (const SweepTask& task : alone.schedule.tasks)
      alone.blocks[0].kernel.sweep(alone.blocks[0], task.chunk, alone.nodes, 1e-6);
    for (int corner = 0; corner < 8; ++corner) {
      const auto place = static_cast<std::size_t>(alone.parts[0].element_slot[e]);
      const auto node = static_cast<std::size_t>(alone.blocks[0].node(place, corner));
      for (std::size_t i = 0; i < 3; ++i) expected[node][i] += alone.nodes.force[node].component[i];
    }
    if (e > 60) break;
  }
  for (const SweepTask& task : model.schedule.tasks)
    model.blocks[0].kernel.sweep(model.blocks[0], task.chunk, model.nodes, 1e-6);
  double largest = 0;
  std::set<int> others;  // nodes of elements that were not summed
  for (std::size_t e = 0; e < 729; ++e)
    if (e > 63 && model.parts[0].element_slot[e] >= 0)
      for (int corner = 0; corner < 8; ++corner)
        others.insert(model.blocks[0].node(static_cast<std::size_t>(model.parts[0].element_slot[e]), corner));
  for (std::size_t node = 0; node < model.nodes.size(); ++node) {
    if (others.count(static_cast<int>(node)) > 0) continue;
    for (std::size_t i = 0; i < 3; ++i) {
      largest = std::max(largest, std::abs(expected[node][i]));
      EXPECT_NEAR(model.nodes.force[node].component[i], expected[node][i], 1e-9 * (1 + largest));
    }
  }
  EXPECT_GT(largest, 1);
}

// A million elements, a hundred deletions: no more than two hundred places change.
TEST(ErosionSlow, DeletionTouchesAsMuchAsItDeletes) {
  Deck deck = torn_block();
  deck.numerics.precision = Precision::single_precision;
  deck.parts.resize(1);
  std::get<BoxMesh>(deck.parts[0].mesh).elements = {100, 100, 100};
  deck.parts[0].deletion->inverted = true;
  Model model = build_model(deck);
  const std::vector<int> order = model.parts[0].element_order;
  std::vector<std::byte> state(model.blocks[0].state.begin(), model.blocks[0].state.end());
  std::size_t changed_before = 0;
  for (int step = 1; step <= 3; ++step) {
    const AllocationCount allocations;
    std::vector<SweepResult> results(model.schedule.tasks.size());
    for (int k = 0; k < 100; ++k) {
      SweepResult& result = results[static_cast<std::size_t>(k) % results.size()];
      const Chunk chunk = model.schedule.tasks[static_cast<std::size_t>(k) % results.size()].chunk;
      const std::size_t first = chunk.first_pack * 16;
      model.blocks[0].lost[first + result.lost] = static_cast<int>(first + 997 * (result.lost + 1));
      ++result.lost;
    }
    erode(*model.erosion, model.schedule, results, model.blocks, model.parts, model.energy);
    EXPECT_LE(allocations.count(), 1u);  // that of `results`
    EXPECT_EQ(model.erosion->deleted.size(), 100u);
    EXPECT_FALSE(is_sparse(model.schedule, model.blocks));
    std::size_t changed = 0, changed_bytes = 0;
    for (std::size_t place = 0; place < order.size(); ++place)
      changed += model.parts[0].element_order[place] != order[place] ? 1 : 0;
    for (std::size_t i = 0; i < state.size(); ++i)
      changed_bytes += state[i] != model.blocks[0].state[i] ? 1 : 0;
    EXPECT_LE(changed - changed_before, 200u);
    EXPECT_LE(changed_bytes, changed * model.blocks[0].pack_bytes / 16);
    changed_before = changed;
  }
  EXPECT_EQ(model.blocks[0].element_count, 1000000u - 300u);
}

// The middle of three cubes is deleted; the outer ones fly apart, turning and ringing without damping.
void expect_stable_debris(std::int64_t steps) {
  Deck deck = pulled_bar(3, brittle(0.01, 0.02));
  deck.boundary_conditions.clear();
  const Triple velocity[] = {{-20, 1, 0}, {-19, 0, 0.5}, {20, 0, 2}, {20.5, 0.5, 1}};
  for (int plane = 0; plane < 4; ++plane) {
    InitialCondition condition = moving("", velocity[plane]);
    condition.where.region = BoxRegion{{plane - 0.25, -1, -1}, {plane + 0.25, 1, 1}};
    deck.initial_conditions.push_back(condition);
  }
  deck.time.end = 1e9;
  Model model = build_model(deck);
  ThreadTeam team(1);
  update_velocities(model, 0.01, team);
  delete_by_hand(model, 0, [](int element) { return element == 1; });
  update_positions(model, team);
  while (model.step < steps) {
    update_velocities(model, 0.01, team);
    update_positions(model, team);
  }
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

TEST(Erosion, MinimumStepDeletesWhatWouldHoldTheStepDown) {
  Deck deck = stretched_bar(2, elastic(0.0), -1);
  deck.time.end = 0.9;
  deck.time.step_scale = 0.5;
  Model reference = build_model(deck);
  ThreadTeam team(1);
  update_velocities(reference, 1, team);
  deck.parts[0].deletion.emplace();
  deck.parts[0].deletion->minimum_step = 0.4 * reference.control.stable;
  Model model = build_model(deck);
  run_all(model, deck);
  EXPECT_EQ(model.erosion->total_deleted(), 2);
  EXPECT_GT(model.control.least, 0.5 * 0.39 * reference.control.stable);
}

TEST(Erosion, VolumeRatioDeletesWhatIsCrushed) {
  Deck deck = stretched_bar(2, elastic(0.0), -1);
  deck.parts[0].deletion.emplace();
  deck.parts[0].deletion->volume_ratio = 0.85;
  deck.time.end = 0.3;
  Model model = build_model(deck);
  ThreadTeam team(1);
  double time_of_death = 0;
  run(model, deck, team, [&](Model& m) {
    if (!m.erosion->deleted.empty()) time_of_death = m.times.time;
  });
  EXPECT_EQ(model.erosion->total_deleted(), 2);
  EXPECT_NEAR(time_of_death, 0.15, 2 * model.control.largest);
}

// One node of a cube is driven along an edge: when it passes the node at the other end, after 1, the edges of
// neither span a positive volume any more, though the cube has kept most of its own.
TEST(Erosion, CornerInvertedDeletesWhatIsInsideOutAtACorner) {
  for (const bool named : {false, true}) {
    Deck deck = pulled_bar(1, elastic(0.0));
    PrescribedMotion driven = pull("", 0, -1);
    driven.where.region = BoxRegion{{0.75, 0.25, 0.25}, {9, 9, 9}};
    deck.boundary_conditions = {fix("bar.all", {1, 2}), fix("bar.xmin", {0}), driven};
    for (const auto& [low, high] : {std::pair{-9.0, 0.25}, std::pair{0.25, 9.0}}) {
      PrescribedMotion held = pull("", 0, 0);
      held.where.region = BoxRegion{{0.75, low, -9}, {9, high, low < 0 ? 9 : 0.25}};
      deck.boundary_conditions.push_back(held);
    }
    deck.parts[0].deletion.emplace();
    deck.parts[0].deletion->inverted = true;
    deck.parts[0].deletion->corner_inverted = named;
    deck.time.end = 1.2;
    Model model = build_model(deck);
    ThreadTeam team(1);
    double time_of_death = 0;
    run(model, deck, team, [&](Model& m) {
      if (!m.erosion->deleted.empty()) time_of_death = m.times.time;
    });
    EXPECT_EQ(model.erosion->total_deleted(), named ? 1 : 0);
    EXPECT_NEAR(time_of_death, named ? 1 : 0, 2 * model.control.largest);
  }
}

// Nodes of one side of a soft cube are driven through the other.
Deck crushed_cube() {
  Deck deck = stretched_bar(2, elastic(0.0), 0);
  deck.boundary_conditions = {fix("bar.all", {1, 2}), fix("bar.xmin", {0}), pull("bar.xmax", 0, -2000)};
  deck.numerics.energy_error_limit = 100;
  deck.time.end = 0.01;
  return deck;
}
TEST(Erosion, InvertedElementIsDeletedOrStopsTheRunAsTheDeckSays) {
  Deck deck = crushed_cube();
  deck.parts[0].deletion.emplace();
  Model stopped = build_model(deck);
  ThreadTeam team(1);
  EXPECT_THROW(run(stopped, deck, team), Breakdown);
  deck.parts[0].deletion->inverted = true;
  Model model = build_model(deck);
  run_all(model, deck);
  EXPECT_GE(model.erosion->total_deleted(), 1);
  EXPECT_TRUE(std::isfinite(model.energy.sum()));
}

TEST(Erosion, PressureGoesWithTheElementItPushes) {
  Deck deck = stretched_bar(2, brittle(0.02, 0.05), 1);
  deck.loads = {Pressure{"bar.xmin", Curve{{{0, 1e3}}}}, Pressure{"bar.ymax", Curve{{{0, 1e3}}}}};
  Model model = build_model(deck);
  const auto sides = [&](std::size_t load) {
    return std::get<PressureLoad>(model.loads[load].load).sides.size();
  };
  EXPECT_EQ(sides(0), 1u);
  EXPECT_EQ(sides(1), 2u);
  run_all(model, deck);
  EXPECT_EQ(sides(0), 0u);
  EXPECT_EQ(sides(1), 0u);
}

// A strip that is bent about one end: points far from the middle fail first.
Deck bent_strip(double failed_points) {
  Deck deck;
  ElasticPlastic law = brittle(0.01, 0.01);
  law.failure->failed_points = failed_points;
  deck.materials = {{"material", law}};
  Shell4 shell;
  shell.thickness = 0.1;
  PlateMesh mesh;
  mesh.size = {1, 1};
  mesh.elements = {1, 1};
  deck.parts = {{"strip", mesh, {}, shell, "material"}};
  // Bending and, far less, stretching: the pulled half fails, then the middle.
  PrescribedMotion turn = pull("strip.xmax", 4, -2);
  turn.components.push_back({0, Curve{{{0, 0.05}}}});
  turn.components.push_back({1, Curve{{{0, 0}}}});
  turn.components.push_back({2, Curve{{{0, 0}}}});
  deck.boundary_conditions = {fix("strip.xmin", {0, 1, 2, 3, 4, 5}), turn};
  deck.time.end = 1;
  return deck;
}
TEST(Erosion, ShellGoesWhenTheChosenShareOfItsPointsHasFailed) {
  double last = 0;
  for (const double share : {0.2, 0.4, 0.6}) {
    const Deck deck = bent_strip(share);
    Model model = build_model(deck);
    ThreadTeam team(1);
    double time_of_death = HUGE_VAL;
    run(model, deck, team, [&](Model& m) {
      if (!m.erosion->deleted.empty()) time_of_death = m.times.time;
    });
    EXPECT_LT(time_of_death, HUGE_VAL) << share;
    EXPECT_GT(time_of_death, last) << share;
    last = time_of_death;
  }
}

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
  const auto corner = static_cast<std::size_t>(end.topology.connectivity[8 * 5 + 3]);
  const auto place = static_cast<std::size_t>(model.parts[0].element_slot[static_cast<std::size_t>(id[5])]);
  const auto node = static_cast<std::size_t>(model.blocks[0].node(place, 3));
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
    update_velocities(model, 1, team);
    const std::size_t now = count.count();
    update_positions(model, team);
    if (model.step > 3 && model.schedule.tasks.size() == tasks) allocations += now;
    deaths += model.erosion->deleted.size();
  }
  EXPECT_EQ(allocations, 0u);
}

}  // namespace
}  // namespace brio
