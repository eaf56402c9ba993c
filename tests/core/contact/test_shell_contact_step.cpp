// Shells, contact and friction in one scene: what must not depend on the number of threads, in either
// precision.

#include <gtest/gtest.h>

#include <cstring>

#include "tests/core/scene.hpp"

namespace brio {
namespace {

using namespace test;

// A can fixed at its bottom, crushed by a tilted block; thin and soft enough to fold.
Deck small_can(Precision precision) {
  ElasticPlastic law;
  law.density = 1000;
  law.youngs_modulus = 1e9;
  law.poissons_ratio = 0.3;
  law.yield_stress = 2e6;
  law.hardening_modulus = 1e7;
  Deck deck;
  deck.materials = {{"metal", law}, {"material", elastic(0.3)}};
  Shell4 shell;
  shell.thickness = 0.02;
  Part can{"can", CylinderMesh{0.5, 1, {24, 16}}, {}, shell, "metal"};
  Part block = box("block", {1.5, 1.5, 0.2}, {5, 5, 1}, {0, 0, 1.25}, hex8());
  block.placement.rotate = Rotation{{0, 1, 0}, 8};
  deck.parts = {can, block};
  deck.initial_conditions = {moving("block", {2, 1, -60})};
  deck.boundary_conditions = {fix("can.bottom", {0, 1, 2, 3, 4, 5})};
  deck.contact.emplace();
  deck.contact->options.friction = 0.3;
  deck.time.end = 1;
  deck.numerics.precision = precision;
  return deck;
}

template <class Record>
bool same_bits(const AlignedBuffer<Record>& a, const AlignedBuffer<Record>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(Record)) == 0;
}

TEST(ShellContactStep, BitsDoNotDependOnTheNumberOfThreads) {
  for (Precision precision : {Precision::double_precision, Precision::single_precision}) {
    const Deck deck = small_can(precision);
    std::vector<Model> models;
    for (int threads : {1, 2, 4}) {
      models.push_back(build_model(deck));
      Model& model = models.back();
      ThreadTeam team(threads);
      make_steps(model, 300, deck.numerics.energy_error_limit, team);
    }
    EXPECT_LT(models[0].energy.friction.half, 0);
    EXPECT_GT(models[0].contacts[0].step.active, 10);
    for (std::size_t i = 1; i < models.size(); ++i) {
      EXPECT_TRUE(same_bits(models[0].nodes.record, models[i].nodes.record));
      EXPECT_TRUE(same_bits(models[0].nodes.angular_velocity, models[i].nodes.angular_velocity));
      EXPECT_EQ(models[0].energy.internal, models[i].energy.internal);
      EXPECT_EQ(models[0].energy.friction.half, models[i].energy.friction.half);
      EXPECT_EQ(models[0].energy.contact.half, models[i].energy.contact.half);
    }
  }
}

}  // namespace
}  // namespace brio
