// `resolve`: the stages of contact in a time step, on one page.

#include <algorithm>
#include <cassert>
#include <chrono>

#include "contact/detection/warm_start.hpp"
#include "contact/enforcement/recovery.hpp"
#include "contact/impact_zone.hpp"
#include "contact/scene.hpp"
#include "contact/step_totals.hpp"
#include "src/base/index.hpp"
#include "src/base/tensor.hpp"

namespace brio {

namespace {

using Clock = std::chrono::steady_clock;
double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}
void set(double* components, const Vector3d& a) {
  components[0] = a.x;
  components[1] = a.y;
  components[2] = a.z;
}

/// One step.
class Resolution {
 public:
  Resolution(ContactScene& scene, Nodes& nodes, double dt, ThreadTeam& team, std::span<RigidMotion> bodies,
             const Ties& ties, std::span<const ContactWall> walls)
      : scene_(scene),
        rows_(scene.rows),
        nodes_(nodes),
        dt_(dt),
        team_(team),
        bodies_(bodies),
        ties_(ties),
        walls_(walls) {}

  void run() {
    find_constraints();
    const std::size_t ordinary = scene_.contacts.size();
    begin_solution();
    solve(true);
    for (int round = 0;; ++round) {
      follow();
      look_again();
      if (scene_.options.velocity_check)
        find_hits(scene_.guard, scene_.proximity, scene_.features, scene_.surface, scene_.options,
                  scene_.pairs, scene_.motion, std::span(scene_.contacts).first(ordinary), team_);
      const bool behind_walls = find_missed_at_walls(round);
      if (scene_.guard.hits.empty() && !behind_walls) break;
      if (round == 0) ++scene_.steps_with_hits;
      ++scene_.rounds;
      if (round >= most_rounds + most_zone_rounds) {
        if (++scene_.unresolved.steps == 1) name_unresolved();
        break;
      }
      if (round >= most_rounds) {
        move_zones_as_one(scene_, nodes_, ties_, bodies_);
        if (!ties_.empty()) carry_velocities(ties_, nodes_, dt_);
        continue;
      }
      add_constraints(ordinary);
      solve(false);
    }
    finish(ordinary);
  }

 private:
  static constexpr int most_rounds = 8;
  static constexpr int most_zone_rounds = 60;
  static constexpr double same_weight = 0.01;
  static constexpr double same_direction = 0.9999;
  /// Over the smallest edge: less is rounding of positions.
  static constexpr double behind_wall = 1e-9;
  /// Iterations of the solver for one pass of the options.
  static constexpr int iterations_a_pass = 10;
  static constexpr std::size_t contacts_a_range = 128;

  void name_unresolved() {
    if (scene_.guard.hits.empty()) return;
    const Hit& hit = scene_.guard.hits.front();
    const Contact& contact = hit.at_hit ? *hit.at_hit : hit.at_start;
    const auto node = [&](int k) { return scene_.surface.node[index(contact.node[index(k)])]; };
    scene_.unresolved.node = {node(0), node(contact.own)};
  }

  void find_constraints() {
    scene_.motion.predict(scene_.features, scene_.surface, nodes_, dt_, bodies_, team_);
    if (scene_.pairs.begin_step(scene_.features, scene_.surface, scene_.motion, team_)) search();
    select();
    scene_.motion.set_limits(2, allowed_surplus(scene_.features));
    scene_.last.swap(scene_.contacts);
    find_proximities(scene_.proximity, scene_.features, scene_.surface, scene_.excluded, scene_.options,
                     scene_.pairs, scene_.motion, team_, scene_.last, scene_.contacts);
    warm_start(scene_.last, step_ratio(), scene_.contacts, rows_.taken);
  }

  void search() {
    const Clock::time_point start = Clock::now();
    scene_.pairs.hold(scene_.contacts);
    scene_.pairs.find(scene_.features, scene_.surface, scene_.excluded, scene_.options, scene_.motion, team_);
    scene_.step.searched = true;
    scene_.step.search_seconds += seconds_since(start);
  }
  void select() {
    select_active(scene_.proximity, scene_.features, scene_.surface, scene_.excluded, scene_.options,
                  scene_.pairs, scene_.motion, team_);
  }
  // Of pairs that were inactive in the predicted motion.
  void look_again() {
    if (scene_.pairs.is_due_after_solution(scene_.features, scene_.surface, scene_.motion, team_)) {
      search();
      select();
    } else if (scene_.motion.exceeds_limits()) {
      select();
    }
  }

