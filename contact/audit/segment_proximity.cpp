#include "contact/audit/segment_proximity.hpp"

#include <algorithm>
#include <numbers>
#include <utility>

#include "contact/audit/distance.hpp"
#include "src/base/index.hpp"

namespace brio {

namespace {

constexpr std::size_t segments_per_task = 128;

enum class SegmentKind : std::uint8_t { beam, particle, free_edge, solid_edge, shell_edge };

struct AuditedSegment {
  SegmentKind kind = SegmentKind::beam;
  std::array<int, 2> node{};  ///< global, ascending; the same twice: a point
  std::array<Vector3d, 2> x;
  int part = 0;
  int body = 0;
  double radius = 0;
  int round = -1;  ///< of a beam or particle, in Surface::round

  bool is_point() const { return node[0] == node[1]; }
  bool is_edge() const { return kind >= SegmentKind::free_edge; }
};

class SegmentProximity {
 public:
  SegmentProximity(const ContactScene& scene, const AuditedSurface& audited)
      : scene_(scene), surface_(scene.surface), audited_(audited) {
    add_rounds();
    if (audited.has_shells || has_beams_) add_edges();
    sort();
    collect_waiting();
  }

  std::size_t size() const { return segment_.size(); }

  void of_segment(int i, Audit& found) const {
    const AuditedSegment& own = segment(i);
    // Of other kinds against each other only with one of these.
    if (own.kind >= SegmentKind::solid_edge) return;
    tree_.for_overlapping(tree_.box(i), 0, [&](int j) {
      const AuditedSegment& other = segment(j);
      if (std::pair(other.kind, j) <= std::pair(own.kind, i) || !kinds_may_touch(own, other)) return;
      const double depth = depth_of(own, other);
      if (depth <= 0 || never_meet(own, other)) return;
      ++found.too_close;
      found.deepest_too_close.keep_deeper(
          {.depth = depth, .node = own.node[0], .part = {own.part, other.part}});
    });
  }

 private:
  const AuditedSegment& segment(int i) const { return segment_[index(i)]; }

  void add(AuditedSegment segment) {
    if (segment.node[1] < segment.node[0]) std::swap(segment.node[0], segment.node[1]);
    segment.x = {audited_.position(segment.node[0]), audited_.position(segment.node[1])};
    segment_.push_back(segment);
  }

  void add_rounds() {
    for (const RoundElement& round : surface_.round) {
      if (!round.alive()) continue;
      has_beams_ |= !round.is_point();
      add({.kind = round.is_point() ? SegmentKind::particle : SegmentKind::beam,
           .node = round.node,
           .x = {},
           .part = round.part,
           .body = round.body,
           .radius = round.radius,
           .round = static_cast<int>(&round - surface_.round.data())});
    }
  }

  // Each edge with the first of its faces. Edges between shells meet nothing but beams.
  void add_edges() {
    if (!scene_.options.edges) return;
    for (const AuditedFace& face : audited_.face) {
      const auto f = index(face.face);
      for (int k = 0; k < face.corners; ++k) {
        const int across = surface_.neighbor[f][index(k)];
        if (across >= 0 && (across < face.face || (face.shell && !has_beams_))) continue;
        add({.kind = !face.shell  ? SegmentKind::solid_edge
                     : across < 0 ? SegmentKind::free_edge
                                  : SegmentKind::shell_edge,
             .node = {face.node[index(k)], face.node[index((k + 1) % face.corners)]},
             .x = {},
             .part = surface_.face[f].part,
             .body = surface_.face[f].body,
             .radius = 0.5 * scene_.options.shell_thickness_scale * surface_.thickness[f]});
      }
    }
  }

  void sort() {
    std::vector<BoundingBox> box(segment_.size());
    for (std::size_t i = 0; i < box.size(); ++i) {
      box[i].add(segment_[i].x[0]);
      box[i].add(segment_[i].x[1]);
      box[i] = box[i].grown(segment_[i].radius);
    }
    std::vector<AuditedSegment> sorted;
    std::vector<BoundingBox> sorted_box;
    for (int i : morton_order(box)) {
      sorted.push_back(segment_[index(i)]);
      sorted_box.push_back(box[index(i)]);
    }
    segment_ = std::move(sorted);
    tree_ = BoxTree(std::move(sorted_box));
  }

  // By kinds, the lesser first: what a node and a face stand for is left to them.
  static bool kinds_may_touch(const AuditedSegment& first, const AuditedSegment& second) {
    if (second.kind == SegmentKind::shell_edge)
      return first.kind == SegmentKind::beam && first.body != second.body;
    if (first.kind == SegmentKind::particle)
      return second.kind == SegmentKind::particle && first.body != second.body;
    return true;
  }

