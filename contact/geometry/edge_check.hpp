#pragma once
/// The edge-edge form of the velocity check: when, within a step, do two moving edges first meet? End points
/// move linearly over the step. An edge has a radius: zero for an edge of a solid, half the thickness or the
/// radius for an edge of a shell or a beam, which is then a segment grown by it and rounded at its ends.
/// Edges meet where their distance falls to the sum of the radii, the reach.
///
/// What is promised, against exact arithmetic on the given numbers:
/// - *No false negative.* If at some time of [0, 1] the edges are closer than or at the reach, a contact is
///   reported, at a time not later than the first such time. Ends count as parts of the edges.
/// - *False positives are near.* At the time reported the edges are within the reach +
///   `touch_tolerance(...)`.
/// - If the edges change places, so do the results, to the bit.
///
/// How: as in `velocity_check`. The differences between points of a and points of b fill a parallelogram;
/// time moves forward for as long as a direction, turning with its normal or with one of its sides, keeps all
/// four corners beyond the reach from the origin. The cubic of the four coplanar ends is not solved for:
/// where it has no use (parallel edges, ends that stay in one plane, edges without length) nothing is
/// special. It tells the side. So no motion is exempt from the promises; what is without meaning there is
/// only the side, and it is zero:
/// - if the ends stay in one plane (the edges slide in it, meet end on end, or stay parallel),
/// - if they are in contact at the start and in one plane then,
/// - where the edges are parallel but for rounding at the time of contact.
///
/// Two to four certificates are usual, the most seen in a million adversarial queries is 90. The work is
/// bounded as in `velocity_check`: should 1024 not do, the tolerance doubles, and again for each 1024 more.

#include <array>
#include <optional>

#include "contact/geometry/closest_segments.hpp"
#include "src/base/tensor.hpp"

namespace brio {

/// An edge over one step: its ends at the beginning and their displacements until its end, same unit.
struct MovingEdge {
  Segment start;
  Segment displacement;
  double radius = 0;  // not negative
};

struct EdgeContact {
  double time;                       // fraction of the step, in [0, 1]
  std::array<double, 2> parameters;  // on a and b at that time: 0 at the first end, 1 at the second
  std::array<SegmentFeature, 2> features;
  /// Unit vector from b to a at that time. Edges that touch without a distance have the common perpendicular,
  /// on the side that a comes from, or, where that side is zero or an end is met, the direction in which they
  /// came together. In contact from the start without distance or side, it is the perpendicular to either
  /// side, and zero if there is none.
  Vector3d normal;
  double distance;  // then: within rounding of the reach, or less at time 0
  /// Of (a - b) . (along a x along b) just before the time: that at the start, unless the lines that the
  /// edges lie on have passed each other beside them.
  int side;
};

/// First contact within the step, if any.
std::optional<EdgeContact> edge_check(const MovingEdge& a, const MovingEdge& b);

/// Length within which the arithmetic of this pair can resolve a touch: 128 unit roundoffs of the largest
/// distance between two ends plus their largest relative displacement (largest components) and the reach.
double touch_tolerance(const MovingEdge& a, const MovingEdge& b);

}  // namespace brio
