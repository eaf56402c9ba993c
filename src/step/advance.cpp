#include "src/step/advance.hpp"

#include <algorithm>

#include "contact/audit/audit.hpp"
#include "src/motion/motion.hpp"
#include "src/step/check_energy.hpp"
#include "src/step/choose_step.hpp"
#include "src/step/contact_stage.hpp"
#include "src/step/leap.hpp"
#include "src/step/sweep_stage.hpp"

namespace brio {

namespace {

void apply_loads(Model& model) {
  if (model.loads.empty()) return;
  const StageTimer timer(model.stages, Stage::loads);
  for (ActiveLoad& load : model.loads) apply(load, model.times.time, model.nodes);
}

// Elastic forces at the present positions, and their bound of the time step.
Contribution stretch_springs(Model& model) {
  if (model.springs.empty()) return {};
  const StageTimer timer(model.stages, Stage::loads);
  const Contribution sum = stretch(model.springs, model.times.previous, model.rigid, model.nodes);
  model.control.stable = bound_step(model.springs, model.control.stable, model.rigid, model.nodes);
  return sum;
}

// With the present velocities.
double load_work(Model& model) {
  if (model.loads.empty()) return 0;
  const StageTimer timer(model.stages, Stage::loads);
  double sum = model.times.mean() * load_power(model.rigid);
  for (const ActiveLoad& load : model.loads) sum += model.times.mean() * power(load, model.nodes);
  return sum;
}

Impulse load_impulse(Model& model) {
  Impulse force;
  if (model.loads.empty()) return force;
  const StageTimer timer(model.stages, Stage::loads);
  for (const ActiveLoad& load : model.loads) force += resultant(load, model.nodes);
  if (!model.rigid.empty()) force += load_resultant(model.rigid);
  force *= model.times.mean();
  return force;
}

// All other forces of the step are known, but those of damping.
Contribution pull_dashpots(Model& model) {
  if (model.springs.empty()) return {};
  const StageTimer timer(model.stages, Stage::loads);
  return pull_dashpots(model.springs, model.times.mean(), model.rigid, model.nodes);
}

// All other forces of the step are known.
Contribution damp_nodes(Model& model) {
  if (model.damping.empty()) return {};
  const StageTimer timer(model.stages, Stage::loads);
  damp(model.damping, model.times.mean(), model.nodes);
  return {.damping = {.before = model.times.mean() * power(model.damping, model.nodes)}};
}

// With the velocities at the end of the step.
Contribution damping_done(Model& model) {
  Contribution sum;
  if (model.damping.empty() && model.springs.empty()) return sum;
  const StageTimer timer(model.stages, Stage::loads);
  if (!model.springs.empty())
    sum += dashpots_done(model.springs, model.times.mean(), model.rigid, model.nodes);
  if (model.damping.empty()) return sum;
  Impulse impulse = resultant(model.damping, model.nodes);
  impulse *= model.times.mean();
  sum += {.damping = {.after = model.times.mean() * power(model.damping, model.nodes)}, .loads = impulse};
  return sum;
}

// Before velocities: forces on tied nodes are transferred to the corners of their main faces.
void gather_tied_forces(Model& model) {
  if (model.ties.empty()) return;
  const StageTimer timer(model.stages, Stage::ties);
  gather_forces(model.ties, model.nodes);
}

// Forces of loads, springs and joined elements on rigid bodies.
void gather_rigid_forces(Model& model) {
  const bool by_parts = !model.springs.empty() || model.rigid.has_joints();
  if (model.rigid.empty() || (model.loads.empty() && !by_parts)) return;
  const StageTimer timer(model.stages, Stage::loads);
  const auto is_gravity = [](const ActiveLoad& load) {
    return std::holds_alternative<GravityLoad>(load.load);
  };
  const bool by_nodes = by_parts || !std::ranges::all_of(model.loads, is_gravity);
  gather_forces(model.rigid, model.loads, model.times.time, by_nodes, model.nodes);
  turn_bodies(model.springs, model.rigid);
}

KineticEnergy accelerate_nodes(Model& model, ThreadTeam& team) {
  const StageTimer timer(model.stages, Stage::nodes);
  return accelerate(model.nodes, model.times.mean(), model.kinetic_sums, team);
}

// Prescribed motion of nodes.
Contribution constrain(Model& model) {
  Contribution sum;
  if (model.prescribed.empty()) return sum;
  const StageTimer timer(model.stages, Stage::constraints);
  for (PrescribedNodes& given : model.prescribed) {
    const Reaction support = prescribe(given, model.times, model.nodes);
    if (model.forces) add_reactions(*model.forces, given, support.impulse.linear);
    sum += of_support(support);
  }
  for (const PrescribedNodes& given : model.prescribed)
    if (given.is_skew()) sum += {.external = {.after = work_after(given, model.nodes)}};
  return sum;
}

// After any change of the velocities of main faces.
void carry_tied_nodes(Model& model) {
  if (model.ties.empty()) return;
  const StageTimer timer(model.stages, Stage::ties);
  carry_velocities(model.ties, model.nodes, model.times.next);
}

Contribution accelerate_rigid(Model& model, ThreadTeam& team) {
  if (model.rigid.empty()) return {};
  const StageTimer timer(model.stages, Stage::rigid);
  const Reaction supports = accelerate(model.rigid, model.times);
  if (model.forces) add_reactions(*model.forces, model.rigid);
  carry_velocities(model.rigid, model.nodes, team);
  return of_support(supports);
}

// After impulses of contact and walls on bodies: all of their nodes follow.
void carry_rigid(Model& model, ThreadTeam& team) {
  if (model.rigid.empty() || (model.contacts.empty() && model.walls.empty())) return;
  const StageTimer timer(model.stages, Stage::rigid);
  carry_velocities(model.rigid, model.nodes, team);
}

// Of nodes and rigid bodies, once supports, contact and walls have changed velocities.
KineticEnergy kinetic_energy_of(Model& model, KineticEnergy accelerated, ThreadTeam& team) {
  if (!model.nodes.velocity_before.empty()) {
    const StageTimer timer(model.stages, Stage::nodes);
    accelerated = kinetic_energy(model.nodes, model.kinetic_sums, team);
  }
  const KineticEnergy rigid = kinetic_energy(model.rigid);
  return {accelerated.half + rigid.half, accelerated.now + rigid.now};
}

void move_nodes(Model& model, ThreadTeam& team) {
  const StageTimer timer(model.stages, Stage::nodes);
  move(model.nodes, model.times.next, team);
}

// Where the deck asks for rotations.
void turn_nodes(Model& model, ThreadTeam& team) {
  if (model.rotations.empty()) return;
  const StageTimer timer(model.stages, Stage::nodes);
  turn(model.rotations, model.nodes, model.times.next, team);
}

void place_tied_nodes(Model& model) {
  if (model.ties.empty()) return;
  const StageTimer timer(model.stages, Stage::ties);
  place(model.ties, model.nodes, model.times.next);
}

// The supports of prescribed rotations do their work before the next half step.
Contribution move_rigid(Model& model, ThreadTeam& team) {
  if (model.rigid.empty()) return {};
  const StageTimer timer(model.stages, Stage::rigid);
  const Reaction supports = move(model.rigid, model.times.next, model.nodes, team);
  return {.external = {.half = supports.after}, .supports = supports.impulse};
}

// A model as built has no time step yet.
bool is_complete(const Model& model) { return model.times.next > 0; }

void advance_time(Model& model) {
  model.times.time += model.times.next;
  if (model.control.settings.end - model.times.time < 1e-12 * model.control.settings.end)
    model.times.time = model.control.settings.end;
  model.times.previous = model.times.next;
  ++model.step;
}

/// Adds what a stage returns to both balances.
struct Balances {
  EnergyBalance& energy;
  MomentumBalance& momentum;

