#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "elements/solid/hex8_kernel.hpp"
#include "elements/sweep.hpp"
#include "src/base/index.hpp"

namespace brio {
namespace {

/// Every lane of every corner holds its own node, relative to the first node of its element where that is
/// asked for.
template <class Kind, Floating Real>
void expect_gathered() {
  constexpr int width = lane_count<Real>;
  std::mt19937 generator(3);
  std::uniform_int_distribution<int> any_node(0, 199);
  Nodes nodes(200, false);
  for (std::size_t i = 0; i < nodes.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k) {
      nodes.record[i].position[k] = static_cast<double>(1000 * k + i);
      nodes.record[i].velocity[k] = -static_cast<double>(5000 * k + 2 * i);
    }
  std::vector<int> connectivity(std::size_t{8} * width);
  for (int& node : connectivity) node = any_node(generator);
  MotionOf<Kind, Lanes<Real>> motion;
  gather_motion<Kind, Real>(nodes, connectivity.data(), motion);
  for (int corner = 0; corner < 8; ++corner)
    for (int lane = 0; lane < width; ++lane)
      for (int k = 0; k < 3; ++k) {
        const auto at = [&](int c) {
          const int* node = connectivity.data() + c * width + lane;
          return nodes.record[index(*node)];
        };
        const double x = at(corner).position[k], v = at(corner).velocity[k];
        const double origin = makes_relative<Kind, Real> ? at(0).position[k] : 0;
        const double speed = makes_relative<Kind, Real> ? at(0).velocity[k] : 0;
        EXPECT_EQ(static_cast<double>(motion.position[k][corner][lane]), x - origin) << corner << ' ' << lane;
        EXPECT_EQ(static_cast<double>(motion.velocity[k][corner][lane]), v - speed) << corner << ' ' << lane;
      }
}

TEST(Sweep, GathersTheMotionOfEachLane) {
  expect_gathered<Hex8Kernel<ObjectiveRate::jaumann>, double>();
  expect_gathered<Hex8Kernel<ObjectiveRate::jaumann>, float>();
}

TEST(Sweep, ScattersEveryCornerOfFullAndPartialPacks) {
  constexpr int width = lane_count<float>;
  std::vector<int> connectivity(std::size_t{8} * width);
  for (std::size_t i = 0; i < connectivity.size(); ++i) connectivity[i] = static_cast<int>(i * 7 % 100);
  NodalForces<Lanes<float>, 8> forces;
  for (int k = 0; k < 3; ++k)
    for (int corner = 0; corner < 8; ++corner)
      for (int lane = 0; lane < width; ++lane)
        forces.force[k][corner].set(lane, static_cast<float>(k + 3 * corner + 24 * lane));
  for (int lane = 0; lane < width; ++lane) forces.stiffness.set(lane, static_cast<float>(7 * lane + 1));
  for (const int count : {1, 7, 8, 9, width}) {
    Nodes nodes(100, false);
    scatter_pack<Hex8Kernel<ObjectiveRate::jaumann>, float>({nodes.force.data(), nullptr},
                                                            connectivity.data(), count, forces);
    std::vector<double> expected(400, 0.0);
    for (int corner = 0; corner < 8; ++corner)
      for (int lane = 0; lane < count; ++lane)
        for (int k = 0; k < 3; ++k) {
          const int* node = connectivity.data() + corner * width + lane;
          double* row = expected.data() + 4 * *node;
          row[k] -= k + 3 * corner + 24 * lane;
          if (k == 0) row[3] -= 7 * lane + 1;
        }
    for (std::size_t i = 0; i < 100; ++i)
      for (std::size_t k = 0; k < 4; ++k)
        EXPECT_EQ(nodes.force[i].component[k], expected[4 * i + k]) << count;
  }
}

/// Forces of one brick through a few steps, by way of a block.
std::vector<double> forces_of_block(const ElasticPlastic& material) {
  Nodes nodes(8, false);
  std::vector<int> connectivity;
  for (int n = 0; n < 8; ++n) {
    connectivity.push_back(n);
    NodeRecord& record = nodes.record[index(n)];
    const int i = n % 4;
    record.position[0] = i == 1 || i == 2 ? 1 : 0;
    record.position[1] = i >= 2 ? 1 : 0;
    record.position[2] = n < 4 ? 0 : 1;
    for (int k = 0; k < 3; ++k) record.velocity[k] = (n * (k + 2)) % 5;
  }
  Block block = make_block("brick", Hex8{}, material, Precision::double_precision, connectivity);
  block.kernel.initialize(block, nodes);
  std::vector<double> forces;
  for (int step = 0; step < 5; ++step) {
    for (NodeRecord& record : nodes.record)
      for (int k = 0; k < 3; ++k) record.position[k] += 1e-3 * record.velocity[k];
    block.kernel.sweep(block, {0, 1, 1}, nodes, 1e-3);
  }
  for (const NodeVector& force : nodes.force)
    forces.insert(forces.end(), force.component, force.component + 3);
  forces.push_back(block.kernel.sample(block, nodes, 0, true).named("equivalent_plastic_strain"));
  return forces;
}

TEST(Sweep, ReducedLawIsTheLimitOfTheFullOne) {
  ElasticPlastic material{.density = 1000,
                          .youngs_modulus = 1e6,
                          .poissons_ratio = 0.3,
                          .yield_stress = 1e3,
                          .hardening_modulus = 1e4};
  const std::vector<double> reduced = forces_of_block(material);
  material.hardening_mix = 1e-14;
  const std::vector<double> full = forces_of_block(material);
  EXPECT_GT(reduced.back(), 1e-3);
  for (std::size_t i = 0; i < full.size(); ++i)
    EXPECT_NEAR(full[i], reduced[i], 1e-9 * std::abs(reduced[i]) + 1e-9);
}

}  // namespace
}  // namespace brio
