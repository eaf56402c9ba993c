#pragma once
/// What the passes over pairs find, by a look at every pair, one after the other: no direction is kept,
/// nothing sleeps, no lanes.

#include <algorithm>
#include <cmath>
#include <tuple>

#include "contact/detection/crossing_check.hpp"
#include "contact/detection/proximity_filter.hpp"
#include "contact/geometry/closest_on_segments.hpp"
#include "contact/geometry/hull_point.hpp"
#include "src/base/index.hpp"
#include "tests/contact/detection/packs.hpp"
#include "tests/contact/detection/random_scene.hpp"

namespace brio {

class Reference {
 public:
  Reference(const RandomScene& scene, const FeaturePairs& all, const FeatureMotion& motion)
      : scene_(scene), all_(all), motion_(motion) {}

  double node_face_distance(std::size_t pair) const { return closest_node_face(pair).distance; }
  double edge_edge_distance(std::size_t pair) const { return closest_edges(pair).distance; }
  /// Of two edges of faces.
  bool closest_at_an_end(std::size_t pair) const {
    const auto is_end = [](double at) { return at <= 0 || at >= 1; };
    const NearPair<2> near = closest_edges(pair);
    return edge(all_.edge_edge.first(pair)).of_face() && edge(all_.edge_edge.second(pair)).of_face() &&
           (is_end(near.at[0]) || is_end(near.at[1]));
  }

  std::vector<Contact> contacts() const {
    std::vector<Contact> contacts;
    std::vector<FoundContact> found;
    const ProximityFilter filter(scene_.features, scene_.surface, scene_.excluded, scene_.options, all_,
                                 motion_, {});
    for (std::size_t i = 0; i < all_.node_face.size(); ++i) {
      if (all_.node_face.spacing(i) == Spacing::none) continue;
      const NearPair<4> near = closest_node_face(i);
      const double ahead = longest_approach(std::array{all_.node_face.first(i)},
                                            scene_.features.face_node[index(all_.node_face.second(i))]);
      if (is_near(near.distance, near.reach, ahead)) filter.node_and_face(near, found);
    }
    take_over(found, contacts);
    for (std::size_t i = 0; i < all_.edge_edge.size(); ++i) {
      if (all_.edge_edge.spacing(i) == Spacing::none) continue;
      const NearPair<2> near = closest_edges(i);
      const double ahead =
          longest_approach(edge(all_.edge_edge.first(i)).node, edge(all_.edge_edge.second(i)).node);
      if (is_near(near.distance, near.reach, ahead)) filter.edge_and_edge(near, found);
    }
    take_over(found, contacts);
    return contacts;
  }

  /// Kind, first and second feature of all pairs that the exact checks find to touch.
  using Touch = std::tuple<PairKind, int, int>;
  std::vector<Touch> touches() const {
    std::vector<Touch> touches;
    const CrossingCheck check(scene_.features, scene_.surface, scene_.options, all_, motion_, {});
    for (std::size_t i = 0; i < all_.node_face.size(); ++i)
      if (all_.node_face.spacing(i) != Spacing::none && check.node_and_face(i))
        touches.emplace_back(PairKind::node_face, all_.node_face.first(i), all_.node_face.second(i));
    for (std::size_t i = 0; i < all_.edge_edge.size(); ++i) {
      const int a = all_.edge_edge.first(i), b = all_.edge_edge.second(i);
      if (all_.edge_edge.spacing(i) == Spacing::none) continue;
      if (!all_.edge_edge.has_radii(i) && (edge(a).is_point() || edge(b).is_point())) continue;
      if (check.edge_and_edge(i)) touches.emplace_back(PairKind::edge_edge, a, b);
    }
    std::sort(touches.begin(), touches.end());
    return touches;
  }

