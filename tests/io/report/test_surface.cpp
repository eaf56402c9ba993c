// What of a scene is seen, against a search of each frame by itself.

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>
#include <set>

#include "io/report/surface.hpp"
#include "src/base/index.hpp"
#include "src/base/tensor.hpp"

namespace brio {
namespace {

using Nodes = std::set<std::int64_t>;

constexpr int across = 4, frames = 9;

/// A cube of hexahedra, none of which is deleted.
SceneCells cube() {
  SceneCells cells{.offset = {0}};
  const auto node = [](int x, int y, int z) { return x + (across + 1) * (y + (across + 1) * z); };
  for (int i = 0; i < across * across * across; ++i) {
    const int x = i % across, y = i / across % across, z = i / across / across;
    for (const int up : {0, 1})
      for (const auto& corner : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}})
        cells.connectivity.push_back(node(x + corner.first, y + corner.second, z + up));
    cells.offset.push_back(static_cast<std::int64_t>(cells.connectivity.size()));
    cells.part.push_back(0);
    cells.id.push_back(i + 1);
    cells.until.push_back(frames);
  }
  return cells;
}

/// Sides that belong to one cell of a frame alone.
std::set<Nodes> seen_by_search(const SceneCells& cells, int frame) {
  const std::vector<std::vector<int>> sides{{0, 1, 2, 3}, {4, 5, 6, 7}, {0, 1, 5, 4},
                                            {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}};
  std::map<Nodes, int> count;
  for (const std::size_t cell : cells.alive(frame))
    for (const auto& side : sides) {
      Nodes nodes;
      for (const int corner : side) nodes.insert(cells.connectivity[index(cells.offset[cell] + corner)]);
      ++count[nodes];
    }
  std::set<Nodes> seen;
  for (const auto& [nodes, cells_there] : count)
    if (cells_there == 1) seen.insert(nodes);
  return seen;
}

std::multiset<Nodes> seen_in(const std::vector<Facet>& facets, int frame) {
  std::multiset<Nodes> seen;
  for (const Facet& facet : facets)
    if (facet.from <= frame && frame < facet.until) seen.emplace(facet.node.begin(), facet.node.end());
  return seen;
}

TEST(ReportSurface, OfACubeIsItsOutside) {
  const std::vector<Facet> facets = facets_of(cube());
  EXPECT_EQ(facets.size(), 6u * across * across);
  EXPECT_TRUE(std::ranges::all_of(facets, [](const Facet& f) { return f.from == 0 && f.until == frames; }));
}

TEST(ReportSurface, FollowsDeletionsAsASearchOfEachFrameDoes) {
  SceneCells cells = cube();
  std::mt19937 random(5);
  for (int& until : cells.until) until = std::uniform_int_distribution<int>(0, frames)(random);
  const std::vector<Facet> facets = facets_of(cells);
  for (int frame = 0; frame < frames; ++frame) {
    const std::multiset<Nodes> seen = seen_in(facets, frame);
    const std::set<Nodes> found = seen_by_search(cells, frame);
    EXPECT_TRUE(std::equal(seen.begin(), seen.end(), found.begin(), found.end())) << frame;
  }
}

TEST(ReportSurface, ShowsOutwardsFromItsCell) {
  const SceneCells cells = cube();
  const auto place = [](std::int64_t node) {
    return Vector3d{static_cast<double>(node % (across + 1)),
                    static_cast<double>(node / (across + 1) % (across + 1)),
                    static_cast<double>(node / (across + 1) / (across + 1))};
  };
  for (const Facet& facet : facets_of(cells)) {
    std::array<Vector3d, 4> p;
    for (std::size_t k = 0; k < 4; ++k) p[k] = place(facet.node[k]);
    double volume = 0;  // of the facet seen from the middle of the cube
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
      volume += (p[0][i] - 0.5 * across) *
                ((p[1][j] - p[0][j]) * (p[2][k] - p[0][k]) - (p[1][k] - p[0][k]) * (p[2][j] - p[0][j]));
    }
    EXPECT_GT(volume, 0);
  }
}

TEST(ReportSurface, KeepsFacesBetweenParts) {
  SceneCells cells = cube();
  for (std::size_t c = 0; c < cells.size(); ++c) cells.part[c] = c < cells.size() / 2 ? 0 : 1;
  EXPECT_EQ(facets_of(cells).size(), 6u * across * across + 2u * across * across);
}

TEST(ReportSurface, LeavesOutCollapsedSidesOfDegenerateHexahedra) {
  // A wedge: its edge is nodes 0 and 3.
  const SceneCells wedge{{0, 0, 3, 3, 4, 5, 6, 7}, {0, 8}, {0}, {1}, {1}};
  const std::vector<Facet> facets = facets_of(wedge);
  EXPECT_EQ(facets.size(), 5u);
  for (const Facet& facet : facets) EXPECT_GE(Nodes(facet.node.begin(), facet.node.end()).size(), 3u);
}

TEST(ReportSurface, HasShellsBeamsAndParticlesAsTheyAre) {
  const SceneCells cells{{0, 1, 2, 3, 3, 4, 5}, {0, 4, 6, 7}, {0, 1, 2}, {1, 1, 1}, {3, 2, 3}};
  const std::vector<Facet> facets = facets_of(cells);
  ASSERT_EQ(facets.size(), 3u);
  EXPECT_EQ(facets[0].kind, Facet::Kind::shell);
  EXPECT_EQ(facets[1].kind, Facet::Kind::line);
  EXPECT_EQ(facets[1].until, 2);
  EXPECT_EQ(facets[1].node, (std::array<std::int64_t, 4>{3, 4, 4, 4}));
  EXPECT_EQ(facets[2].kind, Facet::Kind::vertex);
}

TEST(ReportSurface, NotesWhenCellsAreDeleted) {
  SceneCells cells{.part = {0, 0, 0, 1}, .id = {1, 2, 3, 1}, .until = {4, 4, 4, 4}};
  EXPECT_TRUE(cells.keep(1, {0, 0, 1}, {1, 3, 1}));
  EXPECT_TRUE(cells.keep(2, {0, 1}, {3, 1}));
  EXPECT_EQ(cells.until, (std::vector<int>{2, 1, 4, 4}));
  EXPECT_EQ(cells.alive(2), (std::vector<std::size_t>{2, 3}));
  EXPECT_FALSE(cells.keep(3, {0, 1}, {1, 1})) << "the first was deleted before";
}

TEST(ReportFrames, AreThinnedEvenlyWithBothEnds) {
  EXPECT_EQ(thinned(4, 100), (std::vector<std::size_t>{0, 1, 2, 3}));
  EXPECT_EQ(thinned(1, 100), (std::vector<std::size_t>{0}));
  EXPECT_EQ(thinned(9, 3), (std::vector<std::size_t>{0, 4, 8}));
  EXPECT_EQ(thinned(9, 1), (std::vector<std::size_t>{8}));
  const std::vector<std::size_t> kept = thinned(1000, 64);
  EXPECT_EQ(kept.size(), 64u);
  EXPECT_EQ(kept.front(), 0u);
  EXPECT_EQ(kept.back(), 999u);
  for (std::size_t i = 1; i < kept.size(); ++i) {
    EXPECT_GE(kept[i] - kept[i - 1], 15u);
    EXPECT_LE(kept[i] - kept[i - 1], 16u);
  }
}

}  // namespace
}  // namespace brio
