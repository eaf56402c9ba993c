#pragma once
/// Small scenes of constraint rows.

#include <cmath>
#include <random>
#include <vector>

#include "contact/enforcement/impulse_solver.hpp"
#include "src/base/index.hpp"

namespace brio::test {

inline Vector3d unit(const Vector3d& a) { return (1 / norm(a)) * a; }

inline VelocityBlock moving(double mass, const Vector3d& velocity) { return {velocity, isotropic(1 / mass)}; }

class RandomNumbers {
 public:
  explicit RandomNumbers(unsigned seed) : engine_(seed) {}
  double number(double size = 1) { return size * std::uniform_real_distribution<double>(-1, 1)(engine_); }
  double between(double least, double most) {
    return std::uniform_real_distribution<double>(least, most)(engine_);
  }
  int below(int count) { return std::uniform_int_distribution<int>(0, count - 1)(engine_); }
  Vector3d vector(double size = 1) {
    const double x = number(size);
    const double y = number(size);
    return {x, y, number(size)};
  }
  Vector3d direction() { return unit(vector() + Vector3d{0, 0, 1e-3}); }
  std::mt19937& engine() { return engine_; }

 private:
  std::mt19937 engine_;
};

/// Rows and the blocks that they hold.
struct RowScene {
  ConstraintRows rows;
  std::vector<VelocityBlock> blocks;

  Vector3d momentum() const {
    Vector3d sum{0, 0, 0};
    for (const VelocityBlock& block : blocks) sum = sum + (1 / block.inverse_mass.xx) * block.velocity;
    return sum;
  }
  double kinetic_energy() const {
    double sum = 0;
    for (const VelocityBlock& block : blocks)
      if (block.inverse_mass.xx > 0) sum += 0.5 * dot(block.velocity, block.velocity) / block.inverse_mass.xx;
    return sum;
  }
  Vector3d relative_velocity(std::size_t i) const {
    return RowMap(rows, rows.row[i]).relative_velocity(blocks);
  }
};

/// Converges to rounding.
inline SolveOptions to_the_end(double tolerance = 1e-14) { return {200000, tolerance}; }

inline SolveReport solve(RowScene& scene, const SolveOptions& options, int threads = 1) {
  ThreadTeam team(threads);
  ImpulseSolver solver;
  return solver.solve(options, scene.rows, scene.blocks, team);
}

/// The row of a node on a wall.
inline ConstraintRow& add_wall_row(RowScene& scene, int block, const Vector3d& normal, double friction = 0) {
  ConstraintRow& row = scene.rows.add_row(normal, 0, friction);
  scene.rows.add_point(block, Side::first);
  return row;
}

/// Foot of a random quadrilateral: its corners are the blocks from `first` on.
struct RandomFace {
  std::vector<Vector3d> corner;
  FaceFoot foot;
  Vector3d point;

  RandomFace(RandomNumbers& random, int first, int corners = 4) {
    const Vector3d o = random.vector(3);
    corner = {o, o + Vector3d{1, 0, 0} + random.vector(0.2), o + Vector3d{1, 1, 0} + random.vector(0.2),
              o + Vector3d{0, 1, 0} + random.vector(0.2)};
    const double u = random.between(0.05, corners == 4 ? 0.95 : 0.45);
    const double v = random.between(0.05, corners == 4 ? 0.95 : 0.45);
    double along[4] = {v - 1, 1 - v, v, -v};
    double across[4] = {u - 1, -u, u, 1 - u};
    double weight[4] = {(1 - u) * (1 - v), u * (1 - v), u * v, (1 - u) * v};
    if (corners == 3) {
      corner = {corner[0], corner[1], corner[3]};
      const double flat[3][3] = {{1 - u - v, -1, -1}, {u, 1, 0}, {v, 0, 1}};
      for (int k = 0; k < 3; ++k) {
        weight[k] = flat[k][0];
        along[k] = flat[k][1];
        across[k] = flat[k][2];
      }
    }
    foot.corners = corners;
    point = {0, 0, 0};
    for (int k = 0; k < corners; ++k) {
      foot.block[k] = first + k;
      foot.weight[k] = weight[k];
      point = point + weight[k] * corner[index(k)];
    }
    const auto count = index(corners);
    set_gradients(foot, corner, {along, count}, {across, count});
  }
};

}  // namespace brio::test
