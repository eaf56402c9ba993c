#include "src/build/wall_overlap.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "src/base/breakdown.hpp"
#include "src/base/index.hpp"
#include "src/model/node_name.hpp"

namespace brio {

namespace {

/// A node may be behind a wall by this share of an edge: rounding.
constexpr double rounding_of_edge = 1e-9;
/// ... and by this share of its coordinates.
constexpr double rounding_of_position = 8 * std::numeric_limits<double>::epsilon();
/// Square of the largest component of a normal that is rounding.
constexpr double least_gain = 1e-18;
/// Where walls meet, nodes go from one to the next.
constexpr int most_rounds_of_walls = 200;

double start_height(const RigidWall& wall, const NodeRecord& record) {
  return dot(wall.normal, vector_at(record.position) - wall.point);
}

/// How the nodes of a model stand to its walls.
class WallOverlap {
 public:
  WallOverlap(std::span<const Mesh> meshes, Model& model)
      : meshes_(meshes), model_(model), rigid_(model.nodes.size(), 0) {
    for (const RigidBody& body : model.rigid.body)
      for (const int node : body.node) rigid_[index(node)] = 1;
  }

  bool any() const {
    for (const WallInRun& entry : model_.walls)
      for (std::size_t i = 0; i < model_.nodes.size(); ++i)
        if (!rigid_[i] && start_height(entry.wall, model_.nodes.record[i]) < 0) return true;
    return false;
  }

  /// The deepest by far more than rounding, or nothing.
  void expect_none() {
    find_edges();
    for (const WallInRun& entry : model_.walls)
      for (std::size_t i = 0; i < model_.nodes.size(); ++i) {
        const double depth = -start_height(entry.wall, model_.nodes.record[i]);
        if (!rigid_[i] && depth > rounding(i))
          refuse(entry.wall, i, depth, "where removing other overlaps and ties put it");
      }
  }

  std::vector<InitialOverlap> remove(double limit) {
    find_edges();
    std::vector<InitialOverlap> report;
    std::vector<Vector3d> start;
    for (const NodeRecord& record : model_.nodes.record)
      start.push_back({record.position[0], record.position[1], record.position[2]});
    for (std::size_t w = 0; w < model_.walls.size(); ++w) record(w, report);
    bool moves = true;
    for (int round = 0; moves && round < most_rounds_of_walls; ++round) {
      moves = false;
      for (const WallInRun& entry : model_.walls)
        for (std::size_t i = 0; i < model_.nodes.size(); ++i)
          if (!rigid_[i]) moves = move_out(entry.wall, i, limit, start[i]) || moves;
    }
    for (const PartInModel& part : model_.parts)
      for (const int node : part.node) {
        const auto i = index(node);
        for (InitialOverlap& overlap : report)
          if (overlap.node_part == part.name) overlap.moved = std::max(overlap.moved, way(i, start[i]));
      }
    return report;
  }

 private:
  /// Of each node: the shortest distance of two nodes of an element that it belongs to.
  void find_edges() {
    edge_.assign(model_.nodes.size(), HUGE_VAL);
    for (std::size_t p = 0; p < model_.parts.size(); ++p) {
      const Mesh& mesh = meshes_[p];
      const auto corners = index(mesh.nodes_per_element);
      for (std::size_t e = 0; e < mesh.element_count(); ++e) {
        const std::span corner(mesh.connectivity.data() + e * corners, corners);
        double shortest = corners == 1 ? std::cbrt(mesh.volume[e]) : HUGE_VAL;
        for (std::size_t a = 0; a < corners; ++a)
          for (std::size_t b = a + 1; b < corners; ++b) {
            const double length = distance(mesh, corner[a], corner[b]);
            if (length > 0) shortest = std::min(shortest, length);
          }
        for (const int c : corner) {
          double& edge = edge_[index(model_.parts[p].node[index(c)])];
          edge = std::min(edge, shortest);
        }
      }
    }
  }

  static double distance(const Mesh& mesh, int a, int b) {
    const auto& x = mesh.position[index(a)];
    const auto& y = mesh.position[index(b)];
    return std::hypot(x[0] - y[0], x[1] - y[1], x[2] - y[2]);
  }

