#pragma once
/// The exact check behind the certificates: when, within a step, does a node first meet the hull of a face's
/// four vertices, or an edge an edge? All points move linearly.
///
/// The surface of the hull is at any time the four triangles of its vertices, and what comes in from outside
/// meets one of them. So the promises are those of `velocity_check` and `edge_check`: no false negative
/// against exact arithmetic on the given numbers, a time not later than the first, and false positives only
/// within the touch tolerance. As the hull holds both triangulations of the face, a node that never meets it
/// crosses none of them, on whatever diagonal, however the face warps or inverts.

#include <array>
#include <optional>

#include "contact/edge_check.hpp"
#include "contact/velocity_check.hpp"

namespace brio {

struct MotionContact {
  double time;  // fraction of the step, in [0, 1]
  /// Node and hull: of the four vertices. Edges: of the two ends of a, then of b. None negative; the sum, or
  /// that of each edge, is 1.
  std::array<double, 4> weights;
  /// Unit vector from hull to node, or from b to a, on the side that they come from; zero where they are in
  /// contact at the start and nothing tells a side.
  Eigen::Vector3d normal;
  double distance;  // then
};

/// First contact of the node with the hull grown by `reach`. A node that is inside at the start, beyond
/// rounding, is in contact at time 0 with the nearest triangle, and the normal points out of the hull.
std::optional<MotionContact> hull_motion(const MovingNode& node, const MovingFace& face, double reach = 0);

/// First contact of two edges, nearer than the sum of their radii.
std::optional<MotionContact> edge_motion(const MovingEdge& a, const MovingEdge& b);

}  // namespace brio
