#include "src/build/refused_motions.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>

#include "src/base/breakdown.hpp"
#include "src/base/index.hpp"
#include "src/deck/corner_times.hpp"
#include "src/model/node_name.hpp"

namespace brio {

namespace {

/// Components of a normal below this are rounding.
constexpr double along_axis = 1e-9;
/// Of a way: rounding.
constexpr double rounding_of_way = 1e-9;

/// The motion along one axis, or of one skew support; no curve: it is not prescribed.
struct AxisMotion {
  double share = 0;  ///< of it in that along the normal of the wall
  MotionKind kind = MotionKind::velocity;
  const Curve* curve = nullptr;
  const std::string* place = nullptr;
  double velocity = 0;  ///< at the start
};
using Motion = std::array<AxisMotion, 3>;

/// A height over a time in which curves have no corner: h + v t + c t^2/2 + j t^3/6.
struct Cubic {
  double h = 0, v = 0, c = 0, j = 0;
  double operator()(double t) const { return h + t * (v + t * (c / 2 + t * j / 6)); }
};

struct Lowest {
  double change = 0;  ///< of the height since the start
  double time = 0;
  void look(double height, double now) {
    if (height < change) change = height, time = now;
  }
};

void add(Cubic& sum, const AxisMotion& motion, double share, double begin, double middle) {
  const double value = (*motion.curve)(begin), slope = motion.curve->slope(middle);
  switch (motion.kind) {
    case MotionKind::displacement:
      sum.v += share * slope;
      break;
    case MotionKind::velocity:
      sum.v += share * value, sum.c += share * slope;
      break;
    case MotionKind::acceleration:
      sum.v += share * motion.velocity, sum.c += share * value, sum.j += share * slope;
      break;
  }
}

/// Extremes of a cubic within (0, duration) are where its slope is 0.
void look_inside(const Cubic& height, double begin, double duration, Lowest& lowest) {
  const auto look = [&](double t) {
    if (t > 0 && t < duration) lowest.look(height(t), begin + t);
  };
  if (height.j == 0) {
    if (height.c != 0) look(-height.v / height.c);
    return;
  }
  const double root = std::sqrt(std::max(0.0, height.c * height.c - 2 * height.j * height.v));
  look((-height.c + root) / height.j);
  look((-height.c - root) / height.j);
}

/// The lowest height above a wall on the way to the end time, from that at the start.
Lowest lowest_change(const RigidWall& wall, Motion motion, double end) {
  const std::vector<double> times = corner_times({motion[0].curve, motion[1].curve, motion[2].curve}, end);
  Lowest lowest;
  double height_now = 0;
  for (std::size_t i = 1; i < times.size(); ++i) {
    const double begin = times[i - 1], duration = times[i] - begin, middle = begin + 0.5 * duration;
    Cubic height{.h = height_now};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      height.v -= wall.normal[axis] * wall.velocity[axis];
      AxisMotion& one = motion[axis];
      if (one.curve == nullptr) continue;
      add(height, one, one.share, begin, middle);
      if (one.kind == MotionKind::acceleration)
        one.velocity += duration * ((*one.curve)(begin) + 0.5 * duration * one.curve->slope(middle));
    }
    look_inside(height, begin, duration, lowest);
    height_now = height(duration);
    lowest.look(height_now, times[i]);
  }
  return lowest;
}

/// Whether all axes along which the wall would push are prescribed.
bool cannot_give_way(const Vector3d& free_normal) {
  return std::ranges::all_of(free_normal, [](double part) { return std::abs(part) <= along_axis; });
}

bool passes(double height, const Lowest& lowest) {
  return std::max(height, 0.0) + lowest.change < rounding_of_way * lowest.change;
}

double height_of(const RigidWall& wall, const double* position) {
  return dot(wall.normal, vector_at(position) - wall.point);
}

[[noreturn]] void refuse(const std::string& who, const RigidWall& wall, const Motion& motion, double height,
                         const Lowest& lowest) {
  std::string place;
  for (std::size_t axis = 3; axis-- > 0;)
    if (motion[axis].place != nullptr && std::abs(motion[axis].share) > along_axis)
      place = *motion[axis].place;
  std::ostringstream text;
  text << "this motion takes " << who << " through the rigid wall"
       << (wall.place.empty() ? std::string() : " of " + wall.place) << ": it would be "
       << -std::max(height, 0.0) - lowest.change << " behind it at time " << lowest.time
       << "; accepted are motions that stay on the side that the normal of the wall points to";
  throw BuildError(text.str(), place.empty() ? wall.place : place);
}

/// Of each node: the entry of model.prescribed for each axis, and the place of the node in its list; or -1.
using NodeMotions = std::array<std::array<int, 2>, 3>;

std::vector<NodeMotions> motions_of_nodes(const Model& model) {
  constexpr std::array<int, 2> none{-1, -1};
  std::vector<NodeMotions> motion_of(model.nodes.size(), {none, none, none});
  for (std::size_t i = 0; i < model.prescribed.size(); ++i) {
    const PrescribedNodes& given = model.prescribed[i];
    for (std::size_t k = 0; k < given.nodes.size() && !given.turns(); ++k) {
      NodeMotions& motions = motion_of[index(given.nodes[k])];
      if (!given.is_skew()) {
        motions[index(given.axis)] = {static_cast<int>(i), static_cast<int>(k)};
      } else if (given.dual[k] != Vector3d{}) {
        *std::ranges::find(motions, none) = {static_cast<int>(i), static_cast<int>(k)};
      }
    }
  }
  return motion_of;
}

Motion motion_of_node(const Model& model, std::size_t node, const NodeMotions& motions,
                      const RigidWall& wall) {
  Motion motion;
  const double* v = model.nodes.record[node].velocity;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (motions[axis][0] < 0) continue;
    const PrescribedNodes& given = model.prescribed[index(motions[axis][0])];
    const auto at = index(motions[axis][1]);
    motion[axis] = {given.is_skew() ? dot(wall.normal, given.dual[at]) : wall.normal[axis], given.kind,
                    &given.curve, &given.place, dot(given.direction_of(at), {v[0], v[1], v[2]})};
  }
  return motion;
}

