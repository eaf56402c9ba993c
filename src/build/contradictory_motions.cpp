#include "src/build/refused_motions.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "src/base/breakdown.hpp"
#include "src/deck/corner_times.hpp"
#include "src/model/node_name.hpp"

namespace brio {

namespace {

/// Rates that differ by this share of the largest are equal: rounding of slopes.
constexpr double equal_share = 1e-9;
constexpr std::array component_name{"x", "y", "z", "rx", "ry", "rz"};

/// A curve, as the derivative of the displacement whose order is that of its kind.
struct Given {
  MotionKind kind;
  const Curve& curve;
};

int order_of(MotionKind kind) {
  switch (kind) {
    case MotionKind::displacement:
      return 0;
    case MotionKind::velocity:
      return 1;
    case MotionKind::acceleration:
      return 2;
  }
  return 0;
}

/// Whether two motions are one: always, never, or where the velocity at the start is the given one.
struct Likeness {
  bool alike = true;
  std::optional<double> starting_at{};  ///< set: alike only for this initial velocity
};

/// The derivative of order `order` at both ends of an interval without corners inside.
std::array<double, 2> rates(const Given& given, int order, double begin, double end) {
  const int derivations = order - order_of(given.kind);
  if (derivations == 0) return {given.curve(begin), given.curve(end)};
  if (derivations > 1) return {0, 0};
  const double slope = given.curve.slope(0.5 * (begin + end));
  return {slope, slope};
}

/// Both are compared as derivatives of one order: displacements as velocities, for their start is the mesh.
Likeness compare(const Given& a, const Given& b, double end) {
  const std::vector<double> times = corner_times({&a.curve, &b.curve}, end);
  const int order = std::max({order_of(a.kind), order_of(b.kind), 1});
  const Given& lower = order_of(a.kind) < order_of(b.kind) ? a : b;
  const bool unlike_orders = order == 2 && a.kind != b.kind;
  double largest = 0, difference = 0, fastest = 0, jump = 0;
  for (std::size_t i = 1; i < times.size(); ++i) {
    const auto first = rates(a, order, times[i - 1], times[i]);
    const auto second = rates(b, order, times[i - 1], times[i]);
    for (std::size_t k = 0; k < 2; ++k) {
      largest = std::max({largest, std::abs(first[k]), std::abs(second[k])});
      difference = std::max(difference, std::abs(first[k] - second[k]));
    }
    if (!unlike_orders) continue;
    // An acceleration gives no jumps of the velocity.
    const double now = rates(lower, 1, times[i - 1], times[i])[0];
    fastest = std::max(fastest, std::abs(now));
    if (i > 1) jump = std::max(jump, std::abs(now - rates(lower, 1, times[i - 2], times[i - 1])[1]));
  }
  Likeness likeness;
  likeness.alike = difference <= equal_share * largest && jump <= equal_share * fastest;
  if (unlike_orders) likeness.starting_at = rates(lower, 1, times[0], times[1])[0];
  return likeness;
}

bool holds(const Likeness& likeness, double initial_velocity) {
  if (!likeness.alike || !likeness.starting_at) return likeness.alike;
  const double size = std::max(std::abs(initial_velocity), std::abs(*likeness.starting_at));
  return std::abs(initial_velocity - *likeness.starting_at) <= equal_share * size;
}

[[noreturn]] void refuse(const std::string& who, int axis, const std::string& first,
                         const std::string& second) {
  throw BuildError("'" + std::string(component_name[static_cast<std::size_t>(axis)]) + "' of " + who +
                       " is prescribed here and, otherwise, at " + (first.empty() ? "another entry" : first) +
                       "; accepted is one motion of a component, or equal ones",
                   second);
}

double initial_velocity(const Nodes& nodes, std::size_t node, int axis) {
  return axis < 3 ? nodes.record[node].velocity[axis] : nodes.angular_velocity[node].component[axis - 3];
}

void check_nodes(const Model& model, int axis) {
  const std::vector<PrescribedNodes>& given = model.prescribed;
  const auto of_axis = [axis](const PrescribedNodes& one) { return one.axis == axis; };
  if (std::count_if(given.begin(), given.end(), of_axis) < 2) return;
  std::vector<int> motion_of(model.nodes.size(), -1);  // the first of each node
  for (std::size_t i = 0; i < given.size(); ++i) {
    if (!of_axis(given[i])) continue;
    int compared = -1;
    Likeness likeness;
    for (const int entry : given[i].nodes) {
      const auto node = static_cast<std::size_t>(entry);
      int& first = motion_of[node];
      if (first < 0) {
        first = static_cast<int>(i);
        continue;
      }
      const PrescribedNodes& other = given[static_cast<std::size_t>(first)];
      if (first != compared)
        likeness =
            compare({other.kind, other.curve}, {given[i].kind, given[i].curve}, model.control.settings.end);
      compared = first;
      if (!holds(likeness, initial_velocity(model.nodes, node, axis)))
        refuse(name_of_node(model, node), axis, other.place, given[i].place);
    }
  }
}

void check_body(const Model& model, std::size_t b) {
  const std::vector<PrescribedRigid>& given = model.rigid.body[b].given;
  const RigidMotion& motion = model.rigid.motion[b];
  for (auto later = given.begin(); later != given.end(); ++later) {
    const int axis = later->axis;
    const auto first =
        std::find_if(given.begin(), later, [axis](const PrescribedRigid& one) { return one.axis == axis; });
    if (first == later) continue;
    const double start = axis < 3 ? motion.velocity[axis] : motion.angular_velocity[axis - 3];
    const Likeness likeness =
        compare({first->kind, first->curve}, {later->kind, later->curve}, model.control.settings.end);
    if (!holds(likeness, start))
      refuse("the rigid part '" + model.parts[model.rigid.body[b].part].name + "'", axis, first->place,
             later->place);
  }
}

}  // namespace

void refuse_contradictory_motions(const Model& model) {
  for (int axis = 0; axis < 6; ++axis) check_nodes(model, axis);
  for (std::size_t b = 0; b < model.rigid.body.size(); ++b) check_body(model, b);
}

}  // namespace brio
