// Each kind of body dropped, tilted, on each kind: no penetration, momentum is conserved, energy balances.
// The rows that are printed are the table of docs/contact.md.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "contact/audit/audit.hpp"
#include "src/base/index.hpp"
#include "tests/core/scene.hpp"

namespace brio {
namespace {

using namespace test;

constexpr double impact_speed = 10;  // 0.01 of the wave speed

enum class Dropped { solid, shell, beam, particles, rigid };
constexpr std::array names{"hex8", "shell4", "beam2", "particle", "rigid"};

/// A body about the origin, 0.4 to 0.6 wide.
Part body(Dropped kind, const std::string& name) {
  switch (kind) {
    case Dropped::solid:
      return box(name, {0.4, 0.4, 0.4}, {4, 4, 4}, {0, 0, 0}, hex8());
    case Dropped::rigid:
      return box(name, {0.4, 0.4, 0.4}, {2, 2, 2}, {0, 0, 0}, Rigid{});
    case Dropped::shell: {
      PlateMesh mesh;
      mesh.size = {0.5, 0.5};
      mesh.elements = {6, 6};
      Shell4 element;
      element.thickness = 0.03;
      return {name, mesh, {}, element, "material"};
    }
    case Dropped::beam: {
      LineMesh mesh;
      mesh.start = {-0.3, 0, 0};
      mesh.end = {0.3, 0, 0};
      mesh.elements = 6;
      Beam2 element;
      element.section = CircleSection{0.04};
      return {name, mesh, {}, element, "material"};
    }
    default: {
      ParticleMesh mesh;
      mesh.sphere = ParticleSphere{0.2, 0.05};
      return {name, mesh, {}, Particle{}, "material"};
    }
  }
}

double reach(Dropped kind) {
  constexpr std::array half{0.0, 0.015, 0.04, 0.025, 0.0};
  return half[index(kind)];
}

/// Put the lowest node of the upper body over the highest of the lower, aside by a little, just not touching.
void stack(Part& lower, Dropped lower_kind, Part& upper, Dropped upper_kind) {
  lower.placement.rotate = Rotation{{0.3, 1, 0}, 11};
  upper.placement.rotate = Rotation{{1, 0.4, 0.7}, 37};
  const auto by_height = [](const Vector3d& a, const Vector3d& b) { return a[2] < b[2]; };
  const Mesh below = generate_mesh(lower.mesh, lower.placement);
  const Mesh above = generate_mesh(upper.mesh, upper.placement);
  const Vector3d lowest = *std::min_element(above.position.begin(), above.position.end(), by_height);
  double top = 0;
  for (const Vector3d& x : below.position) top = std::max(top, x[2]);
  const double height = top + reach(lower_kind) + reach(upper_kind) + 2e-3;
  upper.placement.translate = {0.02 - lowest[0], 0.013 - lowest[1], height - lowest[2]};
}

class Drop : public testing::TestWithParam<std::tuple<Dropped, Dropped>> {};

struct DropRun {
  double restitution = 0;
  double linear_error = 0, angular_error = 0;  ///< of momentum
  double overlap = 0;                          ///< over the size of a body
  double energy_error = 0;
  double contact_added = 0;           ///< over the energy at the start
  std::int64_t missed = 0, deep = 0;  ///< deep: without crossings of less than a tenth of an edge
  int most_contacts = 0;
};

DropRun drop(Dropped upper_kind, Dropped lower_kind, double friction) {
  Part lower = body(lower_kind, "lower");
  Part upper = body(upper_kind, "upper");
  stack(lower, lower_kind, upper, upper_kind);
  Deck deck;
  deck.materials = {{"material", elastic(0.3)}};
  deck.parts = {lower, upper};
  deck.initial_conditions = {moving("upper", {0, 0, -impact_speed})};
  deck.contact = ContactSection{};
  deck.contact->options.friction = friction;
  deck.time.end = 30e-3;
  if (upper_kind == Dropped::rigid && lower_kind == Dropped::rigid) deck.time.step = 5e-5;
  Model model = build_model(deck);
  ThreadTeam team(2);
  DropRun outcome;
  int step = 0;
  run(model, deck, team, [&](Model& m) {
    if (step++ % 50 != 0) return;
    const Audit found = audit(m.contacts[0], m.nodes, team);
    outcome.missed += found.missed();
    outcome.deep += found.deep();
  });
  Momentum now = momentum(model.nodes);
  add_momentum(model.rigid, now);
  model.momentum.now = now.total;
  outcome.linear_error = model.momentum.linear_imbalance();
  outcome.angular_error = model.momentum.angular_imbalance();
  const auto velocity = [&](std::size_t part) {
    const int rigid = model.parts[part].rigid;
    return rigid < 0 ? mean_velocity(model, part, 2) : model.rigid.motion[index(rigid)].velocity[2];
  };
  outcome.restitution = (velocity(1) - velocity(0)) / impact_speed;
  const ContactTotals& totals = model.contacts[0].totals;
  outcome.overlap = totals.deepest_overlap / 0.4;
  outcome.energy_error = model.energy.error_max;
  outcome.contact_added = model.energy.contact_added_max / model.energy.kinetic_start;
  outcome.most_contacts = totals.most_contacts;
  return outcome;
}

TEST_P(Drop, OfOneKindOnAnother) {
  const auto [upper, lower] = GetParam();
  const DropRun smooth = drop(upper, lower, 0);
  const DropRun rough = drop(upper, lower, 0.2);
  std::printf("| %s | %s | %.2f | %.0e, %.0e | %.0e | %ld | %.0e | %.2f | %.0e, %.0e | %.0e | %ld |\n",
              names[index(upper)], names[index(lower)], smooth.restitution, smooth.linear_error,
              smooth.angular_error, smooth.overlap, smooth.missed, smooth.energy_error, rough.restitution,
              rough.linear_error, rough.angular_error, rough.overlap, rough.missed);
  // A touch found along the motion pushes along the normal of that moment, a little aside of the line through
  // both places at the beginning of the step.
  EXPECT_LT(smooth.angular_error, 1e-6);
  for (const DropRun& outcome : {smooth, rough}) {
    EXPECT_GT(outcome.most_contacts, 0);
    EXPECT_EQ(outcome.deep, 0);
    EXPECT_EQ(outcome.missed, 0);
    EXPECT_GT(outcome.restitution, -0.9) << "slowed down at least";
    EXPECT_LE(outcome.restitution, 1);
    EXPECT_LT(outcome.linear_error, 1e-12);
    EXPECT_LT(outcome.overlap, 1e-3);
    EXPECT_LT(outcome.energy_error, 1e-2);
    EXPECT_LT(outcome.contact_added, 5e-3);
  }
}

std::string name_of_drop(const testing::TestParamInfo<std::tuple<Dropped, Dropped>>& drop) {
  return std::string(names[index(std::get<0>(drop.param))]) + "_on_" + names[index(std::get<1>(drop.param))];
}

constexpr std::array all{Dropped::solid, Dropped::shell, Dropped::beam, Dropped::particles, Dropped::rigid};
INSTANTIATE_TEST_SUITE_P(EachKind, Drop, testing::Combine(testing::ValuesIn(all), testing::ValuesIn(all)),
                         name_of_drop);

}  // namespace
}  // namespace brio
