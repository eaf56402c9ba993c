#pragma once
/// Faces and sides, as what looks for flat ones asks of either kind of shapes (flatness.hpp).

#include <algorithm>
#include <array>
#include <limits>
#include <vector>

#include "contact/features/feature_motion.hpp"
#include "contact/features/features.hpp"
#include "src/base/index.hpp"

namespace brio {

struct FlatFaces {
  const SurfaceFeatures& features;
  const FeatureMotion& motion;

  bool exists(std::size_t f) const { return features.diagonal_of_face[f][0] >= 0; }
  const std::array<int, 4>& nodes(std::size_t f) const { return features.face_node[f]; }
  double radius(std::size_t f) const { return features.face_radius[f]; }
  double path(std::size_t f) const { return motion.of_face.path[f]; }
  double ahead(std::size_t f) const { return motion.of_face.ahead[f]; }
  /// Of the corners that contact has moved in this step.
  double step_of_solution(std::size_t f) const {
    double longest = 0;
    for (int slave : nodes(f)) longest = std::max(longest, motion.step_of_solution(slave));
    return longest;
  }
  /// Whether contact has moved a corner with a number below that farther than predicted.
  bool exceeds_prediction(std::size_t f, int below = std::numeric_limits<int>::max()) const {
    const std::array<int, 4>& corner = nodes(f);
    return std::any_of(corner.begin(), corner.end(),
                       [&](int slave) { return slave < below && motion.exceeds_prediction(slave); });
  }
  /// Of the corners over that of the shape.
  double path_of_corners(std::size_t) const { return 1; }
};

/// Sides between two faces. Their corners move by no more than the sum of the paths of both faces in the
/// frame of either, and by half as much again where these have frames of different groups, which corners that
/// they share hold together.
struct FlatSides {
  const FlatFaces& faces;
  const std::vector<std::array<int, 6>>& node;
  const SurfaceFeatures& features = faces.features;
  const FeatureMotion& motion = faces.motion;

  bool exists(std::size_t e) const { return features.edge[e].joins_faces(); }
  const std::array<int, 6>& nodes(std::size_t e) const { return node[e]; }
  std::size_t face(std::size_t e, std::size_t k) const { return index(features.edge[e].face[k]); }
  double radius(std::size_t e) const { return std::min(faces.radius(face(e, 0)), faces.radius(face(e, 1))); }
  double path(std::size_t e) const { return faces.path(face(e, 0)) + faces.path(face(e, 1)); }
  double ahead(std::size_t e) const { return faces.ahead(face(e, 0)) + faces.ahead(face(e, 1)); }
  double step_of_solution(std::size_t e) const {
    return faces.step_of_solution(face(e, 0)) + faces.step_of_solution(face(e, 1));
  }
  double path_of_corners(std::size_t e) const {
    const auto group = [&](std::size_t k) {
      return motion.groups.of_node(features.face_node[face(e, k)][0]);
    };
    return group(0) == group(1) ? 1 : 1.5;
  }
};

}  // namespace brio
