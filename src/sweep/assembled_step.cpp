#include "src/sweep/assembled_step.hpp"

#include <algorithm>
#include <cmath>

#include "src/domains/node_ranges.hpp"

namespace brio {

namespace {

/// Gain over the elements' below which nodes are looked at now and then only.
constexpr double worthwhile_gain = 1.02;
constexpr std::int64_t looks_every = 50;
/// Steps from one estimate to the next, longer each time that it gains little over what held until then.
constexpr std::int64_t least_interval = 200, largest_interval = 800;
constexpr double little_gain = 0.95;  // of squares
/// Growth since the estimate, of its square, upon which it is made anew, but not sooner than after so many
/// steps.
constexpr double much_growth = 0.1;
constexpr std::int64_t soonest = 50;
/// Norm of the strain of an element in a time step up to which estimates lengthen it.
constexpr double largest_strain = 0.02;

bool is_estimated(const TimeSection& time, std::span<const Block> blocks) {
  if (time.step_bound != StepBound::assembled || time.step || time.step_scale > largest_scale_with_margin)
    return false;
  const auto gives = [](const Block& block) { return block.kernel.gives_stiffness; };
  return std::ranges::any_of(blocks, gives) && std::ranges::all_of(blocks, [&](const Block& block) {
           return !gives(block) || block.kernel.multiply_stiffness != nullptr;
         });
}

double stiffness_by_mass(const Nodes& nodes, std::size_t i) {
  double least =
      nodes.force[i].component[3] * nodes.record[i].inverse_mass;  // forces hold what is subtracted
  if (nodes.has_rotations())
    least = std::min(least, nodes.moment[i].component[3] * nodes.angular_velocity[i].component[3]);
  return -least;
}

NodalBound nodal_bound(AssembledStep& assembled, const Nodes& nodes, ThreadTeam& team) {
  const double estimate = assembled.frequency_squared;
  sum_node_ranges(nodes, assembled.bounds, team, [&](std::size_t begin, std::size_t end) {
    NodalBound bound;
    for (std::size_t i = begin; i < end; ++i) {
      const double now = stiffness_by_mass(nodes, i);
      bound.largest = std::max(bound.largest, now);
      if (estimate > 0)
        bound.growth = std::max(bound.growth, now - std::max(assembled.reference[i], estimate));
    }
    return bound;
  });
  NodalBound all;
  for (const NodalBound& bound : assembled.bounds) {
    all.largest = std::max(all.largest, bound.largest);
    all.growth = std::max(all.growth, bound.growth);
  }
  return all;
}

bool is_due(const AssembledStep& assembled, const NodalBound& bound, std::int64_t step) {
  if (assembled.vectors.empty()) return false;
  return step >= assembled.next_estimate || (bound.growth > much_growth * assembled.frequency_squared &&
                                             step >= assembled.estimated_at + soonest);
}

void estimate(AssembledStep& assembled, double damping, const NodalBound& nodal, std::int64_t step,
              SweepSchedule& schedule, std::span<Block> blocks, const Nodes& nodes, ThreadTeam& team) {
  for_node_ranges(nodes, team, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) assembled.reference[i] = stiffness_by_mass(nodes, i);
  });
  const double known = assembled.frequency_squared + assembled.damping + nodal.growth;
  const double until_now = assembled.frequency_squared > 0 ? std::min(known, nodal.largest) : nodal.largest;
  assembled.frequency_squared =
      assembled_frequency_squared(assembled.vectors, assembled.reference, schedule, blocks, nodes, team);
  assembled.damping = damping;
  const double found = assembled.frequency_squared + damping;
  assembled.interval = found < little_gain * until_now
                           ? least_interval
                           : std::clamp(2 * assembled.interval, least_interval, largest_interval);
  if (!(found < little_gain * nodal.largest)) assembled.frequency_squared = 0;
  assembled.estimated_at = step;
  assembled.next_estimate = step + assembled.interval;
}

}  // namespace

AssembledStep make_assembled_step(const TimeSection& time, bool is_used, std::span<const Block> blocks,
                                  const Nodes& nodes, double length) {
  AssembledStep assembled;
  if (!is_used) return assembled;
  assembled.bounds.resize(nodes.ranges.size());
  if (!is_estimated(time, blocks) || !(length > 0)) return assembled;
  assembled.reference.resize(nodes.size());
  assembled.vectors = make_lanczos_vectors(nodes, length);
  return assembled;
}

void start_anew(AssembledStep& assembled) {
  const AssembledStep fresh;
  assembled.gain = fresh.gain;
  assembled.frequency_squared = assembled.damping = 0;
  assembled.estimated_at = assembled.interval = 0;
  assembled.next_estimate = fresh.next_estimate;
}

double stable_step_of(double frequency_squared, double last) {
  if (last == 0) return 2 / std::sqrt(frequency_squared);
  const double share = 0.25 * frequency_squared * last * last;
  return share <= 1 ? last / std::sqrt(share) : last / share;
}

double assembled_stable_step(AssembledStep& assembled, const ElementBounds& elements, double last,
                             std::int64_t step, SweepSchedule& schedule, std::span<Block> blocks,
                             const Nodes& nodes, ThreadTeam& team) {
  if (assembled.bounds.empty()) return elements.stable_step;
  const bool is_looked_at = assembled.gain >= worthwhile_gain || assembled.frequency_squared > 0 ||
                            step % looks_every == 0 || is_due(assembled, {}, step);
  if (!is_looked_at) return elements.stable_step;
  NodalBound bound = nodal_bound(assembled, nodes, team);
  if (is_due(assembled, bound, step)) {
    estimate(assembled, elements.damping, bound, step, schedule, blocks, nodes, team);
    bound.growth = 0;
  }
  // Before the first time step those of longer elements count their damping at a longer one.
  const double nodal = bound.largest + (last > 0 ? 0 : elements.damping);
  double stable = std::max(elements.stable_step, stable_step_of(nodal, last));
  if (assembled.frequency_squared > 0) {
    const double estimate = assembled.frequency_squared + assembled.damping + bound.growth;
    const double longest = stable_step_of(estimate, last);
    const double strain = std::sqrt(elements.strain_rate_squared) * longest;
    stable = std::max(stable, strain > largest_strain ? largest_strain / strain * longest : longest);
  }
  assembled.gain = stable / elements.stable_step;
  return stable;
}

}  // namespace brio
