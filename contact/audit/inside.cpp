#include "contact/audit/inside.hpp"

#include <algorithm>

#include "contact/audit/distance.hpp"
#include "src/base/index.hpp"

namespace brio {

namespace {

constexpr std::size_t probes_per_task = 64;
/// Slopes of the rays along x: a ray that meets an edge gives way to the next.
constexpr double slope_of_ray[][2] = {{1.7e-4, 2.3e-4}, {-3.1e-4, 1.3e-4}, {2.9e-4, -4.1e-4},
                                      {-1.1e-3, -7e-4}, {5.3e-3, 3.7e-3},  {-2.3e-2, 1.9e-2}};

/// Is a point of one piece in the solid of another?
struct Probe {
  std::array<int, 2> pieces;  ///< that of the point, that of the solid
  Vector3d x;
};

/// A piece that is not a single point with what stands for it.
struct Piece {
  BoundingBox box;
  Vector3d point;  ///< of it, inside of a face where it has faces
  int face = -1;   ///< in AuditedSurface::face, of solids before shells
  int node = -1;   ///< global
  int part = -1;   ///< of the surface
  bool solid = false;
};

class Enclosure {
 public:
  Enclosure(const AuditedSurface& audited, const Crossings& crossings)
      : audited_(audited), surface_(audited.surface), crossings_(crossings) {
    describe_pieces();
    find_solids();
    add_probes_of_pieces();
    add_probes_of_near_faces();
  }

  const std::vector<Probe>& probes() const { return probe_; }

  // By a signed count of the faces that a ray leaves through and enters by.
  bool is_inside(const Probe& probe) const {
    if (touches(probe)) return false;
    const BoundingBox& solid = piece(probe.pieces[1]).box;
    const double length = 1.01 * (solid.upper[0] - probe.x[0]) + audited_.tolerance;
    for (const auto& slope : slope_of_ray) {
      const Vector3d end = probe.x + length * Vector3d{1, slope[0], slope[1]};
      bool meets_an_edge = false;
      const int turns = turns_along(probe, end, meets_an_edge);
      if (!meets_an_edge) return turns != 0;
    }
    return false;
  }

 private:
  const Piece& piece(int number) const { return piece_[index(number)]; }

  void describe_pieces() {
    piece_.resize(index(audited_.pieces));
    for (std::size_t i = 0; i < audited_.face.size(); ++i) {
      const AuditedFace& face = audited_.face[i];
      Piece& own = piece_[index(face.piece)];
      own.box.add(audited_.tree.box(static_cast<int>(i)));
      if (own.face >= 0 && (own.solid || face.shell)) continue;
      own.face = static_cast<int>(i);
      own.node = face.node[0];
      own.part = surface_.face[index(face.face)].part;
      own.point = centroid(face, 0);
      own.solid = !face.shell;
    }
    for (const RoundElement& round : surface_.round)
      if (round.alive())
        for (int node : round.node) add_node(node, round.part);
    for (int node : surface_.node)
      if (node >= 0) add_node(node, -1);
  }

  void add_node(int node, int part) {
    Piece& own = piece_[index(audited_.piece_of_node(node))];
    own.box.add(audited_.position(node));
    if (own.node >= 0) return;
    own.node = node;
    own.part = part;
    own.point = audited_.position(node);
  }

  void find_solids() {
    std::vector<BoundingBox> box;
    std::vector<int> unsorted;
    for (int p = 0; p < audited_.pieces; ++p) {
      if (!piece(p).solid) continue;
      unsorted.push_back(p);
      box.push_back(piece(p).box);
    }
    std::vector<BoundingBox> sorted;
    for (int i : morton_order(box)) {
      solid_.push_back(unsorted[index(i)]);
      sorted.push_back(box[index(i)]);
    }
    solids_ = BoxTree(std::move(sorted));
  }

  // What lies in a solid whole, lies in its box whole.
  void add_probes_of_pieces() {
    for (int p = 0; p < audited_.pieces; ++p) {
      if (piece(p).node < 0) continue;
      solids_.for_overlapping(piece(p).box, 0, [&](int i) {
        const int other = solid_[index(i)];
        if (other != p && solids_.box(i).holds(piece(p).box)) add_probe(p, other, piece(p).point);
      });
    }
  }

  void add_probes_of_near_faces() {
    for (const auto& [i, j] : crossings_.near_faces) {
      const AuditedFace& first = audited_.face[index(i)];
      const AuditedFace& second = audited_.face[index(j)];
      add_probes_of_face(first, second.piece);
      add_probes_of_face(second, first.piece);
    }
  }

