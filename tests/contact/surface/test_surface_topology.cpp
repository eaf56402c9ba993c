#include "contact/surface/surface_topology.hpp"

#include <gtest/gtest.h>

#include "contact/surface/exclusion.hpp"
#include "contact/surface/face_geometry.hpp"
#include "src/base/index.hpp"
#include "tests/contact/surface/eroding_mesh.hpp"

namespace brio::test {
namespace {

// Two grids that share nodes, with holes and with nodes merged at random, so that elements are wedges,
// pyramids or worse, and sides are shared by more than two; shells on the grids' nodes and beside them.
ErodingMesh random_mesh(std::mt19937& random) {
  constexpr int n = 4;
  ErodingMesh mesh;
  std::vector<int> merged(2 * 5 * 5 * 5 + 40);
  for (std::size_t i = 0; i < merged.size(); ++i) merged[i] = static_cast<int>(i);
  const int merges = std::uniform_int_distribution<int>(0, 12)(random);
  for (int i = 0; i < merges; ++i) {
    const auto at = std::uniform_int_distribution<std::size_t>(0, 248)(random);
    const std::size_t step = std::array<std::size_t, 3>{1, 5, 25}[random() % 3];
    merged[at] = merged[at >= step ? at - step : at + step];
  }
  const auto node = [&](int i, int j, int k) { return merged[index(i + 5 * (j + 5 * k))]; };
  const auto present = [&](int, int, int) { return random() % 8 != 0; };
  mesh.add_grid(n, n, n, node, present);
  mesh.add_grid(
      n, n, 4, [&](int i, int j, int k) { return node(i, j, k + n); }, present);
  std::vector<std::array<int, 4>> shells;
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      shells.push_back({node(i, j, 0), node(i + 1, j, 0), node(i + 1, j + 1, 0), node(i, j + 1, 0)});
      shells.push_back({node(0, i, j), node(0, i, j + 1), node(0, i + 1, j + 1), node(0, i + 1, j + 1)});
    }
  for (int i = 0; i < 8; ++i) shells.push_back({250 + i, 251 + i, 261 + i, 260 + i});
  mesh.add_shells(shells, random);
  mesh.nodes = merged.size();
  return mesh;
}

void delete_and_compare(ErodingMesh& mesh, Surface& surface, SurfaceTopology& topology,
                        std::span<const SurfaceElement> deleted) {
  SurfaceChange change;
  delete_elements(surface, topology, deleted, change);
  mesh.mark(deleted);
  const RebuiltSurface rebuilt(mesh);
  ASSERT_NO_FATAL_FAILURE(expect_same_surface(surface, rebuilt.surface));
  ASSERT_TRUE(same_bodies(surface, rebuilt.surface, faces_by_name(rebuilt.surface)));
  for (int f : change.new_face) ASSERT_TRUE(surface.face[index(f)].alive());
  for (int f : change.dead_face) ASSERT_FALSE(surface.face[index(f)].alive());
}

TEST(SurfaceTopology, MendedSurfaceEqualsOneBuiltAnew) {
  std::mt19937 random(11);
  for (int round = 0; round < 30; ++round) {
    ErodingMesh mesh = random_mesh(random);
    Surface surface = make_surface(mesh.parts(), mesh.nodes);
    SurfaceTopology topology = make_topology(surface, mesh.parts());
    const int most = std::array<int, 4>{1, 3, 20, 90}[index(round % 4)];
    while (!mesh.living().empty()) {
      std::vector<SurfaceElement> deleted = mesh.living();
      std::shuffle(deleted.begin(), deleted.end(), random);
      deleted.resize(std::min(deleted.size(), std::size_t{1} + random() % index(most)));
      ASSERT_NO_FATAL_FAILURE(delete_and_compare(mesh, surface, topology, deleted)) << "round " << round;
      if (random() % 2 == 0) {
        topology.faces.release();
        topology.slaves.release();
      }
    }
    for (const Face& face : surface.face) ASSERT_FALSE(face.alive());
    for (int node : surface.node) ASSERT_LT(node, 0);
  }
}

// Positions of the nodes of a random mesh, as close as shells are thick.
Nodes positions_of(const ErodingMesh& mesh) {
  Nodes nodes(mesh.nodes, false);
  for (std::size_t n = 0; n < mesh.nodes; ++n) {
    const std::size_t along[3] = {n % 5, n / 5 % 5, n / 25};
    for (std::size_t axis = 0; axis < 3; ++axis)
      nodes.record[n].position[axis] = 0.1 * static_cast<double>(along[axis]);
  }
  return nodes;
}

// Exclusions of the mended surface are those of the one built anew.
void expect_same_exclusions(const Surface& mended, const Lists& excluded, const Surface& rebuilt,
                            const Lists& excluded_anew) {
  for (int n = 0; n < static_cast<int>(mended.slave_of.size()); ++n) {
    if (mended.slave(n) < 0) continue;
    const auto known = excluded.of(mended.slave(n));
    ASSERT_TRUE(std::is_sorted(known.begin(), known.end()));
    std::set<FaceName> own = names_of(mended, known);
    for (const FaceName& name : names_of(rebuilt, excluded_anew.of(rebuilt.slave(n))))
      ASSERT_EQ(own.erase(name), 1U) << "node " << n;
    ASSERT_TRUE(own.empty()) << "node " << n;
  }
}

TEST(Exclusion, MendedEqualsOneMadeAnew) {
  std::mt19937 random(21);
  for (int round = 0; round < 12; ++round) {
    ErodingMesh mesh = random_mesh(random);
    const Nodes nodes = positions_of(mesh);
    Surface surface = make_surface(mesh.parts(), mesh.nodes);
    SurfaceTopology topology = make_topology(surface, mesh.parts());
    Lists excluded = excluded_faces(surface, nodes);
    ErodingExclusion exclusion(surface, nodes);
    SurfaceChange change;
    while (!mesh.living().empty()) {
      std::vector<SurfaceElement> deleted = mesh.living();
      std::shuffle(deleted.begin(), deleted.end(), random);
      deleted.resize(std::min(deleted.size(), std::size_t{1} + random() % (round % 2 == 0 ? 4 : 30)));
      delete_elements(surface, topology, deleted, change);
      exclusion.mend(excluded, surface, topology, change);
      mesh.mark(deleted);
      const RebuiltSurface rebuilt(mesh);
      ASSERT_NO_FATAL_FAILURE(
          expect_same_exclusions(surface, excluded, rebuilt.surface, excluded_faces(rebuilt.surface, nodes)))
          << "round " << round;
      if (random() % 2 == 0) {
        topology.faces.release();
        topology.slaves.release();
      }
    }
  }
}

TEST(SurfaceTopology, AllElementsMayGoAtOnce) {
  std::mt19937 random(12);
  ErodingMesh mesh = random_mesh(random);
  Surface surface = make_surface(mesh.parts(), mesh.nodes);
  SurfaceTopology topology = make_topology(surface, mesh.parts());
  const std::vector<SurfaceElement> all = mesh.living();
  delete_and_compare(mesh, surface, topology, all);
  SurfaceChange change;
  delete_elements(surface, topology, all, change);  // once more: nothing is left to delete
  EXPECT_TRUE(change.dead_face.empty() && change.changed_slave.empty() && change.dead_slave.empty());
}

TEST(SurfaceTopology, SurvivorsKeepTheirNumbers) {
  ErodingMesh mesh;
  mesh.add_block(6, 5, 4);
  Surface surface = make_surface(mesh.parts(), mesh.nodes);
  SurfaceTopology topology = make_topology(surface, mesh.parts());
  const auto faces = faces_by_name(surface);
  const std::vector<int> slaves = surface.slave_of;
  SurfaceChange change;
  for (int e = 0; e < 60; ++e) {
    delete_elements(surface, topology, std::vector<SurfaceElement>{{0, 2 * e}}, change);
    for (const auto& [name, f] : faces_by_name(surface)) {
      ASSERT_EQ(faces.contains(name) ? faces.at(name) : f, f);
    }
    for (std::size_t n = 0; n < slaves.size(); ++n) {
      const bool survives = surface.slave_of[n] >= 0 && slaves[n] >= 0;
      ASSERT_EQ(survives ? slaves[n] : surface.slave_of[n], surface.slave_of[n]);
    }
  }
}

TEST(SurfaceTopology, NumbersOfTheDeadWaitUntilReleased) {
  ErodingMesh mesh;
  mesh.add_block(3, 3, 3);
  Surface surface = make_surface(mesh.parts(), mesh.nodes);
  SurfaceTopology topology = make_topology(surface, mesh.parts());
  SurfaceChange change;
  const std::size_t faces = surface.face.size();
  delete_elements(surface, topology, std::vector<SurfaceElement>{{0, 0}}, change);
  EXPECT_EQ(change.dead_face.size(), 3U);
  EXPECT_EQ(change.new_face.size(), 3U);
  EXPECT_EQ(change.dead_slave.size(), 1U);
  EXPECT_EQ(change.new_slave.size(), 1U);
  EXPECT_EQ(surface.face.size(), faces + 3);
  topology.faces.release();
  topology.slaves.release();
  delete_elements(surface, topology, std::vector<SurfaceElement>{{0, 26}}, change);
  EXPECT_EQ(surface.face.size(), faces + 3) << "three dead ones were taken over";
}

TEST(SurfaceTopology, DebrisKeepsItsNodesWithARadius) {
  ErodingMesh mesh;
  mesh.add_block(2, 1, 1);
  Surface surface = make_surface(mesh.parts(), mesh.nodes);
  std::vector<SurfacePart> parts = mesh.parts();
  parts[0].debris_radius = 0.2;
  SurfaceTopology topology = make_topology(surface, parts);
  SurfaceChange change;
  delete_elements(surface, topology, std::vector<SurfaceElement>{{0, 1}}, change);
  EXPECT_TRUE(change.dead_slave.empty());
  int debris = 0;
  for (std::size_t s = 0; s < surface.slaves(); ++s)
    if (surface.faces_of.of(static_cast<int>(s)).empty()) {
      ++debris;
      EXPECT_EQ(surface.radius[s], 0) << "grows where there is room";
      EXPECT_EQ(surface.of_solid[s], 0);
      EXPECT_EQ(surface.body[s], -1);
    }
  EXPECT_EQ(debris, 4);
  EXPECT_EQ(change.debris.size(), 4U);
}

// Eight elements around a node that was inside go at once.
TEST(SurfaceTopology, NodesThatNeverWereOnTheSurfaceBecomeDebris) {
  ErodingMesh mesh;
  mesh.add_block(4, 4, 4);
  std::vector<SurfaceElement> middle;
  for (int k : {1, 2})
    for (int j : {1, 2})
      for (int i : {1, 2}) middle.push_back({0, i + 4 * (j + 4 * k)});
  for (const double radius : {0.0, 0.2}) {
    Surface surface = make_surface(mesh.parts(), mesh.nodes);
    std::vector<SurfacePart> parts = mesh.parts();
    parts[0].debris_radius = radius;
    SurfaceTopology topology = make_topology(surface, parts);
    SurfaceChange change;
    delete_elements(surface, topology, middle, change);
    const int inner = surface.slave(62);
    EXPECT_EQ(inner >= 0, radius > 0);
    EXPECT_EQ(change.new_slave.size(), radius > 0 ? 27U : 26U);
    if (inner < 0) continue;
    EXPECT_TRUE(surface.faces_of.of(inner).empty());
    EXPECT_EQ(change.debris, std::vector<int>{inner});
    EXPECT_EQ(surface.body[index(inner)], -1);
    EXPECT_TRUE(std::is_sorted(change.changed_slave.begin(), change.changed_slave.end()));
    EXPECT_TRUE(std::binary_search(change.changed_slave.begin(), change.changed_slave.end(), inner));
  }
}

TEST(SurfaceTopology, ABlockTornInTwoIsTwoBodies) {
  ErodingMesh mesh;
  mesh.add_block(5, 3, 3);
  Surface surface = make_surface(mesh.parts(), mesh.nodes);
  SurfaceTopology topology = make_topology(surface, mesh.parts());
  SurfaceChange change;
  std::vector<SurfaceElement> layer;
  for (int i = 0; i < 9; ++i) layer.push_back({0, 2 + 5 * i});
  delete_elements(surface, topology, std::span(layer).first(8), change);
  EXPECT_FALSE(change.split) << "one element still joins them";
  EXPECT_EQ(surface.body_count, 1);
  delete_elements(surface, topology, std::span(layer).last(1), change);
  EXPECT_TRUE(change.split);
  EXPECT_EQ(surface.body_count, 2);
}

TEST(SurfaceTopology, DeletionsInTheBulkDoNotSplit) {
  ErodingMesh mesh;
  mesh.add_block(8, 8, 8);
  Surface surface = make_surface(mesh.parts(), mesh.nodes);
  SurfaceTopology topology = make_topology(surface, mesh.parts());
  SurfaceChange change;
  for (int k = 2; k < 6; ++k)
    for (int j = 2; j < 6; ++j)
      for (int i = 2; i < 6; ++i)
        delete_elements(surface, topology, std::vector<SurfaceElement>{{0, i + 8 * (j + 8 * k)}}, change);
  EXPECT_EQ(surface.body_count, 1);
  EXPECT_EQ(surface.face.size() - topology.faces.retired.size(), 6U * 64 + 6 * 16);
}

// The same hole in blocks of very different size.
TEST(SurfaceTopology, WorkIsProportionalToWhatIsDeleted) {
  const auto visits_of = [](int cells, int hole, bool at_once) {
    ErodingMesh mesh;
    mesh.add_block(cells, cells, cells);
    Surface surface = make_surface(mesh.parts(), mesh.nodes);
    SurfaceTopology topology = make_topology(surface, mesh.parts());
    SurfaceChange change;
    std::vector<SurfaceElement> deleted;
    for (int k = 0; k < hole; ++k)
      for (int j = 0; j < hole; ++j)
        for (int i = 0; i < hole; ++i) deleted.push_back({0, i + cells * (j + cells * k)});
    if (at_once) {
      delete_elements(surface, topology, deleted, change);
    } else {
      for (const SurfaceElement& element : deleted)
        delete_elements(surface, topology, std::vector{element}, change);
    }
    return static_cast<double>(topology.visits) / (hole * hole * hole);
  };
  for (const bool at_once : {true, false}) {
    EXPECT_EQ(visits_of(8, 4, at_once), visits_of(32, 4, at_once)) << "of the mesh it is independent";
    EXPECT_LE(visits_of(32, 12, at_once), 1.1 * visits_of(32, 4, at_once)) << "and no more than linear";
    EXPECT_LT(visits_of(32, 4, at_once), 500);
  }
}

}  // namespace
}  // namespace brio::test
