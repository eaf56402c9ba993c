#include "contact/surface/exclusion.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>

#include "contact/surface/face_geometry.hpp"
#include "src/base/index.hpp"
#include "src/base/lists.hpp"

namespace brio {

namespace {

// As built, faces of the same hexahedron stand side by side in the surface.
void add_element_of(const Surface& surface, int face, std::vector<int>& found) {
  const Face& own = surface.face[index(face)];
  const auto same = [&](int other) {
    const Face& candidate = surface.face[index(other)];
    return candidate.part == own.part && candidate.element == own.element && candidate.shell == own.shell;
  };
  int first = face;
  while (first > 0 && same(first - 1)) --first;
  for (int f = first; f < static_cast<int>(surface.face.size()) && same(f); ++f) found.push_back(f);
}

/// Arc of the tightest fold over which a point of radius and a shell of thickness touch.
double fold(double thickness, double radius) { return 0.5 * std::numbers::pi * (0.5 * thickness + radius); }

struct PositionOfNode {
  const Nodes& nodes;
  Vector3d operator[](int node) const { return position(nodes, node); }
};
struct PositionKept {
  const std::vector<Vector3d>& positions;
  Vector3d operator[](int node) const { return positions[index(node)]; }
};

/// Whether the distance of a point to a face is less than `reach`.
template <class Reference>
bool is_within(const Reference& reference, const Vector3d& from, const Face& face, double reach) {
  const double square = reach * reach;
  FaceVertices vertices;
  for (std::size_t k = 0; k < vertices.size(); ++k) {
    vertices[k] = reference[face.node[k]];
    if (squared_norm(vertices[k] - from) < square) return true;
  }
  return closest_point_on_quad(from, vertices).squared_distance < square;
}

}  // namespace

// Over shared nodes from the faces of the slave; the faces reached are left in front_.
template <class Reference, class Within>
void ShellWalk::spread(const Surface& surface, const Reference& reference, int slave, const Within& within) {
  visited_.resize(surface.face.size(), -1);
  ++walk_;
  front_.clear();
  for (int f : surface.faces_of.of(slave))
    if (surface.face[index(f)].shell) {
      visited_[index(f)] = walk_;
      front_.push_back(f);
    }
  const Vector3d centre = reference[surface.node[index(slave)]];
  for (std::size_t i = 0; i < front_.size(); ++i)
    for (int corner : surface.face[index(front_[i])].node)
      for (int next : surface.faces_of.of(surface.slave(corner))) {
        const auto n = index(next);
        if (!surface.face[n].shell || visited_[n] == walk_) continue;
        visited_[n] = walk_;
        if (is_within(reference, centre, surface.face[n], within(n))) front_.push_back(next);
      }
}

template <class Reference>
void ShellWalk::add_fold(const Surface& surface, const Reference& reference, int slave,
                         std::vector<int>& found) {
  const double radius = std::max(surface.radius[index(slave)], surface.radius_of_rounds(slave));
  spread(surface, reference, slave, [&](std::size_t face) { return fold(surface.thickness[face], radius); });
  found.insert(found.end(), front_.begin(), front_.end());
}

template <class Reference>
void ShellWalk::reach(const Surface& surface, const Reference& reference, int from, double distance,
                      std::vector<int>& slaves) {
  spread(surface, reference, from, [&](std::size_t) { return distance; });
  slaves.push_back(from);
  for (int f : front_)
    for (int corner : surface.face[index(f)].node) slaves.push_back(surface.slave(corner));
}

Lists excluded_faces(const Surface& surface, const Nodes& reference) {
  Lists excluded;
  excluded.first.push_back(0);
  ShellWalk walk;
  std::vector<int> found;
  for (int s = 0; s < static_cast<int>(surface.slaves()); ++s) {
    found.clear();
    for (int f : surface.faces_of.of(s)) add_element_of(surface, f, found);
    walk.add_fold(surface, PositionOfNode{reference}, s, found);
    sort_out(found);
    excluded.item.insert(excluded.item.end(), found.begin(), found.end());
    excluded.first.push_back(static_cast<int>(excluded.item.size()));
  }
  return excluded;
}

bool is_excluded(const Lists& excluded, int slave, int face) {
  const auto faces = excluded.of(slave);
  if (faces.empty()) return false;
  // By moves, not by branches, half of which the processor would predict wrongly.
  const int* last = faces.data();
  for (std::size_t left = faces.size(); left > 1;) {
    const std::size_t half = left / 2;
    last = last[half] <= face ? last + half : last;
    left -= half;
  }
  return *last == face;
}

ErodingExclusion::ErodingExclusion(const Surface& surface, const Nodes& reference) {
  double thickest = 0;
  for (double thickness : surface.thickness) thickest = std::max(thickest, thickness);
  if (thickest == 0) return;
  double radius = 0.5 * thickest;
  for (double round : surface.round_radius) radius = std::max(radius, round);
  longest_fold_ = fold(thickest, radius);
  for (std::size_t n = 0; n < reference.size(); ++n)
    reference_.push_back(position(reference, static_cast<int>(n)));
}

const std::vector<int>& ErodingExclusion::mend(Lists& excluded, const Surface& surface,
                                               const SurfaceTopology& topology, const SurfaceChange& change) {
  excluded.loosen();
  while (excluded.first.size() < surface.slaves()) excluded.add_list();
  for (int slave : change.dead_slave) excluded.clear(slave);
  for (int slave : change.new_slave) excluded.clear(slave);
  // All nodes on faces of elements that got new faces; on shells, all whose walk may have met what has gone.
  affected_ = change.changed_slave;
  for (int f : change.new_face)
    for_faces_of(topology, element_of(topology, surface.face[index(f)]), [&](int side) {
      for (int node : surface.face[index(side)].node) affected_.push_back(surface.slave(node));
    });
  if (!reference_.empty()) add_around_tear(excluded, surface, change);
  sort_out(affected_);
  for (int slave : affected_) mend_slave(excluded, surface, topology, slave);
  return affected_;
}

// A path of faces within a fold's distance of a slave that led over a dead face leads to one of its nodes
// now; seen from there it stays within two folds and the size of the face.
void ErodingExclusion::add_around_tear(const Lists& excluded, const Surface& surface,
                                       const SurfaceChange& change) {
  const PositionKept reference{reference_};
  for (int f : change.dead_face) {
    const Face& dead = surface.face[index(f)];
    if (surface.thickness[index(f)] == 0) continue;
    double size = 0;
    for (int a : dead.node)
      for (int b : dead.node) size = std::max(size, norm(reference[a] - reference[b]));
    for (int node : dead.node) {
      const int from = surface.slave(node);
      if (from < 0) continue;
      reached_.clear();
      walk_.reach(surface, reference, from, 2 * longest_fold_ + size, reached_);
      for (int slave : reached_)
        if (is_excluded(excluded, slave, f)) affected_.push_back(slave);
    }
  }
}

void ErodingExclusion::mend_slave(Lists& excluded, const Surface& surface, const SurfaceTopology& topology,
                                  int slave) {
  found_.clear();
  for (int f : surface.faces_of.of(slave))
    for_faces_of(topology, element_of(topology, surface.face[index(f)]),
                 [&](int side) { found_.push_back(side); });
  if (!reference_.empty()) walk_.add_fold(surface, PositionKept{reference_}, slave, found_);
  sort_out(found_);
  // What overlapped as drawn stays excluded; what a tear has parted does not.
  kept_.clear();
  for (int f : excluded.of(slave)) {
    const Face& face = surface.face[index(f)];
    if (face.alive() && !face.shell && !std::binary_search(found_.begin(), found_.end(), f))
      kept_.push_back(f);
  }
  found_.insert(found_.end(), kept_.begin(), kept_.end());
  std::sort(found_.begin(), found_.end());
  excluded.assign(slave, found_);
}

}  // namespace brio
