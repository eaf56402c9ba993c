#include "src/sweep/mass_scaling.hpp"

#include <algorithm>
#include <numeric>

#include "src/base/breakdown.hpp"
#include "src/base/index.hpp"

namespace brio {

namespace {

struct Given {
  double energy = 0;
  Impulse impulse;
};

void give(double mass, double inertia, std::size_t node, Nodes& nodes, Given& given) {
  NodeRecord& record = nodes.record[node];
  const Vector3d position = vector_at(record.position);
  const Vector3d velocity = vector_at(record.velocity);
  nodes.mass[node] += mass;
  record.inverse_mass = 1 / nodes.mass[node];
  given.energy += 0.5 * mass * dot(velocity, velocity);
  given.impulse.add(position, {mass * velocity[0], mass * velocity[1], mass * velocity[2]});
  if (inertia == 0) return;
  double* spin = nodes.angular_velocity[node].component;
  nodes.rotational_inertia[node] += inertia;
  spin[3] = 1 / nodes.rotational_inertia[node];
  given.energy += 0.5 * inertia * (spin[0] * spin[0] + spin[1] * spin[1] + spin[2] * spin[2]);
  for (std::size_t i = 0; i < 3; ++i) given.impulse.angular[i] += inertia * spin[i];
}

void check_share(const AddedMass& mass, std::span<const PartInModel> parts) {
  if (!(mass.share() > mass.settings.largest_share)) return;
  const auto most = std::max_element(mass.added.begin(), mass.added.end()) - mass.added.begin();
  throw Breakdown("mass scaling has added " + std::to_string(100 * mass.share()) +
                  " % to the mass, most to part '" + parts[index(most)].name +
                  "'; accepted is up to time.mass_scaling.largest_share, or a shorter step");
}

bool joins_rigid(const Merge& merge, const Deck& deck) {
  return std::ranges::any_of(deck.parts, [&](const Part& part) {
    return std::holds_alternative<Rigid>(part.element) &&
           std::ranges::find(merge.parts, part.name) != merge.parts.end();
  });
}

}  // namespace

double AddedMass::total() const { return std::accumulate(added.begin(), added.end(), 0.0); }

AddedMass make_mass_scaling(const TimeSection& time, const Deck& deck, std::span<Block> blocks,
                            std::span<const PartInModel> parts) {
  AddedMass mass{.settings = *time.mass_scaling, .added = std::vector<double>(parts.size())};
  for (const Connection& connection : deck.connections)
    if (std::holds_alternative<TieToSurface>(connection))
      throw BuildError(
          "time.mass_scaling does not go with 'tie' in connections: the mass of tied nodes is on the nodes "
          "of the main surface",
          mass.settings.place);
    else if (const auto* merge = std::get_if<Merge>(&connection);
             merge != nullptr && joins_rigid(*merge, deck))
      throw BuildError(
          "time.mass_scaling does not go with 'merge' of a rigid part, which has the mass of shared nodes",
          mass.settings.place);
  for (std::size_t p = 0; p < parts.size(); ++p) {
    Block& block = blocks[parts[p].block];
    if (!traits_of(block.element).gains_mass) continue;
    if (block.deletion.volume_ratio)
      throw BuildError("deletion.volume_ratio of part '" + parts[p].name +
                           "' is judged by mass and does not go with time.mass_scaling",
                       deck.parts[p].place);
    mass.elements += parts[p].mass;
    scale_to(mass.settings.step / time.step_scale, block);
  }
  if (mass.elements == 0)
    throw BuildError("time.mass_scaling has nothing to act on: particles and rigid parts get no mass",
                     mass.settings.place);
  return mass;
}

Contribution hand_out(AddedMass& mass, const SweepSchedule& schedule, std::span<const SweepResult> results,
                      std::span<const Block> blocks, std::span<const PartInModel> parts, Nodes& nodes,
                      bool at_start) {
  Given given;
  for (std::size_t t = 0; t < schedule.tasks.size(); ++t) {
    const SweepTask& task = schedule.tasks[t];
    const Block& block = blocks[task.block];
    const std::size_t first = task.chunk.first_pack * index(block.lanes);
    for (std::size_t i = 0; i < results[t].scaled; ++i) {
      const auto element = index(block.scaled[first + i]);
      const int corners = nodes_per_element(block.element);
      const double share = block.mass_gain[element] / corners;
      const double inertia = has_rotations(block.element) ? share * block.kernel.gyration(block, element) : 0;
      for (int corner = 0; corner < corners; ++corner)
        give(share, inertia, index(block.node(element, corner)), nodes, given);
      mass.added[task.block] += block.mass_gain[element];
    }
  }
  check_share(mass, parts);
  if (at_start) return {.kinetic_start = given.energy, .start = given.impulse};
  return {.external = {.half = given.energy}, .supports = given.impulse};
}

}  // namespace brio