  static bool same(const Contact& a, const Contact& b) {
    bool same = a.slave == b.slave && a.face == b.face && a.body == b.body && a.node == b.node;
    for (std::size_t k = 0; k < 5; ++k) same = same && same_bits(a.weight[k], b.weight[k]);
    for (int axis = 0; axis < 3; ++axis) same = same && same_bits(a.normal[axis], b.normal[axis]);
    return same && same_bits(a.gap, b.gap) && a.friction_coefficient == b.friction_coefficient;
  }

 private:
  const EdgeFeature& edge(int e) const { return scene_.features.edge[index(e)]; }
  template <std::size_t N, std::size_t M>
  double longest_approach(const std::array<int, N>& first, const std::array<int, M>& second) const {
    double longest = 0;
    for (int a : first)
      for (int b : second)
        longest = std::max(longest, norm(motion_.displacement(a) - motion_.displacement(b)));
    return approach_factor * longest;
  }
  bool is_near(double distance, double reach, double ahead) const {
    const double h = scene_.features.smallest_edge;
    return distance > 1e-12 * h && distance <= reach + proximity_band * h + ahead;
  }

  NearPair<4> closest_node_face(std::size_t i) const {
    const PairList& list = all_.node_face;
    const int s = list.first(i), f = list.second(i);
    FaceVertices at;
    for (std::size_t k = 0; k < 4; ++k) at[k] = motion_.start(scene_.features.face_node[index(f)][k]);
    const bool spaced = list.has_radii(i);
    const Vector3d x = motion_.start(s);
    std::array<double, 4> weights{};
    Vector3d offset{};
    if (spaced) {
      const auto found = closest_on_hull<double>(x, {at[0], at[1], at[2], at[3]}, 0.1 * scene_.features.skin);
      weights = found.weights;
      if (!found.inside) {
        offset = weights[0] * (x - at[0]);
        for (std::size_t k = 1; k < 4; ++k) offset = offset + weights[k] * (x - at[k]);
      }
    } else {
      const auto p = closest_on_triangle<double>(x, at[0], at[1], at[2]);
      const auto q = closest_on_triangle<double>(x, at[0], at[2], at[3]);
      const bool first = at[2] == at[3] || p.squared_distance <= q.squared_distance;
      weights = first ? std::array<double, 4>{p.weights[0], p.weights[1], p.weights[2], 0}
                      : std::array<double, 4>{q.weights[0], 0, q.weights[1], q.weights[2]};
      offset = first ? p.offset : q.offset;
    }
    const double distance = std::sqrt(dot(offset, offset));
    const double reach = spaced
                             ? scene_.features.node_radius[index(s)] + scene_.features.face_radius[index(f)]
                             : 2 * scene_.features.skin;
    return {static_cast<int>(i), weights, (1 / distance) * offset, distance, reach};
  }

  NearPair<2> closest_edges(std::size_t i) const {
    const PairList& list = all_.edge_edge;
    const EdgeFeature &a = edge(list.first(i)), &b = edge(list.second(i));
    const auto found = closest_on_segments(motion_.start(a.node[0]), motion_.start(a.node[1]),
                                           motion_.start(b.node[0]), motion_.start(b.node[1]));
    const double distance = std::sqrt(found.squared_distance);
    const double reach = list.has_radii(i) ? a.radius + b.radius : 2 * scene_.features.skin;
    return {static_cast<int>(i), {found.on_a, found.on_b}, (1 / distance) * found.offset, distance, reach};
  }

  static void take_over(std::vector<FoundContact>& found, std::vector<Contact>& contacts) {
    std::sort(found.begin(), found.end(), [](const FoundContact& a, const FoundContact& b) {
      return std::tuple(a.contact.slave, a.support, a.contact.face, a.contact.node) <
             std::tuple(b.contact.slave, b.support, b.contact.face, b.contact.node);
    });
    for (std::size_t i = 0; i < found.size(); ++i)
      if (i == 0 || found[i].contact.slave != found[i - 1].contact.slave ||
          found[i].support != found[i - 1].support)
        contacts.push_back(found[i].contact);
    found.clear();
  }

  const RandomScene& scene_;
  const FeaturePairs& all_;
  const FeatureMotion& motion_;
};

}  // namespace brio
