#include "contact/features/feature_motion.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "src/base/index.hpp"

namespace brio {

namespace {

constexpr std::size_t features_a_range = 4096, groups_a_range = 16;

double length_in_frame(const double* from, const double* to, const Vector3d& frame) {
  double square = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double d = to[axis] - from[axis] - frame[axis];
    square += d * d;
  }
  return std::sqrt(square) * paths_rounded_up;
}

/// What was moved and the step of a node side by side, to be compared at once.
typedef double Both __attribute__((vector_size(16)));

Both longer(Both a, Both b) { return a > b ? a : b; }

/// The ways of features by those of their corners.
template <class Way>
struct Spread {
  const std::vector<Way>& of_node;
  const MotionGroups& groups;

  template <std::size_t Corners>
  void to(PathAndAhead& ways, std::size_t feature, const std::array<int, Corners>& corners,
          bool with_path) const {
    const Both way = longest(corners);
    const double path = ways.path[feature] + (with_path ? way[0] : 0);
    ways.path[feature] = path;
    ways.ahead[feature] = path + approach_factor * way[1];
  }

 private:
  // The longest of the corners, in the frame of the first one's group.
  template <std::size_t Corners>
  Both longest(const std::array<int, Corners>& corners) const {
    Both longest = at_node(corners[0]);
    const int own = groups.of_node(corners[0]);
    for (std::size_t k = 1; k < Corners; ++k) {
      const int other = groups.of_node(corners[k]);
      const Both way = at_node(corners[k]);
      longest = longer(longest, other == own ? way : way + between(own, other));
    }
    return longest;
  }
  Both at_node(int slave) const {
    const Way& way = of_node[index(slave)];
    return Both{way.moved, way.step};
  }
  Both between(int g, int h) const {
    const std::array<double, 2>& apart = groups.frames_apart(g, h);
    return Both{apart[0], apart[1]};
  }
};

void restart_ways(PathAndAhead& ways, std::size_t count) {
  ways.path.resize(count, 0);
  ways.ahead.resize(count, 0);
  for (std::size_t i = 0; i < count; ++i) {
    ways.ahead[i] = std::max(0.0, ways.ahead[i] - ways.path[i]) * paths_rounded_up;
    ways.path[i] = 0;
  }
}

}  // namespace

void FeatureMotion::restart(const SurfaceFeatures& features, const Surface& surface, ThreadTeam& team) {
  restart_ways(of_node, surface.slaves());
  restart_ways(of_face, surface.face.size());
  restart_ways(of_edge, features.edge.size());
  for (double& sum : frame_sum_) sum = 0;
  ++restarts_;
  form_groups(features, surface, team);
  measure_steps(team);
  spread(features, false, team);
}

void FeatureMotion::form_groups(const SurfaceFeatures& features, const Surface& surface, ThreadTeam& team) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  position_.resize(node.size());
  for (std::size_t s = 0; s < node.size(); ++s)
    position_[s] = surface.node[s] < 0 ? Vector3d{none, none, none} : vector_at(node[s].start);
  groups.form(surface, features, position_, team);
}

void FeatureMotion::join(const SurfaceFeatures& features, const Surface& surface, const SurfaceChange& change,
                         std::span<const int> edges) {
  if (!known_) return;
  joined_.insert(joined_.end(), change.new_slave.begin(), change.new_slave.end());
  node.resize(surface.slaves());
  way_.resize(surface.slaves());
  solution_step_.resize(surface.slaves());
  make_room_for_watched(features);
  for (auto [ways, count] : {std::pair(&of_node, surface.slaves()), std::pair(&of_face, surface.face.size()),
                             std::pair(&of_edge, features.edge.size())}) {
    ways->path.resize(count, 0);
    ways->ahead.resize(count, 0);
  }
  groups.join(surface, features, change, edges);
}

void FeatureMotion::make_room_for_watched(const SurfaceFeatures& features) {
  watched_.resize(features.edge.size(), 0);
  watched_edge_.reserve(features.edge.size());
}

void FeatureMotion::start_sums(std::size_t count) {
  sum_.assign((count + features_a_range - 1) / features_a_range, {});
}

