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
constexpr double infinity = std::numeric_limits<double>::infinity();

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
  swept.lower = infinity;
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

// Largest distance between two boxes along an axis; negative where they overlap.
double gap_between(const CaptureBox& a, const CaptureBox& b) {
  double gap = -infinity;
  for (int axis = 0; axis < 3; ++axis)
    gap = std::max(gap, std::max(a.lower[axis] - b.upper[axis], b.lower[axis] - a.upper[axis]));
  return gap;
}

double distance_to_box(const Vector3d& x, const FaceVertices& corner) {
  const Vector3d lower = corner[0].cwiseMin(corner[1]).cwiseMin(corner[2].cwiseMin(corner[3]));
  const Vector3d upper = corner[0].cwiseMax(corner[1]).cwiseMax(corner[2].cwiseMax(corner[3]));
  return (lower - x).cwiseMax(x - upper).cwiseMax(0.0).norm();
}

// How far the node and any point of the face may come nearer to each other as far ahead as constraints look.
double approach(const Nodes& nodes, const Face& face, const Vector3d& own_velocity, double ahead) {
  double fastest = 0;
  for (int corner : face.node)
    fastest = std::max(fastest, (own_velocity - velocity(nodes, corner)).squaredNorm());
  return ahead * std::sqrt(fastest);
}

}  // namespace

void SweptFaces::wake(const Candidates& candidates, int slave) {
  const auto s = static_cast<std::size_t>(slave);
  const std::size_t pairs = candidates.faces_of.of(slave).size();
  std::fill_n(wake_.begin() + candidates.faces_of.first[s], pairs, -infinity);
  wake_of_slave_[s] = pairs == 0 ? infinity : -infinity;
}

void SweptFaces::wake_all(const Surface& surface, const Candidates& candidates) {
  search_ = candidates.counts.searches;
  wake_.resize(candidates.faces_of.item.size());
  wake_of_slave_.resize(surface.slaves());
  for (std::size_t s = 0; s < surface.slaves(); ++s) wake(candidates, static_cast<int>(s));
  woken = surface.slaves();
  solids_.clear();
  faces_known_ = 0;
}

void SweptFaces::wake_renewed(const Surface& surface, const Candidates& candidates) {
  wake_.resize(candidates.faces_of.item.size());
  wake_of_slave_.resize(surface.slaves());
  woken = 0;
  for (int slave : candidates.renewed) {
    if (wake_of_slave_[static_cast<std::size_t>(slave)] != -infinity) ++woken;
    wake(candidates, slave);
  }
}

void SweptFaces::add_solids(const Surface& surface, const Candidates& candidates) {
  for (; faces_known_ < candidates.face.size(); ++faces_known_) {
    const int f = candidates.face[faces_known_];
    const Face& face = surface.face[static_cast<std::size_t>(f)];
    if (face.alive() && !face.shell) solids_.push_back(f);
  }
}

void SweptFaces::begin_step(const Surface& surface, const Candidates& candidates,
                            const ContactOptions& options, const Nodes& nodes, const Travel& travel,
                            ThreadTeam& team) {
  dt = travel.dt();
  for (int axis = 0; axis < 3; ++axis) frame[axis] = travel.velocities().middle(axis);
  solid_.resize(surface.face.size());
  if (search_ != candidates.counts.searches || !may_sleep)
    wake_all(surface, candidates);
  else
    wake_renewed(surface, candidates);
  add_solids(surface, candidates);
  team.for_ranges(solids_.size(), faces_per_task, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto f = static_cast<std::size_t>(solids_[i]);
      if (!surface.face[f].alive()) continue;
      solid_[f] = swept_face(nodes, surface.face[f], frame, approach_share * dt,
                             influence(surface, options, candidates, solids_[i]),
                             influence_outside(surface, options, candidates, solids_[i]));
    }
  });
}

void SweptFaces::find(const Surface& surface, const Candidates& candidates, const ContactOptions& options,
                      const Nodes& nodes, const Travel& travel, int slave, bool everything,
                      std::vector<NearFace>& near) {
  near.clear();
  const auto s = static_cast<std::size_t>(slave);
  const int node = surface.node[s];
  const double radius = options.shell_thickness_scale * surface.radius[s];
  const Sweep path = sweep_of(nodes, node, frame, approach_share * dt);
  const Vector3d& x = path.start;
  CaptureBox own = box_of({&path, 1});
  grow(own, radius);
  const Vector3d own_velocity = velocity(nodes, node);
  const double so_far = travel.so_far(slave);
  const double ahead = travel.ahead(slave);
  double first_wake = infinity;
  // Notes the length by which a pair is too far apart. \returns whether the pair sleeps.
  const auto falls_asleep = [&](double& wake, double clearance) {
    wake = so_far + clearance - travel.rounding();
    return so_far + ahead < wake;
  };
  const auto add = [&](int f, const ClosestPoint& closest, double distance) {
    near.push_back({.face = f, .distance = distance, .closest = closest});
  };
  const auto look_at_shell = [&](int f, double& wake) {
    const Face& face = surface.face[static_cast<std::size_t>(f)];
    const double reach = influence_outside(surface, options, candidates, f) + radius;
    const FaceVertices corner = vertices(nodes, face);
    if (falls_asleep(wake, distance_to_box(x, corner) - reach)) return;
    const ClosestPoint closest = closest_point_on_quad(x, corner);
    const double distance = std::sqrt(closest.squared_distance);
    if (falls_asleep(wake, distance - reach)) return;
    if (distance <= reach + approach(nodes, face, own_velocity, approach_share * dt))
      add(f, closest, distance);
  };
  const auto look_at_solid = [&](int f, double& wake) {
    const SweptFace& solid = solid_[static_cast<std::size_t>(f)];
    const double gap = gap_between(own, solid.box);
    falls_asleep(wake, gap);
    if (gap > 0) return;
    const double from = solid.normal.dot(path.start);
    const double to = solid.normal.dot(path.end);
    if (std::min(from, to) - radius > (everything ? solid.upper : solid.upper_outside) ||
        std::max(from, to) + radius < solid.lower)
      return;
    const ClosestPoint closest =
        closest_point_on_quad(x, vertices(nodes, surface.face[static_cast<std::size_t>(f)]));
    add(f, closest, std::sqrt(closest.squared_distance));
  };
  double* wake = wake_.data() + candidates.faces_of.first[s];
  for (int f : candidates.faces_of.of(slave)) {
    if (!(so_far + ahead < *wake)) {
      if (!surface.face[static_cast<std::size_t>(f)].alive())
        *wake = infinity;
      else if (surface.face[static_cast<std::size_t>(f)].shell)
        look_at_shell(f, *wake);
      else
        look_at_solid(f, *wake);
    }
    first_wake = std::min(first_wake, *wake++);
  }
  wake_of_slave_[s] = first_wake;
  std::sort(near.begin(), near.end(), [](const NearFace& a, const NearFace& b) {
    return a.distance != b.distance ? a.distance < b.distance : a.face < b.face;
  });
}

}  // namespace brio
