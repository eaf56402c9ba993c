#include "contact/start/retraction.hpp"

#include <algorithm>
#include <cmath>
#include <compare>
#include <set>
#include <span>

#include "contact/geometry/closest_segments.hpp"
#include "contact/start/sided_look.hpp"
#include "src/base/index.hpp"

namespace brio {

namespace {

/// Faces look against each other where the cosine of their normals is below this.
constexpr double opposed_cosine = -0.1;
/// Set back by this much more, so that rounding leaves no gap missing.
constexpr double surplus = 1e-6;
/// A node moves at most this many times what its faces are set back by: at a sharp edge.
constexpr double most_miter = 8;
/// Neighbours lie in one plane where the cosine of their normals is above this.
constexpr double coplanar_cosine = 1 - 1e-8;

/// The less free of two bodies keeps its mesh.
enum class Firmness : std::uint8_t { is_free, supported, rigid };

class Retraction {
 public:
  Retraction(const SurfaceFeatures& features, const Surface& surface, const FeaturePairs& pairs, Nodes& nodes)
      : features_(features),
        surface_(surface),
        pairs_(pairs),
        nodes_(nodes),
        look_(features, surface, nodes, {}),
        set_back_(surface.face.size(), 0.0),
        normal_(surface.face.size(), Vector3d{}),
        box_(index(surface.body_count), empty_box),
        firmness_(index(surface.body_count), Firmness::is_free) {
    for (std::size_t s = 0; s < surface.slaves(); ++s) {
      const auto node = index(surface.node[s]);
      Firmness& of_body = firmness_[index(surface.body[s])];
      if (surface.rigid_body(surface.node[s]) >= 0) of_body = Firmness::rigid;
      if (of_body == Firmness::is_free && !nodes.prescribed.empty() && nodes.prescribed[node] != 0)
        of_body = Firmness::supported;
    }
  }

  std::vector<TouchingPair> run() {
    measure();
    find_overlapping();
    for (std::size_t p = 0; p < pairs_.node_face.size(); ++p) look_at_node_and_face(p);
    for (std::size_t p = 0; p < pairs_.edge_edge.size(); ++p) look_at_edges(p);
    if (touching_.empty()) return {};
    spread_over_planes();
    move();
    return std::move(touching_);
  }

 private:
  /// A face of another body near a node.
  struct ToBody {
    int slave, body, face;
    auto operator<=>(const ToBody&) const = default;
  };
  // Normals of faces and boxes around bodies.
  void measure() {
    for (std::size_t f = 0; f < normal_.size(); ++f) {
      const Face& one = surface_.face[f];
      if (!one.alive()) continue;
      const FaceVertices at = look_.corners(one);
      normal_[f] = unit_or(cross(at[2] - at[0], at[3] - at[1]), Vector3d{});
      CaptureBox& box = box_[index(one.body)];
      for (const Vector3d& corner : at) box.include(corner);
    }
  }

  const Face& face(int f) const { return surface_.face[index(f)]; }

  void look_at_node_and_face(std::size_t p) {
    const int s = pairs_.node_face.first(p), f = pairs_.node_face.second(p);
    const Face& other = face(f);
    const auto faces = surface_.faces_of.of(s);
    if (other.shell || faces.empty() || face(faces.front()).shell) return;
    if (!are_two(surface_.body[index(s)], other.body)) return;
    if (look_.surely_farther(s, other, 2 * features_.skin)) return;
    const ClosestPoint closest = closest_point_on_quad(look_.at(s), look_.corners(other));
    double distance = std::sqrt(closest.squared_distance);
    if (distance >= 2 * features_.skin) return;
    if (!is_outside(surface_, nodes_, f, closest)) distance = -distance;
    bool opposed = false;
    for (int own : faces) {
      if (dot(normal(own), normal(f)) >= opposed_cosine) continue;
      set_back(own, other.body, distance);
      opposed = true;
    }
    if (!opposed) return;  // they meet at a rim of the face, beside others that look at each other
    set_back(f, surface_.body[index(s)], distance);
    touching_.push_back({{look_.part_of(s), other.part}, s, std::max(-distance, 0.0)});
  }

  void look_at_edges(std::size_t p) {
    const EdgeFeature& a = look_.edge(pairs_.edge_edge.first(p));
    const EdgeFeature& b = look_.edge(pairs_.edge_edge.second(p));
    if (!a.of_face() || !b.of_face() || a.shell || b.shell || !are_two(a.body, b.body)) return;
    const Segment sa{look_.at(a.node[0]), look_.at(a.node[1])}, sb{look_.at(b.node[0]), look_.at(b.node[1])};
    for (int axis = 0; axis < 3; ++axis)
      if (std::min(sa[0][axis], sa[1][axis]) > std::max(sb[0][axis], sb[1][axis]) + 2 * features_.skin ||
          std::min(sb[0][axis], sb[1][axis]) > std::max(sa[0][axis], sa[1][axis]) + 2 * features_.skin)
        return;
    const double distance = std::sqrt(closest_points_of_segments(sa, sb).squared_distance);
    if (distance >= 2 * features_.skin) return;
    bool opposed = false;
    for (int f : a.face)
      for (int g : b.face) {
        if (f < 0 || g < 0 || dot(normal(f), normal(g)) >= opposed_cosine) continue;
        set_back(f, b.body, distance);
        set_back(g, a.body, distance);
        opposed = true;
      }
    if (opposed) touching_.push_back({{a.part, b.part}, a.node[0], 0});
  }

