#pragma once
/// The velocity check of Heinstein, Attaway, Swegle and Mello (1993): when, within a step, does a moving node
/// first meet a moving face? Node and face vertices move linearly over the step. The face is four triangles
/// about its centroid (one triangle if the fourth vertex repeats the third).
///
/// What is promised, against exact arithmetic on the given numbers:
/// - *No false negative.* If at some time of [0, 1] the node is on the face (closer than or at `reach`), a
/// contact is
///   reported, at a time not later than the first such time. Boundaries count as inside, so no seam between
///   sub-triangles or between neighbouring faces is open, whatever the order in which faces list their
///   vertices.
/// - *False positives are near.* At the time reported the node is within `reach` + `touch_tolerance(...)` of
/// the face:
///   1.5e-14 of the distances and displacements involved, relative to the face, wherever the origin is and
///   however fast node and face move together.
///
/// How: time moves forward for as long as a certificate that holds for rounded arithmetic separates node and
/// triangle: a direction, turning with the normal of the face or with its edge, along which every vertex
/// stays beyond the node (conservative advancement, Mirtich 1996, with directions that turn; it converges
/// like Newton's method on the gap). It ends when no time is left, or at a point of the triangle near enough
/// to the node. No polynomial is solved for, so coplanar motion, double roots and slivers are not special.
/// Two to five certificates are usual, grazing takes 24, the most seen in a million adversarial queries is
/// 347. Should 1024 not do, the tolerance doubles, and again for each 1024 more: the work is bounded.
///
/// Thickness: `reach` is half the thickness of the shell plus the radius of the node. The node meets the
/// mid-surface grown by `reach` on both sides and rounded at edges and corners, so growth opens no gap at a
/// fold. Contact is then entered from the side the node starts on. A node that starts within reach is in
/// contact at time 0.

#include <array>
#include <optional>

#include "contact/geometry/closest_point.hpp"
#include "src/base/tensor.hpp"

namespace brio {

/// A node over one step: position at its beginning and displacement until its end, same unit.
struct MovingNode {
  Vector3d start;
  Vector3d displacement;
};

/// A face over one step, vertices counterclockwise seen from outside.
struct MovingFace {
  FaceVertices start;
  FaceVertices displacement;
};

struct VelocityContact {
  double time;                    // fraction of the step, in [0, 1]
  std::array<double, 4> weights;  // of the four face vertices at that time: none negative, their sum is 1
  Vector3d normal;  // unit normal of the sub-triangle at that time; zero if the face has no area
  double distance;  // from the node to the face then: within rounding of `reach`, or less at time 0
  int side;  // +1: came from the side the normal points to; -1: from behind; 0: in the plane all the while
  int sub_triangle;  // 0..3; 0 for a triangular face
};

/// First contact within the step, if any. `reach` >= 0.
std::optional<VelocityContact> velocity_check(const MovingNode& node, const MovingFace& face,
                                              double reach = 0);

/// Length within which the arithmetic of this pair can resolve a touch: 128 unit roundoffs of the largest
/// distance between node and face plus their largest relative displacement (largest components).
double touch_tolerance(const MovingNode& node, const MovingFace& face, double reach = 0);

}  // namespace brio
