#pragma once
/// Meshes of which elements are deleted, and the comparison of a mended surface with one built anew.

#include <gtest/gtest.h>

#include <map>
#include <random>
#include <set>
#include <tuple>
#include <vector>

#include "contact/surface/surface_topology.hpp"
#include "src/base/index.hpp"

namespace brio::test {

struct ErodingMesh {
  struct Part {
    bool shell = false;
    std::vector<int> connectivity;
    std::vector<double> thickness;
    std::vector<char> alive;
    int corners() const { return shell ? 4 : 8; }
    int count() const { return static_cast<int>(connectivity.size()) / corners(); }
  };
  std::vector<Part> part;
  std::size_t nodes = 0;

  /// Hexahedra of a grid; `node(i, j, k)` names the corners, `present(i, j, k)` the cells.
  template <class Node, class Present>
  void add_grid(int nx, int ny, int nz, const Node& node, const Present& present) {
    Part& grid = part.emplace_back();
    for (int k = 0; k < nz; ++k)
      for (int j = 0; j < ny; ++j)
        for (int i = 0; i < nx; ++i)
          if (present(i, j, k))
            for (int corner :
                 {node(i, j, k), node(i + 1, j, k), node(i + 1, j + 1, k), node(i, j + 1, k),
                  node(i, j, k + 1), node(i + 1, j, k + 1), node(i + 1, j + 1, k + 1), node(i, j + 1, k + 1)})
              grid.connectivity.push_back(corner);
    grid.alive.assign(index(grid.count()), 1);
  }
  void add_block(int nx, int ny, int nz) {
    const int first = static_cast<int>(nodes);
    add_grid(
        nx, ny, nz, [&](int i, int j, int k) { return first + i + (nx + 1) * (j + (ny + 1) * k); },
        [](int, int, int) { return true; });
    nodes += index((nx + 1) * (ny + 1) * (nz + 1));
  }
  void add_shells(const std::vector<std::array<int, 4>>& shells, std::mt19937& random) {
    Part& sheet = part.emplace_back();
    sheet.shell = true;
    std::uniform_real_distribution<double> thickness(0.1, 0.3);
    for (const auto& shell : shells) {
      sheet.connectivity.insert(sheet.connectivity.end(), shell.begin(), shell.end());
      sheet.thickness.push_back(thickness(random));
    }
    sheet.alive.assign(shells.size(), 1);
  }

  std::vector<SurfacePart> parts() const {
    std::vector<SurfacePart> all;
    for (const Part& p : part)
      all.push_back({.name = "part",
                     .nodes_per_element = p.corners(),
                     .connectivity = p.connectivity,
                     .thickness = p.thickness});
    return all;
  }
  std::vector<SurfaceElement> living() const {
    std::vector<SurfaceElement> all;
    for (int p = 0; p < static_cast<int>(part.size()); ++p)
      for (int e = 0; e < part[index(p)].count(); ++e)
        if (part[index(p)].alive[index(e)] != 0) all.push_back({p, e});
    return all;
  }
  void mark(std::span<const SurfaceElement> deleted) {
    for (const auto& [p, e] : deleted) part[index(p)].alive[index(e)] = 0;
  }
};

/// The surface of the living elements built anew, with elements numbered as in the whole mesh.
struct RebuiltSurface {
  std::vector<std::vector<int>> connectivity;
  Surface surface;

