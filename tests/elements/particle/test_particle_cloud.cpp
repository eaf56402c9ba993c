// Gradients over the neighbours of particles, and forces as their transpose.

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "elements/particle/particle_kernel.hpp"
#include "elements/particle/particle_pairs.hpp"
#include "src/base/index.hpp"

namespace brio {
namespace {

/// Particles of a lattice that are moved by up to a quarter of its spacing, of unlike volumes.
struct IrregularCloud {
  Nodes nodes;
  std::vector<double> volume;
  ParticleCloud cloud;

  explicit IrregularCloud(int across = 6) : nodes(index(across * across * across), false) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> shift(-0.25, 0.25), share(0.8, 1.2);
    int node = 0;
    for (int i = 0; i < across; ++i)
      for (int j = 0; j < across; ++j)
        for (int k = 0; k < across; ++k, ++node) {
          NodeRecord& record = nodes.record[index(node)];
          record.position[0] = i + shift(random);
          record.position[1] = j + shift(random);
          record.position[2] = k + shift(random);
          volume.push_back(share(random));
          nodes.mass[index(node)] = volume.back();
        }
    ThreadTeam team(1);
    cloud = make_particle_cloud(0, volume, 1.3, true, nodes, team);
  }
};

struct Gradients {
  Tensor<double> of_position, of_velocity;
  double residual_power, residual_rate;
};
Gradients gradients_of(const NeighbourSums& sums) {
  Tensor<double> x, v;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      x.m[i][j] = sums.position[i][j][0];
      v.m[i][j] = sums.velocity[i][j][0];
    }
  const auto& k = sums.correction;
  const ParticleMotion<double> motion =
      particle_motion(x, v, sums.position_by_velocity[0], sums.velocity_squared[0],
                      SymmetricTensor<double>{k[0][0], k[1][0], k[2][0], k[3][0], k[4][0], k[5][0]});
  return {motion.gradient, motion.gradient_rate, motion.residual_power, motion.residual_rate};
}
Gradients gradients(const IrregularCloud& irregular, int particle) {
  NeighbourSums sums;
  sum_over_neighbours(irregular.cloud, irregular.nodes, &particle, 1, sums);
  return gradients_of(sums);
}

const Tensor<double> of_positions{{{0.9, 0.3, -0.2}, {0.1, 1.2, 0.4}, {-0.3, 0.2, 0.8}}};
const Tensor<double> of_velocities{{{3, -2, 1}, {0.5, 4, -1}, {2, -3, -2}}};

Vector3<double> times(const Tensor<double>& t, const double* x) {
  return {t.m[0][0] * x[0] + t.m[0][1] * x[1] + t.m[0][2] * x[2],
          t.m[1][0] * x[0] + t.m[1][1] * x[1] + t.m[1][2] * x[2],
          t.m[2][0] * x[0] + t.m[2][1] * x[1] + t.m[2][2] * x[2]};
}

TEST(ParticleCloud, LinearFieldsHaveExactGradientsInsideAndAtTheSurface) {
  IrregularCloud irregular;
  for (NodeRecord& record : irregular.nodes.record) {
    const Vector3<double> x = times(of_positions, record.position), v = times(of_velocities, record.position);
    record.position[0] = x.x + 7, record.position[1] = x.y - 5, record.position[2] = x.z + 1;
    record.velocity[0] = v.x - 2, record.velocity[1] = v.y + 9, record.velocity[2] = v.z;
  }
  for (int particle = 0; particle < static_cast<int>(irregular.nodes.size()); ++particle) {
    const Gradients found = gradients(irregular, particle);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        ASSERT_NEAR(found.of_position.m[i][j], of_positions.m[i][j], 1e-12) << particle;
        ASSERT_NEAR(found.of_velocity.m[i][j], of_velocities.m[i][j], 4e-12) << particle;
      }
    ASSERT_NEAR(found.residual_power, 0, 1e-10);
    ASSERT_NEAR(found.residual_rate, 0, 1e-10);
  }
}

// Weighed anew where the particles stand, F is I.
TEST(ParticleCloud, KernelOfNowHasExactGradientsOfVelocities) {
  IrregularCloud irregular;
  start_eulerian(irregular.cloud, 1.5, irregular.nodes);
  const int n = static_cast<int>(irregular.nodes.size());
  std::mt19937 random(9);
  std::uniform_real_distribution<double> shift(-0.2, 0.2);
  for (NodeRecord& record : irregular.nodes.record) {
    for (int i = 0; i < 3; ++i) record.position[i] += shift(random);
    const Vector3<double> v = times(of_velocities, record.position);
    record.velocity[0] = v.x - 2, record.velocity[1] = v.y + 9, record.velocity[2] = v.z;
  }
  place_particles(irregular.cloud, irregular.nodes, 0, irregular.nodes.size());
  std::vector<ReachingPoint> points;
  for (const ParticlePlace& place : irregular.cloud.place)
    points.push_back({{place.position[0], place.position[1], place.position[2]}, place.smoothing_length});
  points.pop_back();  // that without volume
  ThreadTeam team(1);
  NeighbourSearch search;
  search.find(points, team);
  set_neighbours(irregular.cloud, search, irregular.nodes, team);
  for (int particle = 0; particle < n; ++particle) {
    NeighbourSums sums;
    sum_over_neighbours_now(irregular.cloud, &particle, 1, 0.0, sums);
    const Gradients found = gradients_of(sums);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        ASSERT_NEAR(found.of_position.m[i][j], i == j ? 1 : 0, 1e-12) << particle;
        ASSERT_NEAR(found.of_velocity.m[i][j], of_velocities.m[i][j], 4e-12) << particle;
        ASSERT_NEAR(sums.middle_gradient[i][j][0], of_velocities.m[i][j], 4e-12) << particle;
      }
    ASSERT_NEAR(found.residual_power, 0, 1e-10);
    ASSERT_NEAR(found.residual_rate, 0, 1e-10);
  }
}

