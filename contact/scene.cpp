#include "contact/scene.hpp"

#include <algorithm>
#include <cassert>
#include <chrono>
#include <cstdio>

#include "contact/enforcement/impact_zone.hpp"
#include "contact/exclusion.hpp"
#include "contact/face_geometry.hpp"

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
  ContactStep& step = scene.step;
  step.contacts = static_cast<int>(scene.contacts.size());
  for (const Contact& contact : scene.contacts) {
    step.deepest_overlap = std::max(step.deepest_overlap, -contact.gap);
    if (contact.impulse > 0) ++step.active;
  }
  if (step.active > 0) book_work(scene, nodes);
  if (step.active > 0 && !bodies.empty()) book_rigid_work(scene, bodies);
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

void search_lines_anew(ContactScene& scene, const Nodes& nodes, ThreadTeam& team) {
  const Clock::time_point start = Clock::now();
  search_lines(scene.lines->candidates, scene.candidates, scene.surface, scene.options, nodes, team);
  renumber(scene.lines->candidates, scene.contacts);
  scene.step.line_seconds += seconds_since(start);
}

}  // namespace

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

// DEBUG_STATS_BEGIN
struct Stats {
  double t[6] = {};
  std::uint64_t n[12] = {};  // DEBUG
  ~Stats() {
    if (n[0] == 0) return;
    std::fprintf(stderr,
                 "STATS searches %lu steps %lu pairs vf %lu ee %lu awake vf %lu ee %lu rows %lu+%lu closest %lu cert %lu "
                 "renewed %lu checked %lu hits %lu hitsteps %lu rounds %lu zones %lu unres %lu passes %lu| t "
                 "begin %.2f find %.2f solve %.2f follow %.2f guard %.2f search %.2f\n",
                 n[8], n[0], n[1] / n[0], n[2] / n[0], n[3] / n[0], n[4] / n[0], n[5] / n[0], n[6] / n[0],
                 g[0] / n[0], g[1] / n[0], g[2], g[3], g[4], g[5], g[6], g[7], g[8], n[7] / n[0], t[0], t[1],
                 t[2], t[3], t[4], t[5]);
  }
  std::uint64_t g[9] = {};
} stats;
struct Lap {
  double& t;
  Clock::time_point s = Clock::now();
  ~Lap() { t += seconds_since(s); }
};
// DEBUG_STATS_END
/// Constraints by distances, solved again with what they let through until nothing crosses.
class Resolution {
 public:
  Resolution(ContactScene& scene, Nodes& nodes, double dt, ThreadTeam& team, std::span<RigidMotion> bodies,
             const Ties& ties)
      : scene_(scene),
        distance_(*scene.distance),
        nodes_(nodes),
        dt_(dt),
        team_(team),
        bodies_(bodies),
        ties_(ties) {}

