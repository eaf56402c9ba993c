#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include "io/mesh/generate_mesh.hpp"
#include "src/base/index.hpp"
#include "src/deck/mass_properties.hpp"

namespace brio {
namespace {

using std::numbers::pi;

std::array<Vector3d, 8> corners_of(const Mesh& mesh, std::size_t e) {
  std::array<Vector3d, 8> corners{};
  const auto count = index(mesh.nodes_per_element);
  for (std::size_t n = 0; n < count; ++n) corners[n] = mesh.position[index(mesh.connectivity[e * count + n])];
  return corners;
}

/// Jacobian of the trilinear map at a corner: triple product of the edges that leave it.
double corner_jacobian(const std::array<Vector3d, 8>& x, std::size_t corner) {
  // Neighbours along the three local axes, right-handed.
  static constexpr std::size_t next[8][3] = {{1, 3, 4}, {2, 0, 5}, {3, 1, 6}, {0, 2, 7},
                                             {7, 5, 0}, {4, 6, 1}, {5, 7, 2}, {6, 4, 3}};
  const auto edge = [&](std::size_t i) { return x[next[corner][i]] - x[corner]; };
  return dot(edge(0), cross(edge(1), edge(2)));
}
double scaled_jacobian(const std::array<Vector3d, 8>& x, std::size_t corner) {
  static constexpr std::size_t next[8][3] = {{1, 3, 4}, {2, 0, 5}, {3, 1, 6}, {0, 2, 7},
                                             {7, 5, 0}, {4, 6, 1}, {5, 7, 2}, {6, 4, 3}};
  double lengths = 1;
  for (const std::size_t n : next[corner]) lengths *= norm(x[n] - x[corner]);
  return corner_jacobian(x, corner) / lengths;
}

double smallest_corner_jacobian(const Mesh& mesh) {
  double smallest = HUGE_VAL;
  for (std::size_t e = 0; e < mesh.element_count(); ++e)
    for (std::size_t corner = 0; corner < 8; ++corner)
      smallest = std::min(smallest, corner_jacobian(corners_of(mesh, e), corner));
  return smallest;
}

/// Area vector of a quadrilateral: half the product of its diagonals.
Vector3d area_vector(const Vector3d& a, const Vector3d& b, const Vector3d& c, const Vector3d& d) {
  return 0.5 * cross(c - a, d - b);
}

std::array<Vector3d, 4> corners_of(const Mesh& mesh, const ElementSide& side) {
  const auto x = corners_of(mesh, index(side.element));
  if (mesh.nodes_per_element == 4) return {x[0], x[1], x[2], x[3]};
  std::array<Vector3d, 4> corners{};
  for (std::size_t n = 0; n < 4; ++n) corners[n] = x[index(sides_of_hex[index(side.side)][n])];
  return corners;
}

/// Sum of the areas of a side set whose sides are plane.
double area(const Mesh& mesh, const std::string& set) {
  double sum = 0;
  for (const ElementSide& side : mesh.side_sets.at(set)) {
    const auto [a, b, c, d] = corners_of(mesh, side);
    const Vector3d s = area_vector(a, b, c, d);
    sum += norm(s);
  }
  return sum;
}

/// Volume within the surface `all`, by the divergence theorem; exact where sides are plane.
double enclosed_volume(const Mesh& mesh) {
  double volume = 0;
  for (const ElementSide& side : mesh.side_sets.at("all")) {
    const auto [a, b, c, d] = corners_of(mesh, side);
    const Vector3d middle{(a[0] + b[0] + c[0] + d[0]) / 4, (a[1] + b[1] + c[1] + d[1]) / 4,
                          (a[2] + b[2] + c[2] + d[2]) / 4};
    volume += dot(middle, area_vector(a, b, c, d)) / 3;
  }
  return volume;
}

/// Sides that belong to one element only, by their corners.
std::size_t free_side_count(const Mesh& mesh) {
  std::map<std::set<int>, int> owners;
  for (std::size_t e = 0; e < mesh.element_count(); ++e)
    for (const auto& side : sides_of_hex) {
      std::set<int> corners;
      for (const int corner : side) corners.insert(mesh.connectivity[8 * e + index(corner)]);
      ++owners[corners];
    }
  return index(
      std::count_if(owners.begin(), owners.end(), [](const auto& side) { return side.second == 1; }));
}

/// Vertices minus edges plus faces of the surface `all`.
int euler_characteristic(const Mesh& mesh) {
  std::set<int> vertices;
  std::map<std::set<int>, int> edges;
  for (const auto& [element, side] : mesh.side_sets.at("all")) {
    std::array<int, 4> corner{};
    for (std::size_t n = 0; n < 4; ++n) {
      const auto local = mesh.nodes_per_element == 4 ? n : index(sides_of_hex[index(side)][n]);
      corner[n] = mesh.connectivity[index(element * mesh.nodes_per_element) + local];
    }
    for (std::size_t n = 0; n < 4; ++n) {
      vertices.insert(corner[n]);
      if (corner[n] != corner[(n + 1) % 4]) ++edges[{corner[n], corner[(n + 1) % 4]}];
    }
  }
  for (const auto& [edge, count] : edges)
    EXPECT_TRUE(count == 2 || mesh.nodes_per_element == 4) << "the surface of a solid has no rim";
  return static_cast<int>(vertices.size()) - static_cast<int>(edges.size()) +
         static_cast<int>(mesh.side_sets.at("all").size());
}

Mesh mesh_of(const MeshSource& source) { return generate_mesh(source, {}); }

TEST(GenerateMesh, BoxFillsItsSize) {
  const Mesh box = mesh_of(BoxMesh{{22, 11, 2.5}, {22, 11, 3}});
  EXPECT_EQ(box.element_count(), 22U * 11 * 3);
  EXPECT_EQ(box.position.size(), 23U * 12 * 4);
  EXPECT_GT(smallest_corner_jacobian(box), 0.83);
  EXPECT_NEAR(enclosed_volume(box), 22 * 11 * 2.5, 1e-10);
  EXPECT_EQ(euler_characteristic(box), 2);
  EXPECT_EQ(free_side_count(box), box.side_sets.at("all").size());
  EXPECT_NEAR(area(box, "xmax"), 11 * 2.5, 1e-12);
  EXPECT_NEAR(area(box, "ymin"), 22 * 2.5, 1e-12);
  EXPECT_NEAR(area(box, "top"), 22 * 11, 1e-12);
  EXPECT_EQ(box.node_sets.at("xmin").size(), 12U * 4);
  EXPECT_EQ(box.node_sets.at("ymax").size(), 23U * 4);
  EXPECT_EQ(box.node_sets.at("bottom").size(), 23U * 12);
  EXPECT_EQ(box.node_sets.at("zmin"), box.node_sets.at("bottom"));
  for (const int n : box.node_sets.at("top")) EXPECT_EQ(box.position[index(n)][2], 1.25);
  for (const int n : box.node_sets.at("xmin")) EXPECT_EQ(box.position[index(n)][0], -11);
}

TEST(GenerateMesh, SideSetsLookOutwards) {
  const Mesh box = mesh_of(BoxMesh{{1, 2, 3}, {2, 3, 4}});
  const std::map<std::string, Vector3d> outwards{{"xmin", {-1, 0, 0}}, {"xmax", {1, 0, 0}},
                                                 {"ymin", {0, -1, 0}}, {"ymax", {0, 1, 0}},
                                                 {"zmin", {0, 0, -1}}, {"zmax", {0, 0, 1}}};
  for (const auto& [name, normal] : outwards)
    for (const ElementSide& side : box.side_sets.at(name)) {
      const auto [a, b, c, d] = corners_of(box, side);
      const Vector3d s = area_vector(a, b, c, d);
      EXPECT_NEAR(dot(s, normal), norm(s), 1e-14) << name;
    }
}

TEST(GenerateMesh, PlateIsFlatAndLooksUp) {
  const Mesh plate = mesh_of(PlateMesh{{4, 2}, {8, 3}});
  EXPECT_EQ(plate.nodes_per_element, 4);
  EXPECT_EQ(plate.element_count(), 24U);
  EXPECT_EQ(plate.position.size(), 36U);
  EXPECT_NEAR(area(plate, "all"), 8, 1e-14);
  EXPECT_EQ(euler_characteristic(plate), 1);
  EXPECT_EQ(plate.node_sets.at("boundary").size(), 2U * (8 + 3));
  EXPECT_EQ(plate.node_sets.at("xmax").size(), 4U);
  EXPECT_EQ(plate.node_sets.at("ymin").size(), 9U);
  for (const ElementSide& side : plate.side_sets.at("all")) {
    const auto [a, b, c, d] = corners_of(plate, side);
    EXPECT_GT(area_vector(a, b, c, d)[2], 0);
  }
}

TEST(GenerateMesh, ArcOfACylinderBeginsAtTheXAxis) {
  CylinderMesh panel{2, 3, {6, 4}};
  panel.arc = 120;
  const Mesh mesh = mesh_of(panel);
  EXPECT_EQ(mesh.position.size(), 7u * 5u);
  EXPECT_EQ(mesh.connectivity.size(), 4u * 6u * 4u);
  EXPECT_EQ(mesh.node_sets.at("start").size(), 5u);
  for (const int node : mesh.node_sets.at("start")) EXPECT_EQ(mesh.position[index(node)][1], 0);
  for (const int node : mesh.node_sets.at("end")) {
    const Vector3d& x = mesh.position[index(node)];
    EXPECT_NEAR(x[0], 2 * std::cos(2 * std::numbers::pi / 3), 1e-14);
    EXPECT_NEAR(x[1], 2 * std::sin(2 * std::numbers::pi / 3), 1e-14);
  }
  EXPECT_EQ(mesh.node_sets.at("top").size(), 7u);
  EXPECT_EQ(node_set_names(panel), (std::vector<std::string_view>{"all", "bottom", "end", "start", "top"}));
  // As a closed one winds, so that normals point outwards.
  const auto corner = [&](std::size_t k) { return mesh.position[index(mesh.connectivity[k])]; };
  const Vector3d a = corner(0), b = corner(1), d = corner(3);
  const double outwards = (b[1] - a[1]) * (d[2] - a[2]) * a[0] - (b[0] - a[0]) * (d[2] - a[2]) * a[1];
  EXPECT_GT(outwards, 0);
}

TEST(GenerateMesh, CylinderIsClosedAroundAndOpenAtItsEnds) {
  const int around = 96, along = 60;
  const Mesh can = mesh_of(CylinderMesh{5.125, 15, {around, along}});
  EXPECT_EQ(can.position.size(), 96U * 61);
  EXPECT_EQ(can.element_count(), 96U * 60);
  EXPECT_EQ(euler_characteristic(can), 0) << "an annulus";
  EXPECT_EQ(can.node_sets.at("bottom").size(), 96U);
  EXPECT_EQ(can.node_sets.at("top").size(), 96U);
  // The facets of a regular polygon with the radius to its corners.
  EXPECT_NEAR(area(can, "all"), around * 2 * 5.125 * std::sin(pi / around) * 15, 1e-9);
  for (const int n : can.node_sets.at("top")) EXPECT_EQ(can.position[index(n)][2], 15);
  for (const Vector3d& x : can.position) EXPECT_NEAR(std::hypot(x[0], x[1]), 5.125, 1e-14);
  for (const ElementSide& side : can.side_sets.at("all")) {
    const auto [a, b, c, d] = corners_of(can, side);
    EXPECT_GT(dot(area_vector(a, b, c, d), {a[0] + b[0], a[1] + b[1], 0}), 0) << "looks outwards";
  }
}

TEST(GenerateMesh, TubeIsARing) {
  const int around = 24;
  const Mesh tube = mesh_of(TubeMesh{5, 5.25, 15, {around, 10, 3}});
  EXPECT_EQ(tube.position.size(), 24U * 11 * 4);
  EXPECT_EQ(tube.element_count(), 24U * 10 * 3);
  EXPECT_GT(smallest_corner_jacobian(tube), 0);
  EXPECT_EQ(euler_characteristic(tube), 0) << "a torus";
  EXPECT_EQ(free_side_count(tube), tube.side_sets.at("all").size());
  const double polygon = around / 2.0 * std::sin(2 * pi / around);
  EXPECT_NEAR(enclosed_volume(tube), polygon * (5.25 * 5.25 - 25) * 15, 1e-10);
  EXPECT_NEAR(area(tube, "inside"), around * 2 * 5 * std::sin(pi / around) * 15, 1e-10);
  EXPECT_EQ(tube.node_sets.at("outside").size(), 24U * 11);
  EXPECT_EQ(tube.node_sets.at("bottom").size(), 24U * 4);
  for (const int n : tube.node_sets.at("inside")) {
    const Vector3d& x = tube.position[index(n)];
    EXPECT_NEAR(std::hypot(x[0], x[1]), 5, 1e-14);
  }
}

TEST(GenerateMesh, RodIsFilledWithGoodElements) {
  for (const int across : {2, 4, 6, 8, 10, 12, 16, 24}) {
    const Mesh rod = mesh_of(RodMesh{3.2, 32.4, {across, 5}});
    const int around = 4 * (across - 2 * (across / 4));
    EXPECT_EQ(euler_characteristic(rod), 2) << across;
    EXPECT_EQ(free_side_count(rod), rod.side_sets.at("all").size());
    EXPECT_EQ(rod.node_sets.at("outside").size(), index(around * 6));
    EXPECT_NEAR(enclosed_volume(rod), around / 2.0 * std::sin(2 * pi / around) * 3.2 * 3.2 * 32.4, 1e-9);
    double worst = 1;
    for (std::size_t e = 0; e < rod.element_count(); ++e)
      for (std::size_t corner = 0; corner < 8; ++corner)
        worst = std::min(worst, scaled_jacobian(corners_of(rod, e), corner));
    // Of the coarsest, the corner of each quarter disc is the only one off: 135 degrees.
    EXPECT_GT(worst, across == 2 ? std::sqrt(0.5) - 1e-12 : 0.75) << across;
  }
}

TEST(GenerateMesh, RodKeepsTheVolumeOfTheRoundOneWhenAsked) {
  for (const int across : {2, 8, 12}) {
    const Mesh rod = mesh_of(RodMesh{3.2, 32.4, {across, 3}, true});
    EXPECT_NEAR(enclosed_volume(rod) / (pi * 3.2 * 3.2 * 32.4), 1, 1e-14) << across;
  }
}

TEST(GenerateMesh, ElementsAcrossTheDiameterAreCounted) {
  const Mesh rod = mesh_of(RodMesh{1, 1, {8, 1}});
  // Nodes of the bottom on the x axis: one more than elements across.
  const auto& bottom = rod.node_sets.at("bottom");
  EXPECT_EQ(std::count_if(bottom.begin(), bottom.end(),
                          [&](int n) { return std::abs(rod.position[index(n)][1]) < 1e-12; }),
            9);
}

double smallest_scaled_jacobian(const Mesh& mesh) {
  double worst = 1;
  for (std::size_t e = 0; e < mesh.element_count(); ++e)
    for (std::size_t corner = 0; corner < 8; ++corner)
      worst = std::min(worst, scaled_jacobian(corners_of(mesh, e), corner));
  return worst;
}

TEST(GenerateMesh, SphereIsFilledWithGoodElements) {
  for (const int across : {2, 4, 6, 8, 10, 12, 16, 24}) {
    const Mesh sphere = mesh_of(SphereMesh{3, across});
    const int edge = across - 2 * (across / 4);
    EXPECT_EQ(sphere.element_count(), index(edge * edge * edge + 6 * edge * edge * (across / 4)));
    EXPECT_EQ(euler_characteristic(sphere), 2) << across;
    EXPECT_EQ(free_side_count(sphere), sphere.side_sets.at("all").size());
    EXPECT_EQ(sphere.node_sets.at("outside").size(), index(6 * edge * edge + 2));
    EXPECT_GT(smallest_scaled_jacobian(sphere), across == 2 ? 0.67 : 0.68) << across;
    for (const int n : sphere.node_sets.at("outside")) {
      const Vector3d& x = sphere.position[index(n)];
      EXPECT_NEAR(norm(x), 3, 1e-14);
    }
  }
}

TEST(GenerateMesh, SphereTendsToItsVolumeAndInertia) {
  const double volume = 4 * pi / 3 * 27;
  double last = 1;
  for (const int across : {4, 8, 16}) {
    const MassProperties found = mass_properties(mesh_of(SphereMesh{3, across}), 2, 0);
    const double error = 1 - found.mass / (2 * volume);
    EXPECT_GT(error, 0);
    if (across > 4) {
      EXPECT_NEAR(last / error, 4, 0.6) << "with the square of the size of the elements";
    }
    last = error;
    const Tensor<double> exact = 0.4 * 2 * volume * 9 * identity<double>();
    EXPECT_LE(norm(found.inertia - exact), 3 * error * norm(exact));
    EXPECT_LE(norm(found.centre), 1e-12) << "rounding of the sums over thousands of elements";
    const MassProperties kept = mass_properties(mesh_of(SphereMesh{3, across, true}), 2, 0);
    EXPECT_NEAR(kept.mass / (2 * volume), 1, 1e-13);
  }
}

TEST(GenerateMesh, HollowSphereIsClosedAndLooksOutwards) {
  double last = 1;
  for (const int quarter : {1, 4, 8}) {
    const Mesh sphere = mesh_of(HollowSphereMesh{2, quarter});
    EXPECT_EQ(sphere.element_count(), index(6 * quarter * quarter));
    EXPECT_EQ(sphere.position.size(), index(6 * quarter * quarter + 2));
    EXPECT_EQ(euler_characteristic(sphere), 2);
    for (const ElementSide& side : sphere.side_sets.at("all")) {
      const auto [a, b, c, d] = corners_of(sphere, side);
      EXPECT_GT(dot(area_vector(a, b, c, d), a), 0);
    }
    const double error = 1 - area(sphere, "all") / (4 * pi * 4);
    EXPECT_GT(error, 0);
    if (quarter == 8) {
      EXPECT_NEAR(last / error, 4, 0.4);
    }
    last = error;
  }
}

// Section of a blade: its flanks up to the shoulders, a rectangle above them.
double blade_volume(const WedgeMesh& wedge) {
  const double shoulder = wedge.shoulder();
  return wedge.length *
         (shoulder * (wedge.thickness + wedge.tip_width) / 2 + (wedge.height - shoulder) * wedge.thickness);
}

TEST(GenerateMesh, WedgeHasTheSectionOfABlade) {
  for (const WedgeMesh& wedge :
       {WedgeMesh{0.25, 2, 3, 15, 0.02, {4, 8, 5}}, WedgeMesh{0.25, 2, 3, 15, 0, {4, 8, 5}},
        WedgeMesh{1, 0.5, 3, 45, 0, {2, 3, 1}}, WedgeMesh{1, 2, 3, 80, 0.5, {3, 2, 2}}}) {
    const Mesh mesh = mesh_of(wedge);
    EXPECT_NEAR(mass_properties(mesh, 1, 0).mass, blade_volume(wedge), 1e-13);
    EXPECT_EQ(euler_characteristic(mesh), 2);
    double lowest = 1, widest = 0;
    for (const Vector3d& x : mesh.position) {
      lowest = std::min(lowest, x[2]);
      widest = std::max(widest, x[0]);
      EXPECT_LE(std::abs(x[1]), wedge.length / 2);
      EXPECT_LE(x[2], wedge.height);
    }
    EXPECT_EQ(lowest, 0);
    EXPECT_EQ(widest, wedge.thickness / 2);
    // The angle between the tip and the shoulder.
    for (const int n : mesh.node_sets.at("xmax")) {
      const Vector3d& x = mesh.position[index(n)];
      if (x[2] > 0 && x[2] <= wedge.shoulder()) {
        EXPECT_NEAR((x[0] - wedge.tip_width / 2) / x[2], std::tan(wedge.half_angle * pi / 180), 1e-12);
      }
    }
    if (wedge.tip_width > 0) {
      EXPECT_NEAR(area(mesh, "zmin"), wedge.tip_width * wedge.length, 1e-14);
    } else {
      EXPECT_FALSE(mesh.side_sets.contains("zmin"));
    }
    EXPECT_NEAR(area(mesh, "zmax"), wedge.thickness * wedge.length, 1e-13);
  }
}

TEST(GenerateMesh, BladesThatCannotBeDrawnAreRefused) {
  EXPECT_NE((WedgeMesh{1, 2, 3, 15, 1, {1, 2, 1}}.fault()), "");
  EXPECT_NE((WedgeMesh{1, 1, 3, 15, 0, {1, 2, 1}}.fault()), "");
  EXPECT_NE((WedgeMesh{1, 3, 3, 15, 0, {1, 1, 1}}.fault()), "");
  EXPECT_EQ((WedgeMesh{1, 3, 3, 15, 0, {1, 2, 1}}.fault()), "");
  EXPECT_EQ((WedgeMesh{1, 0.5, 3, 45, 0, {1, 1, 1}}.fault()), "") << "flanks up to the top";
}

TEST(GenerateMesh, LineRunsFromStartToEnd) {
  const Mesh mesh = mesh_of(LineMesh{{1, 2, 3}, {2, 0, 3.5}, 3});
  EXPECT_EQ(mesh.nodes_per_element, 2);
  EXPECT_EQ(mesh.connectivity, (std::vector<int>{0, 1, 1, 2, 2, 3}));
  EXPECT_EQ(mesh.position.front(), (Vector3d{1, 2, 3}));
  EXPECT_EQ(mesh.position.back(), (Vector3d{2, 0, 3.5}));
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_NEAR(3 * (mesh.position[2][i] - mesh.position[1][i]), mesh.position[3][i] - mesh.position[0][i],
                1e-15);
  EXPECT_EQ(mesh.node_sets.at("start"), (std::vector<int>{0}));
  EXPECT_EQ(mesh.node_sets.at("end"), (std::vector<int>{3}));
}

TEST(GenerateMesh, NamesOfSetsAreThoseOfTheMesh) {
  const std::array<MeshSource, 10> sources{
      BoxMesh{{1, 1, 1}, {2, 2, 2}},          PlateMesh{{1, 1}, {2, 2}}, CylinderMesh{1, 1, {4, 2}},
      TubeMesh{1, 2, 1, {4, 2, 2}},           RodMesh{1, 1, {4, 2}},     WedgeMesh{1, 3, 2, 15, 0, {2, 4, 2}},
      WedgeMesh{1, 3, 2, 15, 0.1, {2, 4, 2}}, SphereMesh{1, 4},          HollowSphereMesh{1, 2},
      LineMesh{{0, 0, 0}, {1, 2, 3}, 4}};
  const auto names = [](const auto& sets) {
    std::vector<std::string_view> keys;
    for (const auto& [key, members] : sets) keys.push_back(key);
    return keys;
  };
  for (const MeshSource& source : sources) {
    const Mesh mesh = mesh_of(source);
    EXPECT_EQ(names(mesh.node_sets), node_set_names(source));
    EXPECT_EQ(names(mesh.side_sets), side_set_names(source));
    EXPECT_EQ(mesh.nodes_per_element, nodes_per_element(source));
    EXPECT_EQ(mesh.node_sets.at("all").size(), mesh.position.size());
    for (const auto& [name, nodes] : mesh.node_sets) {
      EXPECT_TRUE(std::adjacent_find(nodes.begin(), nodes.end(), std::greater_equal<>()) == nodes.end())
          << name;
      EXPECT_FALSE(nodes.empty());
    }
  }
}

TEST(Placement, TurnsThenMoves) {
  const Placement placement{Rotation{{0, 0, 2}, 90}, {10, 0, 0}};
  EXPECT_EQ(place(placement, {1, 0, 5}), (Vector3d{10, 1, 5}));
  const Placement tilted{Rotation{{0, 1, 0}, 10}, {0, 0, 19}};
  const Vector3d p = place(tilted, {1, 2, 0});
  EXPECT_NEAR(p[0], std::cos(10 * pi / 180), 1e-15);
  EXPECT_EQ(p[1], 2);
  EXPECT_NEAR(p[2], 19 - std::sin(10 * pi / 180), 1e-14);
}

TEST(Placement, ThirdTurnAboutTheDiagonalSwapsTheAxes) {
  const Vector3d p = place({Rotation{{1, 1, 1}, 120}, {}}, {1, 2, 3});
  EXPECT_NEAR(p[0], 3, 1e-14);
  EXPECT_NEAR(p[1], 1, 1e-14);
  EXPECT_NEAR(p[2], 2, 1e-14);
}

TEST(Placement, LeavesVolumeAndSetsAlone) {
  const BoxMesh box{{1, 2, 3}, {2, 3, 4}};
  const Mesh here = mesh_of(box);
  const Mesh there = generate_mesh(box, {Rotation{{1, -2, 0.5}, 33}, {100, -50, 7}});
  EXPECT_EQ(here.connectivity, there.connectivity);
  EXPECT_EQ(here.node_sets, there.node_sets);
  EXPECT_NEAR(smallest_corner_jacobian(there), smallest_corner_jacobian(here), 1e-12);
}

}  // namespace
}  // namespace brio