  double rounding(std::size_t i) const {
    const double* x = model_.nodes.record[i].position;
    const double largest = std::max({std::abs(x[0]), std::abs(x[1]), std::abs(x[2])});
    return rounding_of_edge * edge_[i] + rounding_of_position * largest;
  }

  double way(std::size_t i, const Vector3d& start) const {
    const double* x = model_.nodes.record[i].position;
    return std::hypot(x[0] - start[0], x[1] - start[1], x[2] - start[2]);
  }

  void record(std::size_t w, std::vector<InitialOverlap>& report) const {
    const std::string wall = model_.walls.size() == 1 ? "rigid_wall" : "rigid_wall " + std::to_string(w + 1);
    for (const PartInModel& part : model_.parts) {
      InitialOverlap found{.node_part = part.name, .face_part = wall};
      for (const int node : part.node) {
        const auto i = index(node);
        const double depth = -start_height(model_.walls[w].wall, model_.nodes.record[i]);
        if (rigid_[i] || depth <= rounding(i)) continue;
        found.depth = std::max(found.depth, depth);
        ++found.nodes;
      }
      if (found.nodes > 0) report.push_back(std::move(found));
    }
  }

  /// \return whether the node was behind the wall by more than rounding.
  bool move_out(const RigidWall& wall, std::size_t i, double limit, const Vector3d& start) {
    NodeRecord& node = model_.nodes.record[i];
    const double depth = -start_height(wall, node);
    if (!(depth > 0)) return false;
    const bool counts = depth > rounding(i);
    const Vector3d way_out = model_.nodes.free_translations(i) * wall.normal;
    const double gain = compliance(model_.nodes.free_translations(i), 1, wall.normal);
    if (gain < least_gain || depth > limit * edge_[i] * std::sqrt(gain)) {  // the way is depth / sqrt(gain)
      if (counts) refuse_move(wall, i, depth, gain, limit);
      return false;
    }
    for (std::size_t axis = 0; axis < 3; ++axis) node.position[axis] += depth / gain * way_out[axis];
    if (way(i, start) > limit * edge_[i]) refuse_move(wall, i, depth, gain, limit);
    return counts;
  }

  [[noreturn]] void refuse_move(const RigidWall& wall, std::size_t i, double depth, double gain,
                                double limit) const {
    if (gain < least_gain) refuse(wall, i, depth, "and its motion is prescribed" + place_of_motion(i));
    std::ostringstream why;
    why << "deeper than " << limit << " of the shortest edge of its elements, " << edge_[i]
        << ", up to which nodes are moved onto the wall (contact.initial_overlap_limit)";
    refuse(wall, i, depth, why.str());
  }

  std::string place_of_motion(std::size_t i) const {
    for (const PrescribedNodes& given : model_.prescribed)
      if (given.axis < 3 && !given.place.empty() &&
          std::binary_search(given.nodes.begin(), given.nodes.end(), static_cast<int>(i)))
        return " at " + given.place;
    return "";
  }

  [[noreturn]] void refuse(const RigidWall& wall, std::size_t i, double depth, const std::string& why) const {
    std::ostringstream text;
    text << name_of_node(model_, i) << " begins behind the rigid wall by " << depth << ", " << why
         << "; accepted are nodes on the side that the normal points to";
    throw BuildError(text.str(), wall.place);
  }

  std::span<const Mesh> meshes_;
  Model& model_;
  std::vector<char> rigid_;   // of each node: whether a rigid part has it
  std::vector<double> edge_;  // of each node
};

}  // namespace

std::vector<InitialOverlap> remove_overlap_with_walls(std::span<const Mesh> meshes, double limit,
                                                      Model& model) {
  if (model.walls.empty()) return {};
  WallOverlap overlap(meshes, model);
  return overlap.any() ? overlap.remove(limit) : std::vector<InitialOverlap>{};
}

void expect_nothing_behind_walls(std::span<const Mesh> meshes, Model& model) {
  if (model.walls.empty()) return;
  WallOverlap overlap(meshes, model);
  if (overlap.any()) overlap.expect_none();
}

}  // namespace brio
