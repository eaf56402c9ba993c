#include "contact/features/feature_motion.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "src/base/gather.hpp"
#include "src/base/index.hpp"

namespace brio {

namespace {

constexpr std::size_t features_a_range = 1024, groups_a_range = 4, bodies_a_range = 64;

// Of rows of four numbers, the last of which do not count.
double length_in_frame(const double* from, const double* to, const Vector3d& frame) {
  const Row4 moved = load_row(to) - load_row(from) - Row4{frame.x, frame.y, frame.z, 0},
             square = moved * moved;
  return std::sqrt(square[0] + square[1] + square[2]) * paths_rounded_up;
}
Row4 absolute(Row4 a) { return a < 0 ? -a : a; }
Row4 larger(Row4 a, Row4 b) { return a > b ? a : b; }

/// What was moved and the step of a node side by side, to be compared at once.
typedef double Both __attribute__((vector_size(16)));

Both longer(Both a, Both b) { return a > b ? a : b; }

/// The ways of features by those of their corners.
template <class Way>
struct Spread {
  const std::vector<Way>& of_node;
  const MotionGroups& groups;

  /// \param in_group whether one group has all corners
  template <std::size_t Corners>
  void to(PathAndAhead& ways, std::size_t feature, const std::array<int, Corners>& corners, bool in_group,
          bool with_path) const {
    const Both way = in_group ? longest_in_group(corners) : longest(corners);
    const double path = ways.path[feature] + (with_path ? way[0] : 0);
    ways.path[feature] = path;
    ways.ahead[feature] = path + approach_factor * way[1];
  }

