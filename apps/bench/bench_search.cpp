// Measures the global contact search: each strategy on surfaces of several shapes, whole search (order,
// build, query, pairs in order) and the work it took. Times are the best and the median of several
// repetitions, interleaved.
//
//     bench_search [--csv] [--threads N] [--repetitions N] [SCENE...]      scenes: wall crumpled debris;
//     append 1M

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <exception>
#include <random>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "contact/search/global_search.hpp"
#include "src/base/index.hpp"

namespace brio {
namespace {

using Position = Vector3d;

struct FacedSurface {
  std::vector<Position> node;
  std::vector<std::array<int, 4>> face;
};

/// The six sides of a box of edge^3 elements of unit size; each side has nodes of its own.
void add_brick(FacedSurface& surface, const Position& corner, int edge, double turn) {
  const auto place = [&](double a, double b, double c) {
    return corner +
           Position{std::cos(turn) * a - std::sin(turn) * b, std::sin(turn) * a + std::cos(turn) * b, c};
  };
  for (int side = 0; side < 6; ++side) {
    const int axis = side / 2;
    const double level = side % 2 == 0 ? 0 : edge;
    const int first = static_cast<int>(surface.node.size());
    for (int j = 0; j <= edge; ++j)
      for (int i = 0; i <= edge; ++i) {
        double x[3];
        x[axis] = level;
        x[(axis + 1) % 3] = i;
        x[(axis + 2) % 3] = j;
        surface.node.push_back(place(x[0], x[1], x[2]));
      }
    for (int j = 0; j < edge; ++j)
      for (int i = 0; i < edge; ++i) {
        const int node = first + j * (edge + 1) + i;
        surface.face.push_back({node, node + 1, node + edge + 2, node + edge + 1});
      }
  }
}

/// A wall of bricks in courses, almost touching.
FacedSurface wall(int bricks, int edge) {
  FacedSurface surface;
  const double pitch = edge + 0.05;
  constexpr int bricks_in_course = 6;
  for (int brick = 0; brick < bricks; ++brick) {
    const int course = brick / bricks_in_course;
    const double along = brick % bricks_in_course + 0.5 * (course % 2);
    add_brick(surface, {along * pitch, 0.0, course * pitch}, edge, 0);
  }
  return surface;
}

/// A sheet of unit elements that is rolled and folded by a slope that oscillates along it.
FacedSurface crumpled(int edge) {
  FacedSurface surface;
  for (int j = 0; j <= edge; ++j) {
    const double v = 2 * M_PI * j / edge;
    Position position{0.0, 0.6 * j, 6 * std::sin(3 * v)};
    for (int i = 0; i <= edge; ++i) {
      const double u = 2 * M_PI * i / edge;
      const double slope = 4.5 * std::sin(7 * u + std::sin(2 * v)) + 2 * std::cos(3 * u - v);
      position = position + Position{std::cos(slope), 0.3 * std::sin(5 * u + 2 * v), std::sin(slope)};
      surface.node.push_back(position);
    }
  }
  for (int j = 0; j < edge; ++j)
    for (int i = 0; i < edge; ++i) {
      const int node = j * (edge + 1) + i;
      surface.face.push_back({node, node + 1, node + edge + 2, node + edge + 1});
    }
  return surface;
}

/// Clouds of small fragments, a million edges apart.
FacedSurface debris(int clouds, int fragments) {
  FacedSurface surface;
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (int cloud = 0; cloud < clouds; ++cloud) {
    const Position centre{1e6 * unit(random), 1e6 * unit(random), 1e6 * unit(random)};
    for (int fragment = 0; fragment < fragments; ++fragment)
      add_brick(surface, centre + Position{14 * unit(random), 14 * unit(random), 14 * unit(random)}, 3,
                3 * unit(random));
  }
  return surface;
}

FacedSurface surface_of(std::string_view scene) {
  if (scene == "wall") return wall(17, 14);
  if (scene == "wall1M") return wall(17, 99);
  if (scene == "crumpled") return crumpled(316);
  if (scene == "crumpled1M") return crumpled(1000);
  if (scene == "debris") return debris(20, 60);
  if (scene == "debris1M") return debris(200, 60);
  throw std::invalid_argument(
      fmt::format("no scene '{}'; there are wall, crumpled, debris, and each with 1M", scene));
}

std::vector<CaptureBox> capture_boxes(const FacedSurface& surface, double reach) {
  std::vector<CaptureBox> boxes;
  boxes.reserve(surface.face.size());
  for (const auto& face : surface.face) {
    const auto corner = [&](int k) { return surface.node[index(face[index(k)])]; };
    CaptureBox box{{corner(0).x, corner(0).y, corner(0).z}, {corner(0).x, corner(0).y, corner(0).z}};
    for (int k = 1; k < 4; ++k) {
      const double x[3] = {corner(k).x, corner(k).y, corner(k).z};
      for (int axis = 0; axis < 3; ++axis) {
        box.lower[axis] = std::min(box.lower[axis], x[axis]);
        box.upper[axis] = std::max(box.upper[axis], x[axis]);
      }
    }
    for (int axis = 0; axis < 3; ++axis) {
      box.lower[axis] -= reach;
      box.upper[axis] += reach;
    }
    boxes.push_back(box);
  }
  return boxes;
}

struct Measurement {
  std::vector<double> milliseconds;
  CandidatePairs pairs;
  SearchCounts counts;
};

template <class Search>
void repeat(Search& search, const FacedSurface& surface, const std::vector<CaptureBox>& boxes,
            ThreadTeam& team, Measurement& measurement) {
  measurement.counts = {};
  const auto start = std::chrono::steady_clock::now();
  search.find(surface.node, boxes, team, measurement.pairs, measurement.counts);
  const std::chrono::duration<double, std::milli> taken = std::chrono::steady_clock::now() - start;
  measurement.milliseconds.push_back(taken.count());
}

void print(std::string_view scene, std::string_view strategy, int threads, const FacedSurface& surface,
           Measurement& measurement, bool csv) {
  auto& times = measurement.milliseconds;
  std::sort(times.begin(), times.end());
  fmt::print(fmt::runtime(csv ? "{},{},{},{},{},{:.4f},{:.4f},{},{}\n"
                              : "{:<11} {:<12} {:>7} {:>8} {:>8} {:>10.3f} {:>10.3f} {:>9} {:>13}\n"),
             scene, strategy, threads, surface.node.size(), surface.face.size(), times.front(),
             times[times.size() / 2], measurement.counts.candidate_pairs, measurement.counts.comparisons);
}

/// \throws std::runtime_error when the strategies do not find the same pairs.
void measure(std::string_view scene, int threads, int repetitions, bool csv) {
  const FacedSurface surface = surface_of(scene);
  const std::vector<CaptureBox> boxes = capture_boxes(surface, 0.1);
  ThreadTeam team(threads);
  TreeSearch tree;
  SortedListSearch lists;
  Measurement by_tree;
  Measurement by_lists;
  constexpr std::size_t largest_for_lists = 300000;  // they would take minutes
  const bool both = surface.node.size() <= largest_for_lists;
  for (int i = 0; i < repetitions; ++i) {
    repeat(tree, surface, boxes, team, by_tree);
    if (both) repeat(lists, surface, boxes, team, by_lists);
  }
  print(scene, "tree", threads, surface, by_tree, csv);
  if (!both) return;
  print(scene, "sorted_lists", threads, surface, by_lists, csv);
  if (by_tree.pairs.first != by_lists.pairs.first || by_tree.pairs.node != by_lists.pairs.node)
    throw std::runtime_error(fmt::format("{}: the strategies do not find the same pairs", scene));
}

int run(int count, char** arguments) {
  bool csv = false;
  int threads = 1;
  int repetitions = 5;
  std::vector<std::string> scenes;
  for (int i = 1; i < count; ++i) {
    const std::string_view word = arguments[i];
    if (word == "--csv") {
      csv = true;
    } else if ((word == "--threads" || word == "--repetitions") && i + 1 < count) {
      (word == "--threads" ? threads : repetitions) = std::stoi(arguments[++i]);
    } else {
      scenes.emplace_back(word);
    }
  }
  if (threads < 1 || repetitions < 1) throw std::invalid_argument("threads and repetitions are at least 1");
  if (scenes.empty()) scenes = {"wall", "crumpled", "debris"};
  if (csv) {
    fmt::print("scene,strategy,threads,nodes,faces,best_ms,median_ms,pairs,comparisons\n");
  } else {
    fmt::print("{:<11} {:<12} {:>7} {:>8} {:>8} {:>10} {:>10} {:>9} {:>13}\n", "scene", "strategy", "threads",
               "nodes", "faces", "best ms", "median ms", "pairs", "comparisons");
  }
  for (const std::string& scene : scenes) measure(scene, threads, repetitions, csv);
  return EXIT_SUCCESS;
}

}  // namespace
}  // namespace brio

int main(int count, char** arguments) {
  try {
    return brio::run(count, arguments);
  } catch (const std::exception& error) {
    fmt::print(stderr, "bench_search: {}\n", error.what());
    return 2;
  }
}
