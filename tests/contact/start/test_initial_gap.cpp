#include <gtest/gtest.h>

#include <random>

#include "contact/geometry/closest_segments.hpp"
#include "contact/surface/face_geometry.hpp"
#include "src/base/index.hpp"
#include "tests/contact/spring_model.hpp"
#include "tests/rotation_about.hpp"

// The start of contact by distances: what touches or overlaps a little is moved apart to its radii.

namespace brio::test {
namespace {

/// Boxes, sheets, beams and particles at rest.
class RestingScene {
 public:
  SpringModel model;  ///< boxes and sheets
  std::vector<SurfacePart> more;
  std::vector<Vector3d> extra;  ///< nodes of beams and particles
  Nodes nodes;
  ContactScene scene;
  Tensor<double> turn = identity<double>();
  Vector3d shift{};
  std::vector<InitialOverlap> report;
  std::vector<Vector3d> start;

  void box(const Vector3d& corner, const Vector3d& size, std::array<int, 3> cells) {
    model.add_box(cells, size, 1, shifted(corner));
  }

  /// \param prepare prescribes or makes rigid, after the nodes are there.
  void begin(const std::function<void(std::vector<SurfacePart>&, Nodes&)>& prepare = {}) {
    ContactOptions options;
    model.start(options);
    const auto first = index(model.count());
    nodes = Nodes(first + extra.size(), false);
    nodes.prescribed = AlignedBuffer<std::uint8_t>(nodes.size());
    for (std::size_t n = 0; n < nodes.size(); ++n) {
      const Vector3d x = turn * (n < first ? model.x(static_cast<int>(n)) : extra[n - first]) + shift;
      std::copy(x.data(), x.data() + 3, nodes.record[n].position);
      nodes.record[n].velocity[0] = 7;
      start.push_back(x);
    }
    std::vector<SurfacePart> parts = model.parts();
    parts.insert(parts.end(), more.begin(), more.end());
    if (prepare) prepare(parts, nodes);
    scene = make_contact_scene(options, parts, nodes);
    report = make_initial_gap(scene, nodes, model.alone());
  }

  Vector3d x(int n) const { return position(nodes, n); }
  Vector3d moved(int n) const { return x(n) - start[index(n)]; }
  double most_moved() const {
    double most = 0;
    for (int n = 0; n < static_cast<int>(nodes.size()); ++n) most = std::max(most, norm(moved(n)));
    return most;
  }
  double skin() const { return scene.features.skin; }