 private:
  template <std::size_t Corners>
  Both longest_in_group(const std::array<int, Corners>& corners) const {
    Both longest = at_node(corners[0]);
    for (std::size_t k = 1; k < Corners; ++k) longest = longer(longest, at_node(corners[k]));
    return longest;
  }
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
  for_groups(team, [&](std::size_t g) { measure_group(g); });
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
  for (int s : change.dead_slave) {
    node[index(s)] = {};
    way_[index(s)] = {};
  }
  groups.join(surface, features, change, edges);
}

void FeatureMotion::make_room_for_watched(const SurfaceFeatures& features) {
  watched_.resize(features.edge.size(), 0);
  watched_edge_.reserve(features.edge.size());
}

bool FeatureMotion::follows(const SurfaceFeatures& features, const Surface& surface) const {
  return known_ && node.size() == surface.slaves() && of_edge.path.size() == features.edge.size();
}

void FeatureMotion::start_anew(const SurfaceFeatures& features, const Surface& surface) {
  node.assign(surface.slaves(), {});
  way_.assign(surface.slaves(), {});
  for (auto [ways, count] : {std::pair(&of_node, node.size()), std::pair(&of_face, surface.face.size()),
                             std::pair(&of_edge, features.edge.size())})
    *ways = {std::vector<double>(count, 0), std::vector<double>(count, 0)};
  groups.group.clear();
  driven_.clear();
  joined_.clear();
  for (std::size_t s = 0; s < node.size(); ++s)
    if (surface.rigid_body(surface.node[s]) >= 0) driven_.push_back(static_cast<int>(s));
}

// As if they had moved with their frames.
void FeatureMotion::move_joined(const Surface& surface, const Nodes& nodes) {
  for (int slave : joined_) {
    const int global = surface.node[index(slave)];
    if (global < 0) continue;
    const Vector3d x = position(nodes, global) - frame_of(index(slave));
    std::copy(x.begin(), x.end(), node[index(slave)].start);
  }
  joined_.clear();
}

// By threads, `before(slave, record)` and `after(slave)`, which tells whether it exceeds its limit.
template <class Before, class After>
void FeatureMotion::take_positions(const Surface& surface, const Nodes& nodes, double dt,
                                   std::span<const RigidMotion> bodies, ThreadTeam& team,
                                   const Before& before, const After& after) {
  const Row4 steps{dt, dt, dt, 0};
  follow_bodies(bodies, dt, team);
  sum_.assign((node.size() + features_a_range - 1) / features_a_range, {});
  team.for_ranges(node.size(), features_a_range, [&](std::size_t begin, std::size_t end) {
    Row4 magnitude{};
    bool exceeds = false;
    for (std::size_t s = begin; s < end; ++s) {
      const int global = surface.node[s];
      if (global < 0) continue;
      const NodeRecord& record = nodes.record[index(global)];
      before(s, record);
      const Row4 start = load_row(record.position);
      store_row(node[s].start, start);
      store_row(node[s].end, start + steps * load_row(record.velocity));
      if (const int body = bodies.empty() ? -1 : surface.rigid_body(global); body >= 0)
        end_of_body_node(s, index(body));
      magnitude = larger(magnitude, larger(absolute(start), absolute(load_row(node[s].end))));
      exceeds = after(s) || exceeds;
    }
    sum_[begin / features_a_range] = {std::max(std::max(magnitude[0], magnitude[1]), magnitude[2]), exceeds};
  });
  magnitude_ = 0;
  for (const Sum& sum : sum_) magnitude_ = std::max(magnitude_, sum.magnitude);
}

void FeatureMotion::predict(const SurfaceFeatures& features, const Surface& surface, const Nodes& nodes,
                            double dt, std::span<const RigidMotion> bodies, ThreadTeam& team) {
  if (follows(features, surface)) {
    move_joined(surface, nodes);
    for (int axis = 0; axis < 3; ++axis) frame_sum_[axis] += frame_[axis];
  } else {
    start_anew(features, surface);
  }
  solution_step_.resize(surface.slaves());
  make_room_for_watched(features);
  const bool is_grouped = !groups.group.empty();
  take_positions(
      surface, nodes, dt, bodies, team,
      [&](std::size_t s, const NodeRecord& record) {
        way_[s].moved = is_grouped ? length_in_frame(node[s].start, record.position, frame_of(s)) : 0;
        of_node.path[s] += way_[s].moved;
      },
      [](std::size_t) { return false; });
  if (is_grouped) {
    for_groups(team, [&](std::size_t g) {
      groups.group[g].last = groups.group[g].step;
      measure_group(g);
    });
    spread(features, true, team);
  } else {
    restart(features, surface, team);
  }
  set_frame();
  known_ = true;
  exceeds_ = false;
  is_solution_ = false;
  corrected_ = nullptr;
}

void FeatureMotion::end_by_velocities(const SurfaceFeatures& features, const Surface& surface,
                                      const Nodes& nodes, double dt, std::span<const RigidMotion> bodies,
                                      ThreadTeam& team) {
  take_positions(
      surface, nodes, dt, bodies, team, [](std::size_t, const NodeRecord&) {},
      [&](std::size_t s) { return raise(s); });
  is_solution_ = true;
  corrected_ = nullptr;
  finish_raising(features, team);
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

// Its frame, and the displacements in it.
void FeatureMotion::measure_group(std::size_t g) {
  MotionGroups::Group& group = groups.group[g];
  const std::span<const int> members = groups.members(g);
  Vector3d sum{};
  for (int s : members) sum += displacement(s);
  group.step = members.empty() ? Vector3d{} : sum / static_cast<double>(members.size());
  for (int s : members) {
    const NodeMotion64& moved = node[index(s)];
    way_[index(s)].step = length_in_frame(moved.start, moved.end, group.step);
    of_node.ahead[index(s)] = of_node.path[index(s)] + approach_factor * way_[index(s)].step;
  }
  find_longest(g);
}

void FeatureMotion::find_longest(std::size_t g) {
  double moved = 0, ahead = 0;
  for (int s : groups.members(g)) {
    moved = std::max(moved, way_[index(s)].moved);
    ahead = std::max(ahead, way_[index(s)].step);
  }
  groups.group[g].moved = moved;
  groups.group[g].ahead = ahead;
}

template <class OfGroup>
void FeatureMotion::for_groups(ThreadTeam& team, OfGroup&& of_group) {
  team.for_ranges(groups.group.size(), groups_a_range, [&](std::size_t begin, std::size_t end) {
    for (std::size_t g = begin; g < end; ++g) of_group(g);
  });
}

void FeatureMotion::spread(const SurfaceFeatures& features, bool with_paths, ThreadTeam& team) {
  groups.advance(with_paths);
  const Spread<Way> spread{way_, groups};
  team.for_ranges(features.face_node.size(), features_a_range, [&](std::size_t begin, std::size_t end) {
    for (std::size_t f = begin; f < end; ++f)
      spread.to(of_face, f, features.face_node[f], groups.holds_face[f] != 0, with_paths);
  });
  team.for_ranges(watched_edge_.size(), features_a_range, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto e = index(watched_edge_[i]);
      spread.to(of_edge, e, features.edge_node[e], groups.holds_edge[e] != 0, with_paths);
    }
  });
}

void FeatureMotion::watch_edge(const SurfaceFeatures& features, int edge) {
  const auto e = index(edge);
  if (watched_[e] != 0) return;
  watched_[e] = 1;
  watched_edge_.push_back(edge);
  Spread<Way>{way_, groups}.to(of_edge, e, features.edge_node[e], groups.holds_edge[e] != 0, false);
}

void FeatureMotion::watch_only(std::span<const std::uint8_t> flagged) {
  watched_edge_.clear();  // anew, ascending, so that their paths lie one after the other
  for (std::size_t e = 0; e < flagged.size(); ++e)
    if (watched_[e] &= flagged[e]; watched_[e] != 0) watched_edge_.push_back(static_cast<int>(e));
}

void FeatureMotion::follow_bodies(std::span<const RigidMotion> bodies, double dt, ThreadTeam& team) {
  body_.resize(bodies.size());
  team.for_ranges(bodies.size(), bodies_a_range, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) {
      const RigidMotion& motion = bodies[b];
      BodyStep& body = body_[b];
      body = {motion.centre, dt * motion.velocity, {}};
      if (is_zero(motion.angular_velocity)) continue;
      const auto turn = turn_over(motion, motion.inertia * motion.angular_velocity, dt);
      body.turn = turn ? turn->change_of_arms() : dt * cross_matrix(motion.angular_velocity);
    }
  });
}

