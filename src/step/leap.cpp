#include "src/step/leap.hpp"

#include <algorithm>
#include <cmath>

#include "src/base/breakdown.hpp"
#include "src/domains/node_ranges.hpp"
#include "src/model/model.hpp"
#include "src/model/node_name.hpp"
#include "src/step/diagnosis.hpp"

namespace brio {

namespace {

/// Widths of the scene in a step. What follows from elastic forces is far below one: elements pass their
/// limits before, and steps are shorter than the time of sound through an element.
constexpr double most_widths = 100;

/// Largest component of the change of velocity of a node, as `accelerate` made it.
struct Leap {
  std::size_t node = 0;
  double speed = 0;
};

Leap largest_change(const Nodes& nodes, double mean_step) {
  Leap largest;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    for (const double component : nodes.free_translations(i) * vector_at(nodes.force[i].component)) {
      const double change = std::abs(component) * (nodes.record[i].inverse_mass * mean_step);
      if (change > largest.speed) largest = {i, change};
    }
  }
  return largest;
}

}  // namespace

// The energies show a leap of most of the mass; the nodes themselves are examined only then.
void expect_no_leap(Model& model, const KineticEnergy& kinetic) {
  const double most = most_widths * model.extent.width / model.times.next;
  if (!(most > 0) || kinetic.half - kinetic.now <= 0.5 * model.extent.mass * most * most) return;
  exchange_nodes(model.nodes);
  const Leap leap = largest_change(model.nodes, model.times.mean());
  if (!(leap.speed > most)) return;
  throw Breakdown(
      "forces move " + name_of_node(model, leap.node) + " " +
      written(leap.speed * model.times.next / model.extent.width) +
      " widths of the scene in one time step, at time " + written(model.times.time) +
      "; likely cause: loads that are too large for the masses they act on; check units, densities "
      "and loads of the deck");
}

void refuse_crowd(const Model& model) {
  const Nodes& nodes = model.nodes;
  Vector3d mean{0, 0, 0};
  for (std::size_t i = 0; i < nodes.size(); ++i)
    mean = mean + (nodes.mass[i] / model.extent.mass) * velocity(nodes, i);
  std::size_t fastest = 0;
  double largest = 0;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const Vector3d relative = velocity(nodes, i) - mean;
    if (const double squared = dot(relative, relative); squared > largest) {
      largest = squared;
      fastest = i;
    }
  }
  throw Breakdown(
      "too many contact candidates (all is near all) in one time step, at time " + written(model.times.time) +
      ": " + name_of_node(model, fastest) + " moves " +
      written(std::sqrt(largest) * model.times.next / model.extent.width) +
      " widths of the scene relative to the mean of all; likely cause: velocities or loads that are "
      "too large; check units, densities, velocities and loads of the deck");
}

}  // namespace brio
