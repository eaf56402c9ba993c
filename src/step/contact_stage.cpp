#include "src/step/contact_stage.hpp"

#include "src/step/driven_bodies.hpp"
#include "src/step/leap.hpp"

namespace brio {

namespace {

// To their positions at the start of the time step.
void move_contact_walls(Model& model) {
  model.contact_walls.resize(model.walls.size());
  for (std::size_t w = 0; w < model.walls.size(); ++w) {
    const RigidWall& wall = model.walls[w].wall;
    const Vector3d velocity = wall.velocity;
    model.contact_walls[w] = {wall.point + model.times.time * velocity, wall.normal, velocity, wall.friction};
  }
}

Contribution contribution_of(const ContactStep& step) {
  return {.external = {.before = step.support_work_before + step.wall_work,
                       .after = step.support_work_after + step.wall_work},
          .contact = {.before = step.normal_work_before, .after = step.normal_work_after},
          .friction = {.before = step.friction_work_before, .after = step.friction_work_after},
          .supports = {step.support_impulse, step.support_moment},
          .walls = {step.wall_impulse, step.wall_moment}};
}

void add_forces(ForceSums& sums, const ContactScene& scene, std::span<const WallInRun> walls) {
  sums.add(*scene.log);
  for (std::size_t w = 0; w < scene.walls.push.size(); ++w) {
    const Vector3d& on_wall = scene.walls.push[w].impulse;
    sums.add_reaction(walls[w].condition, {-on_wall.x, -on_wall.y, -on_wall.z});
  }
}

Contribution resolve_scene(ContactScene& scene, Model& model, ThreadTeam& team) {
  try {
    resolve(scene, model.nodes, model.times.next, team, model.rigid.motion, model.ties, model.contact_walls);
  } catch (const TooManyNear&) {
    refuse_crowd(model);
  }
  expect_driven_bodies_apart(model, scene);
  if (scene.unresolved.steps == 1 && scene.unresolved.time < 0) scene.unresolved.time = model.times.time;
  add_contact_impulses(model.rigid);
  model.stages[Stage::contact_search] += scene.step.search_seconds;
  model.stages[Stage::contact] -= scene.step.search_seconds;
  if (model.forces) add_forces(*model.forces, scene, model.walls);
  model.impulse_sums.add(scene, model.nodes.size(), model.times.mean());
  return contribution_of(scene.step);
}

NodesInContact nodes_in_contact(const Model& model) {
  return {model.contacts.empty() ? std::span<const int>() : model.contacts.front().surface.slave_of};
}

Contribution stop_body(const WallInRun& wall, std::size_t b, Model& model) {
  const Contribution sum = stop_at(wall, model.times, nodes_in_contact(model), model.rigid.body[b],
                                   model.rigid.motion[b], model.nodes);
  if (model.forces) model.forces->add_support_of_body(b, sum.supports.linear);
  return sum;
}

Contribution stop_tied(const WallInRun& wall, Model& model) {
  Contribution sum;
  const Reaction supports = stop_tied_at(wall, model.times, nodes_in_contact(model), model.ties, model.nodes);
  sum += of_wall(stop_at(wall, model.times, nodes_in_contact(model), model.nodes), wall);
  sum += of_wall(reaction_of_tied(model.ties, model.times, model.nodes), wall);
  sum += of_support(supports);
  return sum;
}

}  // namespace

Contribution resolve_contact(Model& model, ThreadTeam& team) {
  Contribution sum;
  if (model.contacts.empty()) return sum;
  const StageTimer timer(model.stages, Stage::contact);
  move_contact_walls(model);
  for (ContactScene& scene : model.contacts) sum += resolve_scene(scene, model, team);
  return sum;
}

Contribution stop_at_walls(Model& model) {
  Contribution sum;
  if (model.walls.empty()) return sum;
  const StageTimer timer(model.stages, Stage::constraints);
  for (const WallInRun& wall : model.walls) {
    Contribution one = model.ties.empty()
                           ? of_wall(stop_at(wall, model.times, nodes_in_contact(model), model.nodes), wall)
                           : stop_tied(wall, model);
    for (std::size_t b = 0; b < model.rigid.body.size(); ++b) one += stop_body(wall, b, model);
    add_contact_impulses(model.rigid);
    if (model.forces) model.forces->add_reaction(wall.condition, one.walls.linear);
    sum += one;
  }
  return sum;
}

}  // namespace brio