// A term in the energy of one particle and no stress: forces are its gradient, by central differences.
double residual_energy(const IrregularCloud& irregular, const std::vector<double>& stiffness) {
  double energy = 0;
  for (int i = 0; i < static_cast<int>(irregular.nodes.size()); ++i) {
    const auto row = index(i);
    const Tensor<double> f = gradients(irregular, i).of_position;
    const ParticleCloud& cloud = irregular.cloud;
    for (std::size_t k = cloud.first[row]; k < cloud.first[row] + index(cloud.count[row]); ++k) {
      const double* w = cloud.pair[k].weighted;
      const double pair[3] = {w[0] / w[3], w[1] / w[3], w[2] / w[3]};
      const Vector3<double> fx = times(f, pair);
      const double* from = irregular.nodes.record[row].position;
      const double* to = irregular.nodes.record[index(cloud.neighbour[k])].position;
      const Vector3<double> e{to[0] - from[0] - fx.x, to[1] - from[1] - fx.y, to[2] - from[2] - fx.z};
      energy += 0.5 * stiffness[row] * w[3] * dot(e, e);
    }
  }
  return energy;
}

// With the energy V C:F of a particle, P = C.
TEST(ParticleCloud, PairForcesAreTheGradientOfTheEnergy) {
  IrregularCloud irregular(4);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> number(-1, 1);
  for (NodeRecord& record : irregular.nodes.record)
    for (int i = 0; i < 3; ++i) record.position[i] += 0.3 * number(random);
  const std::size_t n = irregular.nodes.size();
  std::vector<double> stiffness(n);
  std::vector<Tensor<double>> stress(n);
  for (std::size_t i = 0; i < n; ++i) {
    stiffness[i] = 0.02 * (2 + number(random));
    for (auto& row : stress[i].m)
      for (double& entry : row) entry = number(random);
    const Tensor<double> f = gradients(irregular, static_cast<int>(i)).of_position;
    const Tensor<double> force = stress[i] * full(irregular.cloud.correction[i]);
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 3; ++c)
        irregular.cloud.force[i].column[c][r] =
            irregular.volume[i] * force.m[r][c] - stiffness[i] * f.m[r][c];
    irregular.cloud.force[i].column[0][3] = stiffness[i];
  }
  const auto energy = [&] {
    double sum = residual_energy(irregular, stiffness);
    for (std::size_t i = 0; i < n; ++i)
      sum += irregular.volume[i] * contract(stress[i], gradients(irregular, static_cast<int>(i)).of_position);
    return sum;
  };
  std::vector<int> node(n);
  for (std::size_t i = 0; i < n; ++i) node[i] = static_cast<int>(i);
  add_pair_forces(irregular.cloud, irregular.nodes, node.data(), static_cast<int>(n));
  for (const std::size_t i : {std::size_t{0}, n / 3, n / 2, n - 1})
    for (int axis = 0; axis < 3; ++axis) {
      double& x = irregular.nodes.record[i].position[axis];
      const double start = x, h = 1e-4;
      x = start + h;
      const double above = energy();
      x = start - h;
      const double below = energy();
      x = start;
      EXPECT_NEAR(irregular.nodes.force[i].component[axis], -(above - below) / (2 * h), 1e-8) << i;
    }
}

TEST(ParticleCloud, CutParticleLeavesExactGradientsToItsNeighbours) {
  IrregularCloud irregular;
  for (int particle = 60; particle < 100; particle += 3) cut_particle(irregular.cloud, particle);
  for (NodeRecord& record : irregular.nodes.record) {
    const Vector3<double> v = times(of_velocities, record.position);
    record.velocity[0] = v.x, record.velocity[1] = v.y, record.velocity[2] = v.z;
  }
  for (int particle = 0; particle < static_cast<int>(irregular.nodes.size()); ++particle) {
    if (particle >= 60 && particle < 100 && particle % 3 == 0) {
      EXPECT_EQ(irregular.cloud.count[index(particle)], 0);
      continue;
    }
    const Gradients found = gradients(irregular, particle);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        ASSERT_NEAR(found.of_velocity.m[i][j], of_velocities.m[i][j], 1e-11) << particle;
  }
}

TEST(ParticleCloud, RefusesParticlesThatLieInAPlane) {
  Nodes nodes(16, false);
  for (int i = 0; i < 16; ++i) {
    nodes.record[index(i)].position[0] = i % 4;
    nodes.record[index(i)].position[1] = i / 4;
  }
  const std::vector<double> volume(16, 1.0);
  ThreadTeam team(1);
  EXPECT_THROW(make_particle_cloud(0, volume, 1.2, false, nodes, team), std::invalid_argument);
}

}  // namespace
}  // namespace brio
