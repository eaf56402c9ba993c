// Contact of surfaces that deletion lays bare, in the whole step.

#include <gtest/gtest.h>

#include <cmath>

#include "contact/audit/audit.hpp"
#include "tests/core/scene.hpp"

namespace brio {
namespace {

using namespace test;

ElasticPlastic soft() {
  return {.density = 1000,
          .youngs_modulus = 1e9,
          .poissons_ratio = 0.3,
          .yield_stress = 1e6,
          .hardening_modulus = 1e7};
}

InitialCondition thrown(Vector3d lower, Vector3d upper, Vector3d velocity) {
  InitialCondition condition;
  condition.where.region = BoxRegion{lower, upper};
  condition.velocity = velocity;
  return condition;
}

// A bar whose halves run into each other: layers in the middle are crushed and go, the halves go on and meet.
Deck crushed_bar() {
  Deck deck;
  deck.materials = {{"material", soft()}};
  deck.parts = {box("bar", {0.9, 0.3, 0.2}, {9, 3, 2}, {0, 0, 0}, hex8())};
  deck.parts[0].deletion.emplace().plastic_strain = 0.04;
  deck.initial_conditions = {thrown({-1, -1, -1}, {-0.01, 1, 1}, {8, 0, 0}),
                             thrown({0.01, -1, -1}, {1, 1, 1}, {-8, 0.5, 0})};
  deck.contact.emplace();
  deck.contact->options.friction = 0.2;
  deck.time.end = 0.03;
  return deck;
}

// A block that punches through a sheet.
Deck punched_sheet() {
  Deck deck;
  deck.materials = {{"material", soft()}, {"hard", elastic(0.3)}};
  PlateMesh sheet;
  sheet.size = {1, 1};
  sheet.elements = {12, 12};
  Shell4 shell;
  shell.thickness = 0.02;
  Part plate{"plate", sheet, Placement{}, shell, "material"};
  plate.deletion.emplace().plastic_strain = 0.1;
  deck.parts = {plate, box("block", {0.3, 0.3, 0.3}, {3, 3, 3}, {0.02, 0.03, 0.17}, hex8(), "hard")};
  deck.initial_conditions = {moving("block", {0, 0, -60})};
  deck.boundary_conditions = {fix("plate.boundary", {0, 1, 2})};
  deck.contact.emplace();
  deck.time.end = 0.01;
  return deck;
}

struct ErodingRun {
  std::int64_t deleted = 0;
  double first_deletion = 0, first_contact = 0;
  int contacts_while_deleting = 0;
  double worst_energy = 0, worst_momentum = 0;
  std::int64_t missed = 0, deep = 0;  ///< deep: without crossings of less than a tenth of an edge
  std::vector<double> positions;
};

ErodingRun run_scene(const Deck& deck, int threads, int audit_every) {
  Model model = build_model(deck);
  ThreadTeam team(threads);
  ErodingRun outcome;
  run(model, deck, team, [&](Model& m) {
    if (outcome.deleted == 0 && !m.erosion->deleted.empty()) outcome.first_deletion = m.times.time;
    outcome.deleted += std::ssize(m.erosion->deleted);
    const int active = m.contacts[0].step.active;
    if (outcome.first_contact == 0 && active > 0) outcome.first_contact = m.times.time;
    if (!m.erosion->deleted.empty()) outcome.contacts_while_deleting += active;
    outcome.worst_energy = std::max(outcome.worst_energy, std::abs(m.energy.relative_error()));
    if (m.step % audit_every == 0) {
      const Audit found = audit(m.contacts[0], m.nodes, team);
      outcome.missed += found.missed();
      outcome.deep += found.deep();
    }
  });
  outcome.positions.reserve(3 * model.nodes.size());
  for (const NodeRecord& record : model.nodes.record)
    outcome.positions.insert(outcome.positions.end(), record.position, record.position + 3);
  const Vector3d now = momentum_of(model);
  for (std::size_t i = 0; i < 3; ++i)
    outcome.worst_momentum =
        std::max(outcome.worst_momentum,
                 std::abs(now[i] - model.momentum.start.linear[i]) / model.momentum.linear_scale);
  return outcome;
}

TEST(ErodingContact, HalvesOfABarMeetWhereTheMiddleWas) {
  const ErodingRun outcome = run_scene(crushed_bar(), 1, 10);
  EXPECT_GE(outcome.deleted, 6);
  EXPECT_LT(outcome.first_deletion, 0.01);
  EXPECT_GT(outcome.first_contact, outcome.first_deletion);
  EXPECT_EQ(outcome.deep, 0);
  EXPECT_EQ(outcome.missed, 0);
  EXPECT_LT(outcome.worst_energy, 0.02);
  EXPECT_LT(outcome.worst_momentum, 1e-12);
  for (const int threads : {2, 4})
    EXPECT_EQ(run_scene(crushed_bar(), threads, 1000).positions, outcome.positions) << threads << " threads";
}

TEST(ErodingContact, ABlockPunchesThroughASheet) {
  const ErodingRun outcome = run_scene(punched_sheet(), 1, 10);
  EXPECT_GT(outcome.deleted, 5);
  EXPECT_LT(outcome.first_contact, outcome.first_deletion);
  EXPECT_GT(outcome.contacts_while_deleting, 0);
  EXPECT_EQ(outcome.missed, 0);
  EXPECT_LT(outcome.worst_energy, 0.02);
  for (const int threads : {2, 4})
    EXPECT_EQ(run_scene(punched_sheet(), threads, 1000).positions, outcome.positions)
        << threads << " threads";
}

}  // namespace
}  // namespace brio