  // Bodies of which a node of one lies in the other, deeper than the gap, have to be moved apart instead.
  void find_overlapping() {
    std::vector<ToBody> order;
    for (std::size_t p = 0; p < pairs_.node_face.size(); ++p) {
      const int s = pairs_.node_face.first(p), f = pairs_.node_face.second(p);
      const Face& other = face(f);
      if (other.shell || !are_two(surface_.body[index(s)], other.body)) continue;
      if (is_deep_in_box(s, other.body)) order.push_back({s, other.body, f});
    }
    std::sort(order.begin(), order.end());
    for (auto begin = order.begin(); begin != order.end();) {
      const auto end = std::find_if(begin, order.end(), [&](const ToBody& one) {
        return one.slave != begin->slave || one.body != begin->body;
      });
      look_whether_inside({begin, end});
      begin = end;
    }
  }

  // Elsewhere a node in the body is no deeper than the gap.
  bool is_deep_in_box(int s, int body) const {
    const Vector3d x = look_.at(s);
    const CaptureBox& box = box_[index(body)];
    for (int axis = 0; axis < 3; ++axis)
      if (x[axis] <= box.lower[axis] + 2 * features_.skin || x[axis] >= box.upper[axis] - 2 * features_.skin)
        return false;
    return true;
  }

  void look_whether_inside(std::span<const ToBody> faces) {
    const int s = faces.front().slave, body = faces.front().body;
    int nearest = -1;
    ClosestPoint point;
    for (const ToBody& one : faces) {
      if (nearest >= 0 && look_.surely_farther(s, face(one.face), std::sqrt(point.squared_distance)))
        continue;
      const ClosestPoint here = closest_point_on_quad(look_.at(s), look_.corners(face(one.face)));
      if (nearest >= 0 && !(here.squared_distance < point.squared_distance)) continue;
      nearest = one.face;
      point = here;
      if (point.squared_distance <= 4 * features_.skin * features_.skin) return;
    }
    if (!is_outside(surface_, nodes_, nearest, point))
      overlapping_.insert(std::minmax(surface_.body[index(s)], body));
  }

  bool are_two(int body, int other) const {
    return body != other && !surface_.tied.one_piece(body, other) &&
           !overlapping_.contains(std::minmax(body, other));
  }

  // By what is missing of two skins, or half of it where the other body is as firm.
  void set_back(int f, int other_body, double distance) {
    const Firmness own = firmness_[index(face(f).body)];
    const Firmness other = firmness_[index(other_body)];
    if (own > other) return;
    const double missing = (1 + surplus) * (2 * features_.skin - distance);
    double& known = set_back_[index(f)];
    known = std::max(known, own == other ? 0.5 * missing : missing);
  }

  // Flat surfaces stay flat.
  void spread_over_planes() {
    std::vector<int> open;
    for (int f = 0; f < static_cast<int>(set_back_.size()); ++f)
      if (set_back_[index(f)] > 0) open.push_back(f);
    while (!open.empty()) {
      const int f = open.back();
      open.pop_back();
      for (int neighbor : surface_.neighbor[index(f)]) {
        if (neighbor < 0 || !face(neighbor).alive()) continue;
        double& known = set_back_[index(neighbor)];
        if (known >= set_back_[index(f)]) continue;
        if (dot(normal(f), normal(neighbor)) < coplanar_cosine) continue;
        known = set_back_[index(f)];
        open.push_back(neighbor);
      }
    }
  }

  const Vector3d& normal(int f) const { return normal_[index(f)]; }

  void move() {
    std::vector<Vector3d> displacement(surface_.slaves(), Vector3d{});
    for (std::size_t s = 0; s < displacement.size(); ++s)
      if (!is_tied(static_cast<int>(s))) displacement[s] = inward(static_cast<int>(s));
    for (std::size_t s = 0; s < displacement.size(); ++s)
      for (int axis = 0; axis < 3 && !is_zero(displacement[s]); ++axis)
        nodes_.record[index(surface_.node[s])].position[axis] += displacement[s][axis];
  }

  bool is_tied(int s) const {
    return !surface_.tied.empty() && surface_.tied.main_part[index(surface_.node[index(s)])] >= 0;
  }

  // Sets all faces at a node back by what the most of them needs.
  Vector3d inward(int s) const {
    Directions normals;
    double most = 0;
    for (int f : surface_.faces_of.of(s)) {
      const double by = set_back_[index(f)];
      if (by > 0) normals.add(normal(f));
      most = std::max(most, by);
    }
    const Vector3d way = normals.mean();
    double least = 1;
    for (int f : surface_.faces_of.of(s))
      if (set_back_[index(f)] > 0) least = std::min(least, dot(normal(f), way));
    return -most / std::max(least, 1 / most_miter) * way;
  }

  const SurfaceFeatures& features_;
  const Surface& surface_;
  const FeaturePairs& pairs_;
  Nodes& nodes_;
  SidedLook look_;
  std::vector<double> set_back_;               ///< of each face; 0: it stays
  std::vector<Vector3d> normal_;               ///< of each face, as drawn
  std::vector<CaptureBox> box_;                ///< of each body
  std::set<std::pair<int, int>> overlapping_;  ///< bodies
  std::vector<Firmness> firmness_;             ///< of each body
  std::vector<TouchingPair> touching_;
};

}  // namespace

std::vector<TouchingPair> retract_touching_faces(const SurfaceFeatures& features, const Surface& surface,
                                                 const FeaturePairs& pairs, Nodes& nodes) {
  return Retraction(features, surface, pairs, nodes).run();
}

}  // namespace brio