  void begin_solution() {
    scene_.in_contact.clear();
    scene_.zone_impulse.clear();
    rows_.clear();
    scene_.row_of_contact.clear();
    add_rows_from(0);
    if (walls_.empty()) return;
    const double band = proximity_band * scene_.features.smallest_edge;
    scene_.walls.find(walls_, scene_.surface, scene_.motion, dt_, band, step_ratio());
    add_wall_rows_from(0);
  }
  double step_ratio() const { return scene_.last_dt > 0 ? dt_ / scene_.last_dt : 1; }
  RowSources sources() const { return {scene_.surface, scene_.features, nodes_, ties_, bodies_}; }

  void add_rows_from(std::size_t first) {
    const std::size_t known = rows_.end.row;
    for (std::size_t i = first; i < scene_.contacts.size(); ++i)
      scene_.row_of_contact.push_back(known + i - first);
    const auto contacts = std::span<const Contact>(scene_.contacts).subspan(first);
    add_rows(rows_, sources(), contacts, team_);
    const std::span<const double> opening = scene_.loaded.opening_velocities(contacts, recovery(), dt_);
    team_.for_ranges(contacts.size(), contacts_a_range, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        if (scene_.options.kinetic_friction) slow_friction(row_of(first + i));
        set_target(row_of(first + i), opening[i]);
      }
    });
  }
  // Friction at the sliding velocity with which the time step begins.
  void slow_friction(ConstraintRow& row) const {
    if (row.friction_coefficient == 0) return;
    const Vector3d velocity =
        RowMap(rows_.rows, row).velocity([&](int block) { return rows_.before[index(block)]; });
    const Vector3d sliding = velocity - dot(row.normal, velocity) * row.normal;
    const double speed = std::sqrt(dot(sliding, sliding));
    row.friction_coefficient *= scene_.options.kinetic_friction->share(scene_.options.friction, speed);
  }
  void add_wall_rows_from(std::size_t first) {
    const std::size_t known = rows_.end.row;
    add_rows(rows_, sources(), walls_, std::span<const NodeAtWall>(scene_.walls.touch).subspan(first), team_);
    for (std::size_t i = known; i < rows_.rows.size(); ++i) set_target(rows_.rows.row[i], 0);
  }
  ConstraintRow& row_of(std::size_t contact) { return rows_.rows.row[scene_.row_of_contact[contact]]; }

  // Rows for nodes pushed behind a wall by other impulses.
  bool find_missed_at_walls(int round) {
    if (walls_.empty() || round >= most_rounds + most_zone_rounds) return false;
    const std::size_t known = scene_.walls.touch.size();
    if (!scene_.walls.find_missed(walls_, scene_.surface, scene_.motion, dt_,
                                  behind_wall * scene_.features.smallest_edge))
      return false;
    add_wall_rows_from(known);
    return true;
  }

  Recovery recovery() const {
    return recovery_of(scene_.options, scene_.features.smallest_edge, 2 * scene_.features.skin,
                       dt_ / scene_.longest_dt);
  }
  void set_target(ConstraintRow& row, double returned) const {
    double mass = 0;
    if (row.gap < 0 && row.impulse > 0) {
      const double inverse = RowMap(rows_.rows, row).inverse_mass(row.normal, rows_.block);
      mass = inverse > 0 ? 1 / inverse : 0;
    }
    row.target_velocity = target_velocity(recovery(), row.gap, row.impulse, mass, returned, dt_);
  }

  void solve(bool anew) {
    const SolveOptions options{.max_iterations = iterations_a_pass * scene_.options.passes,
                               .tolerance = scene_.options.tolerance};
    const SolveReport report = anew ? scene_.solver.solve(options, rows_.rows, rows_.block, team_)
                                    : scene_.solver.solve_further(options, rows_.rows, rows_.block, team_);
    scene_.step.passes += report.iterations;
    scene_.step.residual = report.residual;
    if (!walls_.empty()) project_wall_rows(rows_.rows, rows_.block);
    store();
  }

  // Velocities of the blocks, to nodes and bodies.
  void store() {
    team_.for_ranges(rows_.block.size(), contacts_a_range, [&](std::size_t begin, std::size_t end) {
      for (std::size_t b = begin; b < end; ++b) store(rows_.owner[b], rows_.block[b].velocity);
    });
    for (const BlockOwner& owner : rows_.owner) {
      if (owner.kind != BlockOwner::Kind::node) continue;
      if (const int slave = scene_.surface.slave(owner.index); slave >= 0) scene_.in_contact.insert(slave);
    }
    if (!ties_.empty()) carry_velocities(ties_, nodes_, dt_);
  }

  void store(const BlockOwner& owner, const Vector3d& velocity) {
    const auto of = index(owner.index);
    switch (owner.kind) {
      case BlockOwner::Kind::node:
        set(nodes_.record[of].velocity, velocity);
        if (const int slave = scene_.surface.slave(owner.index); slave >= 0)
          scene_.velocity[index(slave)] = velocity;
        return;
      case BlockOwner::Kind::rotation_of_node:
        return set(nodes_.angular_velocity[of].component, velocity);
      case BlockOwner::Kind::body:
        bodies_[of].velocity = velocity;
        return;
      case BlockOwner::Kind::rotation_of_body:
        bodies_[of].angular_velocity = velocity;
        return;
    }
  }

  // Positions of the solution.
  void follow() {
    if (ties_.empty())
      scene_.motion.end_by_solution(scene_.features, scene_.surface, scene_.in_contact, scene_.velocity, dt_,
                                    bodies_, team_);
    else
      scene_.motion.end_by_velocities(scene_.features, scene_.surface, nodes_, dt_, bodies_, team_);
  }
  // Along the closest points at the start, which conserves angular momentum; if that is not sufficient, along
  // the direction of first contact as well.
  void add_constraints(std::size_t ordinary) {
    const std::size_t known = scene_.contacts.size();
    scene_.added.last_of_node.resize(scene_.surface.slaves(), -1);
    for (const Hit& hit : scene_.guard.hits) {
      const bool again = add(hit.at_start, ordinary);
      if (hit.at_hit && (again || is_zero(hit.at_start.normal))) add(*hit.at_hit, ordinary);
    }
    for (std::size_t i = ordinary; i < known; ++i) {
      ConstraintRow& row = row_of(i);
      if (row.gap == scene_.contacts[i].gap) continue;
      row.gap = scene_.contacts[i].gap;
      set_target(row, 0);
    }
    add_rows_from(known);
  }
  static bool is_same(const Contact& a, const Contact& b) {
    double apart = 0;
    for (std::size_t k = 0; k < 5; ++k) apart = std::max(apart, std::abs(a.weight[k] - b.weight[k]));
    return a.node == b.node && apart < same_weight && dot(a.normal, b.normal) > same_direction;
  }
  // Features nearly in contact cross by the rotation of the normal alone, for any velocity along the normal:
  // by the relative displacement of the nodes times the angle by which it rotates an edge.
  void open_wider(const Contact& contact, ConstraintRow& row) const {
    const double edge = scene_.features.smallest_edge;
    double squared = 0;
    for (int slave : contact.node)
      squared = std::max(squared, squared_norm(scene_.motion.displacement(slave) -
                                               scene_.motion.displacement(contact.node[0])));
    row.target_velocity =
        std::min(std::max(2 * row.target_velocity, squared / edge / dt_), separation_share * edge / dt_);
  }
  // \returns whether such a constraint is there already
  bool add(const Contact& wanted, std::size_t ordinary) {
    if (is_zero(wanted.normal)) return true;
    int& last = scene_.added.last_of_node[index(wanted.node[0])];
    for (int i = last; i >= 0; i = scene_.added.before[index(i) - ordinary]) {
      Contact& known = scene_.contacts[index(i)];
      if (!is_same(known, wanted)) continue;
      known.gap = std::min(known.gap, wanted.gap);
      if (known.gap > 0)
        known.gap *= 0.5;
      else
        open_wider(known, row_of(index(i)));
      return true;
    }
    scene_.added.before.push_back(last);
    last = static_cast<int>(scene_.contacts.size());
    scene_.contacts.push_back(wanted);
    return false;
  }

  void finish(std::size_t ordinary) {
    account_step(scene_, nodes_, bodies_, walls_.size(), team_);
    for (std::size_t i = ordinary; i < scene_.contacts.size(); ++i)
      scene_.added.last_of_node[index(scene_.contacts[i].node[0])] = -1;
    scene_.added.before.clear();
    scene_.contacts.resize(ordinary);
  }

  ContactScene& scene_;
  ContactRows& rows_;
  Nodes& nodes_;
  double dt_;
  ThreadTeam& team_;
  std::span<RigidMotion> bodies_;
  const Ties& ties_;
  std::span<const ContactWall> walls_;
};

}  // namespace

void resolve(ContactScene& scene, Nodes& nodes, double dt, ThreadTeam& team, std::span<RigidMotion> bodies,
             const Ties& ties, std::span<const ContactWall> walls) {
  assert(nodes.velocity_before.size() == nodes.size());
  scene.step = ContactStep{};
  scene.walls.push.clear();
  if (scene.log) scene.log->begin_step();
  if (scene.surface.node.empty()) return;
  scene.longest_dt = std::max(scene.longest_dt, dt);
  Resolution(scene, nodes, dt, team, bodies, ties, walls).run();
  scene.last_dt = dt;
}

}  // namespace brio
