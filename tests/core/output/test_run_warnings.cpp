/// What a run says of itself that makes its results doubtful.

#include <gtest/gtest.h>

#include "src/output/run_warnings.hpp"
#include "tests/core/sweep/particle_scene.hpp"

namespace brio::test {
namespace {

Deck block_of_particles(Vector3d size, ParticleFrame kernel) {
  Deck deck;
  deck.materials = {{"material", elastic(0.3)}};
  deck.parts = {particles("block", box_of_particles(size, 1), particle(kernel))};
  return deck;
}

TEST(RunWarnings, CountParticlesCloserThanHalfTheirSpacing) {
  for (const double distance : {0.51, 0.49}) {
    Model model = build_model(block_of_particles({5, 5, 5}, ParticleFrame::eulerian));
    watch(model);
    EXPECT_EQ(model.particle_searches[0].paired.largest_share, 0);
    // Towards its neighbour along x, away from all others.
    model.nodes.record[0].position[0] = model.nodes.record[1].position[0] - distance;
    model.nodes.record[0].position[1] = model.nodes.record[1].position[1];
    model.nodes.record[0].position[2] = model.nodes.record[1].position[2];
    watch(model);
    EXPECT_DOUBLE_EQ(model.particle_searches[0].paired.largest_share, distance < 0.5 ? 2.0 / 125 : 0.0);
    EXPECT_EQ(run_warnings(model).size(), distance < 0.5 ? 1u : 0u);
  }
}

/// Warnings of a block strained by 10 % at its ends and held so for 20 passages of a wave.
std::vector<std::string> warnings_when_held(ParticleFrame kernel, double sign) {
  Deck deck = block_of_particles({6, 6, 12}, kernel);
  for (const double end : {-1.0, 1.0}) {
    PrescribedMotion pull;
    pull.where.set = end < 0 ? "block.zmin" : "block.zmax";
    const double speed = sign * end * 0.55 / 0.02;
    pull.components.push_back({2, Curve{{{0, speed}, {0.02, speed}, {0.0201, 0}}}});
    deck.boundary_conditions.push_back(pull);
  }
  deck.time.end = 0.2;
  Model model = build_model(deck);
  ThreadTeam team;
  run(model, deck, team, [](Model& m) {
    if (m.step % 50 == 0) watch(m);
  });
  return run_warnings(model);
}

TEST(RunWarnings, TellOfParticlesThatPairInTension) {
  const std::vector<std::string> warnings = warnings_when_held(ParticleFrame::eulerian, 1);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].find("part 'block': "), std::string::npos) << warnings[0];
  EXPECT_NE(warnings[0].find("gather in pairs"), std::string::npos) << warnings[0];
  EXPECT_TRUE(warnings_when_held(ParticleFrame::eulerian, -1).empty());
  EXPECT_TRUE(warnings_when_held(ParticleFrame::total_lagrangian, 1).empty());
}

}  // namespace
}  // namespace brio::test
