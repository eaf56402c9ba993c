#include "contact/audit.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "contact/audit_lines.hpp"
#include "contact/exclusion.hpp"
#include "contact/face_geometry.hpp"
#include "contact/winding.hpp"
#include "src/base/floating_point.hpp"

namespace brio {

using Eigen::Vector3d;

namespace {

/// Of the sphere: a wedge whose sides come apart by `deep_share` of their length.
constexpr double wedge_share = deep_share / (2 * std::numbers::pi);
/// A node of a flat surface is behind its other faces by rounding.
constexpr double flat_share = 1e-3;
constexpr std::size_t nodes_per_task = 64;

struct Box {
  Vector3d lower, upper;
  double squared_distance(const Vector3d& x) const {
    return (lower - x).cwiseMax(x - upper).cwiseMax(0.0).squaredNorm();
  }
  bool overlaps(const Box& other) const {
    return (lower.array() <= other.upper.array()).all() && (other.lower.array() <= upper.array()).all();
  }
};

Box box_of(const FaceVertices& v) {
  return {v[0].cwiseMin(v[1]).cwiseMin(v[2]).cwiseMin(v[3]),
          v[0].cwiseMax(v[1]).cwiseMax(v[2]).cwiseMax(v[3])};
}

class Auditor {
 public:
  Auditor(const ContactScene& scene, const Nodes& nodes)
      : scene_(scene), surface_(scene.surface), nodes_(nodes) {
    corners_.resize(surface_.face.size());
    box_.resize(surface_.face.size());
    edge_.resize(surface_.face.size());
    solid_of_.resize(static_cast<std::size_t>(surface_.body_count));
    for (std::size_t f = 0; f < surface_.face.size(); ++f) {
      const Face& face = surface_.face[f];
      if (!face.alive()) continue;
      corners_[f] = vertices(nodes, face);
      box_[f] = box_of(corners_[f]);
      edge_[f] = shortest_edge(nodes, face);
      (face.shell ? shell_ : solid_of_[static_cast<std::size_t>(face.body)]).push_back(f);
    }
  }

  BruteForceAudit of_node(int slave) const {
    BruteForceAudit found;
    const auto s = static_cast<std::size_t>(slave);
    if (surface_.node[s] < 0) return found;
    const Vector3d x = position(nodes_, surface_.node[s]);
    if (too_close_to_shell(slave, x, found)) ++found.shells_too_close;
    for (int body = 0; body < surface_.body_count; ++body)
      if (body == surface_.body[s] ? inside_own_body(slave, x, found)
                                   : inside_other_body(body, slave, x, found)) {
        ++found.inside_solids;
        break;
      }
    if (found.deepest > 0) found.deepest_node = surface_.node[s];
    return found;
  }

  // Beams that cross shells.
  BruteForceAudit of_round(int index) const {
    BruteForceAudit found;
    const RoundElement& element = surface_.round[static_cast<std::size_t>(index)];
    if (element.alive() && !element.is_point() && pierces_shell(element.node[0], element.node[1]))
      ++found.shells_pierced;
    return found;
  }

  // Edges of one face that cross shells; an edge of two faces counts with the first.
  BruteForceAudit of_edges(int f) const {
    BruteForceAudit found;
    const auto own = static_cast<std::size_t>(f);
    const Face& face = surface_.face[own];
    if (!face.alive()) return found;
    for (int k = 0; k < face.corners(); ++k) {
      const int neighbor = surface_.neighbor[own][static_cast<std::size_t>(k)];
      if (neighbor >= 0 && neighbor < f) continue;
      const int a = face.node[static_cast<std::size_t>(k)];
      const int b = face.node[static_cast<std::size_t>((k + 1) % face.corners())];
      if (pierces_shell(a, b)) ++found.shells_pierced;
    }
    return found;
  }

 private:
  bool excluded(int slave, std::size_t face) const {
    return surface_.never_touch(slave, surface_.face[face]) ||
           is_excluded(scene_.excluded, slave, static_cast<int>(face));
  }

  bool note(double depth, BruteForceAudit& found) const {
    found.deepest = std::max(found.deepest, depth);
    return true;
  }

  bool too_close_to_shell(int slave, const Vector3d& x, BruteForceAudit& found) const {
    bool close = false;
    for (std::size_t f : shell_) {
      const double touching = touching_distance(surface_, scene_.options, static_cast<int>(f), slave);
      const double least = touching - deep_share * std::min(touching, edge_[f]);
      if (box_[f].squared_distance(x) >= least * least || excluded(slave, f)) continue;
      const double distance = std::sqrt(closest_point_on_quad(x, corners_[f]).squared_distance);
      if (distance < least) close = note(touching - distance, found);
    }
    return close;
  }

  // The closest place of the whole body decides, with its pseudo-normal.
  bool inside_other_body(int body, int slave, const Vector3d& x, BruteForceAudit& found) const {
    double nearest = infinity;
    int nearest_face = -1;
    ClosestPoint nearest_point;
    for (std::size_t f : solid_of_[static_cast<std::size_t>(body)]) {
      if (box_[f].squared_distance(x) >= nearest || excluded(slave, f)) continue;
      const ClosestPoint point = closest_point_on_quad(x, corners_[f]);
      if (point.squared_distance >= nearest) continue;
      nearest = point.squared_distance;
      nearest_face = static_cast<int>(f);
      nearest_point = point;
    }
    if (nearest_face < 0) return false;
    const double gap =
        signed_gap(nearest_point, pseudo_normal(surface_, nodes_, nearest_face, nearest_point));
    const bool deep = gap < -deep_share * edge_[static_cast<std::size_t>(nearest_face)];
    // Flakes turned inside out have pseudo-normals that tell nothing; what is inside is seen all around.
    return deep && winding(body, x) > 0.5 && note(-gap, found);
  }

