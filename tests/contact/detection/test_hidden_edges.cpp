// Which edges flat faces and sides hide, whenever pairs were searched for.

#include <gtest/gtest.h>

#include <algorithm>

#include "contact/features/flatness.hpp"
#include "src/base/index.hpp"

namespace brio {
namespace {

/// A plate of two square bricks side by side, of edge 1, and a bar of one brick above it, at right angles to
/// the side between the squares.
struct Plate {
  ThreadTeam team{1};
  Nodes nodes{20, true};
  Surface surface;
  SurfaceFeatures features;
  FeatureMotion motion;
  SurfaceFlatness flat;

  explicit Plate(double length_of_bar = 0.9) {
    for (int x = 0; x < 3; ++x)
      for (int y = 0; y < 2; ++y)
        for (int z = 0; z < 2; ++z) put(plate_node(x, y, z), {1.0 * x, 1.0 * y, z - 1.0});
    for (int x = 0; x < 2; ++x)
      for (int y = 0; y < 2; ++y)
        for (int z = 0; z < 2; ++z)
          put(bar_node(x, y, z), {1 + (x - 0.5) * length_of_bar, 0.3 + 0.4 * y, 0.1 + 0.5 * z});
    std::array<std::vector<int>, 2> connectivity;
    const auto add_brick = [](std::vector<int>& to, const auto& node) {
      for (int z = 0; z < 2; ++z)
        for (const auto& [x, y] : {std::pair(0, 0), {1, 0}, {1, 1}, {0, 1}}) to.push_back(node(x, y, z));
    };
    for (int first : {0, 1})
      add_brick(connectivity[0], [&](int x, int y, int z) { return plate_node(first + x, y, z); });
    add_brick(connectivity[1], bar_node);
    std::vector<SurfacePart> parts(2);
    for (std::size_t part : {0, 1}) {
      parts[part].nodes_per_element = 8;
      parts[part].connectivity = connectivity[part];
    }
    surface = make_surface(parts, nodes.size());
    measure(features, surface, nodes);
    collect(features, surface, {});
    step();
    flat.measure(features, motion, team);
    watch();
  }
  static int plate_node(int x, int y, int z) { return 4 * x + 2 * y + z; }
  static int bar_node(int x, int y, int z) { return 12 + 4 * x + 2 * y + z; }

  void put(int node, const Vector3d& x) { std::copy_n(x.data(), 3, nodes.record[index(node)].position); }
  void push(int node, const Vector3d& v) { std::copy_n(v.data(), 3, nodes.record[index(node)].velocity); }
  void step() { motion.predict(features, surface, nodes, 1, {}, team); }
  // As a search for all does.
  void watch() {
    flat.forget(features, true);
    for (int f = 0; f < static_cast<int>(surface.face.size()); ++f) flat.watch(features, motion, f);
  }
  int edge_between(int a, int b) const {
    const int first = surface.slave(a), second = surface.slave(b);
    const std::array ends{std::min(first, second), std::max(first, second)};
    const auto found = std::ranges::find(features.edge, ends, &EdgeFeature::node);
    return static_cast<int>(found - features.edge.begin());
  }
  /// The side between the squares on top, a diagonal of one of them, and an edge of the bar.
  int side() const { return edge_between(plate_node(1, 0, 1), plate_node(1, 1, 1)); }
  int diagonal() const { return edge_between(plate_node(0, 0, 1), plate_node(1, 1, 1)); }
  int bar() const { return edge_between(bar_node(0, 0, 0), bar_node(1, 0, 0)); }

