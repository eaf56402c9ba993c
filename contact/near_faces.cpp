#include "contact/near_faces.hpp"

#include <algorithm>
#include <cmath>

#include "contact/face_geometry.hpp"
#include "src/base/floating_point.hpp"

namespace brio {

using Eigen::Vector3d;

namespace {

/// Faces to a task.
constexpr std::size_t faces_per_task = 128;
/// The normal of a face whose diagonals are closer in direction than this is too uncertain to sleep by.
constexpr double flattest = 1e-2;

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

// On what path of both no node comes down to a face above whose highest corner it is: the height over the
// highest corner changes by the path and by the turn of the normal. With diagonals p and q and the farthest
// corner at R, a path s turns a unit normal by at most 2 |change of p x q| / |p x q|, and a corner moves by
// at most s: |change of height| <= s (1 + 4 R (|p| + |q|) / |p x q|) + 8 s^2 R / |p x q|.
double path_above(const Vector3d& x, const FaceVertices& corner, double height) {
  const Vector3d p = corner[2] - corner[0];
  const Vector3d q = corner[3] - corner[1];
  const double area = p.cross(q).norm();
  if (!(area > flattest * p.norm() * q.norm())) return 0;
  double farthest = 0;
  for (const Vector3d& c : corner) farthest = std::max(farthest, (x - c).norm());
  const double linear = 1 + 4 * farthest * (p.norm() + q.norm()) / area;
  return height / (linear + std::sqrt(8 * farthest / area * height));
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
  faces_.clear();
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

void SweptFaces::add_faces(const Surface& surface, const Candidates& candidates) {
  for (; faces_known_ < candidates.face.size(); ++faces_known_) {
    const int f = candidates.face[faces_known_];
    const Face& face = surface.face[static_cast<std::size_t>(f)];
    if (!face.alive()) continue;
    faces_.push_back(f);
    if (!face.shell) solids_.push_back(f);
  }
}

void SweptFaces::follow(const Surface& surface, const Travel& travel, ThreadTeam& team) {
  motion_.resize(surface.face.size());
  team.for_ranges(faces_.size(), faces_per_task, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto f = static_cast<std::size_t>(faces_[i]);
      if (!surface.face[f].alive()) continue;
      Motion longest{0, 0};
      for (int node : surface.face[f].node) {
        const int corner = surface.slave(node);
        longest.path = std::max(longest.path, travel.path(corner));
        longest.ahead = std::max(longest.ahead, travel.own_ahead(corner));
      }
      motion_[f] = longest;
    }
  });
}

void SweptFaces::begin_step(const Surface& surface, const Candidates& candidates,
                            const ContactOptions& options, const Nodes& nodes, const Travel& travel,
                            ThreadTeam& team) {
  dt = travel.dt();
  for (int axis = 0; axis < 3; ++axis) frame[axis] = travel.frame(axis);
  solid_.resize(surface.face.size());
  if (search_ != candidates.counts.searches || !may_sleep)
    wake_all(surface, candidates);
  else
    wake_renewed(surface, candidates);
  add_faces(surface, candidates);
  follow(surface, travel, team);
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

/// One slave node that looks at its candidates.
class Lookout {
 public:
  Lookout(SweptFaces& swept, const Surface& surface, const Candidates& candidates,
          const ContactOptions& options, const Nodes& nodes, const Travel& travel, int slave, NearFaces& near)
      : swept_(swept),
        surface_(surface),
        candidates_(candidates),
        options_(options),
        nodes_(nodes),
        travel_(travel),
        near_(near),
        slave_(slave),
        radius_(reach_of_node(surface, options, slave)),
        path_(sweep_of(nodes, surface.node[static_cast<std::size_t>(slave)], swept.frame,
                       approach_share * swept.dt)),
        velocity_(velocity(nodes, surface.node[static_cast<std::size_t>(slave)])),
        own_(box_of({&path_, 1})) {
    grow(own_, radius_);
  }

  void run(bool everything) {
    near_.face.clear();
    near_.side.clear();
    const auto s = static_cast<std::size_t>(slave_);
    double* wake = swept_.wake_.data() + candidates_.faces_of.first[s];
    double first_wake = infinity;
    double unused = 0;
    for (int f : candidates_.faces_of.of(slave_)) {
      const SweptFaces::Motion& motion = swept_.motion_[static_cast<std::size_t>(f)];
      const Face& face = surface_.face[static_cast<std::size_t>(f)];
      so_far_ = travel_.so_far(slave_, motion.path);
      ahead_ = travel_.ahead(slave_, motion.ahead);
      if (!face.alive())
        *wake = infinity;
      else if (everything && !face.shell)  // also those that the node is far above of, which stay asleep
        look_at_solid(f, true, unused);
      else if (!(so_far_ + ahead_ < *wake))
        face.shell ? look_at_shell(f, *wake) : look_at_solid(f, false, *wake);
      first_wake = std::min(first_wake, *wake++ - so_far_);
    }
    swept_.wake_of_slave_[s] = first_wake + travel_.so_far(slave_);
    add_sides(everything);
    std::sort(near_.face.begin(), near_.face.end(), [](const NearFace& a, const NearFace& b) {
      return a.distance != b.distance ? a.distance < b.distance : a.face < b.face;
    });
  }

 private:
  FaceVertices corners(int f) const { return vertices(nodes_, surface_.face[static_cast<std::size_t>(f)]); }

  // Notes the path on which a pair cannot become near. \returns whether it sleeps.
  bool falls_asleep(double& wake, double clearance) const {
    wake = so_far_ + clearance - travel_.rounding();
    return so_far_ + ahead_ < wake;
  }

  void add(int f, const ClosestPoint& closest, double distance) {
    near_.face.push_back({.face = f, .distance = distance, .closest = closest});
  }

  void look_at_shell(int f, double& wake) {
    const Face& face = surface_.face[static_cast<std::size_t>(f)];
    const double reach = influence_outside(surface_, options_, candidates_, f) + radius_;
    const FaceVertices corner = corners(f);
    if (falls_asleep(wake, distance_to_box(path_.start, corner) - reach)) return;
    const ClosestPoint closest = closest_point_on_quad(path_.start, corner);
    const double distance = std::sqrt(closest.squared_distance);
    if (falls_asleep(wake, distance - reach)) return;
    if (distance <= reach + approach(nodes_, face, velocity_, approach_share * swept_.dt))
      add(f, closest, distance);
  }

  void look_at_solid(int f, bool everything, double& wake) {
    const SweptFace& solid = swept_.solid_[static_cast<std::size_t>(f)];
    const double gap = gap_between(own_, solid.box);
    falls_asleep(wake, gap);
    if (gap > 0) return;
    const double from = solid.normal.dot(path_.start);
    const double to = solid.normal.dot(path_.end);
    const double above = std::min(from, to) - radius_ - solid.upper_outside;
    if (above > (everything ? solid.upper - solid.upper_outside : 0.0)) {
      falls_asleep(wake, path_above(path_.start, corners(f), above));
      return;
    }
    if (std::max(from, to) + radius_ < solid.lower) return;
    const double reach = influence_outside(surface_, options_, candidates_, f) + radius_ + ahead_;
    near_.side.push_back({distance_to_box(path_.start, corners(f)), reach, f});
  }

  // The closest of its body tells whether the node is inside; farther ones matter to those inside only.
  bool matters(const NearFaces::Side& side) const {
    if (side.least_distance <= side.reach) return true;
    const int body = surface_.face[static_cast<std::size_t>(side.face)].body;
    return std::none_of(near_.face.begin(), near_.face.end(), [&](const NearFace& known) {
      const Face& face = surface_.face[static_cast<std::size_t>(known.face)];
      return !face.shell && face.body == body && known.distance < side.least_distance;
    });
  }

  void add_sides(bool everything) {
    std::sort(near_.side.begin(), near_.side.end(), [](const NearFaces::Side& a, const NearFaces::Side& b) {
      return a.least_distance != b.least_distance ? a.least_distance < b.least_distance : a.face < b.face;
    });
    for (const NearFaces::Side& side : near_.side) {
      if (!everything && !matters(side)) continue;
      const ClosestPoint closest = closest_point_on_quad(path_.start, corners(side.face));
      add(side.face, closest, std::sqrt(closest.squared_distance));
    }
  }

  SweptFaces& swept_;
  const Surface& surface_;
  const Candidates& candidates_;
  const ContactOptions& options_;
  const Nodes& nodes_;
  const Travel& travel_;
  NearFaces& near_;
  int slave_;
  double radius_;
  Sweep path_;
  Vector3d velocity_;
  CaptureBox own_;
  double so_far_ = 0;  // of the pair looked at
  double ahead_ = 0;
};

void SweptFaces::find(const Surface& surface, const Candidates& candidates, const ContactOptions& options,
                      const Nodes& nodes, const Travel& travel, int slave, bool everything, NearFaces& near) {
  Lookout(*this, surface, candidates, options, nodes, travel, slave, near).run(everything);
}

}  // namespace brio
