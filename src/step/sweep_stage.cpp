#include "src/step/sweep_stage.hpp"

#include <algorithm>
#include <cmath>

#include "src/base/breakdown.hpp"
#include "src/base/index.hpp"
#include "src/domains/sweep_domains.hpp"
#include "src/step/diagnosis.hpp"
#include "src/step/laid_open.hpp"
#include "src/sweep/release_ties.hpp"

namespace brio {

namespace {

void sweep_chunks(Model& model, ThreadTeam& team) {
  const NodalRows forces{model.nodes.force.data(), model.nodes.moment.data()};
  sweep_domains(model.schedule, forces, team, [&](std::size_t t) {
    const SweepTask& task = model.schedule.tasks[t];
    Block& block = model.blocks[task.block];
    model.sweep_results[t] = block.kernel.sweep(block, task.chunk, model.nodes, model.times.previous);
  });
}

// Forces between particles, after all have computed their stress.
void exchange_between_elements(Model& model, ThreadTeam& team) {
  const auto exchanges = [](const Block& block) { return block.kernel.exchange != nullptr; };
  if (std::none_of(model.blocks.begin(), model.blocks.end(), exchanges)) return;
  team.for_each(model.schedule.tasks.size(), [&](std::size_t t) {
    const SweepTask& task = model.schedule.tasks[t];
    Block& block = model.blocks[task.block];
    if (exchanges(block))
      model.sweep_results[t].viscous_energy +=
          block.kernel.exchange(block, task.chunk, model.nodes, model.times.previous);
  });
}

// Sums and the stable time step in the order of tasks, whatever the number of threads.
Contribution gather_results(Model& model, ThreadTeam& team) {
  Contribution energies;
  StepControl& control = model.control;
  control.stable = HUGE_VAL;
  ElementBounds bounds;  // of elements whose nodes have a stiffness
  double others = HUGE_VAL;
  for (std::size_t t = 0; t < model.schedule.tasks.size(); ++t) {
    const SweepTask& task = model.schedule.tasks[t];
    const SweepResult& result = model.sweep_results[t];
    model.element_updates += static_cast<std::int64_t>(task.chunk.element_count);
    PartEnergy& part = model.part_energy[task.block];
    part.internal += result.internal_energy;
    part.hourglass += result.hourglass_energy;
    energies.internal += result.internal_energy;
    energies.hourglass += result.hourglass_energy;
    energies.viscous += result.viscous_energy;
    if (model.blocks[task.block].kernel.gives_stiffness) {
      bounds.stable_step = std::min(bounds.stable_step, result.stable_step);
      bounds.damping = std::max(bounds.damping, result.damping);
      bounds.strain_rate_squared = std::max(bounds.strain_rate_squared, result.strain_rate_squared);
    } else {
      others = std::min(others, result.stable_step);
    }
    if (!(result.stable_step < control.stable)) continue;
    control.stable = result.stable_step;
    control.critical_block = task.block;
    control.critical_element = index(model.parts[task.block].element_order[result.critical_element]);
  }
  const bool are_any = bounds.stable_step > 0 && bounds.stable_step < HUGE_VAL;
  const double assembled =
      are_any ? assembled_stable_step(model.assembled_step, bounds, model.times.previous, model.step,
                                      model.schedule, model.blocks, model.nodes, team)
              : bounds.stable_step;
  control.stable = std::min(assembled, others) * model.ties.step_share;
  return energies;
}

}  // namespace

Contribution sweep_elements(Model& model, ThreadTeam& team) {
  const StageTimer timer(model.stages, Stage::elements);
  for (ParticleSearch& search : model.particle_searches)
    follow_neighbours(search, model.blocks[search.block], model.nodes, team);
  DomainExchange* exchange = model.schedule.exchange.get();
  if (exchange != nullptr) exchange->note_results(model.schedule, model.sweep_results);
  sweep_chunks(model, team);
  exchange_between_elements(model, team);
  if (exchange != nullptr) exchange->exchange_lists(model.schedule, model.sweep_results, model.blocks);
  const Contribution energies = gather_results(model, team);
  if (!(model.control.stable > 0))
    throw Breakdown(element_name(model, model.control.critical_block, model.control.critical_element) +
                    " has inverted or holds a value that is not a number, at time " +
                    written(model.times.time) + "; " + cause_of_collapse(model));
  return energies;
}

Contribution add_mass(Model& model) {
  if (!model.added_mass) return {};
  return hand_out(*model.added_mass, model.schedule, model.sweep_results, model.blocks, model.parts,
                  model.nodes, model.step == 0);
}

Contribution fail_ties(Model& model) {
  Ties& ties = model.ties;
  if (std::ranges::none_of(ties.found, &TiedParts::can_fail)) return {};
  const StageTimer timer(model.stages, Stage::ties);
  const std::optional<Contribution> failed = fail_ties(ties, model.times.previous, model.nodes);
  if (!failed) return {};
  for (ContactScene& scene : model.contacts) release_tied_pairs(scene, ties);
  return *failed;
}

Contribution remove_freed_nodes(Model& model) {
  if (!model.erosion) return {};
  for (ActiveLoad& load : model.loads) remove_nodes(load, model.erosion->dropping);
  return remove_nodes(*model.erosion, model.nodes);
}

namespace {

// Elements that are given up by all ranks, once what they hold is known to all.
bool gives_up_more(Model& model, ThreadTeam& team) {
  if (!give_up_crossed(model, team)) return false;
  if (DomainExchange* exchange = model.schedule.exchange.get())
    exchange->exchange_deleted(model.schedule, model.sweep_results, model.blocks);
  return true;
}

}  // namespace

Contribution erode_elements(Model& model, ThreadTeam& team) {
  Contribution sum;
  if (!model.erosion) return sum;
  const StageTimer timer(model.stages, Stage::erosion);
  Erosion& erosion = *model.erosion;
  do {
    sum += erode(erosion, model.schedule, model.sweep_results, model.blocks, model.parts);
    if (erosion.deleted.empty()) return sum;
    for (ActiveLoad& load : model.loads) remove_sides(load, erosion.deleted);
    for (ContactScene& scene : model.contacts) erode(scene, *model.surface_numbers, erosion.deleted);
    if (const std::optional<Contribution> released = release_ties(model.ties, erosion, model.nodes)) {
      sum += *released;
      for (ContactScene& scene : model.contacts) release_tied_pairs(scene, model.ties);
    }
  } while (gives_up_more(model, team));
  if (!is_sparse(model.schedule, model.blocks)) return sum;
  repack(model.schedule, model.blocks, model.parts, model.nodes.size());
  model.sweep_results.resize(model.schedule.tasks.size());
  return sum;
}

}  // namespace brio