  void operator+=(const Contribution& stage) {
    energy += stage;
    momentum += stage;
  }
};

}  // namespace

void update_velocities(Model& model, double energy_error_limit, ThreadTeam& team) {
  Balances balance{model.energy, model.momentum};
  model.energy.begin_step();
  balance += remove_freed_nodes(model);

  apply_loads(model);
  if (model.forces) note_loads(*model.forces, model.nodes);
  balance += sweep_elements(model, team);
  if (model.forces) measure_sections(*model.forces, model.nodes);
  balance += add_mass(model);
  balance += erode_elements(model, team);
  balance += fail_ties(model);
  balance += stretch_springs(model);
  gather_tied_forces(model);
  gather_rigid_forces(model);
  choose_step(model);
  if (model.forces) begin_step(*model.forces, model.times.mean());

  balance += {.external = {.before = load_work(model)}};
  balance += pull_dashpots(model);
  balance += damp_nodes(model);
  const KineticEnergy accelerated = accelerate_nodes(model, team);
  expect_no_leap(model, accelerated);
  balance += constrain(model);
  carry_tied_nodes(model);
  balance += accelerate_rigid(model, team);
  balance += resolve_contact(model, team);
  balance += stop_at_walls(model);
  carry_rigid(model, team);
  balance += {.external = {.after = load_work(model)}, .loads = load_impulse(model)};
  balance += damping_done(model);

  const KineticEnergy kinetic = kinetic_energy_of(model, accelerated, team);
  model.energy.kinetic = kinetic.now;
  model.energy.kinetic_half = kinetic.half;
  check_energy_balance(model, energy_error_limit);
}

void update_positions(Model& model, ThreadTeam& team) {
  move_nodes(model, team);
  turn_nodes(model, team);
  place_tied_nodes(model);
  Balances{model.energy, model.momentum} += move_rigid(model, team);
  advance_time(model);
}

void run(Model& model, double energy_error_limit, ThreadTeam& team, const Observer& observe) {
  if (!is_complete(model)) update_velocities(model, energy_error_limit, team);
  while (observe(model) && model.times.time < model.control.settings.end) {
    update_positions(model, team);
    update_velocities(model, energy_error_limit, team);
  }
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

}  // namespace brio