  // A node of a body that does not cut itself sees its own surface from the surface: less than once around.
  // At the bottom of a closed cleft it is all around, and more by the wedge in which its flanks overlap. The
  // tip of a spike narrower than that wedge is not found.
  bool inside_own_body(int slave, const Vector3d& x, BruteForceAudit& found) const {
    if (surface_.of_solid[static_cast<std::size_t>(slave)] == 0) return false;
    const int body = surface_.body[static_cast<std::size_t>(slave)];
    double depth = infinity;
    bool suspect = false;
    for (std::size_t f : solid_of_[static_cast<std::size_t>(body)]) {
      if (excluded(slave, f)) continue;
      if (box_[f].squared_distance(x) >= std::min(depth * depth, edge_[f] * edge_[f])) continue;
      const ClosestPoint point = closest_point_on_quad(x, corners_[f]);
      const double distance = std::sqrt(point.squared_distance);
      const double behind = -point.separation.dot(point.normal);
      const bool far = distance > deep_share * edge_[f];
      if (distance >= depth || distance > edge_[f] || behind <= (far ? flat_share * edge_[f] : 0)) continue;
      depth = distance;
      suspect = far;
    }
    return suspect && winding(body, x) > 1 + wedge_share && note(depth, found);
  }

  double winding(int body, const Vector3d& x) const {
    double sum = 0;
    for (std::size_t f : solid_of_[static_cast<std::size_t>(body)]) sum += winding_share(corners_[f], x);
    return sum;
  }

  bool pierces_shell(int a, int b) const {
    const Vector3d from = position(nodes_, a);
    const Vector3d to = position(nodes_, b);
    const Box own{from.cwiseMin(to), from.cwiseMax(to)};
    for (std::size_t f : shell_) {
      const Face& face = surface_.face[f];
      if (!own.overlaps(box_[f]) || face.has(a) || face.has(b)) continue;
      if (excluded(surface_.slave(a), f) || excluded(surface_.slave(b), f)) continue;
      if (crosses(from, to, corners_[f])) return true;
    }
    return false;
  }

  static bool crosses_triangle(const Vector3d& from, const Vector3d& to, const Vector3d& a, const Vector3d& b,
                               const Vector3d& c) {
    const auto volume = [](const Vector3d& p, const Vector3d& q, const Vector3d& r, const Vector3d& s) {
      return (q - p).dot((r - p).cross(s - p));
    };
    if (volume(from, a, b, c) * volume(to, a, b, c) >= 0) return false;
    const double ab = volume(from, to, a, b), bc = volume(from, to, b, c), ca = volume(from, to, c, a);
    return (ab > 0 && bc > 0 && ca > 0) || (ab < 0 && bc < 0 && ca < 0);
  }
  static bool crosses(const Vector3d& from, const Vector3d& to, const FaceVertices& v) {
    if (is_triangle(v)) return crosses_triangle(from, to, v[0], v[1], v[2]);
    const Vector3d middle = 0.25 * (v[0] + v[1] + v[2] + v[3]);
    for (std::size_t k = 0; k < 4; ++k)
      if (crosses_triangle(from, to, middle, v[k], v[(k + 1) % 4])) return true;
    return false;
  }

  const ContactScene& scene_;
  const Surface& surface_;
  const Nodes& nodes_;
  std::vector<std::size_t> shell_;                  // faces
  std::vector<std::vector<std::size_t>> solid_of_;  // faces of each body
  std::vector<FaceVertices> corners_;
  std::vector<Box> box_;
  std::vector<double> edge_;
};

}  // namespace

BruteForceAudit& BruteForceAudit::operator+=(const BruteForceAudit& other) {
  inside_solids += other.inside_solids;
  shells_too_close += other.shells_too_close;
  shells_pierced += other.shells_pierced;
  lines_crossed += other.lines_crossed;
  if (other.deepest > deepest) {
    deepest = other.deepest;
    deepest_node = other.deepest_node;
  }
  return *this;
}

BruteForceAudit brute_force_audit(const ContactScene& scene, const Nodes& nodes, ThreadTeam& team) {
  const Auditor auditor(scene, nodes);
  const std::size_t slaves = scene.surface.slaves();
  const std::size_t faces = scene.surface.face.size();
  const std::size_t all = slaves + faces + scene.surface.round.size();
  std::vector<BruteForceAudit> piece((all + nodes_per_task - 1) / nodes_per_task);
  team.for_ranges(all, nodes_per_task, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      piece[begin / nodes_per_task] += i < slaves ? auditor.of_node(static_cast<int>(i))
                                       : i < slaves + faces
                                           ? auditor.of_edges(static_cast<int>(i - slaves))
                                           : auditor.of_round(static_cast<int>(i - slaves - faces));
  });
  BruteForceAudit sum;
  for (const BruteForceAudit& part : piece) sum += part;
  if (scene.lines) {
    const LineAudit lines = audit_lines(scene, nodes, team);
    sum += {.lines_crossed = lines.crossed, .deepest = lines.deepest, .deepest_node = lines.deepest_node};
  }
  return sum;
}

}  // namespace brio
