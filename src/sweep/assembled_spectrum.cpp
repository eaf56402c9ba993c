#include "src/sweep/assembled_spectrum.hpp"

#include <array>
#include <cmath>

#include "elements/base/tridiagonal.hpp"
#include "src/domains/node_ranges.hpp"
#include "src/domains/sweep_domains.hpp"

namespace brio {

namespace {

constexpr std::size_t iterations = 16;
/// For what so many iterations have not found. (Measured in tests/core/sweep/test_assembled_step.cpp.)
constexpr double margin = 1.03;

/// Numbers between -1 and 1, as if by chance, that follow from where a node is in its scene: waves whose
/// lengths vary from place to place, so that of all lengths and directions some are among them.
struct Chirp {
  double x, y, z;

  double operator()(int k) const {
    constexpr double waves = 1e4;
    const double a = 0.61803 + 0.1 * k, b = 0.41421 - 0.03 * k, c = 0.73205 + 0.07 * k;
    return std::cos(waves * (a * x * x + b * y * y + c * z * z + c * x * y - a * y * z + b * z * x + a * x -
                             c * y + b * z));
  }
};

/// Sums over nodes, range by range.
template <class Term>
double sum_over_nodes(LanczosVectors& vectors, const Nodes& nodes, ThreadTeam& team, Term&& of_node) {
  sum_node_ranges(nodes, vectors.of_ranges, team, [&](std::size_t begin, std::size_t end) {
    double sum = 0;
    for (std::size_t i = begin; i < end; ++i) sum += of_node(i);
    return sum;
  });
  double total = 0;
  for (const double sum : vectors.of_ranges) total += sum;
  return total;
}

double dot3(const NodeVector& a, const NodeVector& b) {
  return a.component[0] * b.component[0] + a.component[1] * b.component[1] + a.component[2] * b.component[2];
}

void scale(double factor, NodeVector& a) {
  for (double& component : a.component) component *= factor;
}

class Lanczos {
 public:
  Lanczos(LanczosVectors& vectors, const Nodes& nodes, ThreadTeam& team)
      : vectors_(vectors), nodes_(nodes), team_(team), turns_(nodes.has_rotations()) {
    mass_ = sum_over_nodes(vectors_, nodes_, team_, [&](std::size_t i) { return moving_mass(i); });
  }

  /// Displacements over the length of the scene, and rotations, of sizes with which all have energies alike.
  /// \returns norm
  double start(std::span<const double> weight) {
    const Vector3d centre = centre_of_mass();
    const double squared = sum_over_nodes(vectors_, nodes_, team_, [&](std::size_t i) {
      const Chirp chirp = chirp_at(i, centre);
      double norm = 0;
      const auto begin = [&](std::size_t kind, double length, double mass, double inverse_mass) {
        const double whole = square_of(vectors_.length / length) * mass_;
        const double size = length * weight[i] * std::sqrt(whole * inverse_mass);
        const int first = kind == 0 ? 0 : 3;
        now(kind)[i] = {{size * chirp(first), size * chirp(first + 1), size * chirp(first + 2), 0}};
        next(kind)[i] = {};
        norm += mass * dot3(now(kind)[i], now(kind)[i]);
      };
      begin(0, vectors_.length, nodes_.mass[i], nodes_.record[i].inverse_mass);
      if (turns_) begin(1, 1, nodes_.rotational_inertia[i], nodes_.angular_velocity[i].component[3]);
      return norm;
    });
    return std::sqrt(squared / unit());
  }

  /// next -= K now. \returns now . K now, where next was orthogonal to now
  double multiply(SweepSchedule& schedule, std::span<Block> blocks) {
    const NodalRows displacement{now(0).data(), now(1).data()}, product{next(0).data(), next(1).data()};
    sweep_domains(schedule, product, team_, [&](std::size_t t) {
      const SweepTask& task = schedule.tasks[t];
      Block& block = blocks[task.block];
      if (block.kernel.multiply_stiffness != nullptr)
        block.kernel.multiply_stiffness(block, task.chunk, nodes_, displacement, product);
    });
    const double product_of_both = sum_over_nodes(vectors_, nodes_, team_, [&](std::size_t i) {
      double sum = dot3(now(0)[i], next(0)[i]);
      if (turns_) sum += dot3(now(1)[i], next(1)[i]);
      return sum;
    });
    return -product_of_both / unit();
  }

