// Measures the kernels of contact detection: closest point of a face's hull, closest points of segments and
// certificates of separation, eight pairs at once, gathered from a sheet of 100,000 nodes, beside the scalar
// functions. Pairs in the order of their faces, as a search lists them, and in none. Nanoseconds a pair, best
// of several repetitions, interleaved, one thread.
//
//     bench_closest [REPETITIONS]

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <functional>
#include <random>
#include <string_view>
#include <vector>

#include "contact/features/gather.hpp"
#include "contact/geometry/closest_on_hull.hpp"
#include "contact/geometry/closest_on_segments.hpp"
#include "contact/geometry/closest_point.hpp"
#include "contact/geometry/closest_segments.hpp"
#include "contact/geometry/separation.hpp"
#include "src/base/index.hpp"

namespace brio {
namespace {

using Pack = Lanes<double>;

constexpr int columns = 316;
constexpr int rows = 317;
constexpr std::size_t pack_count = 32768;  // of eight pairs each: 2.6 pairs a node

// A crumpled sheet. A node meets a face some columns away, as after folding; so do edges.
class Sheet {
 public:
  explicit Sheet(bool is_ordered) : node_(columns * rows), end_(columns * rows) {
    for (int j = 0; j < rows; ++j) {
      for (int i = 0; i < columns; ++i) {
        const auto node = index(j * columns + i);
        const Vector3d place = Vector3d{1.0 * i, 1.0 * j, 0} + vector(0.2);
        for (int k = 0; k < 3; ++k) {
          node_[node].position[k] = place[k];
          end_[node].component[k] = place[k] + 0.01 * number();
        }
      }
    }
    std::vector<int> corners(8 * pack_count);
    for (int& corner : corners) corner = whole(2, columns - 4) + columns * whole(2, rows - 4);
    if (is_ordered) std::sort(corners.begin(), corners.end());
    for (std::size_t k = 0; k < corners.size(); ++k) add_pair(k, corners[k]);
  }
  const NodeRecord* nodes() const { return &node_[0]; }
  const PointRow* ends() const { return &end_[0]; }
  // Five nodes of eight pairs each: node and face; the first four are also those of two edges.
  const int* pack(std::size_t k) const { return &index_[40 * k]; }
  Vector3d position(int node) const {
    const double* p = node_[index(node)].position;
    return {p[0], p[1], p[2]};
  }

 private:
  void add_pair(std::size_t pair, int corner) {
    const int near = corner + whole(-2, 2) + columns * whole(-2, 2);
    const int nodes[5] = {near, corner, corner + 1, corner + columns + 1, corner + columns};
    for (std::size_t k = 0; k < 5; ++k) index_[40 * (pair / 8) + 8 * k + pair % 8] = nodes[k];
  }
  double number() { return uniform_(engine_); }
  int whole(int low, int high) {
    return low + static_cast<int>(engine_() % static_cast<unsigned>(high - low + 1));
  }
  Vector3d vector(double size) {
    const double x = size * number();
    const double y = size * number();
    return {x, y, size * number()};
  }

