// Elements that are deleted all at once, side by side in one step, or whose damage jumps past one; and
// particles in one place.

#include <gtest/gtest.h>

#include "src/build/build.hpp"
#include "tests/core/extremes/extremes.hpp"

namespace brio {
namespace {

using namespace test;

double total_mass(const Model& model) {
  const MassBalance balance = mass_balance(*model.erosion, model.nodes);
  return balance.intact + balance.debris + model.erosion->dropped_mass;
}

/// No step of the body is as long as it asks for.
void let_all_go(Part& part, FreeNodes free_nodes) {
  part.deletion.emplace().minimum_step = 1e3;
  part.deletion->free_nodes = free_nodes;
}

TEST(ExtremesDeletion, EverythingAtOnceLeavesNodesThatFlyOnOrNothing) {
  const FloatingPointTraps traps;
  for (const Kind kind : deformable_kinds)
    for (const FreeNodes free_nodes : {FreeNodes::keep, FreeNodes::drop}) {
      SCOPED_TRACE(testing::Message()
                   << name_of_kind(kind) << (free_nodes == FreeNodes::keep ? " keep" : " drop"));
      Deck deck;
      deck.materials = {{"material", elastic(0.3)}};
      deck.parts = {body(kind, "body")};
      let_all_go(deck.parts[0], free_nodes);
      deck.initial_conditions = {moving("body", {1, 2, 3})};
      deck.time.end = 1e-3;
      deck.time.step = 1e-5;  // nothing is left that bounds it
      Model model = build_model(deck);
      const double mass = total_mass(model);
      ThreadTeam team(1);
      run(model, deck, team);
      EXPECT_EQ(model.times.time, deck.time.end);
      EXPECT_EQ(model.blocks[0].element_count, 0U);
      EXPECT_NEAR(total_mass(model), mass, 1e-12 * mass);
      model.momentum.now = momentum(model.nodes).total;
      EXPECT_LE(model.momentum.linear_imbalance(), 1e-12);
      EXPECT_LE(model.energy.error_max, 1e-9);
    }
}

TEST(ExtremesDeletion, EverythingAtOnceInContactLetsTheOtherBodyPass) {
  const FloatingPointTraps traps;
  for (const Kind kind : deformable_kinds)
    for (const bool as_debris : {false, true}) {
      SCOPED_TRACE(testing::Message() << name_of_kind(kind) << (as_debris ? " with a radius" : ""));
      Deck deck = impact(Kind::hex8, kind);
      let_all_go(deck.parts[0], FreeNodes::keep);
      if (as_debris) deck.parts[0].deletion->debris_radius = 0.01;
      const Watched watched(deck, 20);
      EXPECT_EQ(watched.model.blocks[0].element_count, 0U);
      EXPECT_EQ(watched.missed, 0);
      EXPECT_LE(watched.worst_linear, 1e-12);
      if (!as_debris) {
        EXPECT_NEAR(mean_velocity(watched.model, 1, 2), -20, 1e-9);
      }
    }
}

// Cubes in a row: those in the middle are pulled until both go in one step; then the ends are pushed
// together.
TEST(ExtremesDeletion, TwoNeighboursInOneStepLayBareWhatWasBetweenThem) {
  const FloatingPointTraps traps;
  for (const Element& element : {Element(Hex8{}), Element(Hex8Full{})}) {
    Deck deck;
    deck.materials = {{"material", tough()}};
    deck.parts = {box("bar", {0.6, 0.1, 0.1}, {6, 1, 1}, {0.3, 0, 0}, element)};
    deck.parts[0].deletion.emplace().plastic_strain = 0.05;
    deck.boundary_conditions = {fix("bar.all", {1, 2})};
    for (int i = 0; i <= 6; ++i) {
      PrescribedMotion motion;
      motion.where.region = BoxRegion{{0.1 * i - 0.02, -1, -1}, {0.1 * i + 0.02, 1, 1}};
      const double speed = 5.0 * std::clamp(i - 3, -1, 1);
      if (i == 3) continue;  // the middle goes as it must
      if (i == 2 || i == 4) {
        motion.components.push_back({0, Curve{{{0, speed}, {3e-3, speed}, {3.01e-3, -4 * speed}}}});
        deck.boundary_conditions.push_back(motion);
      }
    }
    deck.contact.emplace();
    deck.time.end = 10e-3;
    deck.numerics.energy_error_limit = 1;
    Model model = build_model(deck);
    ThreadTeam team(1);
    std::vector<std::vector<DeletedElement>> deaths;
    int touched = 0;
    std::int64_t missed = 0;
    double most_overlap = 0;
    run(model, deck, team, [&](Model& m) {
      if (!m.erosion->deleted.empty())
        deaths.emplace_back(m.erosion->deleted.begin(), m.erosion->deleted.end());
      touched = std::max(touched, m.contacts[0].step.active);
      missed += audit(m.contacts[0], m.nodes, team).missed();
      most_overlap = m.contacts[0].totals.deepest_overlap;
    });
    ASSERT_FALSE(deaths.empty());
    EXPECT_EQ(deaths[0], (std::vector<DeletedElement>{{0, 2}, {0, 3}}));
    EXPECT_GT(touched, 0) << "the ends meet";
    EXPECT_EQ(missed, 0);
    EXPECT_LE(most_overlap, 0.02);
  }
}

// The strain of one step is a thousand times that at which damage is one.
TEST(ExtremesDeletion, DamageThatJumpsPastOneInAStepDeletesAndBalances) {
  const FloatingPointTraps traps;
  for (const Kind kind : {Kind::hex8, Kind::hex8_full, Kind::shell, Kind::beam, Kind::particles}) {
    SCOPED_TRACE(name_of_kind(kind));
    Deck deck;
    deck.materials = {{"material", brittle(0.002, 1e-8)}};
    deck.parts = {body(kind, "body")};
    InitialCondition apart = moving("", {30, 0, 0});
    apart.where = {"", BoxRegion{{0.01, -1, -1}, {1, 1, 1}}, "body"};
    deck.initial_conditions = {apart};
    deck.time.end = 4e-3;
    Model model = build_model(deck);
    ThreadTeam team(1);
    const double mass = total_mass(model);
    run(model, deck, team);
    EXPECT_GT(model.erosion->total_deleted(), 0);
    EXPECT_NEAR(total_mass(model), mass, 1e-12 * mass);
    EXPECT_LE(model.energy.error_max, 0.05);
    for (const Block& block : model.blocks)
      for (std::size_t e = 0; e < block.element_count; ++e)
        EXPECT_LE(block.kernel.sample(block, model.nodes, e, true).named("damage"), 1);
  }
}

// ---- particles

// They have no direction to push each other in, and go on together.
TEST(ExtremesParticles, TwoOfOnePartInOnePlaceRunAndBalanceEnergy) {
  const FloatingPointTraps traps;
  for (const ParticleFrame kernel : {ParticleFrame::total_lagrangian, ParticleFrame::eulerian}) {
    Part part = body(Kind::particles, "body");
    std::get<Particle>(part.element).kernel = kernel;
    Deck deck;
    deck.materials = {{"material", elastic(0.3)}};
    deck.parts = {part};
    InitialCondition spin = moving("body", {1, 0, 0});
    spin.spin = Spin{{0, 0, 0}, {0, 0, 20}};
    deck.initial_conditions = {spin};
    deck.time.end = 0.02;
    Mesh mesh = generate_mesh(part.mesh, part.placement);
    mesh.position[21] = mesh.position[22];
    Model model = build(deck, {&mesh, 1});
    ThreadTeam team(1);
    run(model, deck, team);
    EXPECT_LE(model.energy.error_max, 1e-3);
    model.momentum.now = momentum(model.nodes).total;
    EXPECT_LE(model.momentum.linear_imbalance(), 1e-12);
  }
}

TEST(ExtremesParticles, OverlappingPartsWithoutContactDoNotSeeEachOther) {
  const FloatingPointTraps traps;
  Deck deck;
  deck.materials = {{"material", elastic(0.3)}};
  deck.parts = {body(Kind::particles, "one"), body(Kind::particles, "two")};
  deck.initial_conditions = {moving("one", {1, 0, 0})};
  deck.time.end = 1e-3;
  Model model = build_model(deck);
  ThreadTeam team(1);
  run(model, deck, team);
  EXPECT_NEAR(mean_velocity(model, 0, 0), 1, 1e-12);
  EXPECT_NEAR(mean_velocity(model, 1, 0), 0, 1e-12);
}

}  // namespace
}  // namespace brio
