#pragma once
/// Nodes, faces and segments at rest, chosen to be difficult for closest points.

#include "contact/geometry/closest_point.hpp"
#include "contact/geometry/closest_segments.hpp"
#include "tests/contact/geometry/adversarial_queries.hpp"

namespace brio {

struct FaceQuery {
  Vector3d node;
  FaceVertices face;
};

struct SegmentQuery {
  Segment a;
  Segment b;
};

/// Faces: at random; flat, exactly or but for rounding or for a warp of 1e-16 to 1; slivers of 1e-16 to 1;
/// triangular; on a lattice of small integers; with vertices that coincide. Nodes: at random; near or on a
/// point of the face, a side or a vertex; inside the hull. Then, for a quarter of them, 1e6 sizes away.
FaceQuery any_face_query(Random& random);

/// Segments: at random; crossing, exactly or nearly; nearly or exactly parallel; on a lattice; with ends that
/// coincide; of any length down to none. Then, for a quarter of them, 1e6 sizes away.
SegmentQuery any_segment_query(Random& random);

}  // namespace brio