  void run() {
    find_constraints();
    ++stats.n[0];
    stats.n[1] += distance_.pairs.node_face.size();
    stats.n[2] += distance_.pairs.edge_edge.size();
    stats.n[3] += distance_.proximity.node_face.size();
    stats.n[4] += distance_.proximity.edge_edge.size();
    for (const Contact& c : scene_.contacts) ++stats.n[c.of_lines() ? 6 : 5];
    keep_prediction();
    std::size_t ordinary = scene_.contacts.size();
    ContactOptions options = scene_.options;
    {
      Lap lap{stats.t[2]};
      solve_constraints(scene_, options, nodes_, dt_, bodies_, ties_);
    }
    stats.n[7] += static_cast<std::uint64_t>(scene_.step.passes);
    for (int round = 0;; ++round) {
      {
        Lap lap{stats.t[3]};
        follow();
      }
      if (distance_.pairs.is_due(scene_.surface, distance_.motion)) {
        search();
        select();
      } else if (distance_.motion.exceeds_limits()) {
        select();
      }
      Lap lapg{stats.t[4]};
      find_hits(distance_.guard, distance_.proximity, distance_.features, scene_.surface, scene_.options,
                distance_.pairs, distance_.motion, team_);
      if (distance_.guard.hits.empty()) break;
      if (const char* tell = std::getenv("BRIO_TELL"); tell && std::atoi(tell) > 0) {
        static int told = 0;
        for (const Hit& hit : distance_.guard.hits) {
          if (++told > std::atoi(tell)) break;
          const bool nf = hit.kind == PairKind::node_face;
          const PairList& list = nf ? distance_.pairs.node_face : distance_.pairs.edge_edge;
          const auto& c = hit.at_start;
          double vn = 0;
          for (std::size_t k = 0; k < 5; ++k)
            vn += c.weight[k] * c.normal.dot(distance_.motion.displacement(c.node[k]));
          std::fprintf(stderr, "TELL step %lu round %d %s spaced %d gap/h %.3g vn dt/h %.3g time %.3f",
                       stats.n[0], round, nf ? "vf" : "ee", list.spaced[hit.pair],
                       c.gap / distance_.features.smallest_edge, vn / distance_.features.smallest_edge,
                       hit.time);
          if (!nf) {
            const auto &a = distance_.features.edge[static_cast<std::size_t>(list.first[hit.pair])],
                       &b = distance_.features.edge[static_cast<std::size_t>(list.second[hit.pair])];
            std::fprintf(stderr, " kinds %d %d parts %d %d w %.3f %.3f", (int)a.kind, (int)b.kind, a.part,
                         b.part, c.weight[1], -c.weight[3]);
            for (const auto* e : {&a, &b}) {
              std::fprintf(stderr, " wings");
              for (int w : e->wing)
                if (w >= 0) {
                  const Vector3d foot = e == &a ? Vector3d(c.weight[0] * distance_.motion.start(a.node[0]) +
                                                           c.weight[1] * distance_.motion.start(a.node[1]))
                                                : Vector3d(-c.weight[2] * distance_.motion.start(b.node[0]) -
                                                           c.weight[3] * distance_.motion.start(b.node[1]));
                  std::fprintf(
                      stderr, " %.4f",
                      (e == &a ? 1 : -1) * c.normal.dot((distance_.motion.start(w) - foot).normalized()));
                }
            }
          } else {
            for (double w : c.weight) std::fprintf(stderr, " %.3f", w);
          }
          std::fprintf(stderr, "\n");
        }
      }
      if (round == 0) ++distance_.steps_with_hits;
      ++distance_.rounds;
      if (round >= most_rounds + most_zone_rounds) {
        ++distance_.unresolved;
        break;
      }
      if (round >= most_rounds) {
        move_zones_as_one(scene_, nodes_, dt_, bodies_);
        continue;
      }
      add_constraints(ordinary);
      restore_prediction();
      options.passes = std::max(options.passes, least_passes) << (round % 2);
      solve_constraints(scene_, options, nodes_, dt_, bodies_, ties_);
    }
    finish(ordinary);
  }

 private:
  static constexpr int most_rounds = 8;
  static constexpr int most_zone_rounds = 60;
  static constexpr int least_passes = 20;
  static constexpr double same_weight = 0.01;
  static constexpr double same_direction = 0.9999;

  void find_constraints() {
    if (distance_.changed) {
      collect(distance_.features, scene_.surface, scene_.options);
      distance_.pairs.expire();
      distance_.motion.forget();
      distance_.changed = false;
      scene_.candidates.smallest_edge = distance_.features.smallest_edge;
      scene_.candidates.mean_edge = distance_.features.mean_edge;
    }
    {
      Lap lap{stats.t[0]};
      distance_.motion.begin(distance_.features, scene_.surface, nodes_, team_);
      distance_.motion.end_by_velocity(distance_.features, scene_.surface, nodes_, dt_, bodies_, team_);
    }
    if (distance_.pairs.is_due(scene_.surface, distance_.motion)) search();
    select();
    distance_.motion.set_limits(2, allowed_surplus(distance_.features));
    scene_.last.swap(scene_.contacts);
    Lap lap{stats.t[1]};
    find_proximities(distance_.proximity, distance_.features, scene_.surface, scene_.options, distance_.pairs,
                     distance_.motion, team_, scene_.contacts);
    warm_start(scene_.last, scene_.last_dt > 0 ? dt_ / scene_.last_dt : 1.0, scene_.contacts);
  }

  void search() {
    Lap lap{stats.t[5]};
    ++stats.n[8];
    ++stats.n[8];
    const Clock::time_point start = Clock::now();
    distance_.pairs.find(distance_.features, scene_.surface, scene_.excluded, scene_.options,
                         distance_.motion, team_);
    scene_.step.searched = true;
    scene_.step.search_seconds += seconds_since(start);
  }
  void select() {
    Lap lap{stats.t[0]};
    select_awake(distance_.proximity, distance_.features, distance_.pairs, distance_.motion, team_);
  }

