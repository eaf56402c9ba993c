// The highest frequency of a linear elastic cloud of particles, by Lanczos' method.

#include <algorithm>
#include <cmath>
#include <vector>

#include "elements/base/tridiagonal.hpp"
#include "elements/particle/particle_pairs.hpp"
#include "src/base/index.hpp"

namespace brio {

namespace {

constexpr int lanczos_steps = 40;
/// For what so many steps have not found.
constexpr double margin = 1.02;

using Displacements = AlignedBuffer<NodeVector>;
constexpr std::size_t stride = sizeof(NodeVector) / sizeof(double);

Row4 row(const Displacements& u, std::size_t i) { return load_row(u[i].component); }
double dot(const NodeVector& a, const NodeVector& b) {
  return a.component[0] * b.component[0] + a.component[1] * b.component[1] + a.component[2] * b.component[2];
}

/// Numbers in [-1, 1) that are the same everywhere.
class Noise {
 public:
  double next() {
    state_ = state_ * 6364136223846793005ULL + 1442695040888963407ULL;
    return static_cast<double>(state_ >> 11) * 0x1p-52 - 1;
  }

 private:
  std::uint64_t state_ = 1;
};

struct Stiffness {
  ParticleCloud& cloud;
  const Nodes& nodes;
  ElasticModuli<double> moduli;
  double hourglass_modulus;

  double mass(std::size_t i) const { return nodes.mass[index(cloud.first_node) + i]; }

  // Columns of A for displacements u.
  ParticleForce force_of(std::size_t i, const Displacements& u) const {
    const Row4 own = row(u, i);
    Row4 of_component[3] = {};
    for (std::size_t k = cloud.first[i]; k < cloud.first[i] + index(cloud.count[i]); ++k) {
      const Row4 d = row(u, index(cloud.neighbour[k])) - own;
      const double* w = cloud.pair[k].weighted;
#pragma GCC unroll 3
      for (int c = 0; c < 3; ++c) of_component[c] += w[c] * d;
    }
    Tensor<double> sum;
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 3; ++c) sum.m[r][c] = of_component[c][r];
    const SymmetricTensor<double>& k = cloud.correction[i];
    const Tensor<double> correction = full(k);
    const Tensor<double> gradient = sum * correction;
    const double volume = cloud.volume[i];
    const double stiffness = hourglass_modulus * volume * cloud.hourglass_weight[i];
    Tensor<double> stress;
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 3; ++c)
        stress.m[r][c] = volume * (moduli.shear * (gradient.m[r][c] + gradient.m[c][r]) +
                                   (r == c ? moduli.first_lame * trace(gradient) : 0));
    const Tensor<double> a = stress * correction;
    ParticleForce force{};
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 3; ++c) force.column[c][r] = a.m[r][c] - stiffness * gradient.m[r][c];
    force.column[0][3] = stiffness;
    return force;
  }

  // Accelerations, towards the displacements.
  void apply(const Displacements& u, Displacements& result) const {
    for (std::size_t i = 0; i < u.size(); ++i) cloud.force[i] = force_of(i, u);
    for (std::size_t i = 0; i < u.size(); ++i) {
      Row4 acceleration = (-1 / mass(i)) * pair_forces_on(cloud, u[0].component, stride, i);
      acceleration[3] = 0;
      store_row(result[i].component, acceleration);
    }
  }

  // With the masses over the first one, so that its size is that of the squared numbers alone.
  double product(const Displacements& a, const Displacements& b) const {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += mass(i) / mass(0) * dot(a[i], b[i]);
    return sum;
  }
};

}  // namespace

double highest_frequency_squared(ParticleCloud& cloud, const Nodes& nodes,
                                 const ElasticModuli<double>& moduli, double hourglass_modulus) {
  const Stiffness stiffness{cloud, nodes, moduli, hourglass_modulus};
  const std::size_t n = cloud.size();
  Displacements before(n), now(n), next(n);
  Noise noise;
  for (NodeVector& v : now) v = {{noise.next(), noise.next(), noise.next(), 0}};
  const auto scale = [](double factor, NodeVector& v) {
    store_row(v.component, factor * load_row(v.component));
  };
  const double length = std::sqrt(stiffness.product(now, now));
  for (NodeVector& v : now) scale(1 / length, v);
  std::vector<double> diagonal, beside;
  for (int step = 0; step < lanczos_steps; ++step) {
    stiffness.apply(now, next);
    diagonal.push_back(stiffness.product(now, next));
    const double coupling = beside.empty() ? 0 : beside.back();
    for (std::size_t i = 0; i < n; ++i)
      store_row(next[i].component, row(next, i) - diagonal.back() * row(now, i) - coupling * row(before, i));
    const double size = std::sqrt(stiffness.product(next, next));
    if (!(size > 1e-12 * diagonal.front())) break;
    beside.push_back(size);
    for (std::size_t i = 0; i < n; ++i) scale(1 / size, next[i]);
    std::swap(before, now);
    std::swap(now, next);
  }
  return margin * largest_eigenvalue(diagonal, beside);
}

}  // namespace brio
