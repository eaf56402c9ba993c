#include "contact/surface/surface.hpp"

#include <gtest/gtest.h>

#include <map>
#include <random>
#include <stdexcept>

#include "contact/surface/exclusion.hpp"
#include "contact/surface/face_geometry.hpp"
#include "src/base/index.hpp"
#include "tests/contact/spring_model.hpp"

namespace brio::test {
namespace {

// A grid of hexahedra of which some are left out.
std::vector<int> grid(int nx, int ny, int nz, const std::function<bool(int, int, int)>& present) {
  std::vector<int> connectivity;
  const auto at = [&](int i, int j, int k) { return i + (nx + 1) * (j + (ny + 1) * k); };
  for (int k = 0; k < nz; ++k)
    for (int j = 0; j < ny; ++j)
      for (int i = 0; i < nx; ++i)
        if (present(i, j, k))
          for (int node :
               {at(i, j, k), at(i + 1, j, k), at(i + 1, j + 1, k), at(i, j + 1, k), at(i, j, k + 1),
                at(i + 1, j, k + 1), at(i + 1, j + 1, k + 1), at(i, j + 1, k + 1)})
            connectivity.push_back(node);
  return connectivity;
}

Surface solid_surface(const std::vector<int>& connectivity, std::size_t nodes) {
  const std::vector<SurfacePart> parts{{.name = "block", .connectivity = connectivity, .thickness = {}}};
  return make_surface(parts, nodes);
}

TEST(Surface, OfABoxHasItsSidesAndNodes) {
  const auto connectivity = grid(3, 4, 5, [](int, int, int) { return true; });
  const Surface surface = solid_surface(connectivity, 4 * 5 * 6);
  EXPECT_EQ(surface.face.size(), 2U * (3 * 4 + 4 * 5 + 3 * 5));
  EXPECT_EQ(surface.slaves(), 4U * 5 * 6 - 2 * 3 * 4);
  EXPECT_EQ(surface.body_count, 1);
}

TEST(Surface, OfRandomBlocksIsClosed) {
  std::mt19937 random(3);
  for (int round = 0; round < 20; ++round) {
    std::bernoulli_distribution present(0.2 + 0.03 * round);
    const auto connectivity = grid(5, 5, 5, [&](int, int, int) { return present(random); });
    const Surface surface = solid_surface(connectivity, 6 * 6 * 6);
    // Closed and oriented: every edge is run as often one way as the other.
    std::map<std::pair<int, int>, int> runs;
    for (const Face& face : surface.face)
      for (std::size_t k = 0; k < 4; ++k) {
        ++runs[{face.node[k], face.node[(k + 1) % 4]}];
        --runs[{face.node[(k + 1) % 4], face.node[k]}];
      }
    for (const auto& [edge, balance] : runs) EXPECT_EQ(balance, 0);
    for (const auto& neighbors : surface.neighbor)
      for (int neighbor : neighbors) EXPECT_GE(neighbor, 0);
  }
}

TEST(Surface, DegenerateSidesVanishOrBecomeTriangles) {
  // A wedge: the edge of nodes 2, 3 and of 6, 7 are one node each.
  const std::vector<int> wedge{0, 1, 2, 2, 3, 4, 5, 5};
  const Surface surface = solid_surface(wedge, 6);
  ASSERT_EQ(surface.face.size(), 5U);
  int triangles = 0;
  for (const Face& face : surface.face) triangles += face.corners() == 3;
  EXPECT_EQ(triangles, 2);
  for (std::size_t f = 0; f < 5; ++f)
    for (int k = 0; k < surface.face[f].corners(); ++k) EXPECT_GE(surface.neighbor[f][index(k)], 0);
}

TEST(Surface, TrianglesBetweenWedgesAreInside) {
  for (const std::array<int, 8>& above :
       {std::array{3, 4, 5, 5, 6, 7, 8, 8}, std::array{4, 5, 3, 3, 7, 8, 6, 6},
        std::array{5, 3, 4, 4, 8, 6, 7, 7}, std::array{3, 3, 4, 5, 6, 6, 7, 8}}) {
    std::vector<int> wedges{0, 1, 2, 2, 3, 4, 5, 5};
    wedges.insert(wedges.end(), above.begin(), above.end());
    EXPECT_EQ(solid_surface(wedges, 9).face.size(), 2U + 6U);
  }
}

TEST(Surface, ShellsAreOneFaceEachWithFreeEdges) {
  SpringModel model;
  model.add_sheet({3, 2}, {3, 2}, 0.1, 1, shifted({0, 0, 0}));
  model.start({});
  const Surface& surface = model.scene.surface;
  EXPECT_EQ(surface.face.size(), 6U);
  EXPECT_EQ(surface.slaves(), 12U);
  int free_edges = 0;
  for (const auto& neighbors : surface.neighbor)
    for (int neighbor : neighbors) free_edges += neighbor < 0;
  EXPECT_EQ(free_edges, 10);
  for (double radius : surface.radius) EXPECT_DOUBLE_EQ(radius, 0.05);
}

TEST(Surface, RefusesWhatHasNone) {
  const std::vector<int> nodes{0, 1, 2, 3};
  const std::vector<SurfacePart> thin{
      {.name = "sheet", .nodes_per_element = 4, .connectivity = nodes, .thickness = {}}};
  EXPECT_THROW(make_surface(thin, 4), std::invalid_argument);
  const std::vector<SurfacePart> dangling{
      {.name = "sheet", .nodes_per_element = 4, .connectivity = nodes, .thickness = {0.1}}};
  EXPECT_THROW(make_surface(dangling, 3), std::invalid_argument);
}

TEST(Exclusion, OfAShellReachesAsFarAsItsTightestFold) {
  for (const int refine : {1, 2, 4}) {
    SpringModel model;
    const int cells = 12 * refine;
    model.add_sheet({cells, cells}, {3, 3}, 0.25, 1, shifted({0, 0, 0}));
    model.start({});
    const Surface& surface = model.scene.surface;
    const int middle = cells / 2 * (cells + 1) + cells / 2;
    const double fold = 0.5 * std::numbers::pi * 0.25;
    for (int f = 0; f < static_cast<int>(surface.face.size()); ++f) {
      const Face& face = surface.face[index(f)];
      const double distance =
          std::sqrt(closest_point_on_quad(model.x(middle), vertices(model.nodes, face)).squared_distance);
      EXPECT_EQ(is_excluded(model.scene.excluded, surface.slave(middle), f), distance < fold) << refine;
    }
  }
}

TEST(Exclusion, DoesNotJumpBetweenLayersOfOnePart) {
  // A U of shells whose legs are 1.2 thicknesses apart: the other leg is not excluded, far from the bend.
  SpringModel model;
  const int cells = 40;
  const double thickness = 0.1;
  const double bend = 0.06 * std::numbers::pi;
  model.add_sheet({cells, 1}, {4, 0.1}, thickness, 1, [&](const Vector3d& x) -> Vector3d {
    const double along = x[0] - 2;
    if (std::abs(along) <= bend / 2) {
      const double angle = along / 0.06;
      return {0.06 * std::cos(angle), x[1], 0.06 * std::sin(angle)};
    }
    return {-(std::abs(along) - bend / 2), x[1], along > 0 ? 0.06 : -0.06};
  });
  model.start({});
  EXPECT_FALSE(is_excluded(model.scene.excluded, 0, cells - 1));
  EXPECT_FALSE(is_excluded(model.scene.excluded, 5, cells - 6));
}

TEST(Exclusion, OfASolidIsItsOwnElements) {
  SpringModel model;
  model.add_box({4, 4, 1}, {4, 4, 1}, 1, shifted({0, 0, 0}));
  model.start({});
  const Surface& surface = model.scene.surface;
  const int middle =
      surface.slave(12);  // in the lower side, of four elements, which have nothing but two sides each
  EXPECT_EQ(model.scene.excluded.of(middle).size(), 8U);
}

}  // namespace
}  // namespace brio::test