  AlignedBuffer<NodeRecord> node_;
  AlignedBuffer<PointRow> end_;
  std::vector<int> index_ = std::vector<int>(40 * pack_count);
  std::mt19937_64 engine_{7};
  std::uniform_real_distribution<double> uniform_{-1, 1};
};

std::array<Vector3<Pack>, 4> gather_four(const auto* rows_of, const int* node) {
  return {gather<Pack>(rows_of, node), gather<Pack>(rows_of, node + 8), gather<Pack>(rows_of, node + 16),
          gather<Pack>(rows_of, node + 24)};
}

double hulls(const Sheet& sheet) {
  Pack total(0.0);
  for (std::size_t k = 0; k < pack_count; ++k) {
    const int* node = sheet.pack(k);
    const auto closest =
        closest_on_hull(gather<Pack>(sheet.nodes(), node), gather_four(sheet.nodes(), node + 8));
    total += closest.squared_distance + closest.offset.x + closest.offset.y + closest.offset.z +
             (closest.weights[0] * closest.weights[1] + closest.weights[2] * closest.weights[3]) +
             where(closest.inside, Pack(1.0), Pack(0.0));
  }
  return sum(total, 8);
}

double segments(const Sheet& sheet) {
  Pack total(0.0);
  for (std::size_t k = 0; k < pack_count; ++k) {
    const int* node = sheet.pack(k);
    const auto [a0, a1, b0, b1] = gather_four(sheet.nodes(), node);
    const auto closest = closest_on_segments(a0, a1, b0, b1);
    total += closest.squared_distance + closest.on_a + closest.on_b + closest.offset.x + closest.offset.y +
             closest.offset.z;
  }
  return sum(total, 8);
}

// The direction is that of the first coordinates: as good as any for the time it takes.
double separations(const Sheet& sheet) {
  Pack total(0.0);
  const Vector3<Pack> d{Pack(0.1), Pack(0.2), Pack(0.9)};
  for (std::size_t k = 0; k < pack_count; ++k) {
    const int* node = sheet.pack(k);
    const auto heights =
        separation(d, gather<Pack>(sheet.nodes(), node), gather<Pack>(sheet.ends(), node),
                   gather_four(sheet.nodes(), node + 8), gather_four(sheet.ends(), node + 8));
    total += where(heights.is_certain(), Pack(1.0), Pack(0.0));
  }
  return sum(total, 8);
}

double separations_of_segments(const Sheet& sheet) {
  Pack total(0.0);
  const Vector3<Pack> d{Pack(0.1), Pack(0.2), Pack(0.9)};
  for (std::size_t k = 0; k < pack_count; ++k) {
    const int* node = sheet.pack(k);
    const auto [a0, a1, b0, b1] = gather_four(sheet.nodes(), node);
    const auto [a2, a3, b2, b3] = gather_four(sheet.ends(), node);
    const auto heights = separation<Pack, 2, 2>(d, {a0, a1}, {a2, a3}, {b0, b1}, {b2, b3});
    total += where(heights.is_certain(), Pack(1.0), Pack(0.0));
  }
  return sum(total, 8);
}

// With an extent that is known.
double separations_within(const Sheet& sheet) {
  Pack total(0.0);
  const Vector3<Pack> d{Pack(0.1), Pack(0.2), Pack(0.9)};
  const Vector3<Pack> extent{Pack(4.0), Pack(4.0), Pack(4.0)};
  for (std::size_t k = 0; k < pack_count; ++k) {
    const int* node = sheet.pack(k);
    const auto heights = separation_within<Pack, 1, 4>(
        extent, d, {gather<Pack>(sheet.nodes(), node)}, {gather<Pack>(sheet.ends(), node)},
        gather_four(sheet.nodes(), node + 8), gather_four(sheet.ends(), node + 8));
    total += where(heights.is_certain(), Pack(1.0), Pack(0.0));
  }
  return sum(total, 8);
}

double scalar_quads(const Sheet& sheet) {
  double total = 0;
  for (std::size_t k = 0; k < pack_count; ++k) {
    for (int lane = 0; lane < 8; ++lane) {
      const int* node = sheet.pack(k) + lane;
      total +=
          closest_point_on_quad(sheet.position(node[0]), {sheet.position(node[8]), sheet.position(node[16]),
                                                          sheet.position(node[24]), sheet.position(node[32])})
              .squared_distance;
    }
  }
  return total;
}

double scalar_segments(const Sheet& sheet) {
  double total = 0;
  for (std::size_t k = 0; k < pack_count; ++k) {
    for (int lane = 0; lane < 8; ++lane) {
      const int* node = sheet.pack(k) + lane;
      total += closest_points_of_segments({sheet.position(node[0]), sheet.position(node[8])},
                                          {sheet.position(node[16]), sheet.position(node[24])})
                   .squared_distance;
    }
  }
  return total;
}

struct Kernel {
  std::string_view name;
  double (*run)(const Sheet&);
  double best[2] = {1e300, 1e300};
  double total[2] = {0, 0};
};

void measure(int repetitions) {
  const Sheet sheets[2] = {Sheet(true), Sheet(false)};
  Kernel kernels[] = {{"hull, 8 lanes", hulls},
                      {"quad, scalar function", scalar_quads},
                      {"segments, 8 lanes", segments},
                      {"segments, scalar function", scalar_segments},
                      {"separation of node and face, 8 lanes", separations},
                      {"the same, extent known, 8 lanes", separations_within},
                      {"separation of segments, 8 lanes", separations_of_segments}};
  for (int k = 0; k < repetitions; ++k) {
    for (Kernel& kernel : kernels) {
      for (int order = 0; order < 2; ++order) {
        const auto begin = std::chrono::steady_clock::now();
        kernel.total[order] = kernel.run(sheets[order]);
        const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - begin;
        kernel.best[order] = std::min(kernel.best[order], elapsed.count());
      }
    }
  }
  fmt::print("{:<40} {:>10} {:>10} {:>16}\n", "ns a pair", "ordered", "shuffled", "sum");
  for (const Kernel& kernel : kernels)
    fmt::print("{:<40} {:>10.1f} {:>10.1f} {:>16.6g}\n", kernel.name, 1e9 * kernel.best[0] / (8 * pack_count),
               1e9 * kernel.best[1] / (8 * pack_count), kernel.total[0]);
}

}  // namespace
}  // namespace brio

int main(int argc, char** argv) {
  const int repetitions = argc > 1 ? std::atoi(argv[1]) : 20;
  if (repetitions < 1) {
    fmt::print(stderr, "bench_closest: REPETITIONS is a number above zero\n");
    return 2;
  }
  brio::measure(repetitions);
  return 0;
}