  /// The most that is missing at any pair of features of two bodies, by brute force.
  double missing() const {
    const SurfaceFeatures& features = scene.features;
    const Surface& surface = scene.surface;
    const auto at = [&](int slave) { return x(surface.node[index(slave)]); };
    double most = -1;
    for (std::size_t s = 0; s < surface.slaves(); ++s)
      for (std::size_t f = 0; f < surface.face.size(); ++f) {
        if (surface.face[f].body == surface.body[s]) continue;
        const ClosestPoint closest =
            closest_point_on_quad(at(static_cast<int>(s)), vertices(nodes, surface.face[f]));
        const double reach = features.node_radius[s] + features.face_radius[f];
        most = std::max(most, (reach - std::sqrt(closest.squared_distance)) / reach);
      }
    for (const EdgeFeature& a : features.edge)
      for (const EdgeFeature& b : features.edge) {
        if (a.body >= b.body || a.kind == EdgeKind::node || b.kind == EdgeKind::node) continue;
        const ClosestSegments closest =
            closest_points_of_segments({at(a.node[0]), at(a.node[1])}, {at(b.node[0]), at(b.node[1])});
        const double reach = a.radius + b.radius;
        most = std::max(most, (reach - std::sqrt(closest.squared_distance)) / reach);
      }
    return most;
  }
};

/// What may be missing of a gap is 1e-9 of an edge, 250 times as much of two skins.
constexpr double resolved = 1e-9 * 250;

void expect_made(const RestingScene& scene, double overlap = 0) {
  EXPECT_LT(scene.missing(), resolved);
  EXPECT_GT(scene.most_moved(), 0);
  EXPECT_LE(scene.most_moved(), overlap + 3 * scene.skin());
  for (std::size_t n = 0; n < scene.nodes.size(); ++n) EXPECT_EQ(scene.nodes.record[n].velocity[0], 7);
}

TEST(InitialGap, IsMadeBetweenBricksThatTouch) {
  for (const Vector3d& at :
       {Vector3d{0, 0, 2}, Vector3d{0.5, 0, 2}, Vector3d{0.3, 0.7, 2}, Vector3d{2, 0, 2},  // along an edge
        Vector3d{2, 0.3, 2}, Vector3d{2, 2, 2}, Vector3d{1, 1, 2}, Vector3d{1.9, 0.2, 2}}) {
    SCOPED_TRACE(testing::PrintToString(at));
    RestingScene scene;
    scene.box({0, 0, 0}, {2, 2, 2}, {2, 2, 2});
    scene.box(at, {2, 2, 2}, {2, 2, 2});
    scene.begin();
    expect_made(scene);
    ASSERT_FALSE(scene.report.empty());
    for (const InitialOverlap& entry : scene.report) {
      EXPECT_FALSE(entry.is_overlap());
      EXPECT_NEAR(entry.gap, 2 * scene.skin(), 1e-15);
      EXPECT_NEAR(entry.moved, scene.most_moved(), 1e-15);
    }
  }
}

// Rounding of turned and shifted coordinates is no side.
TEST(InitialGap, IsTheSameInAnyFrame) {
  const auto make = [](RestingScene& scene) {
    for (int i = 0; i < 4; ++i) scene.box({0.25 * i, 0.1 * i, 0.5 * i}, {1, 1, 0.5}, {2, 2, 1});
    scene.box({1, 0, 0}, {1, 1, 0.5}, {2, 2, 1});
    scene.box({1.25, 1.1, 0.5}, {1, 1, 0.5}, {1, 1, 1});
    scene.begin();
    expect_made(scene);
  };
  RestingScene scene;
  make(scene);
  const std::pair<double, Vector3d> frames[] = {{0, {1, 2, 3}}, {1e3, {-1, 0.3, 0.2}}, {1e3, {0, 0, 1}}};
  for (const auto& [far, axis] : frames) {
    RestingScene turned;
    turned.turn = rotation_about(0.7, axis);
    turned.shift = {far, 2 * far, -far};
    make(turned);
    for (int n = 0; n < static_cast<int>(scene.nodes.size()); ++n)
      EXPECT_LT(norm(turned.moved(n) - turned.turn * scene.moved(n)), 1e-2 * scene.skin()) << n;
  }
}

// Faces that touch move along their normal alone, each side by half.
TEST(InitialGap, IsSharedByBothAlongTheNormal) {
  RestingScene scene;
  scene.box({0, 0, 0}, {1, 1, 1}, {1, 1, 1});
  scene.box({0, 0, 1}, {1, 1, 1}, {1, 1, 1});
  scene.begin();
  for (int n = 4; n < 12; ++n) {
    const double way = n < 8 ? -scene.skin() : scene.skin();
    EXPECT_LT(norm(scene.moved(n) - Vector3d{0, 0, way}), 1e-7) << n;
  }
  for (int n : {0, 1, 2, 3, 12, 13, 14, 15}) EXPECT_EQ(scene.moved(n), (Vector3d{})) << n;
}

TEST(InitialGap, IsMadeInAStackOfTenEachAQuarterBeside) {
  RestingScene scene;
  for (int i = 0; i < 10; ++i) scene.box({0.25 * i, 0, 0.5 * i}, {1, 1, 0.5}, {2, 2, 1});
  scene.begin();
  expect_made(scene);
}

// A tube that is open along a slit, in a half ring around it, with facets that match, and with others that
// cut up to 1 % of an edge into it.
TEST(InitialGap, IsMadeBetweenAPipeAndItsHolder) {
  const auto ring = [](double inner, double outer, double from, double to) {
    return [=](const Vector3d& x) -> Vector3d {
      const double radius = inner + (outer - inner) * x[0], angle = from + (to - from) * x[1];
      return {radius * std::cos(angle), radius * std::sin(angle), x[2]};
    };
  };
  const double pi = std::numbers::pi;
  for (const int facets : {16, 15}) {
    SCOPED_TRACE(facets);
    RestingScene scene;
    scene.model.add_box({1, 30, 3}, {1, 1, 1}, 1, ring(0.8, 1, 0, 15. / 8 * pi));
    scene.model.add_box({1, facets, 2}, {1, 1, 1}, 1, ring(1, 1.3, 0, pi));
    scene.begin();
    const double sagitta = 1 - std::cos(0.5 * pi / facets);
    expect_made(scene, facets == 16 ? 0 : sagitta);
  }
}

TEST(InitialGap, IsMadeWhereBlocksOverlapByATenthOfAnEdge) {
  RestingScene scene;
  scene.box({0, 0, 0}, {4, 4, 2}, {4, 4, 2});
  scene.box({0.8, 0.7, 1.9}, {2, 2, 2}, {2, 2, 2});
  scene.begin();
  expect_made(scene, 0.1);
  ASSERT_FALSE(scene.report.empty());
  EXPECT_TRUE(scene.report.front().is_overlap());
  EXPECT_NEAR(scene.report.front().depth, 0.1, 1e-12);
}

double sum_of_magnitudes(const Vector3d& a) { return std::abs(a.x) + std::abs(a.y) + std::abs(a.z); }

/// Of two cubes of two units, one turned and shifted: the least overlap along the normals of faces and of
/// pairs of edges, and the direction from the first to the second along which it is.
std::pair<double, Vector3d> least_overlap(const Tensor<double>& turn, const Vector3d& shift) {
  double least = 1e9;
  Vector3d along{};
  const auto consider = [&](const Vector3d& axis) {
    if (norm(axis) < 1e-6) return;
    const Vector3d unit = normalized(axis);
    const double reach = sum_of_magnitudes(unit) + sum_of_magnitudes(transposed_times(turn, unit));
    const double overlap = reach - std::abs(dot(unit, shift));
    if (overlap >= least) return;
    least = overlap;
    along = dot(unit, shift) < 0 ? -unit : unit;
  };
  for (int i = 0; i < 3; ++i) {
    consider(identity<double>().row(i));
    consider(turn.column(i));
    for (int j = 0; j < 3; ++j) consider(cross(identity<double>().row(i), turn.column(j)));
  }
  return {least, along};
}

// Corners in faces and edges across edges, at any angle and from 0 to 0.08 of an edge deep.
TEST(InitialGap, IsMadeBetweenCubesAtAnyAngle) {
  std::mt19937 engine(5);
  const auto random = [&] { return std::uniform_real_distribution<double>(-1, 1)(engine); };
  for (int trial = 0; trial < 60; ++trial) {
    SCOPED_TRACE(trial);
    const Tensor<double> turn =
        rotation_matrix(normalized(Quaternion<double>{random(), random(), random(), random()}));
    Vector3d shift{2 * random(), 2 * random(), 2.5};
    const double depth = trial % 4 == 0 ? 0 : 0.04 * (1 + random());
    for (int round = 0; round < 50; ++round) {
      const auto [overlap, along] = least_overlap(turn, shift);
      shift += (overlap - depth) * along;
    }
    RestingScene scene;
    scene.box({-1, -1, -1}, {2, 2, 2}, {2, 2, 2});
    scene.model.add_box({2, 2, 2}, {2, 2, 2}, 1, [&](const Vector3d& x) -> Vector3d {
      return turn * (x - Vector3d{1, 1, 1}) + shift;
    });
    scene.begin();
    expect_made(scene, depth);
  }
}

// Bars across each other, where no node of either lies in the other.
TEST(InitialGap, IsMadeBetweenEdgesAlone) {
  for (const double depth : {0.0, 0.05}) {
    SCOPED_TRACE(depth);
    RestingScene scene;
    scene.model.add_box({3, 1, 1}, {3, 0.4, 0.4}, 1, shifted({-1.5, -0.2, 0}));
    scene.model.add_box({1, 3, 1}, {0.4, 3, 0.4}, 1, shifted({-0.2, -1.5, 0.4 - depth}));
    scene.begin();
    expect_made(scene, depth);
  }
}

TEST(InitialGap, LeavesWhatIsApartAsItIs) {
  RestingScene scene;
  scene.box({0, 0, 0}, {2, 2, 2}, {2, 2, 2});
  scene.box({0.3, 0.4, 2.01}, {2, 2, 2}, {2, 2, 2});
  scene.model.add_sheet({3, 3}, {2, 2}, 0.1, 1, shifted({0, 0, 4.2}));
  scene.model.add_sheet({3, 3}, {2, 2}, 0.1, 1, shifted({0.1, 0, 4.301}));
  scene.begin();
  EXPECT_TRUE(scene.report.empty());
  EXPECT_EQ(scene.most_moved(), 0);
}

// Shells keep their thickness, against solids the skin as well.
TEST(InitialGap, OfShellsIsTheirThickness) {
  RestingScene scene;
  scene.box({0, 0, 0}, {2, 2, 1}, {2, 2, 1});
  scene.model.add_sheet({3, 3}, {1.5, 1.5}, 0.1, 1, shifted({0.2, 0.3, 1.05}));
  scene.model.add_sheet({3, 3}, {1.5, 1.5}, 0.1, 1, shifted({0.1, 0.2, 1.145}));
  scene.begin();
  expect_made(scene, 0.005);
  for (const InitialOverlap& entry : scene.report) {
    const bool of_block = entry.node_part == "part 0" || entry.face_part == "part 0";
    EXPECT_EQ(entry.is_overlap(), !of_block) << entry.node_part << entry.face_part;
    EXPECT_NEAR(entry.depth, of_block ? 0 : 0.005, 1e-12);
    EXPECT_NEAR(entry.gap, of_block ? scene.skin() : 0, 1e-12);
  }
}

TEST(InitialGap, IsMadeBetweenBeamsAndParticlesAndAWall) {
  RestingScene scene;
  scene.box({0, 0, 0}, {2, 2, 1}, {2, 2, 1});
  const int first = scene.model.count();
  scene.extra = {{0.3, 0.2, 1.095}, {1.7, 0.4, 1.095},  // a beam of radius 0.1 on the wall
                 {0.5, -0.5, 1.29}, {0.9, 1.5, 1.29},   // one across it
                 {1.5, 1.5, 1.05},                      // a particle on the wall
                 {1.5, 1.6, 1.05}};                     // and one beside it
  const std::vector<int> beams{first, first + 1, first + 2, first + 3}, particles{first + 4, first + 5};
  scene.more.push_back(
      {.name = "beams", .nodes_per_element = 2, .connectivity = beams, .thickness = {0.2, 0.2}});
  scene.more.push_back(
      {.name = "particles", .nodes_per_element = 1, .connectivity = particles, .thickness = {0.1, 0.1}});
  scene.begin();
  expect_made(scene, 0.02);
}

TEST(InitialGap, LeavesPrescribedAndRigidNodesWhereTheyAre) {
  for (const bool rigid : {false, true}) {
    RestingScene scene;
    scene.box({0, 0, 0}, {2, 2, 2}, {2, 2, 2});
    scene.box({0.3, 0.4, 2}, {2, 2, 2}, {2, 2, 2});
    scene.begin([&](std::vector<SurfacePart>& parts, Nodes& nodes) {
      if (rigid) parts[0].rigid = 0;
      for (std::size_t n = 0; n < 27 && !rigid; ++n) nodes.prescribed[n] = 4;
    });
    EXPECT_LT(scene.missing(), resolved);
    for (int n = 0; n < 27; ++n) EXPECT_EQ(scene.moved(n)[2], 0) << n;
    EXPECT_NEAR(scene.most_moved(), 2 * scene.skin(), 1e-6);
  }
}

// Two bricks side by side whose bottoms are fixed: fixed nodes are moved where they coincide.
TEST(InitialGap, OfTwoThatAreHeldIsMadeWhereTheyLieOnEachOther) {
  RestingScene scene;
  scene.box({0, 0, 0}, {1, 1, 1}, {1, 1, 1});
  scene.box({1, 0, 0}, {1, 1, 1}, {1, 1, 1});
  scene.begin([](std::vector<SurfacePart>&, Nodes& nodes) {
    for (std::size_t n : {0, 1, 2, 3, 8, 9, 10, 11}) nodes.prescribed[n] = 7;
  });
  EXPECT_LT(scene.missing(), resolved);
  EXPECT_LT(scene.most_moved(), 2 * scene.skin());
}

TEST(InitialGap, OfTwoThatAreRigidIsMadeOfTheirSurfaces) {
  RestingScene scene;
  scene.box({0, 0, 0}, {1, 1, 1}, {1, 1, 1});
  scene.box({1, 0, 0}, {1, 1, 1}, {1, 1, 1});
  scene.begin([](std::vector<SurfacePart>& parts, Nodes&) {
    parts[0].rigid = 0;
    parts[1].rigid = 1;
  });
  expect_made(scene);
}

// The fold of a strip that is drawn tighter than its thickness is no overlap.
TEST(InitialGap, KeepsWhatOverlapsAsDrawnWithinAPart) {
  RestingScene scene;
  scene.model.add_sheet({20, 2}, {4, 0.5}, 0.2, 1, [](const Vector3d& x) -> Vector3d {
    const double bend = 0.08 * std::numbers::pi, half = 0.5 * (4 - bend);
    if (x[0] < half) return {x[0], x[1], 0};
    if (x[0] > half + bend) return {half - (x[0] - half - bend), x[1], 0.16};
    const double angle = (x[0] - half) / 0.08;
    return {half + 0.08 * std::sin(angle), x[1], 0.08 - 0.08 * std::cos(angle)};
  });
  scene.begin();
  EXPECT_TRUE(scene.report.empty());
  EXPECT_EQ(scene.most_moved(), 0);
}

TEST(InitialGap, OfMirrorImagesIsAMirrorImage) {
  RestingScene scene;  // about the plane x = 0
  scene.box({-1, 0, 0}, {2, 1, 0.5}, {4, 2, 1});
  scene.box({-1.3, 0.1, 0.5}, {1, 0.8, 0.5}, {2, 2, 1});
  const Map mirrored = [](const Vector3d& x) -> Vector3d { return {0.3 + x[0], 0.1 + x[1], 0.48 + x[2]}; };
  scene.model.add_box({2, 2, 1}, {1, 0.8, 0.5}, 1, [&](const Vector3d& x) -> Vector3d {
    return mirrored(x) + Vector3d{0, 0, 0.02};
  });
  scene.box({-0.7, 0.3, 0.98}, {1.4, 1, 0.5}, {2, 1, 1});
  scene.begin();
  expect_made(scene, 0.02);
  const int count = static_cast<int>(scene.nodes.size());
  for (int n = 0; n < count; ++n) {
    int image = -1;
    for (int m = 0; m < count; ++m) {
      const Vector3d &a = scene.start[index(n)], &b = scene.start[index(m)];
      const auto box_of = [](int k) { return k < 30 ? 0 : k < 66 ? 1 : 2; };
      if (std::abs(a[0] + b[0]) + std::abs(a[1] - b[1]) + std::abs(a[2] - b[2]) < 1e-12 &&
          box_of(n) == box_of(m))
        image = m;
    }
    ASSERT_GE(image, 0) << n;
    const Vector3d own = scene.moved(n), other = scene.moved(image);
    EXPECT_NEAR(own[0], -other[0], 1e-12) << n;
    EXPECT_NEAR(own[1], other[1], 1e-12) << n;
    EXPECT_NEAR(own[2], other[2], 1e-12) << n;
  }
}

std::string refusal(RestingScene& scene) {
  try {
    scene.begin();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "accepted";
}

TEST(InitialGap, IsNotMadeForCrossedShells) {
  RestingScene scene;
  scene.model.add_sheet({4, 4}, {4, 4}, 0.05, 1, shifted({0, 0, 0}));
  scene.model.add_sheet({4, 4}, {2, 2}, 0.05, 1, [](const Vector3d& x) -> Vector3d {
    return {1.1 + 0.1 * x[1], 0.9 + x[0], x[1] - 1.03};
  });
  const std::string told = refusal(scene);
  EXPECT_NE(told.find("'part 1' goes through part 'part 0'"), std::string::npos) << told;
}

TEST(InitialGap, IsNotMadeForDeepOverlapsOrWhatLiesInside) {
  RestingScene deep;
  deep.box({0, 0, 0}, {4, 4, 3}, {4, 4, 3});
  deep.box({0.8, 0.9, 2.5}, {2, 2, 2}, {2, 2, 2});
  const std::string told = refusal(deep);
  EXPECT_NE(told.find("overlaps part"), std::string::npos) << told;
  EXPECT_NE(told.find("by 0.5 "), std::string::npos) << told;
  RestingScene inside;
  inside.box({0, 0, 0}, {8, 8, 8}, {8, 8, 8});
  inside.box({3.5, 3.5, 3.5}, {1, 1, 1}, {1, 1, 1});
  const std::string also_told = refusal(inside);
  EXPECT_NE(also_told.find("'part 1' lies in part 'part 0'"), std::string::npos) << also_told;
}

}  // namespace
}  // namespace brio::test
