#pragma once
/// What touches along a line: sharp edges of solids, free edges of shells, beams; and particles, which are
/// lines without length. A node against a face is detect.hpp's; what can meet with no node near is here:
///
/// |                | edge of solid | edge of shell | beam | particle |
/// | ---            | ---           | ---           | ---  | ---      |
/// | edge of solid  | x             | x             | x    | its node |
/// | edge of shell  |               | x             | x    | its node |
/// | beam           |               |               | x    | x        |
/// | particle       |               |               |      | x        |
/// | node of a face | its face      | its face      | x    | its node |

#include <Eigen/Dense>
#include <array>
#include <cstdint>
#include <vector>

#include "contact/options.hpp"
#include "contact/surface.hpp"
#include "src/base/nodes.hpp"

namespace brio {

enum class LineKind : std::uint8_t { solid_edge, shell_edge, beam, particle, node };

struct Line {
  std::array<int, 2> node{};  ///< slave indices, ascending; the same twice: a point
  LineKind kind = LineKind::node;
  std::uint8_t corner = 0;          ///< of an edge: from this corner of its face to the next
  std::array<bool, 2> continues{};  ///< an edge: whether another goes on straight from this end
  int part = 0;
  int body = 0;
  int face = -1;   ///< of an edge
  int round = -1;  ///< of a beam or particle, in Surface::round
  double radius = 0;

  bool is_point() const { return node[0] == node[1]; }
  bool is_edge() const { return kind == LineKind::solid_edge || kind == LineKind::shell_edge; }
};

/// Edges of solids are sharp where the normals of their faces are farther apart than this, 20 degrees.
inline constexpr double cosine_of_sharp = 0.93969262078590843;

/// Normals of the two faces of an edge of a solid, of unit length, and the edge's direction so that it turns
/// the first into the second the short way where the edge is convex.
struct EdgeNormals {
  Eigen::Vector3d first, second, along;
};
EdgeNormals normals_at(const Surface& surface, const Nodes& nodes, const Line& edge);

/// Whether a line is still what it was when it was collected: elements may have been deleted since.
bool is_alive(const Surface& surface, const Line& line);

/// An end of an edge: working space of collect_lines.
struct LineEnd {
  int slave;
  std::size_t line, end;
  Eigen::Vector3d away;  ///< from it along the line, of unit length
};

/// Replace `lines` by all of the surface, ascending by nodes and kind. Edges of solids are those that are
/// sharp now; nodes of faces are lines only where there are beams.
void collect_lines(const Surface& surface, const ContactOptions& options, const Nodes& nodes,
                   std::vector<Line>& lines, std::vector<LineEnd>& ends);

/// The nodes of two lines, global.
using NodesOfPair = std::array<int, 4>;
NodesOfPair nodes_of(const Surface& surface, const Line& a, const Line& b);

/// Whether two lines may touch by their kinds, parts and bodies: not where a node and a face stand for it,
/// where they belong to one rigid body, or are neighbours in one surface. \pre both are alive
bool may_touch(const Surface& surface, const Line& a, const Line& b);

}  // namespace brio
