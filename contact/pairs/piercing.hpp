#pragma once
/// Edges of a mesh at rest that go through faces: the check that nothing crosses at the start.
///
/// An edge is looked at as the way of a point from one of its ends to the other, by the velocity check, which
/// misses nothing; what touches is found too. A face is the hull of its corners, among neighbours of one
/// piece its two triangles. Left out are pairs that share a node, that are parts of one rigid body, that a
/// tie joins, or that the deck keeps from touching.

#include <optional>

#include "contact/features/features.hpp"
#include "contact/geometry/closest_point.hpp"
#include "contact/options.hpp"
#include "contact/surface/surface.hpp"
#include "src/base/nodes.hpp"
#include "src/base/parallel.hpp"
#include "src/base/tensor.hpp"

namespace brio {

struct Piercing {
  int edge = 0;  ///< of the features
  int face = 0;
  Vector3d point{};
};

/// Whether the straight way from one point to another meets a face. \param as_hull of its corners; else of
/// its two triangles
bool passes_through(const Vector3d& from, const Vector3d& to, const FaceVertices& face, bool as_hull);

/// The first by face and edge. \param excluded pairs of nodes and faces that are one piece \param
/// shells_alone look only at the middle surfaces of shells, where other bodies cross them: they have no
/// inside that could be left
std::optional<Piercing> find_piercing(const SurfaceFeatures& features, const Surface& surface,
                                      const Lists& excluded, const ContactOptions& options,
                                      const Nodes& nodes, bool shells_alone, ThreadTeam& team);

/// \throws std::invalid_argument naming parts and place of the first piercing, of which the parameters are.
void expect_nothing_crosses(const SurfaceFeatures& features, const Surface& surface, const Lists& excluded,
                            const ContactOptions& options, const Nodes& nodes, bool shells_alone,
                            ThreadTeam& team);

}  // namespace brio