  void keep_prediction() {
    distance_.bodies_before.assign(bodies_.begin(), bodies_.end());
    distance_.zone_impulse.clear();
    if (ties_.empty()) return;
    distance_.velocity_before.resize(nodes_.size());
    for (std::size_t i = 0; i < nodes_.size(); ++i)
      std::copy(nodes_.record[i].velocity, nodes_.record[i].velocity + 3,
                distance_.velocity_before[i].component);
    distance_.angular_before.assign(nodes_.angular_velocity.begin(), nodes_.angular_velocity.end());
    step_before_ = scene_.step;
  }
  void restore_prediction() {
    std::copy(distance_.bodies_before.begin(), distance_.bodies_before.end(), bodies_.begin());
    if (ties_.empty()) return;
    for (std::size_t i = 0; i < nodes_.size(); ++i)
      std::copy(distance_.velocity_before[i].component, distance_.velocity_before[i].component + 3,
                nodes_.record[i].velocity);
    std::copy(distance_.angular_before.begin(), distance_.angular_before.end(),
              nodes_.angular_velocity.begin());
    scene_.step = step_before_;
  }

  // Where the solution takes the nodes.
  void follow() {
    if (ties_.empty()) {
      distance_.motion.end_by_solution(distance_.features, scene_.surface, scene_.in_contact, scene_.motion,
                                       dt_, bodies_, team_);
      return;
    }
    store_solution(scene_, nodes_, dt_, ties_);
    distance_.motion.end_by_velocity(distance_.features, scene_.surface, nodes_, dt_, bodies_, team_);
  }

  // Along the closest points at the start, which keeps angular momentum; where that did not do, along the
  // direction in which they meet as well.
  void add_constraints(std::size_t ordinary) {
    for (const Hit& hit : distance_.guard.hits) {
      const bool again = add(hit.at_start, ordinary);
      if (hit.at_hit && (again || hit.at_start.normal.isZero(0))) add(*hit.at_hit, ordinary);
    }
  }
  static bool is_same(const Contact& a, const Contact& b) {
    double apart = 0;
    for (std::size_t k = 0; k < 5; ++k) apart = std::max(apart, std::abs(a.weight[k] - b.weight[k]));
    return a.node == b.node && apart < same_weight && a.normal.dot(b.normal) > same_direction;
  }
  // \returns whether such a constraint is there already
  bool add(const Contact& wanted, std::size_t ordinary) {
    if (wanted.normal.isZero(0)) return true;
    for (std::size_t i = ordinary; i < scene_.contacts.size(); ++i) {
      Contact& known = scene_.contacts[i];
      if (!is_same(known, wanted)) continue;
      known.gap = std::min(known.gap, wanted.gap);
      if (known.gap > 0) known.gap *= 0.5;
      return true;
    }
    scene_.contacts.push_back(wanted);
    return false;
  }

  void finish(std::size_t ordinary) {
    if (ties_.empty()) store_solution(scene_, nodes_, dt_, ties_);
    for (std::size_t s = 0; s < distance_.zone_impulse.size(); ++s) {
      if (distance_.zone_impulse[s].isZero(0)) continue;
      scene_.pushed.insert(static_cast<int>(s));
      scene_.normal_impulse[s] += distance_.zone_impulse[s];
    }
    if (!distance_.zone_impulse.empty()) store_velocities(scene_, nodes_);
    book(scene_, nodes_, bodies_);
    scene_.contacts.resize(ordinary);
    stats.g[0] = distance_.proximity.closest_points;
    stats.g[1] = distance_.guard.certified;
    stats.g[2] = distance_.guard.renewed;
    stats.g[3] = distance_.guard.checked;
    stats.g[4] = distance_.guard.found;
    stats.g[5] = distance_.steps_with_hits;
    stats.g[6] = distance_.rounds;
    stats.g[7] = distance_.zones;
    stats.g[8] = distance_.unresolved;
  }

  ContactScene& scene_;
  DistanceContact& distance_;
  Nodes& nodes_;
  double dt_;
  ThreadTeam& team_;
  std::span<RigidMotion> bodies_;
  const Ties& ties_;
  ContactStep step_before_;
};

}  // namespace

void resolve(ContactScene& scene, Nodes& nodes, double dt, ThreadTeam& team, std::span<RigidMotion> bodies,
             const Ties& ties) {
  assert(nodes.velocity_before.size() == nodes.size());
  scene.step = ContactStep{};
  if (scene.surface.node.empty()) return;
  if (scene.distance) {
    Resolution(scene, nodes, dt, team, bodies, ties).run();
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
