#include "contact/scene.hpp"

#include <algorithm>
#include <cassert>
#include <chrono>

#include "contact/exclusion.hpp"
#include "contact/face_geometry.hpp"
#include "contact/resolution.hpp"

namespace brio {

using Eigen::Vector3d;

namespace {

using Clock = std::chrono::steady_clock;
double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

void load_motion(ContactScene& scene, const Nodes& nodes, const Ties& ties) {
  scene.in_contact.clear();
  if (!ties.empty()) {
    find_held(scene.held, scene.surface, ties, scene.contacts, scene.in_contact);
    load_outside(scene.held, nodes);
  }
  for (const Contact& contact : scene.contacts)
    for (int slave : contact.node) scene.in_contact.insert(slave);
  scene.in_contact.for_each([&](std::size_t s) {
    const auto node = static_cast<std::size_t>(scene.surface.node[s]);
    for (int axis = 0; axis < 3; ++axis) {
      scene.motion[s].velocity[axis] = nodes.record[node].velocity[axis];
      scene.motion[s].inverse_mass[axis] = nodes.free_inverse_mass(node, axis);
      // Not a support: its corners take what it is given.
      if (ties.holds(scene.surface.node[s])) scene.motion[s].inverse_mass[axis] = 1;
    }
  });
}

void store_velocities(const ContactScene& scene, Nodes& nodes) {
  scene.in_contact.for_each([&](std::size_t s) {
    double* v = nodes.record[static_cast<std::size_t>(scene.surface.node[s])].velocity;
    for (int axis = 0; axis < 3; ++axis) v[axis] = scene.motion[s].velocity[axis];
  });
}

void book_work(ContactScene& scene, const Nodes& nodes) {
  ContactStep& step = scene.step;
  scene.pushed.for_each([&](std::size_t s) {
    if (scene.surface.rigid_body(scene.surface.node[s]) >= 0) return;  // booked with its body
    const ContactMotion& motion = scene.motion[s];
    const Vector3d before(nodes.velocity_before[static_cast<std::size_t>(scene.surface.node[s])].component);
    const Vector3d after(motion.velocity);
    step.normal_work_before += scene.normal_impulse[s].dot(before);
    step.normal_work_after += scene.normal_impulse[s].dot(after);
    step.friction_work_before += scene.friction_impulse[s].dot(before);
    step.friction_work_after += scene.friction_impulse[s].dot(after);
    Vector3d reaction = Vector3d::Zero();
    for (int axis = 0; axis < 3; ++axis)
      if (motion.inverse_mass[axis] == 0)
        reaction[axis] = -scene.normal_impulse[s][axis] - scene.friction_impulse[s][axis];
    step.support_work_before += reaction.dot(before);
    step.support_work_after += reaction.dot(after);
    step.support_impulse += reaction;
    step.support_moment += position(nodes, scene.surface.node[s]).cross(reaction);
  });
}

void book_rigid_work(ContactScene& scene, std::span<const RigidMotion> bodies) {
  const RigidWork work = scene.rigid.work(scene.contacts, bodies);
  ContactStep& step = scene.step;
  step.normal_work_before += work.normal_before;
  step.normal_work_after += work.normal_after;
  step.friction_work_before += work.friction_before;
  step.friction_work_after += work.friction_after;
  step.support_work_before += work.support_before;
  step.support_work_after += work.support_after;
  step.support_impulse += work.support_impulse;
  step.support_moment += work.support_moment;
}

void book(ContactScene& scene, const Nodes& nodes, std::span<const RigidMotion> bodies) {
  count_contacts(scene);
  if (scene.step.active > 0) book_work(scene, nodes);
  if (scene.step.active > 0 && !bodies.empty()) book_rigid_work(scene, bodies);
  add_to_totals(scene);
}

void search_lines_anew(ContactScene& scene, const Nodes& nodes, ThreadTeam& team) {
  const Clock::time_point start = Clock::now();
  search_lines(scene.lines->candidates, scene.candidates, scene.surface, scene.options, nodes, team);
  renumber(scene.lines->candidates, scene.contacts);
  scene.step.line_seconds += seconds_since(start);
}

}  // namespace

void sum_impulses(ContactScene& scene) {
  scene.pushed.for_each([&](std::size_t s) {
    scene.normal_impulse[s].setZero();
    scene.friction_impulse[s].setZero();
  });
  scene.pushed.clear();
  for (const Contact& contact : scene.contacts) {
    if (contact.impulse == 0) continue;
    for (std::size_t k = 0; k < 5; ++k) {
      const auto s = static_cast<std::size_t>(contact.node[k]);
      scene.pushed.insert(contact.node[k]);
      scene.normal_impulse[s] += contact.weight[k] * contact.impulse * contact.normal;
      scene.friction_impulse[s] += contact.weight[k] * contact.friction;
    }
  }
}

void count_contacts(ContactScene& scene) {
  ContactStep& step = scene.step;
  step.contacts = static_cast<int>(scene.contacts.size());
  for (const Contact& contact : scene.contacts) {
    step.deepest_overlap = std::max(step.deepest_overlap, -contact.gap);
    if (contact.impulse > 0) ++step.active;
  }
}

void add_to_totals(ContactScene& scene) {
  const ContactStep& step = scene.step;
  ContactTotals& totals = scene.totals;
  ++totals.steps;
  totals.contacts += static_cast<std::uint64_t>(step.contacts);
  totals.most_contacts = std::max(totals.most_contacts, step.contacts);
  totals.normal_work += step.normal_work();
  totals.normal_work_added += std::max(0.0, step.normal_work());
  totals.largest_normal_work = std::max(totals.largest_normal_work, totals.normal_work);
  totals.friction_work += step.friction_work();
  totals.deepest_overlap = std::max(totals.deepest_overlap, step.deepest_overlap);
}

ContactScene make_contact_scene(const ContactOptions& options, std::span<const SurfacePart> parts,
                                const Nodes& nodes) {
  ContactScene scene;
  scene.options = options;
  scene.surface = make_surface(parts, nodes.size());
  scene.excluded = excluded_faces(scene.surface, nodes);
  scene.candidates = Candidates(options.search);
  if (options.edges || !scene.surface.round.empty()) {
    scene.lines.emplace(options.search);
    collect_lines(scene.surface, options, nodes, scene.lines->candidates.line, scene.lines->candidates.ends);
  }
  if (options.rule == DetectionRule::distance) {
    scene.distance.emplace();
    measure(scene.distance->features, scene.surface, nodes);
    collect(scene.distance->features, scene.surface, options);
    scene.candidates.smallest_edge = scene.distance->features.smallest_edge;
    scene.candidates.mean_edge = scene.distance->features.mean_edge;
  }
  const std::size_t slaves = scene.surface.slaves();
  scene.motion.resize(slaves);
  scene.in_contact = scene.pushed = SlaveSet(slaves);
  scene.normal_impulse.resize(slaves, Vector3d::Zero());
  scene.friction_impulse.resize(slaves, Vector3d::Zero());
  return scene;
}

void find_contacts(ContactScene& scene, const Nodes& nodes, ThreadTeam& team) {
  const Clock::time_point start = Clock::now();
  scene.step.searched =
      refresh(scene.candidates, scene.surface, scene.excluded, scene.options, nodes, scene.travel, team);
  scene.step.search_seconds = seconds_since(start);
  if (scene.step.searched && scene.lines) search_lines_anew(scene, nodes, team);
  if (scene.erosion && !scene.erosion->growing.empty()) grow_debris(scene, nodes);
  scene.last.swap(scene.contacts);
  detect(scene.detection, scene.surface, scene.candidates, scene.options, nodes, scene.travel, scene.last,
         team, scene.contacts);
  scene.candidates.renewed.clear();
  if (!scene.lines || scene.lines->candidates.partners.item.empty()) return;
  const Clock::time_point lines = Clock::now();
  detect_lines(*scene.lines, scene.surface, scene.options, scene.candidates, nodes, scene.travel, scene.last,
               team, scene.contacts);
  scene.step.line_seconds += seconds_since(lines);
}

void hold(ContactScene& scene, const Ties& ties, const std::vector<int>& part_of_surface) {
  scene.surface.held = held_pairs(scene.surface, ties, part_of_surface);
  scene.held.way.resize(scene.surface.slave_of.size());
}

void let_go(ContactScene& scene, const Ties& ties) {
  renew(scene.surface.held, scene.surface, ties);
  scene.candidates.growth[0] = -1;
}

namespace {

void solve_constraints(ContactScene& scene, const ContactOptions& options, const Nodes& nodes, double dt,
                       std::span<RigidMotion> bodies, const Ties& ties) {
  load_motion(scene, nodes, ties);
  const double edge = scene.candidates.smallest_edge;
  if (!ties.empty()) {
    scene.rigid.find(scene.surface, nodes, scene.contacts, bodies);
    solve(scene.solver, options, edge, dt, scene.contacts,
          HeldMotion{MixedMotion{scene.contacts, scene.rigid.touch, scene.motion, bodies}, scene.held,
                     scene.held.outside_motion});
  } else if (bodies.empty()) {
    solve(scene.solver, options, edge, dt, scene.contacts, scene.motion);
  } else {
    scene.rigid.find(scene.surface, nodes, scene.contacts, bodies);
    solve(scene.solver, options, edge, dt, scene.contacts,
          MixedMotion{scene.contacts, scene.rigid.touch, scene.motion, bodies});
  }
  scene.step.passes = scene.solver.passes_done;
  scene.step.residual = scene.solver.residual;
}

void store_solution(ContactScene& scene, Nodes& nodes, double dt, const Ties& ties) {
  if (!scene.contacts.empty()) store_velocities(scene, nodes);
  sum_impulses(scene);
  if (!ties.empty() && !scene.contacts.empty()) {
    store_outside(scene.held, nodes);
    pass_on(scene, ties, nodes, dt);
  }
}

}  // namespace

void resolve(ContactScene& scene, Nodes& nodes, double dt, ThreadTeam& team, std::span<RigidMotion> bodies,
             const Ties& ties, std::span<const ContactWall> walls) {
  assert(nodes.velocity_before.size() == nodes.size());
  scene.step = ContactStep{};
  if (scene.surface.node.empty()) return;
  if (scene.distance) {
    resolve_by_distances(scene, nodes, dt, team, bodies, ties, walls);
    scene.last_dt = dt;
    return;
  }
  if (scene.erosion && !scene.erosion->exclusion.torn.empty()) release_torn_pairs(scene, nodes, team);
  scene.travel.follow(scene.surface, nodes, scene.candidates.point, dt, team);
  find_contacts(scene, nodes, team);
  warm_start(scene.last, scene.last_dt > 0 ? dt / scene.last_dt : 1.0, scene.contacts);
  solve_constraints(scene, scene.options, nodes, dt, bodies, ties);
  store_solution(scene, nodes, dt, ties);
  book(scene, nodes, bodies);
  scene.last_dt = dt;
}

}  // namespace brio
