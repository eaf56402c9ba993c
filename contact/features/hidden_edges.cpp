// Which edges flat shapes hide, asked of the shapes at one moment.

#include "contact/features/flat_hull.hpp"
#include "contact/features/flat_kinds.hpp"
#include "contact/features/flatness.hpp"

namespace brio {

namespace {

/// Of the thickness up to which a face is flat: so thick its hull may become before what is a constraint
/// beside it no longer is one.
constexpr double share_to_stay_beside = 1.5;

template <class Kind>
FlatHull<double> hull_at(const Kind& kind, std::size_t i, Moment moment) {
  std::array<Vector3d, std::tuple_size_v<std::remove_cvref_t<decltype(kind.nodes(0))>>> at;
  for (std::size_t k = 0; k < at.size(); ++k) {
    const int node = kind.nodes(i)[k];
    at[k] = moment == Moment::start ? kind.motion.start(node) : kind.motion.end(node);
  }
  return flat_hull(at);
}

Flatness flatness_for(bool radii) { return radii ? Flatness::radii : Flatness::all; }

}  // namespace

bool SurfaceFlatness::is_hidden(const SurfaceFeatures& features, const FeatureMotion& motion, int flat,
                                int other, const FlatnessQuery& query) const {
  const EdgeFeature& edge = features.edge[index(flat)];
  const auto is_flat = [&](const auto& kind, std::size_t i) {
    const double thickness = flat_thickness(features, kind.radius(i), flatness_for(query.radii));
    const FlatHull<double> hull = hull_at(kind, i, query.moment);
    return hull.slack(thickness) >= 0;
  };
  if (!finds_flat_) return false;
  const FlatFaces faces{features, motion};
  if (edge.is_diagonal()) return is_flat(faces, index(edge.face[0]));
  const FlatSides sides{faces, side_node_};
  return sides.exists(index(flat)) && lengths_.spans(flat, other) && is_flat(sides, index(flat));
}

double SurfaceFlatness::thickness_of_flat(const SurfaceFeatures& features, const FeatureMotion& motion,
                                          int face, bool radii, bool is_constraint) const {
  const FlatFaces faces{features, motion};
  if (!finds_flat_ || !faces.exists(index(face))) return 0;
  const double thickness = (is_constraint ? share_to_stay_beside : 1.0) *
                           flat_thickness(features, faces.radius(index(face)), flatness_for(radii));
  return hull_at(faces, index(face), Moment::start).slack(thickness) >= 0 ? thickness : 0;
}

}  // namespace brio
