#include "contact/travel.hpp"

#include <algorithm>
#include <cmath>

#include "src/base/floating_point.hpp"

namespace brio {

namespace {

constexpr std::size_t slaves_per_task = 1024;
constexpr Spread nothing{{infinity, infinity, infinity}, {-infinity, -infinity, -infinity}};
/// Over magnitudes: hundreds of roundings of one distance; far less than any length that matters.
constexpr double rounding_of_distance = 1e-13;
/// Of one step of a path.
constexpr double rounding_of_step = 1e-15;

void include(Spread& spread, int axis, double value) {
  spread.lower[axis] = std::min(spread.lower[axis], value);
  spread.upper[axis] = std::max(spread.upper[axis], value);
}
void include(Spread& spread, const Spread& other) {
  for (int axis = 0; axis < 3; ++axis) {
    spread.lower[axis] = std::min(spread.lower[axis], other.lower[axis]);
    spread.upper[axis] = std::max(spread.upper[axis], other.upper[axis]);
  }
}

}  // namespace

void Travel::Range::include(const Range& other) {
  brio::include(velocity, other.velocity);
  brio::include(displacement, other.displacement);
  brio::include(ahead, other.ahead);
  for (int axis = 0; axis < 3; ++axis) sum[axis] += other.sum[axis];
  count += other.count;
  longest_move = std::max(longest_move, other.longest_move);
  fastest = std::max(fastest, other.fastest);
  magnitude = std::max(magnitude, other.magnitude);
}

// Velocities are taken relative to the frame of the last step: that of the present one is not yet known.
Travel::Range Travel::follow_range(const Surface& surface, const Nodes& nodes,
                                   std::span<const Vector3<double>> since, std::size_t begin,
                                   std::size_t end) {
  Range range{nothing, nothing, nothing, {0, 0, 0}, 0, 0, 0, 0};
  const double ahead = approach_share * dt_;
  for (std::size_t s = begin; s < end; ++s) {
    if (surface.node[s] < 0) continue;
    const NodeRecord& record = nodes.record[static_cast<std::size_t>(surface.node[s])];
    const double last[3] = {position_[s].x, position_[s].y, position_[s].z};
    double move = 0;
    double speed = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const double x = record.position[axis];
      const double v = record.velocity[axis];
      const double moved = (x - last[axis]) - frame_move_[axis];
      const double relative = v - frame_[axis];
      move += moved * moved;
      speed += relative * relative;
      include(range.velocity, axis, v);
      range.sum[axis] += v;
      range.magnitude = std::max(range.magnitude, std::abs(x) + ahead * std::abs(v));
    }
    if (!since.empty()) {
      const double start[3] = {since[s].x, since[s].y, since[s].z};
      for (int axis = 0; axis < 3; ++axis) {
        const double displacement = record.position[axis] - start[axis];
        include(range.displacement, axis, displacement);
        include(range.ahead, axis, displacement + ahead * record.velocity[axis]);
      }
    }
    ++range.count;
    move = std::sqrt(move);
    speed = std::sqrt(speed);
    position_[s] = {record.position[0], record.position[1], record.position[2]};
    path_[s] += move;
    ahead_[s] = ahead * speed;
    range.longest_move = std::max(range.longest_move, move);
    range.fastest = std::max(range.fastest, speed);
  }
  return range;
}

void Travel::follow(const Surface& surface, const Nodes& nodes, std::span<const Vector3<double>> since,
                    double dt, ThreadTeam& team) {
  if (path_.size() != surface.slaves()) {
    position_.assign(surface.slaves(), {0, 0, 0});
    path_.assign(surface.slaves(), 0);
    ahead_.assign(surface.slaves(), 0);
    piece_.resize((surface.slaves() + slaves_per_task - 1) / slaves_per_task);
  }
  for (int axis = 0; axis < 3; ++axis) frame_move_[axis] = dt_ * frame_[axis];
  dt_ = dt;
  if (since.size() != surface.slaves()) since = {};
  team.for_ranges(surface.slaves(), slaves_per_task, [&](std::size_t begin, std::size_t end) {
    piece_[begin / slaves_per_task] = follow_range(surface, nodes, since, begin, end);
  });
  range_ = {nothing, nothing, nothing, {0, 0, 0}, 0, 0, 0, 0};
  for (const Range& piece : piece_) range_.include(piece);
  if (!(range_.velocity.width(0) >= 0)) range_.velocity = {};  // all deleted
  rounding_ = rounding_of_distance * range_.magnitude;
  margin_ += rounding_of_step * range_.magnitude;
  path_of_faces_ += range_.longest_move + rounding_of_step * range_.magnitude;
  double turn = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double next = range_.count > 0 ? range_.sum[axis] / range_.count : 0;
    turn += (next - frame_[axis]) * (next - frame_[axis]);
    frame_[axis] = next;
  }
  // Twice: in the frame of the present step both the node and the face may be that much faster.
  ahead_margin_ = approach_share * dt * 2 * std::sqrt(turn) + rounding_;
  ahead_of_faces_ = approach_share * dt * range_.fastest + ahead_margin_;
}

// As if they had moved with the frame so far.
void Travel::join(const Surface& surface, const Nodes& nodes, std::span<const int> slaves) {
  if (path_.empty()) return;
  position_.resize(surface.slaves());
  path_.resize(surface.slaves());
  ahead_.resize(surface.slaves());
  piece_.resize((surface.slaves() + slaves_per_task - 1) / slaves_per_task);
  for (int slave : slaves) {
    const auto s = static_cast<std::size_t>(slave);
    const double* x = nodes.record[static_cast<std::size_t>(surface.node[s])].position;
    position_[s] = {x[0] - dt_ * frame_[0], x[1] - dt_ * frame_[1], x[2] - dt_ * frame_[2]};
    path_[s] = 0;
  }
}

void Travel::restart() {
  std::fill(path_.begin(), path_.end(), 0.0);
  path_of_faces_ = 0;
  margin_ = 0;
}

}  // namespace brio