void FeatureMotion::begin(const SurfaceFeatures& features, const Surface& surface, const Nodes& nodes,
                          ThreadTeam& team) {
  const bool follows =
      known_ && node.size() == surface.slaves() && of_edge.path.size() == features.edge.size();
  node.resize(surface.slaves());
  way_.resize(surface.slaves());
  solution_step_.resize(surface.slaves());
  make_room_for_watched(features);
  if (!follows) {
    for (auto [ways, count] : {std::pair(&of_node, node.size()), std::pair(&of_face, surface.face.size()),
                               std::pair(&of_edge, features.edge.size())})
      *ways = {std::vector<double>(count, 0), std::vector<double>(count, 0)};
    groups.group.clear();
    driven_.clear();
    for (std::size_t s = 0; s < node.size(); ++s)
      if (surface.rigid_body(surface.node[s]) >= 0) driven_.push_back(static_cast<int>(s));
  }
  for (int slave : joined_) {  // as if it had moved with its frame
    if (surface.node[index(slave)] < 0) continue;
    const double* x = nodes.record[index(surface.node[index(slave)])].position;
    for (std::size_t axis = 0; axis < 3; ++axis)
      node[index(slave)].start[axis] = x[axis] - frame_of(index(slave))[axis];
  }
  joined_.clear();
  team.for_ranges(node.size(), features_a_range, [&](std::size_t begin, std::size_t end) {
    for (std::size_t s = begin; s < end; ++s) {
      if (surface.node[s] < 0) {
        node[s] = {};
        way_[s] = {};
        continue;
      }
      const double* x = nodes.record[index(surface.node[s])].position;
      way_[s].moved = follows ? length_in_frame(node[s].start, x, frame_of(s)) : 0;
      of_node.path[s] += way_[s].moved;
      std::copy(x, x + 3, node[s].start);
    }
  });
  if (follows)
    for (int axis = 0; axis < 3; ++axis) frame_sum_[axis] += frame_[axis];
  known_ = true;
  predicted_ = false;
}

void FeatureMotion::end_by_velocity(const SurfaceFeatures& features, const Surface& surface,
                                    const Nodes& nodes, double dt, std::span<const RigidMotion> bodies,
                                    ThreadTeam& team) {
  start_sums(node.size());
  team.for_ranges(node.size(), features_a_range, [&](std::size_t begin, std::size_t end) {
    Sum sum;
    for (std::size_t s = begin; s < end; ++s) {
      const int global = surface.node[s];
      if (global < 0) continue;
      const int body = bodies.empty() ? -1 : surface.rigid_body(global);
      NodeMotion64& moved = node[s];
      if (body >= 0) {
        end_of_body_node(s, bodies[index(body)], dt);
      } else {
        const double* v = nodes.record[index(global)].velocity;
        for (int axis = 0; axis < 3; ++axis) moved.end[axis] = moved.start[axis] + dt * v[axis];
      }
      for (int axis = 0; axis < 3; ++axis)
        sum.magnitude =
            std::max(sum.magnitude, std::max(std::abs(moved.start[axis]), std::abs(moved.end[axis])));
      if (predicted_) sum.exceeds = raise(s) || sum.exceeds;
    }
    sum_[begin / features_a_range] = sum;
  });
  magnitude_ = 0;
  for (const Sum& sum : sum_) magnitude_ = std::max(magnitude_, sum.magnitude);
  is_solution_ = predicted_;
  corrected_ = nullptr;
  if (predicted_) {
    finish_raising(features, team);
    return;
  }
  if (groups.group.empty()) {
    restart(features, surface, team);
  } else {
    for (MotionGroups::Group& g : groups.group) g.last = g.step;
    measure_steps(team);
    spread(features, true, team);
  }
  set_frame();
  predicted_ = true;
  exceeds_ = false;
}

// The mean of the nodes without the fastest quarter of the groups either way: a splinter does not move it. It
// stays as it was predicted, whatever contact does to single nodes.
void FeatureMotion::set_frame() {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    of_groups_.clear();
    for (std::size_t g = 0; g < groups.group.size(); ++g)
      of_groups_.emplace_back(groups.group[g].step[axis], static_cast<double>(groups.members(g).size()));
    std::sort(of_groups_.begin(), of_groups_.end());
    const std::size_t trimmed = of_groups_.size() / 4;
    double sum = 0, count = 0;
    for (std::size_t i = trimmed; i < of_groups_.size() - trimmed; ++i) {
      sum += of_groups_[i].second * of_groups_[i].first;
      count += of_groups_[i].second;
    }
    frame_[axis] = count > 0 ? sum / count : 0;
  }
}

// Frames, and the displacements in them.
void FeatureMotion::measure_steps(ThreadTeam& team) {
  team.for_ranges(groups.group.size(), groups_a_range, [&](std::size_t begin, std::size_t end) {
    for (std::size_t g = begin; g < end; ++g) {
      MotionGroups::Group& group = groups.group[g];
      const std::span<const int> members = groups.members(g);
      Vector3d sum{};
      for (int s : members)
        for (std::size_t axis = 0; axis < 3; ++axis)
          sum[axis] += node[index(s)].end[axis] - node[index(s)].start[axis];
      for (std::size_t axis = 0; axis < 3; ++axis)
        group.step[axis] = members.empty() ? 0 : sum[axis] / static_cast<double>(members.size());
      for (int s : members) {
        const NodeMotion64& moved = node[index(s)];
        way_[index(s)].step = length_in_frame(moved.start, moved.end, group.step);
        of_node.ahead[index(s)] = of_node.path[index(s)] + approach_factor * way_[index(s)].step;
      }
    }
  });
}