// Nothing is lost where a body does not turn.
void FeatureMotion::end_of_body_node(std::size_t slave, std::size_t body) {
  const BodyStep& moved = body_[body];
  const Vector3d start = vector_at(node[slave].start),
                 end = start + (moved.displacement + moved.turn * (start - moved.centre));
  store_row(node[slave].end, Row4{end.x, end.y, end.z, 0});
}

// As a row: it is read as one at once.
void FeatureMotion::set_end(std::size_t slave, const Vector3d& velocity, double dt) {
  store_row(node[slave].end, load_row(node[slave].start) + dt * Row4{velocity.x, velocity.y, velocity.z, 0});
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
  for_groups(team, [&](std::size_t g) { find_longest(g); });
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
  follow_bodies(bodies, dt, team);
  in_contact.for_each(team, [&](std::size_t range, std::size_t s) {
    set_end(s, corrected[s], dt);
    if (!bodies.empty() && surface.rigid_body(surface.node[s]) >= 0) return;
    sum_[range].exceeds = raise(s) || sum_[range].exceeds;
  });
  team.for_ranges(driven, features_a_range, [&](std::size_t begin, std::size_t end) {
    Sum& sum = sum_[ranges + begin / features_a_range];
    for (std::size_t i = begin; i < end; ++i) {
      const std::size_t s = index(driven_[i]);
      const int body = surface.rigid_body(surface.node[s]);
      if (body < 0) continue;
      end_of_body_node(s, index(body));
      sum.exceeds = raise(s) || sum.exceeds;
    }
  });
  finish_raising(features, team);
}

}  // namespace brio
