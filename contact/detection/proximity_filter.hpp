#pragma once
/// Selects, among near closest points, the constraints: local minima of distance on the union of the surfaces
/// that approach enough in this step (proximity.hpp).

#include <span>

#include "contact/detection/proximity.hpp"
#include "contact/geometry/closest_point.hpp"
#include "src/base/index.hpp"

namespace brio {

/// The closest points of a pair at the start of the step.
template <std::size_t Numbers>
struct NearPair {
  int pair = 0;
  std::array<double, Numbers> at{};  ///< weights of the corners of the face; parameters on both edges
  Vector3d normal;                   ///< unit vector from the second feature to the first
  double distance = 0;
  double reach = 0;  ///< distance at which they touch
};

class ProximityFilter {
 public:
  ProximityFilter(const SurfaceFeatures& features, const Surface& surface, const Lists& excluded,
                  const ContactOptions& options, const FeaturePairs& pairs, const FeatureMotion& motion,
                  std::span<const Contact> last)
      : features_(features),
        surface_(surface),
        excluded_(excluded),
        options_(options),
        pairs_(pairs),
        motion_(motion),
        last_(last),
        band_(proximity_band * features.smallest_edge) {}

  /// Append the constraint of the pair, if it is one.
  void node_and_face(const NearPair<4>& near, std::vector<FoundContact>& found) const;
  void edge_and_edge(const NearPair<2>& near, std::vector<FoundContact>& found) const;

 private:
  const EdgeFeature& edge(int e) const { return features_.edge[index(e)]; }
  struct EdgePair {
    int first, second;
    bool radii;  ///< whether these are kept
  };
  bool was_constraint(const EdgePair& pair) const;
  bool are_features(const EdgePair& pair) const;
  /// At both ends of the step, as predicted.
  struct MovingPoint {
    Vector3d start, end;
  };
  /// The other side, where it is of the same shell: neighbours that are one piece with it do not count.
  using OtherSide = std::span<const int>;
  bool is_one_piece(int neighbour, OtherSide other) const;
  /// \param allowed by how much a neighbour may come nearer all the same
  template <class List, class Allowed>
  bool look_away(const List& neighbours, const MovingPoint& foot, const Vector3d& away, double slack,
                 OtherSide other, const Allowed& allowed) const;
  template <class List>
  bool look_away(const List& neighbours, const MovingPoint& foot, const Vector3d& away, double slack,
                 OtherSide other) const;
  bool wings_look_away(const EdgeFeature& own, const MovingPoint& foot, const Vector3d& away, double slack,
                       const EdgePair& pair, OtherSide other) const;
  MovingPoint point_of(int node) const;
  static double slack_of(const Vector3d& foot, double distance);
  /// A share of the step later, or more than all of it.
  Vector3d after(double share, int node) const {
    return motion_.start(node) + share * motion_.displacement(node);
  }
  double squared_distance_after(double share, int slave, int face, bool as_hull) const;
  double squared_distance_after(double share, const EdgeFeature& a, const EdgeFeature& b) const;
  template <class... Pair>
  bool is_near(const Contact& contact, double distance, const Pair&... pair) const;
  double rounding_of_foot(double slack, double distance) const;
  bool is_minimum_on_face(int face, const std::array<double, 4>& weights, const MovingPoint& foot,
                          const Vector3d& normal, double slack, OtherSide other,
                          std::array<int, 2>& support) const;
  bool is_minimum_on_edge(int edge, double parameter, const MovingPoint& foot, const Vector3d& away,
                          double slack, double distance, const EdgePair& pair, OtherSide other,
                          int& on) const;
  bool lay_in_plane(const NearPair<4>& near, double slack, Contact& contact) const;
  bool is_kept_beside_rim(const NearPair<4>& near, const std::array<int, 2>& support, bool in_plane,
                          double slack, Contact& contact) const;
  /// Of the faces at an edge or a node: the largest cosine of a normal and a direction; whether they bend.
  struct Edginess {
    double cosine = 0;
    bool sharp = false;
  };
  template <class Faces>
  Edginess edginess(const Faces& faces, const Vector3d& direction) const;
  static double tilt_of(double cosine);
  double spared_skin(double tilt) const;
  double passing_gap(double tilt) const;
  template <class... Pair>
  bool passes_by(double reach, const Pair&... pair) const;
  std::array<int, 2> faces_of_side(int face, const std::array<int, 2>& ends) const;
  bool are_parallel(const EdgeFeature& a, const EdgeFeature& b, double sine) const;
  enum class Flatness : std::uint8_t { none, rim, inside };
  Flatness flatness(const EdgeFeature& own, const Vector3d& foot, const Vector3d& direction) const;

  const SurfaceFeatures& features_;
  const Surface& surface_;
  const Lists& excluded_;
  const ContactOptions& options_;
  const FeaturePairs& pairs_;
  const FeatureMotion& motion_;
  std::span<const Contact> last_;  ///< constraints of the step before, by Contact::slave
  double band_;
};

}  // namespace brio
