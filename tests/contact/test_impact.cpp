#include <gtest/gtest.h>

#include "src/base/index.hpp"
#include "tests/contact/spring_model.hpp"

namespace brio::test {
namespace {

const Map as_is = shifted({0, 0, 0});

// A single hexahedron whose lowest nodes lie over a big fixed block.
TEST(Impact, NodeOnFaceReceivesTheExactImpulse) {
  SpringModel model;
  model.stiffness = 0;
  const int floor = model.add_box({1, 1, 1}, {4, 4, 1}, 1, as_is);
  const int block = model.add_box({1, 1, 1}, {1, 1, 1}, 8, shifted({1.3, 1.2, 1}));
  model.throw_from(block, {0, 0, -3});
  model.start({});
  model.hold(floor, block);
  model.make_gap();
  model.step(1e-3);
  for (int n = block; n < block + 4; ++n) {
    EXPECT_NEAR(model.v(n)[2], 0, 1e-8 / 1e-3) << "what the gap was beyond touching, in a step";
    const auto s = index(model.scene.surface.slave(n));
    EXPECT_NEAR(model.scene.normal_impulse[s][2], 3 + model.v(n)[2], 1e-12);
  }
  for (int n = block + 4; n < block + 8; ++n) EXPECT_EQ(model.v(n)[2], -3);
}

TEST(ImpactSlow, TwoEqualBlocksExchangeTheirVelocities) {
  for (const bool lower_first : {true, false}) {
    SpringModel model;
    model.stiffness = 1e4;
    const auto add_lower = [&] { return model.add_box({2, 2, 10}, {1, 1, 5}, 1, as_is); };
    const auto add_upper = [&] { return model.add_box({3, 3, 10}, {1, 1, 5}, 1, shifted({0, 0, 5.001})); };
    const int first = lower_first ? add_lower() : add_upper();
    if (!lower_first) model.throw_from(first, {0, 0, -1});
    const int b = lower_first ? add_upper() : add_lower();
    if (lower_first) model.throw_from(b, {0, 0, -1});
    model.start({});
    const double energy = model.kinetic_energy();
    const Vector3d momentum = model.momentum();
    const Vector3d angular = model.angular_momentum();
    const double dt = 2e-4;
    for (int i = 0; i < 4000; ++i) model.step(dt);
    EXPECT_LT(norm(model.momentum() - momentum), 1e-12 * norm(momentum));
    EXPECT_LT(norm(model.angular_momentum() - angular), 1e-11 * norm(momentum) * 5);
    const auto end_speed = [&](bool lower) {
      const bool first_piece = lower == lower_first;
      return first_piece ? model.mean_velocity(0, b)[2] : model.mean_velocity(b, model.count())[2];
    };
    // Five elements a block: first touch of nine lumped nodes takes a share, and both blocks keep vibrating.
    EXPECT_LT(end_speed(true), -0.84);
    EXPECT_GT(end_speed(false), -0.16);
    const double plastic_first_touch = 0.04;  // of lumped contact masses, proportional to the mesh size
    EXPECT_LT(model.scene.totals.largest_normal_work, 1e-3 * energy);
    EXPECT_GT(model.scene.totals.normal_work, -plastic_first_touch * energy);
  }
}

}  // namespace
}  // namespace brio::test
