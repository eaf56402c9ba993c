#include "contact/lines.hpp"

#include <algorithm>
#include <tuple>

#include "contact/candidates.hpp"
#include "contact/face_geometry.hpp"

namespace brio {

using Eigen::Vector3d;

namespace {

/// Where the normals of two faces are opposite but for rounding, which way they turn is not to be told: the
/// edge is a blade's.
constexpr double opposite = -0.99;

const Face& face_at(const Surface& surface, int face) { return surface.face[static_cast<std::size_t>(face)]; }

Line line_between(const Surface& surface, int from, int to) {
  Line line;
  line.node = {surface.slave(from), surface.slave(to)};
  if (line.node[1] < line.node[0]) std::swap(line.node[0], line.node[1]);
  return line;
}

bool is_sharp(const Surface& surface, const Nodes& nodes, const Line& edge) {
  const EdgeNormals at = normals_at(surface, nodes, edge);
  const double cosine = at.first.dot(at.second);
  return cosine < cosine_of_sharp && (cosine < opposite || at.first.cross(at.second).dot(at.along) > 0);
}

void add_edges(const Surface& surface, const ContactOptions& options, const Nodes& nodes,
               std::vector<Line>& lines) {
  for (int f = 0; f < static_cast<int>(surface.face.size()); ++f) {
    const Face& face = face_at(surface, f);
    if (!face.alive()) continue;
    for (int k = 0; k < face.corners(); ++k) {
      const int across = surface.neighbor[static_cast<std::size_t>(f)][static_cast<std::size_t>(k)];
      if (face.shell ? across >= 0 : across < f) continue;
      Line edge = line_between(surface, face.node[static_cast<std::size_t>(k)],
                               face.node[static_cast<std::size_t>((k + 1) % face.corners())]);
      edge.kind = face.shell ? LineKind::shell_edge : LineKind::solid_edge;
      edge.corner = static_cast<std::uint8_t>(k);
      edge.part = face.part;
      edge.body = face.body;
      edge.face = f;
      edge.radius = 0.5 * options.shell_thickness_scale * surface.thickness[static_cast<std::size_t>(f)];
      if (face.shell || is_sharp(surface, nodes, edge)) lines.push_back(edge);
    }
  }
}

// \returns whether there are beams.
bool add_round_elements(const Surface& surface, std::vector<Line>& lines) {
  bool beams = false;
  for (std::size_t i = 0; i < surface.round.size(); ++i) {
    const RoundElement& element = surface.round[i];
    if (!element.alive()) continue;
    Line line = line_between(surface, element.node[0], element.node[1]);
    line.kind = element.is_point() ? LineKind::particle : LineKind::beam;
    line.part = element.part;
    line.body = element.body;
    line.round = static_cast<int>(i);
    line.radius = element.radius;
    lines.push_back(line);
    beams |= !element.is_point();
  }
  return beams;
}

void add_nodes(const Surface& surface, const ContactOptions& options, std::vector<Line>& lines) {
  for (int s = 0; s < static_cast<int>(surface.slaves()); ++s) {
    const auto faces = surface.faces_of.of(s);
    if (surface.node[static_cast<std::size_t>(s)] < 0 || faces.empty()) continue;
    Line node;
    node.node = {s, s};
    node.part = face_at(surface, faces.front()).part;
    node.body = surface.body[static_cast<std::size_t>(s)];
    node.radius = options.shell_thickness_scale * surface.radius[static_cast<std::size_t>(s)];
    lines.push_back(node);
  }
}

// Where sharp edges of a mesh are but one edge of a body, or the rim of a shell.
void find_continued(const Surface& surface, const Nodes& nodes, std::vector<Line>& lines,
                    std::vector<LineEnd>& ends) {
  ends.clear();
  for (std::size_t l = 0; l < lines.size(); ++l) {
    if (!lines[l].is_edge()) continue;
    const auto at = [&](std::size_t k) {
      return position(nodes, surface.node[static_cast<std::size_t>(lines[l].node[k])]);
    };
    const Vector3d along = (at(1) - at(0)).normalized();
    ends.push_back({lines[l].node[0], l, 0, along});
    ends.push_back({lines[l].node[1], l, 1, -along});
  }
  std::sort(ends.begin(), ends.end(), [](const LineEnd& a, const LineEnd& b) {
    return std::tuple(a.slave, a.line) < std::tuple(b.slave, b.line);
  });
  for (std::size_t i = 0; i < ends.size(); ++i)
    for (std::size_t j = i + 1; j < ends.size() && ends[j].slave == ends[i].slave; ++j)
      if (ends[i].away.dot(ends[j].away) < -cosine_of_sharp)
        lines[ends[i].line].continues[ends[i].end] = lines[ends[j].line].continues[ends[j].end] = true;
}

bool share_a_node(const Line& a, const Line& b) {
  return a.node[0] == b.node[0] || a.node[0] == b.node[1] || a.node[1] == b.node[0] || a.node[1] == b.node[1];
}

// Whether any face has a node of both.
bool share_a_face(const Surface& surface, const Line& a, const Line& b) {
  for (int slave : a.node)
    for (int f : surface.faces_of.of(slave))
      for (int other : b.node)
        if (face_at(surface, f).has(surface.node[static_cast<std::size_t>(other)])) return true;
  return false;
}

bool are_held(const Surface& surface, const Line& a, const Line& b) {
  const auto apart = [&](const Line& line, int part) {
    return std::any_of(line.node.begin(), line.node.end(), [&](int slave) {
      return surface.held.apart(surface.node[static_cast<std::size_t>(slave)], part);
    });
  };
  return apart(a, b.part) || apart(b, a.part);
}

bool kinds_may_touch(const Line& a, const Line& b) {
  const Line& first = a.kind <= b.kind ? a : b;
  const Line& second = a.kind <= b.kind ? b : a;
  if (second.kind == LineKind::node) return first.kind == LineKind::beam;
  if (second.kind == LineKind::particle)
    return first.kind == LineKind::beam || (first.kind == LineKind::particle && first.body != second.body);
  return true;
}

}  // namespace

EdgeNormals normals_at(const Surface& surface, const Nodes& nodes, const Line& edge) {
  const Face& own = face_at(surface, edge.face);
  const int across =
      surface.neighbor[static_cast<std::size_t>(edge.face)][static_cast<std::size_t>(edge.corner)];
  const int from = own.node[edge.corner];
  const int to = own.node[static_cast<std::size_t>((edge.corner + 1) % own.corners())];
  EdgeNormals found{.first = sub_triangle_area(vertices(nodes, own), edge.corner).normalized(),
                    .second = Vector3d::Zero(),
                    .along = (position(nodes, to) - position(nodes, from)).normalized()};
  if (across < 0) return found;
  const Face& other = face_at(surface, across);
  for (int k = 0; k < other.corners(); ++k)
    if (other.node[static_cast<std::size_t>(k)] == to &&
        other.node[static_cast<std::size_t>((k + 1) % other.corners())] == from)
      found.second = sub_triangle_area(vertices(nodes, other), k).normalized();
  return found;
}

bool is_alive(const Surface& surface, const Line& line) {
  if (line.round >= 0) return surface.round[static_cast<std::size_t>(line.round)].alive();
  if (line.face < 0) return surface.node[static_cast<std::size_t>(line.node[0])] >= 0;
  if (!face_at(surface, line.face).alive()) return false;
  const int across = surface.neighbor[static_cast<std::size_t>(line.face)][line.corner];
  return (line.kind == LineKind::shell_edge) == (across < 0);
}

void collect_lines(const Surface& surface, const ContactOptions& options, const Nodes& nodes,
                   std::vector<Line>& lines, std::vector<LineEnd>& ends) {
  lines.clear();
  if (options.edges) add_edges(surface, options, nodes, lines);
  if (add_round_elements(surface, lines)) add_nodes(surface, options, lines);
  std::sort(lines.begin(), lines.end(), [](const Line& a, const Line& b) {
    return std::tuple(a.node, a.kind, a.round, a.face) < std::tuple(b.node, b.kind, b.round, b.face);
  });
  find_continued(surface, nodes, lines, ends);
}

NodesOfPair nodes_of(const Surface& surface, const Line& a, const Line& b) {
  const auto node = [&](int slave) { return surface.node[static_cast<std::size_t>(slave)]; };
  return {node(a.node[0]), node(a.node[1]), node(b.node[0]), node(b.node[1])};
}

bool may_touch(const Surface& surface, const Line& a, const Line& b) {
  if (!kinds_may_touch(a, b) || share_a_node(a, b)) return false;
  const int rigid = surface.rigid_body(surface.node[static_cast<std::size_t>(a.node[0])]);
  if (rigid >= 0 && rigid == surface.rigid_body(surface.node[static_cast<std::size_t>(b.node[0])]))
    return false;
  if (surface.pairs.parts_apart(a.part, b.part)) return false;
  if (!surface.held.empty() && are_held(surface, a, b)) return false;
  return a.body != b.body || !share_a_face(surface, a, b);
}

}  // namespace brio
