#pragma once
/// Crumpled sheets, cubes, beams and particles that lie about each other, and their motion.

#include "contact/pairs/feature_pairs.hpp"
#include "contact/surface/exclusion.hpp"
#include "src/base/index.hpp"
#include "tests/contact/geometry/adversarial_queries.hpp"

namespace brio {

/// How many of them.
struct SceneSize {
  int sheets = 2, cells = 2;  ///< cells along either side of a sheet
  int cubes = 1;
  int beams = 2;
  int particles = 2;
  double room = 1.5;  ///< edge of the cube they are scattered in
};

struct RandomScene {
  std::vector<int> sheet, cube, beam, particle;  ///< connectivity
  Nodes nodes;
  Surface surface;
  SurfaceFeatures features;
  Lists excluded;
  ContactOptions options;
  double dt = 0.01;

  RandomScene(const SceneSize& size, Random& random) {
    std::vector<Vector3d> at;
    for (int i = 0; i < size.sheets; ++i) add_sheet(size, random, at);
    for (int i = 0; i < size.cubes; ++i) add_cube(random.vector(size.room / 2), random, at);
    for (int i = 0; i < size.beams; ++i) {
      const Vector3d from = random.vector(size.room / 2);
      for (double share : {0.0, 1.0}) beam.push_back(add(from + share * random.vector(0.7), at));
    }
    for (int i = 0; i < size.particles; ++i) particle.push_back(add(random.vector(size.room / 2), at));
    build(at);
  }

  /// Velocities of all nodes: together, and every one by itself up to `speed`.
  void push(double speed, Random& random) {
    const Vector3d common = random.vector(5 * speed);
    for (NodeRecord& node : nodes.record) {
      const Vector3d v = common + random.vector(speed);
      std::copy(v.data(), v.data() + 3, node.velocity);
    }
  }
  /// To the end of the step, some of them a little farther: no path relies on what was predicted.
  void move(Random& random) {
    for (NodeRecord& node : nodes.record) {
      const Vector3d shift = random.integer(0, 19) == 0 ? random.vector(0.02) : Vector3d{};
      for (int axis = 0; axis < 3; ++axis) node.position[axis] += dt * node.velocity[axis] + shift[axis];
    }
  }

 private:
  static int add(const Vector3d& x, std::vector<Vector3d>& at) {
    at.push_back(x);
    return static_cast<int>(at.size()) - 1;
  }
  void add_sheet(const SceneSize& size, Random& random, std::vector<Vector3d>& at) {
    const Vector3d corner = random.vector(size.room / 2), u = random.vector(0.6), v = random.vector(0.6);
    const int first = static_cast<int>(at.size()), row = size.cells + 1;
    for (int j = 0; j < row; ++j)
      for (int i = 0; i < row; ++i) add(corner + i * u + j * v + random.vector(0.15), at);
    for (int j = 0; j < size.cells; ++j)
      for (int i = 0; i < size.cells; ++i)
        for (int n : {i + row * j, i + 1 + row * j, i + 1 + row * (j + 1), i + row * (j + 1)})
          sheet.push_back(first + n);
  }
  void add_cube(const Vector3d& corner, Random& random, std::vector<Vector3d>& at) {
    constexpr double lattice[8][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                                      {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
    for (const double* c : lattice)
      cube.push_back(add(corner + 0.5 * Vector3d{c[0], c[1], c[2]} + random.vector(0.05), at));
  }
  void build(const std::vector<Vector3d>& at) {
    nodes = Nodes(at.size(), true);
    for (std::size_t i = 0; i < at.size(); ++i) {
      std::copy(at[i].data(), at[i].data() + 3, nodes.record[i].position);
      nodes.record[i].inverse_mass = 1;
    }
    std::vector<SurfacePart> parts;
    const auto add_part = [&](const char* name, int per_element, const std::vector<int>& connectivity,
                              double thickness) {
      if (connectivity.empty()) return;
      SurfacePart& part = parts.emplace_back();
      part.name = name;
      part.nodes_per_element = per_element;
      part.connectivity = connectivity;
      if (thickness > 0) part.thickness.assign(connectivity.size() / index(per_element), thickness);
    };
    add_part("cubes", 8, cube, 0);
    add_part("sheets", 4, sheet, 0.05);
    add_part("beams", 2, beam, 0.04);
    add_part("particles", 1, particle, 0.08);
    surface = make_surface(parts, nodes.size());
    excluded = excluded_faces(surface, nodes);
    measure(features, surface, nodes);
    collect(features, surface, options);
  }
};

/// Every pair of features of a scene that may meet at all, however far apart.
inline FeaturePairs all_pairs(RandomScene& scene, ThreadTeam& team) {
  FeatureMotion motion;
  motion.predict(scene.features, scene.surface, scene.nodes, scene.dt, {}, team);
  ContactOptions everywhere = scene.options;
  everywhere.reach_buffer = 1e4;
  FeaturePairs pairs;
  const std::vector<double> any_depth(scene.surface.slaves(), 1);
  pairs.find(scene.features, scene.surface, scene.excluded, everywhere, motion, team, {any_depth, true});
  return pairs;
}

}  // namespace brio
