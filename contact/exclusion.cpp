#include "contact/exclusion.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "contact/face_geometry.hpp"

namespace brio {

namespace {

// Faces of the same hexahedron stand side by side in the surface.
void add_element_of(const Surface& surface, int face, std::vector<int>& found) {
  const Face& own = surface.face[static_cast<std::size_t>(face)];
  const auto same = [&](int other) {
    const Face& candidate = surface.face[static_cast<std::size_t>(other)];
    return candidate.part == own.part && candidate.element == own.element && candidate.shell == own.shell;
  };
  int first = face;
  while (first > 0 && same(first - 1)) --first;
  for (int f = first; f < static_cast<int>(surface.face.size()) && same(f); ++f) found.push_back(f);
}

class ShellNeighborhood {
 public:
  ShellNeighborhood(const Surface& surface, const Nodes& reference)
      : surface_(surface), reference_(reference), visited_(surface.face.size(), -1) {}

  // Walk from the faces of the slave over shared nodes, as far as the tightest fold reaches.
  void add(int slave, std::vector<int>& found) {
    const auto s = static_cast<std::size_t>(slave);
    const Eigen::Vector3d centre = position(reference_, surface_.node[s]);
    front_.clear();
    for (int f : surface_.faces_of.of(slave)) visit(slave, f);
    for (std::size_t i = 0; i < front_.size(); ++i) {
      const int face = front_[i];
      found.push_back(face);
      for (int corner : surface_.face[static_cast<std::size_t>(face)].node)
        for (int next : surface_.faces_of.of(surface_.slave(corner))) {
          const auto n = static_cast<std::size_t>(next);
          if (!surface_.face[n].shell || visited_[n] == slave) continue;
          const double fold = 0.5 * std::numbers::pi * (0.5 * surface_.thickness[n] + surface_.radius[s]);
          const ClosestPoint closest = closest_point_on_quad(centre, vertices(reference_, surface_.face[n]));
          if (closest.squared_distance < fold * fold) visit(slave, next);
        }
    }
  }

 private:
  void visit(int slave, int face) {
    const auto f = static_cast<std::size_t>(face);
    if (!surface_.face[f].shell || visited_[f] == slave) return;
    visited_[f] = slave;
    front_.push_back(face);
  }

  const Surface& surface_;
  const Nodes& reference_;
  std::vector<int> visited_;
  std::vector<int> front_;
};

}  // namespace

Lists excluded_faces(const Surface& surface, const Nodes& reference) {
  Lists excluded;
  excluded.first.push_back(0);
  ShellNeighborhood shells(surface, reference);
  std::vector<int> found;
  for (int s = 0; s < static_cast<int>(surface.slaves()); ++s) {
    found.clear();
    for (int f : surface.faces_of.of(s)) add_element_of(surface, f, found);
    shells.add(s, found);
    std::sort(found.begin(), found.end());
    found.erase(std::unique(found.begin(), found.end()), found.end());
    excluded.item.insert(excluded.item.end(), found.begin(), found.end());
    excluded.first.push_back(static_cast<int>(excluded.item.size()));
  }
  return excluded;
}

bool is_excluded(const Lists& excluded, int slave, int face) {
  const auto faces = excluded.of(slave);
  return std::binary_search(faces.begin(), faces.end(), face);
}

}  // namespace brio