  bool are_paired(int a, int b) const { return flat.pairs(features, a, b, false); }
  bool are_features(int a, int b, Moment moment = Moment::start) const {
    return flat.are_features(features, motion, a, b, {.radii = false, .moment = moment});
  }
  /// How thick hulls are at most that are flat.
  double most() const { return flat_thickness(features, 0, Flatness::all); }
};

TEST(HiddenEdges, AreTheDiagonalsAndShortSidesOfFlatFaces) {
  const Plate plate;
  for (int hidden : {plate.side(), plate.diagonal()}) {
    EXPECT_FALSE(plate.are_paired(plate.bar(), hidden));
    EXPECT_FALSE(plate.are_features(plate.bar(), hidden));
  }
  const Plate longer(1.2);
  EXPECT_TRUE(longer.are_paired(longer.bar(), longer.side())) << "longer than the squares are wide";
  EXPECT_TRUE(longer.are_features(longer.bar(), longer.side()));
  EXPECT_FALSE(longer.are_features(longer.bar(), longer.diagonal()));
}

// Whether they are constraints depends on the shape at the moment, not on when pairs were listed; those that
// must be constraints are listed.
TEST(HiddenEdges, AreFeaturesOnceTheFaceBends) {
  for (const double thickness : {0.4, 0.9, 1.1}) {
    Plate plate;
    const double by = thickness * plate.most();  // one corner by twice that: the hull of the face
    plate.put(Plate::plate_node(0, 0, 1), {0, 0, 2 * by});
    plate.step();
    EXPECT_EQ(plate.are_features(plate.bar(), plate.diagonal()), thickness > 1) << thickness;
    if (thickness > 1) {
      EXPECT_TRUE(plate.flat.any_bends(plate.features, plate.motion, plate.team));
    }
    plate.watch();
    EXPECT_EQ(plate.are_paired(plate.bar(), plate.diagonal()), thickness > 0.5) << thickness;
  }
  Plate plate;
  plate.push(Plate::plate_node(0, 0, 1), {0, 0, 3 * plate.most()});
  plate.step();
  EXPECT_FALSE(plate.are_features(plate.bar(), plate.diagonal()));
  EXPECT_TRUE(plate.are_features(plate.bar(), plate.diagonal(), Moment::end));
}

// What is a constraint stays in the list at the next search, however flat the face is.
TEST(HiddenEdges, StayPairedWhileTheyAreConstraints) {
  Plate plate;
  for (int hidden : {plate.side(), plate.diagonal()}) {
    const auto& [a, b] = plate.features.edge_node[index(plate.bar())];
    const auto& [c, d] = plate.features.edge_node[index(hidden)];
    const std::array<Contact, 1> constraints{Contact{.slave = first_edge_slave + plate.bar(),
                                                     .face = -1,
                                                     .own = 2,
                                                     .node = {a, b, c, d, d},
                                                     .weight = {}}};
    EXPECT_TRUE(has_edges(constraints, plate.bar(), constraints[0].node));
    EXPECT_FALSE(has_edges(constraints, hidden, constraints[0].node));
    plate.flat.hold(constraints);
    plate.watch();
    EXPECT_TRUE(plate.are_paired(plate.bar(), hidden));
    plate.flat.hold({});
    plate.watch();
    EXPECT_FALSE(plate.are_paired(plate.bar(), hidden));
  }
}

// Lengths are followed at the same steps whatever is searched.
TEST(HiddenEdges, LengthsAreMeasuredEvery128Steps) {
  Plate plate;
  const auto steps_until_paired = [&] {
    int steps = 0;
    while (++steps < 1000)
      if (plate.flat.follow_lengths(plate.features, plate.motion, plate.team)) return steps;
    return 0;
  };
  const auto stretch = [&](double length) {
    for (int y : {0, 1})
      for (int z : {0, 1})
        for (int x : {0, 1})
          plate.put(Plate::bar_node(x, y, z), {1 + (x - 0.5) * length, 0.3 + 0.4 * y, 0.1 + 0.5 * z});
    plate.step();
  };
  EXPECT_EQ(steps_until_paired(), 0) << "nothing moves";
  stretch(0.9 * 1.019);
  EXPECT_EQ(steps_until_paired(), 0) << "by less than a fiftieth";
  stretch(1.1);
  EXPECT_FALSE(plate.are_features(plate.bar(), plate.side())) << "as measured";
  // 999 steps twice before, of which 1,920 were whole periods.
  EXPECT_EQ(steps_until_paired(), 128 - (2 * 999) % 128);
  EXPECT_TRUE(plate.are_features(plate.bar(), plate.side()));
  stretch(0.9);
  EXPECT_EQ(steps_until_paired(), 0) << "what is shorter pairs nothing";
  EXPECT_FALSE(plate.are_features(plate.bar(), plate.side()));
}

}  // namespace
}  // namespace brio