bool same_way(const Motion& a, const Motion& b) {
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (a[axis].curve != b[axis].curve || a[axis].share != b[axis].share ||
        (a[axis].kind == MotionKind::acceleration && a[axis].velocity != b[axis].velocity))
      return false;
  return true;
}

void check_nodes(const Model& model, const RigidWall& wall, std::span<const NodeMotions> motion_of) {
  Motion last;
  Lowest lowest;
  bool known = false;
  for (std::size_t i = 0; i < model.nodes.size(); ++i) {
    if (model.nodes.prescribed_translations(i) == 0) continue;
    if (!cannot_give_way(model.nodes.free_translations(i) * wall.normal)) continue;
    const Motion motion = motion_of_node(model, i, motion_of[i], wall);
    if (!known || !same_way(motion, last)) lowest = lowest_change(wall, motion, model.control.settings.end);
    known = true;
    last = motion;
    const double height = height_of(wall, model.nodes.record[i].position);
    if (passes(height, lowest)) refuse(name_of_node(model, i), wall, motion, height, lowest);
  }
}

/// All rotations are prescribed as none.
bool cannot_turn(const RigidBody& body) {
  for (int axis = 3; axis < 6; ++axis)
    if (!body.is_given(axis)) return false;
  return std::all_of(body.given.begin(), body.given.end(), [](const PrescribedRigid& one) {
    return one.axis < 3 || std::all_of(one.curve.points.begin(), one.curve.points.end(),
                                       [](const auto& point) { return point[1] == 0; });
  });
}

void check_body(const Model& model, const WallInRun& wall, std::size_t b) {
  const RigidBody& body = model.rigid.body[b];
  Motion motion;
  const Vector3d normal = body.axes * wall.wall.normal;
  Vector3d free = normal;
  for (const PrescribedRigid& given : body.given) {
    if (given.axis >= 3) continue;
    const auto axis = index(given.axis);
    motion[axis] = {normal[given.axis], given.kind, &given.curve, &given.place,
                    dot(body.axes.row(given.axis), model.rigid.motion[b].velocity)};
    free[axis] = 0;
  }
  if (!cannot_give_way(free)) return;
  const double height =
      cannot_turn(body) ? height_above(wall, body, model.nodes) : height_of(wall.wall, body.centre.data());
  const Lowest lowest = lowest_change(wall.wall, motion, model.control.settings.end);
  if (passes(height, lowest))
    refuse("the rigid part '" + model.parts[body.part].name + "'", wall.wall, motion, height, lowest);
}

}  // namespace

void refuse_motions_through_walls(const Model& model) {
  if (model.walls.empty()) return;
  if (!model.prescribed.empty()) {
    const std::vector<NodeMotions> motion_of = motions_of_nodes(model);
    for (const WallInRun& wall : model.walls) check_nodes(model, wall.wall, motion_of);
  }
  for (const WallInRun& wall : model.walls)
    for (std::size_t b = 0; b < model.rigid.body.size(); ++b) check_body(model, wall, b);
}

}  // namespace brio
