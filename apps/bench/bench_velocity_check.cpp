// Measures the detailed contact check, of nodes with faces and of edges with edges: the rejection over eight
// pairs at once, and the whole check on pairs that are rejected, on near misses and on hits. Millions of
// pairs per second, best of several repetitions, one thread.
//
//     bench_velocity_check [REPETITIONS]

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <random>
#include <string_view>
#include <vector>

#include "contact/geometry/apart.hpp"
#include "contact/geometry/edge_check.hpp"
#include "contact/geometry/edges_apart.hpp"
#include "contact/geometry/velocity_check.hpp"
#include "src/base/index.hpp"

namespace brio {
namespace {

constexpr std::size_t pair_count = std::size_t{1} << 14;

struct Pair {
  MovingNode node;
  MovingFace face;
};

class Pairs {
 public:
  enum class Kind { random, near_miss, hit };

  explicit Pairs(Kind kind) : kind_(kind) {
    for (std::size_t k = 0; k < pair_count; ++k) pairs_.push_back(pair());
  }
  const std::vector<Pair>& all() const { return pairs_; }

 private:
  // A warped unit square that moves by a tenth of its size. A random node is within two sizes, as a search
  // with a buffer gives it; a near miss passes beside an edge by a hundredth; a hit comes down inside.
  Pair pair() {
    static constexpr double corner[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    Pair result;
    for (std::size_t k = 0; k < 4; ++k) {
      result.face.start[k] = Vector3d{corner[k][0], corner[k][1], 0} + vector(0.1);
      result.face.displacement[k] = vector(0.1);
    }
    result.node.displacement = vector(0.1);
    if (kind_ == Kind::random) {
      result.node.start = Vector3d{0.5, 0.5, 0} + vector(2);
      return result;
    }
    Vector3d target{};
    const double time = 0.5 + 0.4 * number();
    const double x = kind_ == Kind::hit ? 0.5 + 0.4 * number() : -0.01;
    const double y = 0.5 + 0.4 * number();
    const double weights[4] = {(1 - x) * (1 - y), x * (1 - y), x * y, (1 - x) * y};
    for (std::size_t k = 0; k < 4; ++k)
      target += weights[k] * (result.face.start[k] + time * result.face.displacement[k]);
    result.node.start = target - time * result.node.displacement;
    return result;
  }
  double number() { return uniform_(engine_); }
  Vector3d vector(double size) {
    const double x = size * number();
    const double y = size * number();
    return {x, y, size * number()};
  }

  Kind kind_;
  std::mt19937_64 engine_{7};
  std::uniform_real_distribution<double> uniform_{-1, 1};
  std::vector<Pair> pairs_;
};

struct Edges {
  MovingEdge a;
  MovingEdge b;
};

class EdgePairs {
 public:
  enum class Kind { random, near_miss, hit, parallel };

  explicit EdgePairs(Kind kind) : kind_(kind) {
    for (std::size_t k = 0; k < pair_count; ++k) pairs_.push_back(pair());
  }
  const std::vector<Edges>& all() const { return pairs_; }

 private:
  // Edges of about unit length that move by a tenth of it. Random ones have middles within two lengths; a
  // near miss passes an end by a hundredth; a hit crosses inside; parallel ones come down side by side.
  Edges pair() {
    Edges result;
    for (MovingEdge* edge : {&result.a, &result.b}) {
      const Vector3d direction = kind_ == Kind::parallel ? Vector3d{1, 0, 0} : normalized(vector(1));
      const Vector3d motion = vector(0.1);
      for (std::size_t k = 0; k < 2; ++k) {
        edge->start[k] = (k == 0 ? -0.5 : 0.5) * direction;
        edge->displacement[k] = kind_ == Kind::parallel ? motion : Vector3d(motion + vector(0.05));
      }
    }
    const double time = 0.5 + 0.4 * number();
    const double on_a = kind_ == Kind::near_miss ? 1.01 : 0.5 + 0.4 * number();
    const double on_b = 0.5 + 0.4 * number();
    const Vector3d shift = kind_ == Kind::random
                               ? vector(2)
                               : Vector3d(point(result.b, on_b, time) - point(result.a, on_a, time));
    for (Vector3d& end : result.a.start) end += shift;
    return result;
  }
  static Vector3d point(const MovingEdge& edge, double share, double time) {
    return (1 - share) * (edge.start[0] + time * edge.displacement[0]) +
           share * (edge.start[1] + time * edge.displacement[1]);
  }
  double number() { return uniform_(engine_); }
  Vector3d vector(double size) {
    const double x = size * number();
    const double y = size * number();
    return {x, y, size * number()};
  }