  explicit RebuiltSurface(const ErodingMesh& mesh) {
    std::vector<SurfacePart> parts = mesh.parts();
    std::vector<std::vector<int>> element(parts.size());
    for (std::size_t p = 0; p < parts.size(); ++p) {
      const auto& whole = mesh.part[p];
      auto& nodes = connectivity.emplace_back();
      parts[p].thickness.clear();
      for (int e = 0; e < whole.count(); ++e) {
        if (whole.alive[index(e)] == 0) continue;
        const auto begin = whole.connectivity.begin() + whole.corners() * e;
        nodes.insert(nodes.end(), begin, begin + whole.corners());
        if (whole.shell) parts[p].thickness.push_back(whole.thickness[index(e)]);
        element[p].push_back(e);
      }
    }
    for (std::size_t p = 0; p < parts.size(); ++p) parts[p].connectivity = connectivity[p];
    surface = make_surface(parts, mesh.nodes);
    for (Face& face : surface.face) face.element = element[index(face.part)][index(face.element)];
  }
};

using FaceName = std::tuple<int, int, int>;  ///< part, element, side
inline FaceName name_of(const Surface& surface, int face) {
  if (face < 0) return {-1, -1, -1};
  const Face& f = surface.face[index(face)];
  return {f.part, f.element, f.side};
}
template <class Faces>
std::set<FaceName> names_of(const Surface& surface, const Faces& faces) {
  std::set<FaceName> names;
  for (int f : faces)
    if (surface.face[index(f)].alive()) names.insert(name_of(surface, f));
  return names;
}

/// Whether faces have the same bodies but for their numbers.
inline bool same_bodies(const Surface& a, const Surface& b, const std::map<FaceName, int>& face_of_b) {
  std::map<int, int> to_b, to_a;
  for (const Face& face : a.face) {
    if (!face.alive()) continue;
    const int other = b.face[index(face_of_b.at({face.part, face.element, face.side}))].body;
    if (to_b.try_emplace(face.body, other).first->second != other) return false;
    if (to_a.try_emplace(other, face.body).first->second != face.body) return false;
  }
  return true;
}

inline std::map<FaceName, int> faces_by_name(const Surface& surface) {
  std::map<FaceName, int> faces;
  for (std::size_t f = 0; f < surface.face.size(); ++f) {
    if (!surface.face[f].alive()) continue;
    EXPECT_TRUE(faces.try_emplace(name_of(surface, static_cast<int>(f)), static_cast<int>(f)).second);
  }
  return faces;
}

/// The same faces, slave nodes, neighbours, radii, but for numbers.
inline void expect_same_surface(const Surface& mended, const Surface& rebuilt) {
  const std::map<FaceName, int> mine = faces_by_name(mended);
  const std::map<FaceName, int> other = faces_by_name(rebuilt);
  ASSERT_EQ(mine.size(), other.size());
  for (const auto& [name, g] : other) {
    ASSERT_EQ(mine.count(name), 1U);
    const auto a = index(mine.at(name));
    const auto b = index(g);
    ASSERT_EQ(mended.face[a].node, rebuilt.face[b].node);
    ASSERT_EQ(mended.face[a].shell, rebuilt.face[b].shell);
    ASSERT_EQ(mended.thickness[a], rebuilt.thickness[b]);
    for (std::size_t k = 0; k < 4; ++k)
      ASSERT_EQ(name_of(mended, mended.neighbor[a][k]), name_of(rebuilt, rebuilt.neighbor[b][k]));
  }
  for (std::size_t n = 0; n < mended.slave_of.size(); ++n) {
    const int mine_s = mended.slave_of[n];
    const int other_s = rebuilt.slave_of[n];
    ASSERT_EQ(mine_s < 0, other_s < 0) << "node " << n;
    if (mine_s < 0) continue;
    const auto a = index(mine_s);
    const auto b = index(other_s);
    ASSERT_EQ(mended.node[a], static_cast<int>(n));
    ASSERT_EQ(mended.radius[a], rebuilt.radius[b]);
    ASSERT_EQ(mended.of_solid[a], rebuilt.of_solid[b]);
    ASSERT_EQ(mended.pinched[a], rebuilt.pinched[b]) << "node " << n;
    const auto faces = mended.faces_of.of(mine_s);
    ASSERT_TRUE(std::is_sorted(faces.begin(), faces.end()));
    ASSERT_EQ(names_of(mended, faces), names_of(rebuilt, rebuilt.faces_of.of(other_s)));
    for (int f : faces) {
      ASSERT_TRUE(mended.face[index(f)].alive());
      ASSERT_EQ(mended.face[index(f)].body, mended.body[a]);
    }
  }
  for (std::size_t s = 0; s < mended.slaves(); ++s) {
    if (mended.node[s] >= 0) {
      ASSERT_EQ(mended.slave(mended.node[s]), static_cast<int>(s));
    } else {
      ASSERT_TRUE(mended.faces_of.of(static_cast<int>(s)).empty());
    }
  }
}

}  // namespace brio::test
