#pragma once
/// The surface as the audit sees it: living faces along a curve, at their present positions.

#include <array>
#include <vector>

#include "contact/audit/box_tree.hpp"
#include "contact/audit/segment_triangle.hpp"
#include "contact/surface/surface.hpp"
#include "src/base/index.hpp"
#include "src/base/nodes.hpp"
#include "src/base/tensor.hpp"

namespace brio {

struct AuditedFace {
  std::array<Vector3d, 4> x;             ///< corners; a triangle repeats its third
  std::array<int, 4> node{};             ///< global
  std::array<bool, 4> edge_continues{};  ///< as Continuation says
  std::array<bool, 4> corner_continues{};
  bool shell = false;
  int corners = 4;
  int face = 0;   ///< in Surface::face
  int piece = 0;  ///< the connected piece it belongs to
  int rigid = -1;
  double shortest_edge = 0;

  bool has(int global_node) const {
    return node[0] == global_node || node[1] == global_node || node[2] == global_node ||
           node[3] == global_node;
  }
  int triangles() const { return corners - 2; }
  /// A quadrilateral is cut along the diagonal from corner 0 to corner 2.
  SurfaceTriangle triangle(int number) const {
    const auto& e = edge_continues;
    const auto& c = corner_continues;
    if (corners == 3) return {x[0], x[1], x[2], {{e[0], e[1], e[2]}, {c[0], c[1], c[2]}}};
    if (number == 0) return {x[0], x[1], x[2], {{e[0], e[1], true}, {c[0], c[1], c[2]}}};
    return {x[0], x[2], x[3], {{true, e[2], e[3]}, {c[0], c[2], c[3]}}};
  }
};

/// Built anew for each audit.
struct AuditedSurface {
  AuditedSurface(const Surface& surface, const Nodes& nodes);

  const Surface& surface;
  const Nodes& nodes;
  std::vector<AuditedFace> face;  ///< along the curve
  BoxTree tree;                   ///< of `face`
  std::vector<int> piece;         ///< of each slave node: one number for all that faces and beams connect
  int pieces = 0;
  bool has_shells = false, has_solids = false;
  double tolerance = 0;  ///< a depth that rounding of positions explains

  Vector3d position(int global_node) const {
    const double* x = nodes.record[index(global_node)].position;
    return {x[0], x[1], x[2]};
  }
  int piece_of_node(int global_node) const { return piece[index(surface.slave(global_node))]; }

 private:
  void find_pieces();
  void collect_faces();
  void add_face(int number);
  void find_continuation();
};

}  // namespace brio