  Kind kind_;
  std::mt19937_64 engine_{8};
  std::uniform_real_distribution<double> uniform_{-1, 1};
  std::vector<Edges> pairs_;
};

template <Floating Real>
void put(Vector3<Lanes<Real>>& to, int lane, const Vector3d& from) {
  to.x.set(lane, static_cast<Real>(from[0]));
  to.y.set(lane, static_cast<Real>(from[1]));
  to.z.set(lane, static_cast<Real>(from[2]));
}

template <Floating Real>
std::vector<MovingEdgePair<Lanes<Real>>> packed(const std::vector<Edges>& pairs) {
  constexpr auto width = index(lane_count<Real>);
  std::vector<MovingEdgePair<Lanes<Real>>> packs(pairs.size() / width);
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    MovingEdgePair<Lanes<Real>>& pack = packs[k / width];
    const auto lane = static_cast<int>(k % width);
    for (std::size_t i = 0; i < 2; ++i) {
      put(pack.start_a[i], lane, pairs[k].a.start[i]);
      put(pack.displacement_a[i], lane, pairs[k].a.displacement[i]);
      put(pack.start_b[i], lane, pairs[k].b.start[i]);
      put(pack.displacement_b[i], lane, pairs[k].b.displacement[i]);
    }
  }
  return packs;
}

template <Floating Real>
std::vector<MovingPair<Lanes<Real>>> packed(const std::vector<Pair>& pairs) {
  constexpr auto width = index(lane_count<Real>);
  std::vector<MovingPair<Lanes<Real>>> packs(pairs.size() / width);
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    MovingPair<Lanes<Real>>& pack = packs[k / width];
    const auto lane = static_cast<int>(k % width);
    put(pack.start[0], lane, pairs[k].node.start);
    put(pack.displacement[0], lane, pairs[k].node.displacement);
    for (std::size_t i = 0; i < 4; ++i) {
      put(pack.start[i + 1], lane, pairs[k].face.start[i]);
      put(pack.displacement[i + 1], lane, pairs[k].face.displacement[i]);
    }
  }
  return packs;
}

template <class Work>
double best_seconds(int repetitions, Work&& work) {
  double best = 1e300;
  for (int k = 0; k < repetitions; ++k) {
    const auto begin = std::chrono::steady_clock::now();
    work();
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - begin;
    best = std::min(best, elapsed.count());
  }
  return best;
}

void row(std::string_view what, double seconds, std::size_t found, std::string_view of) {
  fmt::print("{:<34} {:>10.2f} {:>12.1f} {:>10} {}\n", what, 1e-6 * pair_count / seconds,
             1e9 * seconds / pair_count, found, of);
}

template <Floating Real, class AnyPair>
void measure_rejection(int repetitions, std::string_view name, const std::vector<AnyPair>& pairs) {
  const auto packs = packed<Real>(pairs);
  std::size_t apart = 0;
  const double seconds = best_seconds(repetitions, [&] {
    Lanes<Real> count(0.0);
    for (const auto& pack : packs)
      count += where(surely_apart(pack, Lanes<Real>(0.0)), Lanes<Real>(1.0), Lanes<Real>(0.0));
    apart = static_cast<std::size_t>(sum(count, lane_count<Real>));
  });
  row(name, seconds, apart, "dismissed");
}

void measure_check(int repetitions, std::string_view name, const std::vector<Pair>& pairs, double reach) {
  std::size_t touching = 0;
  const double seconds = best_seconds(repetitions, [&] {
    touching = 0;
    for (const Pair& pair : pairs) touching += velocity_check(pair.node, pair.face, reach).has_value();
  });
  row(name, seconds, touching, "touch");
}

void measure_edge_check(int repetitions, std::string_view name, std::vector<Edges> pairs, double radius) {
  for (Edges& pair : pairs) pair.a.radius = radius;
  std::size_t touching = 0;
  const double seconds = best_seconds(repetitions, [&] {
    touching = 0;
    for (const Edges& pair : pairs) touching += edge_check(pair.a, pair.b).has_value();
  });
  row(name, seconds, touching, "touch");
}

void measure_edges(int repetitions) {
  const EdgePairs random(EdgePairs::Kind::random);
  const EdgePairs near_miss(EdgePairs::Kind::near_miss);
  const EdgePairs hit(EdgePairs::Kind::hit);
  const EdgePairs parallel(EdgePairs::Kind::parallel);
  measure_rejection<double>(repetitions, "edges: rejection, 8 lanes, random", random.all());
  measure_rejection<float>(repetitions, "edges: rejection, 16 lanes float", random.all());
  measure_edge_check(repetitions, "edge check, random", random.all(), 0);
  measure_edge_check(repetitions, "edge check, near misses", near_miss.all(), 0);
  measure_edge_check(repetitions, "edge check, hits", hit.all(), 0);
  measure_edge_check(repetitions, "edge check, hits, radius 0.01", hit.all(), 0.01);
  measure_edge_check(repetitions, "edge check, parallel", parallel.all(), 0);
  measure_edge_check(repetitions, "edge check, parallel, radius 0.01", parallel.all(), 0.01);
}

void measure(int repetitions) {
  const Pairs random(Pairs::Kind::random);
  const Pairs near_miss(Pairs::Kind::near_miss);
  const Pairs hit(Pairs::Kind::hit);
  fmt::print("{:<34} {:>10} {:>12} {:>10} of {}\n", "", "M pairs/s", "ns a pair", "found", pair_count);
  measure_rejection<double>(repetitions, "rejection, 8 lanes, random", random.all());
  measure_rejection<float>(repetitions, "rejection, 16 lanes float, random", random.all());
  measure_check(repetitions, "velocity check, random", random.all(), 0);
  measure_check(repetitions, "velocity check, near misses", near_miss.all(), 0);
  measure_check(repetitions, "velocity check, hits", hit.all(), 0);
  measure_check(repetitions, "velocity check, hits, reach 0.01", hit.all(), 0.01);
}

}  // namespace
}  // namespace brio

int main(int argc, char** argv) {
  const int repetitions = argc > 1 ? std::atoi(argv[1]) : 20;
  if (repetitions < 1) {
    fmt::print(stderr, "bench_velocity_check: REPETITIONS is a number above zero\n");
    return 2;
  }
  brio::measure(repetitions);
  brio::measure_edges(repetitions);
  return 0;
}
