#include "contact/start/enclosed.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <vector>

#include "contact/geometry/winding.hpp"
#include "contact/search/tree_search.hpp"
#include "contact/surface/face_geometry.hpp"
#include "src/base/floating_point.hpp"
#include "src/base/index.hpp"

namespace brio {

namespace {

/// How far behind a face a body is probed, in its edges.
constexpr double probe_share = 0.2;

class Enclosures {
 public:
  Enclosures(const ContactScene& scene, const Nodes& nodes, double overlap_limit)
      : surface_(scene.surface),
        nodes_(nodes),
        overlap_limit_(overlap_limit),
        faces_(index(surface_.body_count)) {
    for (std::size_t f = 0; f < surface_.face.size(); ++f)
      if (const Face& face = surface_.face[f]; face.alive() && !face.shell)
        faces_[index(face.body)].push_back(static_cast<int>(f));
  }

  // A point just inside of each closed body, in no other.
  void expect_bodies_apart(bool enclosed_alone) {
    std::vector<Vector3d> probes;
    std::vector<CaptureBox> boxes;
    std::vector<int> bodies;
    for (int body = 0; body < surface_.body_count; ++body) {
      if (faces_of(body).empty()) continue;
      const Vector3d probe = probe_of(body);
      if (winding(body, probe) <= 0.5) continue;  // thinner than that
      bodies.push_back(body);
      probes.push_back(probe);
      boxes.push_back(box_of(body));
    }
    ThreadTeam team(1);
    TreeSearch search;
    CandidatePairs pairs;
    SearchCounts counts;
    search.find(SearchNodes(probes), boxes, team, pairs, counts);
    for (std::size_t b = 0; b < bodies.size(); ++b)
      for (const int other : pairs.of_box(b))
        if (other != static_cast<int>(b) && (!enclosed_alone || is_within(boxes[index(other)], boxes[b])))
          expect_apart(bodies[index(other)], bodies[b]);
  }

 private:
  const std::vector<int>& faces_of(int body) const { return faces_[index(body)]; }
  const Face& face(int f) const { return surface_.face[index(f)]; }

  double winding(int body, const Vector3d& x) const {
    double sum = 0;
    for (const int f : faces_of(body)) sum += winding_share(vertices(nodes_, face(f)), x);
    return sum;
  }

  // Behind the middle of a face.
  Vector3d probe_of(int body) const {
    const int f = faces_of(body).front();
    const FaceVertices v = vertices(nodes_, face(f));
    const Vector3d normal = cross(v[2] - v[0], v[3] - v[1]);
    const Vector3d middle = 0.25 * (v[0] + v[1] + v[2] + v[3]);
    return middle - probe_share * shortest_edge(nodes_, face(f)) * normalized(normal);
  }

  CaptureBox box_of(int body) const {
    CaptureBox box = empty_box;
    for (const int f : faces_of(body))
      for (const Vector3d& x : vertices(nodes_, face(f))) box.include(x);
    return box;
  }

  static bool is_within(const CaptureBox& box, const CaptureBox& other) {
    for (int axis = 0; axis < 3; ++axis)
      if (box.lower[axis] < other.lower[axis] || box.upper[axis] > other.upper[axis]) return false;
    return true;
  }

  void expect_apart(int body, int other) const {
    const Face& own = face(faces_of(body).front());
    const Face& theirs = face(faces_of(other).front());
    if (surface_.never_touch(surface_.slave(own.node[0]), theirs)) return;
    const Vector3d probe = probe_of(body);
    double depth = infinity;
    double edge = 0;
    for (const int f : faces_of(other)) {
      const double distance =
          std::sqrt(closest_point_on_quad(probe, vertices(nodes_, face(f))).squared_distance);
      if (distance >= depth) continue;
      depth = distance;
      edge = shortest_edge(nodes_, face(f));
    }
    // A ball around the probe is in both: they overlap by its diameter or more.
    const double own_edge = shortest_edge(nodes_, own);
    if (2 * std::min(probe_share * own_edge, depth) <= overlap_limit_ * std::max(own_edge, edge)) return;
    if (depth > deep_share * edge && winding(other, probe) > 0.5) refuse(own.part, theirs.part, depth, probe);
  }

  [[noreturn]] void refuse(int part, int other, double depth, const Vector3d& x) const {
    std::ostringstream text;
    text << "contact: part '" << surface_.part_name[index(part)] << "' lies in part '"
         << surface_.part_name[index(other)] << "', " << depth << " deep at (" << x[0] << ", " << x[1] << ", "
         << x[2] << "); accepted are bodies that do not intersect at the start";
    throw std::invalid_argument(text.str());
  }

  const Surface& surface_;
  const Nodes& nodes_;
  double overlap_limit_;
  std::vector<std::vector<int>> faces_;  ///< of each body
};

}  // namespace

void expect_bodies_apart(const ContactScene& scene, const Nodes& nodes, double overlap_limit) {
  Enclosures(scene, nodes, overlap_limit).expect_bodies_apart(false);
}

void expect_none_enclosed(const ContactScene& scene, const Nodes& nodes, double overlap_limit) {
  Enclosures(scene, nodes, overlap_limit).expect_bodies_apart(true);
}

}  // namespace brio