  // 0 where it does not count. Where edges are closest at an end of one, its node and a face stand for them.
  static double depth_of(const AuditedSegment& first, const AuditedSegment& second) {
    const double reach = first.radius + second.radius;
    const SegmentDistance closest = distance_of_segments(first.x, second.x);
    if (closest.distance >= (1 - tolerated_closeness) * reach) return 0;
    if (first.is_edge() && !(closest.inside(0) && closest.inside(1))) return 0;
    return reach - closest.distance;
  }

  bool never_meet(const AuditedSegment& first, const AuditedSegment& second) const {
    for (int node : first.node)
      if (node == second.node[0] || node == second.node[1]) return true;
    const int rigid = surface_.rigid_body_of_all(first.node);
    if (rigid >= 0 && rigid == surface_.rigid_body_of_all(second.node)) return true;
    if (surface_.pairs.parts_apart(first.part, second.part)) return true;
    if (!surface_.tied.empty() && (is_tied(first, second.part) || is_tied(second, first.part))) return true;
    return (first.body == second.body && share_a_face(first, second)) || lie_so_by_the_mesh(first, second);
  }

  bool is_tied(const AuditedSegment& segment, int part) const {
    return surface_.tied.apart(segment.node[0], part) || surface_.tied.apart(segment.node[1], part);
  }

  bool share_a_face(const AuditedSegment& first, const AuditedSegment& second) const {
    for (int node : first.node)
      for (int f : surface_.faces_of.of(surface_.slave(node)))
        for (int other : second.node)
          if (surface_.face[index(f)].has(other)) return true;
    return false;
  }

  // Pairs that overlap as drawn, lie in the tightest fold of a shell, or were left so by a tear.
  bool lie_so_by_the_mesh(const AuditedSegment& first, const AuditedSegment& second) const {
    if (!first.is_edge() && !second.is_edge() && first.body == second.body && drawn_together(first, second))
      return true;
    return is_excluded(first, second) || is_excluded(second, first) ||
           std::binary_search(waiting_.begin(), waiting_.end(), nodes_of_pair(first, second));
  }

  // Within the tightest fold of beams of their radii.
  bool drawn_together(const AuditedSegment& first, const AuditedSegment& second) const {
    const auto drawn = [&](const AuditedSegment& beam) {
      return scene_.features.drawn_beam[index(beam.round)];
    };
    const double fold = 0.5 * std::numbers::pi * (first.radius + second.radius);
    return distance_of_segments(drawn(first), drawn(second)).distance < fold;
  }

  using NodesOfPair = std::array<int, 4>;
  static NodesOfPair nodes_of_pair(const AuditedSegment& first, const AuditedSegment& second) {
    std::array<int, 2> a{std::min(first.node[0], first.node[1]), std::max(first.node[0], first.node[1])};
    std::array<int, 2> b{std::min(second.node[0], second.node[1]), std::max(second.node[0], second.node[1])};
    if (b < a) std::swap(a, b);
    return {a[0], a[1], b[0], b[1]};
  }
  // Whether a node of one is excluded from contact with a face of the other.
  bool is_excluded(const AuditedSegment& first, const AuditedSegment& second) const {
    for (int node : first.node)
      for (int f : scene_.excluded.of(surface_.slave(node)))
        if (const Face& face = surface_.face[index(f)]; face.has(second.node[0]) && face.has(second.node[1]))
          return true;
    return false;
  }
  // Pairs that were nearer than their radii when they were exposed, and still are.
  void collect_waiting() {
    const PairList& list = scene_.pairs.edge_edge;
    const auto segment = [&](int e) {
      const auto& node = scene_.features.edge[index(e)].node;
      AuditedSegment result;
      for (std::size_t k = 0; k < 2; ++k) result.node[k] = surface_.node[index(node[k])];
      return result;
    };
    for (std::size_t p = 0; p < list.size(); ++p)
      if (list.spacing(p) == Spacing::waiting)
        waiting_.push_back(nodes_of_pair(segment(list.first(p)), segment(list.second(p))));
    std::sort(waiting_.begin(), waiting_.end());
  }

  const ContactScene& scene_;
  const Surface& surface_;
  const AuditedSurface& audited_;
  std::vector<NodesOfPair> waiting_;
  std::vector<AuditedSegment> segment_;  ///< along the curve
  BoxTree tree_;                         ///< of their boxes, grown by their radii
  bool has_beams_ = false;
};

}  // namespace

Audit find_segments_too_close(const ContactScene& scene, const AuditedSurface& surface, ThreadTeam& team) {
  const SegmentProximity proximity(scene, surface);
  std::vector<Audit> piece((proximity.size() + segments_per_task - 1) / segments_per_task);
  team.for_ranges(proximity.size(), segments_per_task, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      proximity.of_segment(static_cast<int>(i), piece[begin / segments_per_task]);
  });
  Audit sum;
  for (const Audit& part : piece) sum += part;
  return sum;
}

}  // namespace brio
