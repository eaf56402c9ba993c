#include "contact/near_faces.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "contact/face_geometry.hpp"

namespace brio {

using Eigen::Vector3d;

namespace {

/// Faces to a task.
constexpr std::size_t faces_per_task = 128;

struct Sweep {
  Vector3d start, end;
};

Sweep sweep_of(const Nodes& nodes, int node, const Vector3d& frame, double ahead) {
  const Vector3d x = position(nodes, node);
  return {x, x + ahead * (velocity(nodes, node) - frame)};
}

void grow(CaptureBox& box, double by) {
  for (int axis = 0; axis < 3; ++axis) {
    box.lower[axis] -= by;
    box.upper[axis] += by;
  }
}

CaptureBox box_of(std::span<const Sweep> sweeps) {
  Vector3d lower = sweeps[0].start.cwiseMin(sweeps[0].end);
  Vector3d upper = sweeps[0].start.cwiseMax(sweeps[0].end);
  for (const Sweep& sweep : sweeps.subspan(1)) {
    lower = lower.cwiseMin(sweep.start).cwiseMin(sweep.end);
    upper = upper.cwiseMax(sweep.start).cwiseMax(sweep.end);
  }
  return {{lower[0], lower[1], lower[2]}, {upper[0], upper[1], upper[2]}};
}

SweptFace swept_face(const Nodes& nodes, const Face& face, const Vector3d& frame, double ahead,
                     double influence, double outside) {
  std::array<Sweep, 4> sweeps;
  for (std::size_t k = 0; k < 4; ++k) sweeps[k] = sweep_of(nodes, face.node[k], frame, ahead);
  SweptFace swept{};
  swept.box = box_of(sweeps);
  grow(swept.box, influence);
  const Vector3d area = (sweeps[2].start - sweeps[0].start).cross(sweeps[3].start - sweeps[1].start);
  const double length = area.norm();
  swept.normal = length > 0 ? Vector3d(area / length) : Vector3d::UnitX();
  swept.lower = std::numeric_limits<double>::infinity();
  swept.upper = -swept.lower;
  for (const Sweep& sweep : sweeps)
    for (const Vector3d& x : {sweep.start, sweep.end}) {
      const double height = swept.normal.dot(x);
      swept.lower = std::min(swept.lower, height);
      swept.upper = std::max(swept.upper, height);
    }
  swept.lower -= influence;
  swept.upper_outside = swept.upper + outside;
  swept.upper += influence;
  return swept;
}

ShellExtent extent_of(const Nodes& nodes, const Face& face, double margin) {
  FaceVertices velocities;
  for (std::size_t k = 0; k < 4; ++k) velocities[k] = velocity(nodes, face.node[k]);
  return shell_extent(vertices(nodes, face), velocities, margin);
}

bool apart(const CaptureBox& a, const CaptureBox& b) {
  bool separated = false;
  for (int axis = 0; axis < 3; ++axis)
    separated |= a.lower[axis] > b.upper[axis] || b.lower[axis] > a.upper[axis];
  return separated;
}

}  // namespace

void sweep(SweptFaces& swept, const Surface& surface, const Candidates& candidates,
           const ContactOptions& options, const Nodes& nodes, const Spread& velocities, double dt,
           ThreadTeam& team) {
  swept.dt = dt;
  for (int axis = 0; axis < 3; ++axis)
    swept.frame[axis] = 0.5 * (velocities.lower[axis] + velocities.upper[axis]);
  swept.solid.resize(surface.face.size());
  swept.shell.resize(surface.face.size());
  team.for_ranges(candidates.face.size(), faces_per_task, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto f = static_cast<std::size_t>(candidates.face[i]);
      if (!surface.face[f].alive()) {
        swept.solid[f].box = empty_box;
        continue;
      }
      const double outside = influence_outside(surface, options, candidates, candidates.face[i]);
      if (surface.face[f].shell)
        swept.shell[f] = extent_of(nodes, surface.face[f], outside);
      else
        swept.solid[f] = swept_face(nodes, surface.face[f], swept.frame, approach_share * dt,
                                    influence(surface, options, candidates, candidates.face[i]), outside);
    }
  });
}

void find_near_faces(const SweptFaces& swept, const Surface& surface, const Candidates& candidates,
                     const ContactOptions& options, const Nodes& nodes, int slave, bool everything,
                     std::vector<NearFace>& near) {
  near.clear();
  const auto s = static_cast<std::size_t>(slave);
  const int node = surface.node[s];
  const double radius = options.shell_thickness_scale * surface.radius[s];
  const Sweep path = sweep_of(nodes, node, swept.frame, approach_share * swept.dt);
  const Vector3d& x = path.start;
  CaptureBox own = box_of({&path, 1});
  grow(own, radius);
  const Vector3d own_velocity = velocity(nodes, node);
  const auto left_out = [&](int face) {
    const auto f = static_cast<std::size_t>(face);
    if (surface.face[f].shell)
      return surely_out_of_reach(swept.shell[f], x, own_velocity, radius, approach_share * swept.dt);
    const SweptFace& solid = swept.solid[f];
    if (apart(own, solid.box)) return true;
    const double from = solid.normal.dot(path.start);
    const double to = solid.normal.dot(path.end);
    return std::min(from, to) - radius > (everything ? solid.upper : solid.upper_outside) ||
           std::max(from, to) + radius < solid.lower;
  };
  for (int f : candidates.faces_of.of(slave)) {
    if (left_out(f)) continue;
    const ClosestPoint closest =
        closest_point_on_quad(x, vertices(nodes, surface.face[static_cast<std::size_t>(f)]));
    near.push_back({.face = f, .distance = std::sqrt(closest.squared_distance), .closest = closest});
  }
  std::sort(near.begin(), near.end(), [](const NearFace& a, const NearFace& b) {
    return a.distance != b.distance ? a.distance < b.distance : a.face < b.face;
  });
}

}  // namespace brio
