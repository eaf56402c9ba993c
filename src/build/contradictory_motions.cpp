#include "src/build/refused_motions.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <sstream>

#include "src/base/breakdown.hpp"
#include "src/base/index.hpp"
#include "src/deck/corner_times.hpp"
#include "src/model/node_name.hpp"
#include "src/motion/skew_supports.hpp"

namespace brio {

namespace {

/// Rates that differ by this share of the largest are equal: rounding of slopes.
constexpr double equal_share = 1e-9;
/// Of a unit motion: less is rounding.
constexpr double least_share = 1e-6;
constexpr std::array component_name{"x", "y", "z", "rx", "ry", "rz"};

/// A motion times a factor; its curve is the derivative of the displacement whose order is that of its kind.
struct Term {
  double factor;
  MotionKind kind;
  const Curve* curve;
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

/// Whether the sum of motions is none: always, never, or where the velocity at the start of those whose
/// acceleration is given, times their factors, is the given one.
struct Likeness {
  bool alike = true;
  std::optional<double> starting_at{};  ///< set: alike only for this initial velocity
};

/// The derivative of order `order` at both ends of an interval without corners inside.
std::array<double, 2> rates(const Term& term, int order, double begin, double end) {
  const int derivations = order - order_of(term.kind);
  if (derivations == 0) return {term.factor * (*term.curve)(begin), term.factor * (*term.curve)(end)};
  if (derivations > 1) return {0, 0};
  const double slope = term.factor * term.curve->slope(0.5 * (begin + end));
  return {slope, slope};
}

/// Velocity by those whose acceleration is not given, at an end of an interval.
double velocity_of_others(std::span<const Term> terms, double begin, double end, std::size_t which) {
  double sum = 0;
  for (const Term& term : terms)
    if (term.kind != MotionKind::acceleration) sum += rates(term, 1, begin, end)[which];
  return sum;
}

/// All are compared as derivatives of one order: displacements as velocities, for their start is the mesh.
Likeness compare(std::span<const Term> terms, double end) {
  std::vector<const Curve*> curves;
  int order = 1, least = 2;
  for (const Term& term : terms) {
    curves.push_back(term.curve);
    order = std::max(order, order_of(term.kind));
    least = std::min(least, order_of(term.kind));
  }
  const std::vector<double> times = corner_times(curves, end);
  const bool unlike_orders = order == 2 && least < 2;
  double largest = 0, difference = 0, fastest = 0, jump = 0;
  for (std::size_t i = 1; i < times.size(); ++i) {
    std::array<double, 2> sum{};
    for (const Term& term : terms) {
      const std::array<double, 2> own = rates(term, order, times[i - 1], times[i]);
      for (std::size_t k = 0; k < 2; ++k) {
        largest = std::max(largest, std::abs(own[k]));
        sum[k] += own[k];
      }
    }
    difference = std::max({difference, std::abs(sum[0]), std::abs(sum[1])});
    if (!unlike_orders) continue;
    // An acceleration gives no jumps of the velocity.
    const double now = velocity_of_others(terms, times[i - 1], times[i], 0);
    fastest = std::max(fastest, std::abs(now));
    if (i > 1)
      jump = std::max(jump, std::abs(now - velocity_of_others(terms, times[i - 2], times[i - 1], 1)));
  }
  Likeness likeness;
  likeness.alike = difference <= equal_share * largest && jump <= equal_share * fastest;
  if (unlike_orders) likeness.starting_at = -velocity_of_others(terms, times[0], times[1], 0);
  return likeness;
}

Likeness compare(MotionKind kind, const Curve& curve, MotionKind other_kind, const Curve& other, double end) {
  return compare(std::array{Term{1, kind, &curve}, Term{-1, other_kind, &other}}, end);
}

bool holds(const Likeness& likeness, double initial_velocity) {
  if (!likeness.alike || !likeness.starting_at) return likeness.alike;
  const double size = std::max(std::abs(initial_velocity), std::abs(*likeness.starting_at));
  return std::abs(initial_velocity - *likeness.starting_at) <= equal_share * size;
}

/// Of a velocity, where the sum of motions sets it: minus it where the second of two is the acceleration.
double sign_of_start(MotionKind first) { return first == MotionKind::acceleration ? 1 : -1; }

[[noreturn]] void refuse(const std::string& component, const std::string& who, const std::string& first,
                         const std::string& second) {
  throw BuildError(component + " of " + who + " is prescribed here and, otherwise, at " +
                       (first.empty() ? "another entry" : first) +
                       "; accepted is one motion of a component, or equal ones",
                   second);
}

std::string name_of(int axis) {
  std::string name("'");
  name += component_name[index(axis)];
  return name += "'";
}

double initial_velocity(const Nodes& nodes, std::size_t node, int axis) {
  return axis < 3 ? nodes.record[node].velocity[axis] : nodes.angular_velocity[node].component[axis - 3];
}

void check_nodes(const Model& model, int axis) {
  const std::vector<PrescribedNodes>& given = model.prescribed;
  const auto of_axis = [axis](const PrescribedNodes& one) { return one.axis == axis && !one.is_skew(); };
  if (std::count_if(given.begin(), given.end(), of_axis) < 2) return;
  std::vector<int> motion_of(model.nodes.size(), -1);  // the first of each node
  for (std::size_t i = 0; i < given.size(); ++i) {
    if (!of_axis(given[i])) continue;
    int compared = -1;
    Likeness likeness;
    for (const int entry : given[i].nodes) {
      const auto node = index(entry);
      int& first = motion_of[node];
      if (first < 0) {
        first = static_cast<int>(i);
        continue;
      }
      const PrescribedNodes& other = given[index(first)];
      if (first != compared)
        likeness =
            compare(other.kind, other.curve, given[i].kind, given[i].curve, model.control.settings.end);
      compared = first;
      if (!holds(likeness, sign_of_start(other.kind) * initial_velocity(model.nodes, node, axis)))
        refuse(name_of(axis), name_of_node(model, node), other.place, given[i].place);
    }
  }
}

/// A skew motion in the span of those before it is the sum of their shares.
void check_dependent(const Model& model, std::span<const SupportPlace> before, const SupportPlace& place) {
  const PrescribedNodes& given = model.prescribed[place.entry];
  const Vector3d& direction = given.direction[place.at];
  const auto node = index(place.node);
  const double* v =
      given.turns() ? model.nodes.angular_velocity[node].component : model.nodes.record[node].velocity;
  std::vector<Term> terms{{-1, given.kind, &given.curve}};
  const auto start_of = [&](const Vector3d& along) { return dot(along, {v[0], v[1], v[2]}); };
  double start = given.kind == MotionKind::acceleration ? -start_of(direction) : 0;
  std::string others;
  for (const SupportPlace& one : before) {
    const PrescribedNodes& other = model.prescribed[one.entry];
    const double share = dot(other.dual[one.at], direction);
    if (std::abs(share) < least_share) continue;
    terms.push_back({share, other.kind, &other.curve});
    if (other.kind == MotionKind::acceleration) start += share * start_of(other.direction[one.at]);
    if (!other.place.empty()) others += (others.empty() ? "" : ", ") + other.place;
  }
  if (holds(compare(terms, model.control.settings.end), start)) return;
  std::ostringstream component;
  component << "the component along (" << direction[0] << ", " << direction[1] << ", " << direction[2] << ")";
  refuse(component.str(), name_of_node(model, node), others, given.place);
}

void check_skew(const Model& model, bool turns) {
  const std::vector<SupportPlace> places = skew_places(model.prescribed, turns);
  std::size_t first = 0;  // of the node
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (places[i].node != places[first].node) first = i;
    if (model.prescribed[places[i].entry].dual[places[i].at] == Vector3d{})
      check_dependent(model, std::span(places).subspan(first, i - first), places[i]);
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
    const double start = dot(motion.axes.row(axis % 3), axis < 3 ? motion.velocity : motion.angular_velocity);
    const Likeness likeness =
        compare(first->kind, first->curve, later->kind, later->curve, model.control.settings.end);
    if (!holds(likeness, sign_of_start(first->kind) * start))
      refuse(name_of(axis), "the rigid part '" + model.parts[model.rigid.body[b].part].name + "'",
             first->place, later->place);
  }
}

}  // namespace

void refuse_contradictory_motions(const Model& model) {
  for (int axis = 0; axis < 6; ++axis) check_nodes(model, axis);
  for (const bool turns : {false, true}) check_skew(model, turns);
  for (std::size_t b = 0; b < model.rigid.body.size(); ++b) check_body(model, b);
}

}  // namespace brio
