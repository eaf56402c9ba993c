#pragma once
/// Points and capture boxes of many kinds, made to be hard for a search.

#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "contact/search/search.hpp"
#include "src/base/floating_point.hpp"

namespace brio {

struct SearchScene {
  std::string name;
  std::vector<Vector3d> points{};
  std::vector<CaptureBox> boxes;
};

class SceneMaker {
 public:
  explicit SceneMaker(unsigned seed) : random_(seed) {}

  double uniform(double lower, double upper) { return lower + (upper - lower) * unit_(random_); }
  Vector3d in_cube(double half_edge) {
    return {uniform(-half_edge, half_edge), uniform(-half_edge, half_edge), uniform(-half_edge, half_edge)};
  }
  static CaptureBox around(const Vector3d& centre, double half_edge) {
    return {{centre.x - half_edge, centre.y - half_edge, centre.z - half_edge},
            {centre.x + half_edge, centre.y + half_edge, centre.z + half_edge}};
  }

  SearchScene uniform_cloud(int points, int boxes) {
    SearchScene scene{"uniform", {}, {}};
    for (int i = 0; i < points; ++i) scene.points.push_back(in_cube(1));
    for (int i = 0; i < boxes; ++i) scene.boxes.push_back(around(in_cube(1), uniform(0, 0.2)));
    return scene;
  }
  /// A flat sheet; many coordinates equal to the last bit, and box faces that pass through points.
  SearchScene sheet(int edge) {
    SearchScene scene{"sheet", {}, {}};
    for (int j = 0; j <= edge; ++j)
      for (int i = 0; i <= edge; ++i) scene.points.push_back({i * 0.25, j * 0.25, 3.0});
    for (int j = 0; j < edge; ++j)
      for (int i = 0; i < edge; ++i)
        scene.boxes.push_back({{i * 0.25, j * 0.25, 3.0}, {(i + 1) * 0.25, (j + 1) * 0.25, 3.0}});
    return scene;
  }
  /// A sheet folded to and fro onto itself, layers one tenth of an edge apart.
  SearchScene folded(int edge) {
    SearchScene scene{"folded", {}, {}};
    for (int j = 0; j < edge; ++j)
      for (int i = 0; i < edge; ++i) {
        const int layer = i / 5;
        scene.points.push_back({std::abs(i % 10 - 5) * 1.0, j * 1.0, 0.1 * layer + 0.001 * uniform(-1, 1)});
      }
    for (const auto& point : scene.points) scene.boxes.push_back(around(point, 1.1));
    return scene;
  }
  /// Small clusters of points a million edges apart.
  SearchScene debris(int clusters, int points_each) {
    SearchScene scene{"debris", {}, {}};
    for (int c = 0; c < clusters; ++c) {
      const Vector3d centre = in_cube(1e6);
      for (int i = 0; i < points_each; ++i) {
        scene.points.push_back(centre + in_cube(5));
        scene.boxes.push_back(around(centre + in_cube(5), uniform(0, 1.5)));
      }
    }
    return scene;
  }
  /// Scales over many orders of magnitude about a point that is not the origin.
  SearchScene graded(int points) {
    SearchScene scene{"graded", {}, {}};
    for (int i = 0; i < points; ++i) {
      const double scale = std::pow(10.0, uniform(-12, 12));
      const Vector3d point = Vector3d{0.3, -0.7, 1.1} + in_cube(scale);
      scene.points.push_back(point);
      scene.boxes.push_back(around(point, uniform(0, 1) * scale));
    }
    return scene;
  }
  SearchScene coincident(int points) {
    SearchScene scene{"coincident", {}, {}};
    for (int i = 0; i < points; ++i) scene.points.push_back({1, 2, 3});
    for (int i = 0; i < 20; ++i) scene.boxes.push_back(around({1, 2, 3}, 0));
    scene.boxes.push_back(around({1, 2, 3.5}, 0.25));
    return scene;
  }
  /// Boxes that are empty, flat, single points, infinite or not numbers; points likewise.
  SearchScene odd(int points) {
    constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
    constexpr double largest = std::numeric_limits<double>::max();
    SearchScene scene = uniform_cloud(points, points);
    scene.name = "odd";
    scene.points[3].y = not_a_number;
    scene.points[5] = {not_a_number, not_a_number, not_a_number};
    scene.points[7].x = infinity;
    scene.points[9].z = -infinity;
    scene.points[11] = {largest, -largest, largest};
    scene.points[13] = {0.0, -0.0, 0.0};
    scene.points[15] = {5e-324, -5e-324, 1e-310};
    scene.boxes[2] = {{-infinity, -infinity, -infinity}, {infinity, infinity, infinity}};
    scene.boxes[4] = {{-1, -1, -1}, {1, 1, 1}};
    scene.boxes[6] = {{1, 1, 1}, {-1, -1, -1}};
    scene.boxes[8] = {{-1, not_a_number, -1}, {1, 1, 1}};
    scene.boxes[10] = {{-1, -1, -1}, {1, 1, not_a_number}};
    scene.boxes[12] = {{-1, -1, 0.25}, {1, 1, 0.25}};
    scene.boxes[14] = {{-0.0, 0.0, -0.0}, {0.0, 0.0, 0.0}};
    scene.boxes[16] = {{-largest, -largest, -largest}, {largest, largest, largest}};
    scene.boxes[18] = {{infinity, -1, -1}, {infinity, 1, 1}};
    scene.boxes[20] = {{0, -1e-300, 0}, {1e-300, 1e-300, 1e-300}};
    return scene;
  }
  /// Every box holds every point.
  SearchScene crowded(int points) {
    SearchScene scene = uniform_cloud(points, 0);
    scene.name = "crowded";
    for (int i = 0; i < 40; ++i) scene.boxes.push_back(around(in_cube(0.1), 2));
    return scene;
  }

  std::vector<SearchScene> all() {
    return {uniform_cloud(1500, 1000), sheet(40), folded(40),   debris(8, 150), graded(600),
            coincident(400),           odd(300),  crowded(1300)};
  }

 private:
  std::mt19937_64 random_;
  std::uniform_real_distribution<double> unit_{0, 1};
};

}  // namespace brio