void FeatureMotion::spread(const SurfaceFeatures& features, bool with_paths, ThreadTeam& team) {
  team.for_ranges(groups.group.size(), groups_a_range, [&](std::size_t begin, std::size_t end) {
    for (std::size_t g = begin; g < end; ++g) {
      double moved = 0, ahead = 0;
      for (int s : groups.members(g)) {
        moved = std::max(moved, way_[index(s)].moved);
        ahead = std::max(ahead, way_[index(s)].step);
      }
      groups.group[g].moved = moved;
      groups.group[g].ahead = ahead;
    }
  });
  groups.advance(with_paths);
  const Spread<Way> spread{way_, groups};
  team.for_ranges(features.face_node.size(), features_a_range, [&](std::size_t begin, std::size_t end) {
    for (std::size_t f = begin; f < end; ++f) spread.to(of_face, f, features.face_node[f], with_paths);
  });
  team.for_ranges(watched_edge_.size(), features_a_range, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto e = index(watched_edge_[i]);
      spread.to(of_edge, e, features.edge_node[e], with_paths);
    }
  });
}

void FeatureMotion::watch_edge(const SurfaceFeatures& features, int edge) {
  const auto e = index(edge);
  if (watched_[e] != 0) return;
  watched_[e] = 1;
  watched_edge_.push_back(edge);
  Spread<Way>{way_, groups}.to(of_edge, e, features.edge_node[e], false);
}

void FeatureMotion::watch_only(std::span<const std::uint8_t> flagged) {
  std::erase_if(watched_edge_, [&](int e) { return flagged[index(e)] == 0; });
  std::copy(flagged.begin(), flagged.end(), watched_.begin());
}

void FeatureMotion::end_of_body_node(std::size_t slave, const RigidMotion& body, double dt) {
  const Vector3d v = body.velocity_at(vector_at(node[slave].start) - body.centre);
  for (int axis = 0; axis < 3; ++axis) node[slave].end[axis] = node[slave].start[axis] + dt * v[axis];
}

void FeatureMotion::set_limits(double factor, double surplus) {
  limit_factor_ = factor;
  limit_surplus_ = surplus;
}

// Take the step of a node that exceeds its limit for its step. \returns whether it does
bool FeatureMotion::raise(std::size_t slave) {
  const double step = length_in_frame(node[slave].start, node[slave].end, frame_of(slave));
  solution_step_[slave] = step;
  if (step <= limit_factor_ * way_[slave].step + limit_surplus_) return false;
  way_[slave].step = step;
  of_node.ahead[slave] = of_node.path[slave] + approach_factor * way_[slave].step;
  return true;
}

void FeatureMotion::finish_raising(const SurfaceFeatures& features, ThreadTeam& team) {
  exceeds_ = std::any_of(sum_.begin(), sum_.end(), [](const Sum& sum) { return sum.exceeds; });
  if (!exceeds_) return;
  spread(features, false, team);
}

void FeatureMotion::end_by_solution(const SurfaceFeatures& features, const Surface& surface,
                                    const SlaveSet& in_contact, std::span<const Vector3d> corrected,
                                    double dt, std::span<const RigidMotion> bodies, ThreadTeam& team) {
  const std::size_t driven = bodies.empty() ? 0 : driven_.size();
  const std::size_t ranges = in_contact.ranges();
  sum_.assign(ranges + (driven + features_a_range - 1) / features_a_range, {});
  is_solution_ = true;
  corrected_ = &in_contact;
  in_contact.for_each(team, [&](std::size_t range, std::size_t s) {
    for (int axis = 0; axis < 3; ++axis) node[s].end[axis] = node[s].start[axis] + dt * corrected[s][axis];
    if (!bodies.empty() && surface.rigid_body(surface.node[s]) >= 0) return;
    sum_[range].exceeds = raise(s) || sum_[range].exceeds;
  });
  team.for_ranges(driven, features_a_range, [&](std::size_t begin, std::size_t end) {
    Sum& sum = sum_[ranges + begin / features_a_range];
    for (std::size_t i = begin; i < end; ++i) {
      const std::size_t s = index(driven_[i]);
      const int body = surface.rigid_body(surface.node[s]);
      if (body < 0) continue;
      end_of_body_node(s, bodies[index(body)], dt);
      sum.exceeds = raise(s) || sum.exceeds;
    }
  });
  finish_raising(features, team);
}

}  // namespace brio
