#include "contact/detection/feature_motion.hpp"

#include <algorithm>
#include <cmath>

namespace brio {

using Eigen::Vector3d;

namespace {

constexpr std::size_t nodes_a_range = 4096;
/// Paths are rounded up by more than their sums are rounded down.
constexpr double rounded_up = 1 + 1e-9;

double length_in_frame(const double* from, const double* to, const double* frame) {
  double square = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double d = to[axis] - from[axis] - frame[axis];
    square += d * d;
  }
  return std::sqrt(square) * rounded_up;
}

// The longest of the corners of each face and edge.
void spread_to_features(const SurfaceFeatures& features, const Surface& surface,
                        const std::vector<double>& of_node, std::vector<double>& of_face,
                        std::vector<double>& of_edge, bool add, ThreadTeam& team) {
  const auto at = [&](int slave) { return of_node[static_cast<std::size_t>(slave)]; };
  team.for_ranges(surface.face.size(), nodes_a_range, [&](std::size_t begin, std::size_t end) {
    for (std::size_t f = begin; f < end; ++f) {
      const Face& face = surface.face[f];
      if (!face.alive()) continue;
      double longest = 0;
      for (int corner : face.node) longest = std::max(longest, at(surface.slave(corner)));
      of_face[f] = add ? of_face[f] + longest : longest;
    }
  });
  team.for_ranges(features.edge.size(), nodes_a_range, [&](std::size_t begin, std::size_t end) {
    for (std::size_t e = begin; e < end; ++e) {
      const double longest = std::max(at(features.edge[e].node[0]), at(features.edge[e].node[1]));
      of_edge[e] = add ? of_edge[e] + longest : longest;
    }
  });
}

}  // namespace

void FeatureMotion::restart(const SurfaceFeatures& features, const Surface& surface) {
  node_path_.assign(surface.slaves(), 0);
  face_path_.assign(surface.face.size(), 0);
  edge_path_.assign(features.edge.size(), 0);
  for (double& sum : frame_sum_) sum = 0;
}

void FeatureMotion::begin(const SurfaceFeatures& features, const Surface& surface, const Nodes& nodes,
                          ThreadTeam& team) {
  const bool follows = known_ && node.size() == surface.slaves() && edge_path_.size() == features.edge.size();
  node.resize(surface.slaves());
  node_step_.assign(surface.slaves(), 0);
  team.for_ranges(node.size(), nodes_a_range, [&](std::size_t begin, std::size_t end) {
    for (std::size_t s = begin; s < end; ++s) {
      if (surface.node[s] < 0) {
        node[s] = {};
        continue;
      }
      const double* x = nodes.record[static_cast<std::size_t>(surface.node[s])].position;
      if (follows) {
        node_step_[s] = length_in_frame(node[s].start, x, frame_);
        node_path_[s] += node_step_[s];
      }
      std::copy(x, x + 3, node[s].start);
    }
  });
  if (follows) {
    spread_to_features(features, surface, node_step_, face_path_, edge_path_, true, team);
    for (int axis = 0; axis < 3; ++axis) frame_sum_[axis] += frame_[axis];
  } else {
    restart(features, surface);
  }
  known_ = true;
  magnitude_ = -1;
}

void FeatureMotion::end_by_velocity(const SurfaceFeatures& features, const Surface& surface,
                                    const Nodes& nodes, double dt, std::span<const RigidMotion> bodies,
                                    ThreadTeam& team) {
  sum_.assign((node.size() + nodes_a_range - 1) / nodes_a_range, {});
  team.for_ranges(node.size(), nodes_a_range, [&](std::size_t begin, std::size_t end) {
    Sum& sum = sum_[begin / nodes_a_range];
    for (std::size_t s = begin; s < end; ++s) {
      const int global = surface.node[s];
      if (global < 0) continue;
      const int body = bodies.empty() ? -1 : surface.rigid_body(global);
      NodeMotion64& moved = node[s];
      if (body >= 0) {
        end_of_body_node(s, bodies[static_cast<std::size_t>(body)], dt);
      } else {
        const double* v = nodes.record[static_cast<std::size_t>(global)].velocity;
        for (int axis = 0; axis < 3; ++axis) moved.end[axis] = moved.start[axis] + dt * v[axis];
      }
      for (int axis = 0; axis < 3; ++axis) {
        sum.displacement[axis] += moved.end[axis] - moved.start[axis];
        sum.magnitude = std::max({sum.magnitude, std::abs(moved.start[axis]), std::abs(moved.end[axis])});
      }
      sum.count += 1;
    }
  });
  const bool first = magnitude_ < 0;
  Sum total;
  for (const Sum& part : sum_) {
    for (int axis = 0; axis < 3; ++axis) total.displacement[axis] += part.displacement[axis];
    total.magnitude = std::max(total.magnitude, part.magnitude);
    total.count += part.count;
  }
  magnitude_ = total.magnitude;
  // The frame of a step stays as it was predicted, whatever contact does to single nodes.
  if (first && total.count > 0)
    for (int axis = 0; axis < 3; ++axis) frame_[axis] = total.displacement[axis] / total.count;
  measure_steps(features, surface, team);
}

void FeatureMotion::end_of_body_node(std::size_t slave, const RigidMotion& body, double dt) {
  const Vector3d v = body.velocity_at(Vector3d(node[slave].start) - body.centre);
  for (int axis = 0; axis < 3; ++axis) node[slave].end[axis] = node[slave].start[axis] + dt * v[axis];
}

void FeatureMotion::end_by_solution(const SurfaceFeatures& features, const Surface& surface,
                                    const SlaveSet& in_contact, std::span<const ContactMotion> corrected,
                                    double dt, std::span<const RigidMotion> bodies, ThreadTeam& team) {
  in_contact.for_each([&](std::size_t s) {
    for (int axis = 0; axis < 3; ++axis)
      node[s].end[axis] = node[s].start[axis] + dt * corrected[s].velocity[axis];
  });
  if (!bodies.empty())
    for (std::size_t s = 0; s < node.size(); ++s) {
      const int body = surface.rigid_body(surface.node[s]);
      if (body >= 0) end_of_body_node(s, bodies[static_cast<std::size_t>(body)], dt);
    }
  measure_steps(features, surface, team);
}

void FeatureMotion::set_limits(double factor, double surplus) {
  limit_.resize(node_step_.size());
  for (std::size_t s = 0; s < limit_.size(); ++s) limit_[s] = factor * node_step_[s] + surplus;
}

bool FeatureMotion::exceeds_limits() const {
  bool exceeds = false;
  for (std::size_t s = 0; s < limit_.size(); ++s) exceeds = exceeds || node_step_[s] > limit_[s];
  return exceeds;
}

void FeatureMotion::measure_steps(const SurfaceFeatures& features, const Surface& surface, ThreadTeam& team) {
  node_step_.resize(surface.slaves());
  face_step_.resize(surface.face.size());
  edge_step_.resize(features.edge.size());
  team.for_ranges(node.size(), nodes_a_range, [&](std::size_t begin, std::size_t end) {
    for (std::size_t s = begin; s < end; ++s)
      node_step_[s] = surface.node[s] < 0 ? 0 : length_in_frame(node[s].start, node[s].end, frame_);
  });
  spread_to_features(features, surface, node_step_, face_step_, edge_step_, false, team);
}

}  // namespace brio