  /// next = - M^-1 next - a now. \returns norm of next
  double orthogonalize(double a) {
    const auto subtract = [&](std::size_t kind, std::size_t i, double inverse_mass) {
      NodeVector& result = next(kind)[i];
      for (std::size_t k = 0; k < 3; ++k)
        result.component[k] = -inverse_mass * result.component[k] - a * now(kind)[i].component[k];
      return dot3(result, result);
    };
    const double squared = sum_over_nodes(vectors_, nodes_, team_, [&](std::size_t i) {
      double sum = nodes_.mass[i] * subtract(0, i, nodes_.record[i].inverse_mass);
      if (turns_)
        sum += nodes_.rotational_inertia[i] * subtract(1, i, nodes_.angular_velocity[i].component[3]);
      return sum;
    });
    return std::sqrt(squared / unit());
  }

  /// now = next / norm, next = norm M now: what the next iteration subtracts.
  void shift(double norm) {
    std::swap(vectors_.linear[0], vectors_.linear[1]);
    std::swap(vectors_.angular[0], vectors_.angular[1]);
    for_nodes([&](std::size_t i) {
      scale(1 / norm, now(0)[i]);
      scale(norm * nodes_.mass[i], next(0)[i]);
      if (!turns_) return;
      scale(1 / norm, now(1)[i]);
      scale(norm * nodes_.rotational_inertia[i], next(1)[i]);
    });
  }

  /// now /= norm
  void normalize(double norm) {
    for_nodes([&](std::size_t i) {
      scale(1 / norm, now(0)[i]);
      if (turns_) scale(1 / norm, now(1)[i]);
    });
  }

 private:
  AlignedBuffer<NodeVector>& now(std::size_t kind) {
    return (kind == 0 ? vectors_.linear : vectors_.angular)[0];
  }
  AlignedBuffer<NodeVector>& next(std::size_t kind) {
    return (kind == 0 ? vectors_.linear : vectors_.angular)[1];
  }

  template <class Task>
  void for_nodes(Task&& of_node) {
    for_node_ranges(nodes_, team_, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) of_node(i);
    });
  }

  static double square_of(double a) { return a * a; }
  /// Of products of displacements by masses: in any units of length and mass they are of time alone.
  double unit() const { return mass_ * square_of(vectors_.length); }
  double moving_mass(std::size_t i) const { return nodes_.record[i].inverse_mass > 0 ? nodes_.mass[i] : 0; }

  Chirp chirp_at(std::size_t i, const Vector3d& centre) const {
    const double* x = nodes_.record[i].position;
    return {(x[0] - centre[0]) / vectors_.length, (x[1] - centre[1]) / vectors_.length,
            (x[2] - centre[2]) / vectors_.length};
  }

  Vector3d centre_of_mass() {
    Vector3d centre{};
    for (std::size_t axis = 0; axis < 3; ++axis)
      centre[axis] =
          sum_over_nodes(vectors_, nodes_, team_,
                         [&](std::size_t i) { return moving_mass(i) * nodes_.record[i].position[axis]; }) /
          mass_;
    return centre;
  }

  LanczosVectors& vectors_;
  const Nodes& nodes_;
  ThreadTeam& team_;
  bool turns_;
  double mass_;
};

}  // namespace

LanczosVectors make_lanczos_vectors(const Nodes& nodes, double length) {
  LanczosVectors vectors;
  for (AlignedBuffer<NodeVector>& v : vectors.linear) v = AlignedBuffer<NodeVector>(nodes.size());
  if (nodes.has_rotations())
    for (AlignedBuffer<NodeVector>& v : vectors.angular) v = AlignedBuffer<NodeVector>(nodes.size());
  vectors.length = length;
  vectors.of_ranges.resize(nodes.ranges.size());
  return vectors;
}

double assembled_frequency_squared(LanczosVectors& vectors, std::span<const double> stiffness_by_mass,
                                   SweepSchedule& schedule, std::span<Block> blocks, const Nodes& nodes,
                                   ThreadTeam& team) {
  Lanczos lanczos(vectors, nodes, team);
  std::array<double, iterations> diagonal{}, beside{};
  const double norm = lanczos.start(stiffness_by_mass);
  if (!(norm > 0)) return 0;
  lanczos.normalize(norm);
  std::size_t size = 0;
  while (size < iterations) {
    diagonal[size] = lanczos.multiply(schedule, blocks);
    beside[size] = lanczos.orthogonalize(diagonal[size]);
    ++size;
    if (!(beside[size - 1] > 1e-12 * diagonal[0])) break;
    if (size < iterations) lanczos.shift(beside[size - 1]);
  }
  return margin * largest_eigenvalue(std::span(diagonal).first(size), beside);
}

}  // namespace brio