  void add_probes_of_face(const AuditedFace& face, int other) {
    if (!piece(other).solid) return;
    for (int t = 0; t < face.triangles(); ++t) {
      const Vector3d x = centroid(face, t);
      if (piece(other).box.squared_distance(x) == 0) add_probe(face.piece, other, x);
    }
  }

  void add_probe(int own, int other, const Vector3d& x) {
    const std::array<int, 2> pair{std::min(own, other), std::max(own, other)};
    const auto& crossed = crossings_.crossed_pieces;
    if (std::binary_search(crossed.begin(), crossed.end(), pair) || never_meet(own, other)) return;
    probe_.push_back({.pieces = {own, other}, .x = x});
  }

  bool never_meet(int own, int other) const {
    const Face& face = surface_.face[index(audited_.face[index(piece(other).face)].face)];
    const auto body = [&](int node) { return surface_.body[index(surface_.slave(node))]; };
    if (!surface_.tied.empty() && surface_.tied.one_piece(body(piece(own).node), face.body)) return true;
    return (piece(own).part >= 0 && surface_.pairs.parts_apart(piece(own).part, face.part)) ||
           surface_.never_touch(surface_.slave(piece(own).node), face);
  }

  static Vector3d centroid(const AuditedFace& face, int triangle) {
    const SurfaceTriangle at = face.triangle(triangle);
    return (at.corner[0] + at.corner[1] + at.corner[2]) / 3;
  }

  // Within rounding of the solid's surface.
  bool touches(const Probe& probe) const {
    bool close = false;
    const BoundingBox box = BoundingBox{probe.x, probe.x}.grown(audited_.tolerance);
    for_faces_of(probe.pieces[1], box, [&](const AuditedFace& face) {
      for (int t = 0; t < face.triangles(); ++t) {
        const SurfaceTriangle at = face.triangle(t);
        close |= squared_distance_to_triangle(probe.x, at.corner[0], at.corner[1], at.corner[2]) <=
                 audited_.tolerance * audited_.tolerance;
      }
    });
    return close;
  }

  int turns_along(const Probe& probe, const Vector3d& end, bool& meets_an_edge) const {
    int turns = 0;
    BoundingBox box;
    box.add(probe.x);
    box.add(end);
    for_faces_of(probe.pieces[1], box, [&](const AuditedFace& face) {
      for (int t = 0; t < face.triangles(); ++t) {
        SurfaceTriangle triangle = face.triangle(t);
        triangle.continues = {{true, true, true}, {true, true, true}};
        if (!crosses(probe.x, end, triangle)) continue;
        triangle.continues = {};
        if (!crosses(probe.x, end, triangle)) meets_an_edge = true;
        turns += triangle.volume(end).value > 0 ? 1 : -1;
      }
    });
    return turns;
  }

  template <class Visit>
  void for_faces_of(int solid, const BoundingBox& box, const Visit& visit) const {
    audited_.tree.for_overlapping(box, 0, [&](int f) {
      const AuditedFace& face = audited_.face[index(f)];
      if (face.piece == solid && !face.shell) visit(face);
    });
  }

  const AuditedSurface& audited_;
  const Surface& surface_;
  const Crossings& crossings_;
  std::vector<Piece> piece_;
  std::vector<int> solid_;  ///< pieces with closed surfaces, along a curve
  BoxTree solids_;          ///< of their boxes
  std::vector<Probe> probe_;
};

}  // namespace

std::int64_t count_swallowed(const AuditedSurface& surface, const Crossings& crossings, ThreadTeam& team) {
  if (!surface.has_solids) return 0;
  const Enclosure enclosure(surface, crossings);
  const std::vector<Probe>& probes = enclosure.probes();
  std::vector<std::uint8_t> inside(probes.size());
  team.for_ranges(probes.size(), probes_per_task, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) inside[i] = enclosure.is_inside(probes[i]) ? 1 : 0;
  });
  std::vector<std::array<int, 2>> pairs;
  for (std::size_t i = 0; i < probes.size(); ++i) {
    const auto [own, other] = probes[i].pieces;
    if (inside[i] != 0) pairs.push_back({std::min(own, other), std::max(own, other)});
  }
  std::sort(pairs.begin(), pairs.end());
  return std::unique(pairs.begin(), pairs.end()) - pairs.begin();
}

}  // namespace brio
