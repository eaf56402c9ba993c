#include "contact/audit_lines.hpp"

#include <algorithm>
#include <cmath>

#include "contact/closest_segments.hpp"
#include "contact/face_geometry.hpp"
#include "contact/winding.hpp"

namespace brio {

using Eigen::Vector3d;

namespace {

constexpr std::size_t lines_per_task = 16;

class LineAuditor {
 public:
  LineAuditor(const ContactScene& scene, const Nodes& nodes)
      : scene_(scene), surface_(scene.surface), nodes_(nodes) {
    std::vector<LineEnd> ends;
    collect_lines(surface_, scene.options, nodes, line_, ends);
    for (const Line& line : line_) {
      const Segment segment{end(line, 0), end(line, 1)};
      segment_.push_back(segment);
      lower_.push_back(segment[0].cwiseMin(segment[1]).array() - line.radius);
      upper_.push_back(segment[0].cwiseMax(segment[1]).array() + line.radius);
    }
    solid_of_.resize(static_cast<std::size_t>(surface_.body_count));
    for (const Face& face : surface_.face)
      if (face.alive() && !face.shell)
        solid_of_[static_cast<std::size_t>(face.body)].push_back(vertices(nodes, face));
  }

  std::size_t size() const { return line_.size(); }

  LineAudit of_line(std::size_t a) const {
    LineAudit found;
    for (std::size_t b = a + 1; b < line_.size(); ++b) {
      if ((lower_[a].array() > upper_[b].array()).any() || (lower_[b].array() > upper_[a].array()).any())
        continue;
      if (!may_touch(surface_, line_[a], line_[b]) || are_kept_apart(line_[a], line_[b])) continue;
      const double depth = depth_of(a, b);
      if (depth <= 0) continue;
      ++found.crossed;
      if (depth <= found.deepest) continue;
      found.deepest = depth;
      found.deepest_node = surface_.node[static_cast<std::size_t>(line_[a].node[0])];
    }
    return found;
  }

 private:
  Vector3d end(const Line& line, std::size_t k) const {
    return position(nodes_, surface_.node[static_cast<std::size_t>(line.node[k])]);
  }

  bool are_kept_apart(const Line& a, const Line& b) const {
    const LineCandidates& known = scene_.lines->candidates;
    const auto pair = nodes_of(surface_, a, b);
    return std::binary_search(known.drawn.begin(), known.drawn.end(), pair) ||
           std::binary_search(known.torn.begin(), known.torn.end(), pair);
  }

  // 0 where they do not cross, or hardly.
  double depth_of(std::size_t a, std::size_t b) const {
    const ClosestSegments closest = closest_points_of_segments(segment_[a], segment_[b]);
    for (std::size_t side = 0; side < 2; ++side) {
      const Line& line = line_[side == 0 ? a : b];
      if (line.is_edge() && closest.features[side] != SegmentFeature::inside) return 0;
    }
    const double distance = std::sqrt(closest.squared_distance);
    if (const double reach = line_[a].radius + line_[b].radius; reach > 0)
      return distance < (1 - deep_share) * reach ? reach - distance : 0;
    const double size =
        std::min((segment_[a][1] - segment_[a][0]).norm(), (segment_[b][1] - segment_[b][0]).norm());
    if (distance <= deep_share * size || line_[a].body == line_[b].body) return 0;
    const auto at = [&](std::size_t line, double parameter) -> Vector3d {
      return segment_[line][0] + parameter * (segment_[line][1] - segment_[line][0]);
    };
    const bool inside = winding(line_[b].body, at(a, closest.parameters[0])) > 0.5 &&
                        winding(line_[a].body, at(b, closest.parameters[1])) > 0.5;
    return inside ? distance : 0;
  }

  double winding(int body, const Vector3d& x) const {
    double sum = 0;
    for (const FaceVertices& face : solid_of_[static_cast<std::size_t>(body)]) sum += winding_share(face, x);
    return sum;
  }

  const ContactScene& scene_;
  const Surface& surface_;
  const Nodes& nodes_;
  std::vector<Line> line_;
  std::vector<Segment> segment_;
  std::vector<Vector3d> lower_, upper_;
  std::vector<std::vector<FaceVertices>> solid_of_;  // faces of each body
};

}  // namespace

LineAudit audit_lines(const ContactScene& scene, const Nodes& nodes, ThreadTeam& team) {
  const LineAuditor auditor(scene, nodes);
  const std::size_t tasks = (auditor.size() + lines_per_task - 1) / lines_per_task;
  std::vector<LineAudit> piece(tasks);
  team.for_ranges(auditor.size(), lines_per_task, [&](std::size_t begin, std::size_t last) {
    LineAudit& own = piece[begin / lines_per_task];
    for (std::size_t l = begin; l < last; ++l) {
      const LineAudit found = auditor.of_line(l);
      own.crossed += found.crossed;
      if (found.deepest <= own.deepest) continue;
      own.deepest = found.deepest;
      own.deepest_node = found.deepest_node;
    }
  });
  LineAudit sum;
  for (const LineAudit& part : piece) {
    sum.crossed += part.crossed;
    if (part.deepest <= sum.deepest) continue;
    sum.deepest = part.deepest;
    sum.deepest_node = part.deepest_node;
  }
  return sum;
}

}  // namespace brio
