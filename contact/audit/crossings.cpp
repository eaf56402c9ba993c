#include "contact/audit/crossings.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <iterator>

#include "src/base/index.hpp"

namespace brio {

namespace {

constexpr std::size_t faces_per_task = 128;
/// Of the shortest edge of two faces: crossings that go deeper are counted apart.
constexpr double deep_ratio = 0.1;

/// Edges of a quadrilateral, then its diagonals; a triangle has the first three.
constexpr std::size_t segment_end[6][2] = {{0, 1}, {1, 2}, {2, 0}, {2, 3}, {3, 0}, {1, 3}};

/// A face's corners, or a beam's ends, that may cross triangles.
struct CrossingElement {
  const Vector3d* x;
  const int* node;
  int corners;
  int part;
  const Face* face;  ///< of a beam: none
};

struct PairOfElements {
  bool crosses = false;
  AuditPlace deepest;  ///< of what may not cross; depth 0: none
};

class CrossingSearch {
 public:
  CrossingSearch(const AuditedSurface& audited) : audited_(audited), surface_(audited.surface) {}

  // Face `i` and all that come after it.
  void of_face(int i, Crossings& result) const {
    const AuditedFace& own = face(i);
    audited_.tree.for_overlapping(audited_.tree.box(i), i + 1, [&](int j) {
      const AuditedFace& other = face(j);
      if (own.rigid >= 0 && own.rigid == other.rigid) return;
      PairOfElements pair;
      cross(element(own), other, audited_.tree.box(j), pair);
      cross(element(other), own, audited_.tree.box(i), pair);
      note(pair, std::min(own.shortest_edge, other.shortest_edge), own.piece, other.piece, result);
      if (!pair.crosses && own.piece != other.piece && !(own.shell && other.shell))
        result.near_faces.push_back({i, j});
    });
  }

  void of_beam(const RoundElement& beam, Crossings& result) const {
    if (!beam.alive() || beam.is_point()) return;
    const Vector3d x[2] = {audited_.position(beam.node[0]), audited_.position(beam.node[1])};
    BoundingBox box;
    box.add(x[0]);
    box.add(x[1]);
    const CrossingElement own{
        .x = x, .node = beam.node.data(), .corners = 2, .part = beam.part, .face = nullptr};
    audited_.tree.for_overlapping(box, 0, [&](int j) {
      PairOfElements pair;
      cross(own, face(j), audited_.tree.box(j), pair);
      note(pair, std::min(face(j).shortest_edge, norm(x[1] - x[0])), audited_.piece_of_node(beam.node[0]),
           face(j).piece, result);
    });
  }

 private:
  const AuditedFace& face(int i) const { return audited_.face[index(i)]; }
  const Face& known(const AuditedFace& own) const { return surface_.face[index(own.face)]; }

  CrossingElement element(const AuditedFace& own) const {
    return {.x = own.x.data(),
            .node = own.node.data(),
            .corners = own.corners,
            .part = known(own).part,
            .face = &known(own)};
  }

  // Segments of the element with triangles of the face.
  void cross(const CrossingElement& own, const AuditedFace& other, const BoundingBox& box_of_other,
             PairOfElements& pair) const {
    const unsigned near = segments_near(own, other, box_of_other);
    if (near == 0) return;
    for (int t = 0; t < other.triangles(); ++t) {
      const SurfaceTriangle triangle = other.triangle(t);
      std::array<SurfaceTriangle::Volume, 4> volume;
      for (std::size_t c = 0; c < index(own.corners); ++c) volume[c] = triangle.volume(own.x[c]);
      const double touch = audited_.tolerance * triangle.twice_area;
      for (unsigned bits = near; bits != 0; bits &= bits - 1) {
        const auto& [a, b] = segment_end[std::countr_zero(bits)];
        if (may_cross(volume[a], volume[b], touch)) keep_crossing(own, a, b, other, triangle, pair);
      }
    }
  }

  // Bit s: segment s shares no node with the face, and its box overlaps that of the face.
  static unsigned segments_near(const CrossingElement& own, const AuditedFace& other,
                                const BoundingBox& box) {
    bool shared[4], below[4][3], above[4][3];
    for (int c = 0; c < own.corners; ++c) {
      shared[c] = other.has(own.node[c]);
      for (int axis = 0; axis < 3; ++axis) {
        below[c][axis] = own.x[c][axis] < box.lower[axis];
        above[c][axis] = own.x[c][axis] > box.upper[axis];
      }
    }
    unsigned near = 0;
    const int segments = own.corners == 2 ? 1 : own.corners == 3 ? 3 : 6;
    for (int s = 0; s < segments; ++s) {
      const auto& [a, b] = segment_end[s];
      bool apart = shared[a] || shared[b];
      for (int axis = 0; axis < 3; ++axis)
        apart |= (below[a][axis] && below[b][axis]) || (above[a][axis] && above[b][axis]);
      near |= (apart ? 0u : 1u) << s;
    }
    return near;
  }

