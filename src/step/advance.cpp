#include "src/step/advance.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "contact/audit/audit.hpp"
#include "src/motion/motion.hpp"
#include "src/step/choose_step.hpp"
#include "src/step/diagnosis.hpp"
#include "src/step/driven_bodies.hpp"
#include "src/step/laid_open.hpp"
#include "src/step/leap.hpp"
#include "src/sweep/release_ties.hpp"

namespace brio {

namespace {

bool has_loads(const Model& model) { return !model.loads.empty(); }

void apply_loads(Model& model) {
  if (!has_loads(model)) return;
  const StageTimer timer(model.stages, Stage::loads);
  for (ActiveLoad& load : model.loads) apply(load, model.times.time, model.nodes);
  gather_loads(model.rigid, model.loads, model.times.time, model.nodes);
}

double load_work(Model& model) {
  if (!has_loads(model)) return 0;
  const StageTimer timer(model.stages, Stage::loads);
  double sum = model.times.mean() * weight_power(model.rigid);
  for (const ActiveLoad& load : model.loads) sum += model.times.mean() * power(load, model.nodes);
  return sum;
}

void account_load_impulses(Model& model) {
  if (!has_loads(model)) return;
  const StageTimer timer(model.stages, Stage::loads);
  const auto add = [&](Impulse impulse) {
    for (std::size_t i = 0; i < 3; ++i) {
      impulse.linear[i] *= model.times.mean();
      impulse.angular[i] *= model.times.mean();
    }
    model.momentum.loads.add(impulse);
  };
  for (const ActiveLoad& load : model.loads) add(resultant(load, model.nodes));
  if (!model.rigid.empty()) add(weight(model.rigid));
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

// Internal forces by colours of chunks; sums and the stable time step in the order of tasks.
void sweep_elements(Model& model, ThreadTeam& team) {
  const StageTimer timer(model.stages, Stage::elements);
  for (ParticleSearch& search : model.particle_searches)
    follow_neighbours(search, model.blocks[search.block], model.nodes, team);
  const SweepSchedule& schedule = model.schedule;
  for (std::size_t colour = 0; colour + 1 < schedule.colour_first.size(); ++colour) {
    const std::size_t first = schedule.colour_first[colour];
    team.for_each(schedule.colour_first[colour + 1] - first, [&](std::size_t i) {
      const SweepTask& task = schedule.tasks[first + i];
      Block& block = model.blocks[task.block];
      model.sweep_results[first + i] =
          block.kernel.sweep(block, task.chunk, model.nodes, model.times.previous);
    });
  }
  exchange_between_elements(model, team);
  model.control.stable = HUGE_VAL;
  for (std::size_t t = 0; t < schedule.tasks.size(); ++t) {
    const SweepResult& result = model.sweep_results[t];
    model.element_updates += static_cast<std::int64_t>(schedule.tasks[t].chunk.element_count);
    PartEnergy& part = model.part_energy[schedule.tasks[t].block];
    part.internal += result.internal_energy;
    part.hourglass += result.hourglass_energy;
    model.energy.internal += result.internal_energy;
    model.energy.hourglass += result.hourglass_energy;
    model.energy.viscous += result.viscous_energy;
    if (result.stable_step < model.control.stable) {
      model.control.stable = result.stable_step;
      model.control.critical_block = schedule.tasks[t].block;
      model.control.critical_element = static_cast<std::size_t>(
          model.parts[model.control.critical_block].element_order[result.critical_element]);
    }
  }
  model.control.stable *= model.ties.step_share;
  if (!(model.control.stable > 0))
    throw Breakdown(element_name(model, model.control.critical_block, model.control.critical_element) +
                    " has inverted or holds a value that is not a number, at time " +
                    written(model.times.time) + "; " + cause_of_collapse(model));
}

void add_mass(Model& model) {
  if (!model.added_mass) return;
  hand_out(*model.added_mass, model.schedule, model.sweep_results, model.blocks, model.parts, model.nodes,
           model.energy, model.momentum, model.step == 0);
}

void account_support(Model& model, const Reaction& reaction) {
  model.energy.external.before += reaction.before;
  model.energy.external.after += reaction.after;
  model.momentum.supports.add(reaction.impulse);
}

// Before velocities: forces on tied nodes are transferred to the corners of their main faces.
void gather_tied_forces(Model& model) {
  if (model.ties.empty()) return;
  const StageTimer timer(model.stages, Stage::ties);
  gather_forces(model.ties, model.nodes);
}

// After any change of the velocities of main faces.
void carry_tied_nodes(Model& model) {
  if (model.ties.empty()) return;
  const StageTimer timer(model.stages, Stage::ties);
  carry_velocities(model.ties, model.nodes, model.times.next);
}

void constrain(Model& model) {
  if (model.prescribed.empty()) return;
  const StageTimer timer(model.stages, Stage::constraints);
  for (const PrescribedNodes& given : model.prescribed)
    account_support(model, prescribe(given, model.times, model.nodes));
}

void accelerate_rigid(Model& model, ThreadTeam& team) {
  if (model.rigid.empty()) return;
  const StageTimer timer(model.stages, Stage::rigid);
  account_support(model, accelerate(model.rigid, model.times));
  carry_velocities(model.rigid, model.nodes, team);
}

// After impulses of contact and walls on bodies: all of their nodes follow.
void carry_rigid(Model& model, ThreadTeam& team) {
  if (model.rigid.empty() || (model.contacts.empty() && model.walls.empty())) return;
  const StageTimer timer(model.stages, Stage::rigid);
  carry_velocities(model.rigid, model.nodes, team);
}

// To their positions at the start of the time step.
void move_contact_walls(Model& model) {
  model.contact_walls.resize(model.walls.size());
  for (std::size_t w = 0; w < model.walls.size(); ++w) {
    const RigidWall& wall = model.walls[w].wall;
    const Eigen::Vector3d velocity(wall.velocity.data());
    model.contact_walls[w] = {Eigen::Vector3d(wall.point.data()) + model.times.time * velocity,
                              Eigen::Vector3d(wall.normal.data()), velocity, wall.friction};
  }
}

void resolve_contact(Model& model, ThreadTeam& team) {
  if (model.contacts.empty()) return;
  const StageTimer timer(model.stages, Stage::contact);
  move_contact_walls(model);
  for (ContactScene& scene : model.contacts) {
    try {
      resolve(scene, model.nodes, model.times.next, team, model.rigid.motion, model.ties,
              model.contact_walls);
    } catch (const TooManyNear&) {
      refuse_crowd(model);
    }
    expect_driven_bodies_apart(model, scene);
    if (scene.unresolved.steps == 1 && scene.unresolved.time < 0) scene.unresolved.time = model.times.time;
    add_contact_impulses(model.rigid);
    const ContactStep& step = scene.step;
    model.stages[Stage::contact_search] += step.search_seconds;
    model.stages[Stage::contact] -= step.search_seconds;
    model.energy.contact.before += step.normal_work_before;
    model.energy.contact.after += step.normal_work_after;
    model.energy.friction.before += step.friction_work_before;
    model.energy.friction.after += step.friction_work_after;
    model.energy.external.before += step.support_work_before;
    model.energy.external.after += step.support_work_after;
    Impulse support;
    for (std::size_t i = 0; i < 3; ++i) {
      support.linear[i] = step.support_impulse[static_cast<Eigen::Index>(i)];
      support.angular[i] = step.support_moment[static_cast<Eigen::Index>(i)];
    }
    model.momentum.supports.add(support);
    Impulse walls;
    for (std::size_t i = 0; i < 3; ++i) {
      walls.linear[i] = step.wall_impulse[static_cast<Eigen::Index>(i)];
      walls.angular[i] = step.wall_moment[static_cast<Eigen::Index>(i)];
    }
    model.momentum.walls.add(walls);
  }
}

void account_wall(Model& model, const WallReaction& reaction) {
  model.energy.contact.before += reaction.normal.before;
  model.energy.contact.after += reaction.normal.after;
  model.energy.friction.before += reaction.friction.before;
  model.energy.friction.after += reaction.friction.after;
  model.momentum.walls.add(reaction.normal.impulse);
  model.momentum.walls.add(reaction.friction.impulse);
}

void stop_at_walls(Model& model) {
  if (model.walls.empty()) return;
  const StageTimer timer(model.stages, Stage::constraints);
  for (const WallInRun& wall : model.walls) {
    Reaction support_of_ties;
    if (!model.ties.empty()) stop_tied_at(wall, model.times, model.ties, model.nodes, support_of_ties);
    account_wall(model, stop_at(wall, model.times, model.nodes));
    if (!model.ties.empty()) {
      account_wall(model, reaction_of_tied(model.ties, model.times, model.nodes));
      account_support(model, support_of_ties);
    }
    for (std::size_t b = 0; b < model.rigid.body.size(); ++b) {
      Reaction support;
      account_wall(model, stop_at(wall, model.times, model.rigid.body[b], model.rigid.motion[b], model.nodes,
                                  support));
      account_support(model, support);
    }
    add_contact_impulses(model.rigid);
  }
}

// Kinetic energy of all nodes if they moved by the rounding error of the largest coordinate in a time step:
// the only energy of a scene at rest before its loads begin.
double energy_of_rounding(const Model& model) {
  double mass = 0, largest = 0;
  for (std::size_t i = 0; i < model.nodes.size(); ++i) {
    mass += model.nodes.mass[i];
    for (int axis = 0; axis < 3; ++axis)
      largest = std::max(largest, std::abs(model.nodes.record[i].position[axis]));
  }
  const double speed = std::numeric_limits<double>::epsilon() * largest / model.times.next;
  return 0.5 * mass * speed * speed;
}

// Hourglass energies below this fraction of the energy of the run are ignored.
constexpr double ignored_fraction = 1e-3;

void check_energy_balance(Model& model, double energy_error_limit) {
  EnergyBalance& energy = model.energy;
  if (model.step == 0) energy.reference = energy_of_rounding(model);
  energy.reference =
      std::max({energy.reference, energy.kinetic_start, std::abs(energy.sum()), energy.internal});
  energy.contact_added_max = std::max(energy.contact_added_max, energy.contact.at_step());
  const double error = energy.relative_error();
  energy.error_max = std::max(energy.error_max, std::abs(error));
  if (!(std::abs(error) <= energy_error_limit))
    throw Breakdown((std::isfinite(error) ? "the energy error " + written(error) +
                                                " exceeds numerics.energy_error_limit at time "
                                          : "the energy is not a number at time ") +
                    written(model.times.time) + "; " + cause_of_energy_error(model));
  for (PartEnergy& part : model.part_energy)
    part.note_ratio(model.times.time, ignored_fraction * energy.reference, model.hourglass_warning);
}

}  // namespace

// After the sweep, whose order of elements it changes, and before contact, whose surfaces it opens.
void erode_elements(Model& model, ThreadTeam& team) {
  if (!model.erosion) return;
  const StageTimer timer(model.stages, Stage::erosion);
  Erosion& erosion = *model.erosion;
  do {
    erode(erosion, model.schedule, model.sweep_results, model.blocks, model.parts, model.energy);
    if (erosion.deleted.empty()) return;
    for (ActiveLoad& load : model.loads) remove_sides(load, erosion.deleted);
    for (ContactScene& scene : model.contacts) erode(scene, *model.surface_numbers, erosion.deleted);
    if (release_ties(model.ties, erosion, model.nodes, model.energy, model.momentum))
      for (ContactScene& scene : model.contacts) release_tied_pairs(scene, model.ties);
  } while (give_up_crossed(model, team));
  if (!is_sparse(model.schedule, model.blocks)) return;
  model.schedule = repack(model.schedule, model.blocks, model.parts, model.nodes.size());
  model.sweep_results.resize(model.schedule.tasks.size());
}

void update_velocities(Model& model, double energy_error_limit, ThreadTeam& team) {
  EnergyBalance& energy = model.energy;
  for (Work* work : {&energy.external, &energy.contact, &energy.friction}) work->begin_step();

  if (model.erosion) {
    for (ActiveLoad& load : model.loads) remove_nodes(load, model.erosion->dropping);
    remove_nodes(*model.erosion, model.nodes, energy, model.momentum);
  }
  apply_loads(model);
  sweep_elements(model, team);
  add_mass(model);
  erode_elements(model, team);
  gather_tied_forces(model);
  choose_step(model);
  energy.external.before += load_work(model);
  KineticEnergy kinetic;
  {
    const StageTimer timer(model.stages, Stage::nodes);
    kinetic = accelerate(model.nodes, model.times.mean(), model.kinetic_sums, team);
  }
  expect_no_leap(model, kinetic);
  constrain(model);
  carry_tied_nodes(model);
  accelerate_rigid(model, team);
  resolve_contact(model, team);
  stop_at_walls(model);
  carry_rigid(model, team);
  energy.external.after += load_work(model);
  account_load_impulses(model);
  if (!model.nodes.velocity_before.empty()) {
    const StageTimer timer(model.stages, Stage::nodes);
    kinetic = kinetic_energy(model.nodes, model.kinetic_sums, team);
  }
  const KineticEnergy rigid = kinetic_energy(model.rigid);
  energy.kinetic = kinetic.now + rigid.now;
  energy.kinetic_half = kinetic.half + rigid.half;
  check_energy_balance(model, energy_error_limit);
}

void audit_contacts(Model& model, ThreadTeam& team) {
  if (!model.contact_audits) return;
  const StageTimer timer(model.stages, Stage::audit);
  ContactAudits& audits = *model.contact_audits;
  Audit now;
  for (const ContactScene& scene : model.contacts) now += audit(scene, model.nodes, team);
  if (now.deepest_crossing.depth > audits.found.deepest_crossing.depth)
    audits.time_of_deepest_crossing = model.times.time;
  if (now.deepest_too_close.depth > audits.found.deepest_too_close.depth)
    audits.time_of_deepest_too_close = model.times.time;
  audits.found += now;
  ++audits.dumps;
  if (now.crossings > 0) ++audits.crossed_dumps;
}

void update_positions(Model& model, ThreadTeam& team) {
  {
    const StageTimer timer(model.stages, Stage::nodes);
    move(model.nodes, model.times.next, team);
  }
  if (!model.ties.empty()) {
    const StageTimer timer(model.stages, Stage::ties);
    place(model.ties, model.nodes, model.times.next);
  }
  if (!model.rigid.empty()) {
    const StageTimer timer(model.stages, Stage::rigid);
    const Reaction reaction = move(model.rigid, model.times.next, model.nodes, team);
    model.energy.external.half += reaction.after;
    model.momentum.supports.add(reaction.impulse);
  }
  model.times.time += model.times.next;
  if (model.control.settings.end - model.times.time < 1e-12 * model.control.settings.end)
    model.times.time = model.control.settings.end;
  model.times.previous = model.times.next;
  ++model.step;
}

}  // namespace brio
