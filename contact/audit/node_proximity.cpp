#include "contact/audit/node_proximity.hpp"

#include <algorithm>

#include "contact/audit/distance.hpp"
#include "src/base/index.hpp"

namespace brio {

namespace {

constexpr std::size_t nodes_per_task = 128;

class NodeProximity {
 public:
  NodeProximity(const ContactScene& scene, const AuditedSurface& audited)
      : scene_(scene), surface_(scene.surface), audited_(audited) {
    for (const AuditedFace& face : audited.face)
      largest_half_ = std::max(largest_half_, half_thickness(face));
  }

  void of_node(int slave, Audit& found) const {
    const int node = surface_.node[index(slave)];
    const double radius = node < 0 ? 0 : radius_of(slave);
    if (node < 0 || radius + largest_half_ <= 0) return;
    const Vector3d x = audited_.position(node);
    const BoundingBox box = BoundingBox{x, x}.grown(radius + largest_half_);
    AuditPlace deepest;
    audited_.tree.for_overlapping(box, 0, [&](int f) {
      const AuditedFace& face = audited_.face[index(f)];
      const double depth = depth_at(slave, x, radius, face, audited_.tree.box(f));
      if (depth > deepest.depth)
        deepest = {.depth = depth, .node = node, .part = {part_of(slave), known(face).part}};
    });
    if (deepest.depth <= 0) return;
    ++found.too_close;
    found.deepest_too_close.keep_deeper(deepest);
  }

 private:
  const Face& known(const AuditedFace& face) const { return surface_.face[index(face.face)]; }
  double half_thickness(const AuditedFace& face) const {
    return 0.5 * scene_.options.shell_thickness_scale * surface_.thickness[index(face.face)];
  }
  double radius_of(int slave) const {
    return std::max(scene_.options.shell_thickness_scale * surface_.radius[index(slave)],
                    surface_.radius_of_rounds(slave));
  }

  // 0 where it does not count.
  double depth_at(int slave, const Vector3d& x, double radius, const AuditedFace& face,
                  const BoundingBox& box) const {
    if (!face.shell && (radius <= 0 || known(face).body == surface_.body[index(slave)])) return 0;
    const double touching = half_thickness(face) + radius;
    const double least = touching - tolerated_closeness * std::min(touching, face.shortest_edge);
    if (box.squared_distance(x) >= least * least) return 0;
    if (is_excluded(slave, face.face)) return 0;
    const double distance = distance_to_face(x, face.x, face.corners);
    return distance < least && !surface_.never_touch(slave, known(face)) ? touching - distance : 0;
  }

  // Lists are short: all of one is compared at once.
  bool is_excluded(int slave, int face) const {
    int found = 0;
    for (int other : scene_.excluded.of(slave)) found |= other == face ? 1 : 0;
    return found != 0;
  }

  int part_of(int slave) const {
    const auto faces = surface_.faces_of.of(slave);
    if (!faces.empty()) return surface_.face[index(faces.front())].part;
    const int node = surface_.node[index(slave)];
    for (const RoundElement& round : surface_.round)
      if (round.alive() && (round.node[0] == node || round.node[1] == node)) return round.part;
    return -1;
  }

  const ContactScene& scene_;
  const Surface& surface_;
  const AuditedSurface& audited_;
  double largest_half_ = 0;
};

}  // namespace

Audit find_nodes_too_close(const ContactScene& scene, const AuditedSurface& surface, ThreadTeam& team) {
  const NodeProximity proximity(scene, surface);
  const std::size_t nodes = scene.surface.slaves();
  std::vector<Audit> piece((nodes + nodes_per_task - 1) / nodes_per_task);
  team.for_ranges(nodes, nodes_per_task, [&](std::size_t begin, std::size_t end) {
    for (std::size_t s = begin; s < end; ++s)
      proximity.of_node(static_cast<int>(s), piece[begin / nodes_per_task]);
  });
  Audit sum;
  for (const Audit& part : piece) sum += part;
  return sum;
}

}  // namespace brio