  // Whether the ends may lie on different sides, and neither within the tolerance for certain.
  static bool may_cross(const SurfaceTriangle::Volume& a, const SurfaceTriangle::Volume& b, double touch) {
    if (std::abs(a.value) + a.error <= touch || std::abs(b.value) + b.error <= touch) return false;
    return (a.value > 0) != (b.value > 0) || std::abs(a.value) <= a.error || std::abs(b.value) <= b.error;
  }

  void keep_crossing(const CrossingElement& own, std::size_t a, std::size_t b, const AuditedFace& other,
                     const SurfaceTriangle& triangle, PairOfElements& pair) const {
    const Vector3d &from = own.x[a], &to = own.x[b];
    for (int axis = 0; axis < 3; ++axis) {
      const auto at = [&](std::size_t k) { return triangle.corner[k][axis]; };
      if (std::max(from[axis], to[axis]) < std::min({at(0), at(1), at(2)}) ||
          std::min(from[axis], to[axis]) > std::max({at(0), at(1), at(2)}))
        return;
    }
    if (!crosses(from, to, triangle)) return;
    const double depth = crossing_depth(from, to, triangle);
    if (depth <= audited_.tolerance) return;
    pair.crosses = true;
    if (depth <= pair.deepest.depth || never_meet(own, a, b, other)) return;
    const bool first = std::abs(triangle.volume(from).value) < std::abs(triangle.volume(to).value);
    pair.deepest = {.depth = depth, .node = own.node[first ? a : b], .part = {own.part, known(other).part}};
  }

  // What the deck, a rigid body or a tie says of the segment and the face.
  bool never_meet(const CrossingElement& own, std::size_t a, std::size_t b, const AuditedFace& other) const {
    if (surface_.pairs.parts_apart(own.part, known(other).part)) return true;
    for (std::size_t end : {a, b})
      if (surface_.never_touch(surface_.slave(own.node[end]), known(other))) return true;
    for (int node : other.node)
      if (own.face != nullptr ? surface_.never_touch(surface_.slave(node), *own.face)
                              : surface_.pairs.apart(node, own.part) ||
                                    (!surface_.tied.empty() && surface_.tied.apart(node, own.part)))
        return true;
    return false;
  }

  static void note(const PairOfElements& pair, double shortest_edge, int piece, int other,
                   Crossings& result) {
    if (!pair.crosses) return;
    if (piece != other) result.crossed_pieces.push_back({std::min(piece, other), std::max(piece, other)});
    if (pair.deepest.depth <= 0) return;
    ++result.found.crossings;
    if (pair.deepest.depth > deep_ratio * shortest_edge) ++result.found.deep_crossings;
    result.found.deepest_crossing.keep_deeper(pair.deepest);
  }

  const AuditedSurface& audited_;
  const Surface& surface_;
};

template <class Item>
void append(std::vector<Item>& all, const std::vector<Item>& more) {
  all.insert(all.end(), more.begin(), more.end());
}

}  // namespace

Crossings find_crossings(const AuditedSurface& surface, ThreadTeam& team) {
  const CrossingSearch search(surface);
  const std::size_t faces = surface.face.size();
  const std::size_t all = faces + surface.surface.round.size();
  std::vector<Crossings> piece((all + faces_per_task - 1) / faces_per_task);
  team.for_ranges(all, faces_per_task, [&](std::size_t begin, std::size_t end) {
    Crossings& own = piece[begin / faces_per_task];
    for (std::size_t i = begin; i < end; ++i) {
      if (i < faces) {
        search.of_face(static_cast<int>(i), own);
      } else {
        search.of_beam(surface.surface.round[i - faces], own);
      }
    }
  });
  Crossings sum;
  for (const Crossings& part : piece) {
    sum.found += part.found;
    append(sum.crossed_pieces, part.crossed_pieces);
    append(sum.near_faces, part.near_faces);
  }
  std::sort(sum.crossed_pieces.begin(), sum.crossed_pieces.end());
  sum.crossed_pieces.erase(std::unique(sum.crossed_pieces.begin(), sum.crossed_pieces.end()),
                           sum.crossed_pieces.end());
  return sum;
}

}  // namespace brio
