#include "contact/step_totals.hpp"

#include <algorithm>

#include "contact/scene.hpp"
#include "src/base/index.hpp"

namespace brio {

namespace {

void sum_impulses(ContactScene& scene) {
  scene.pushed.for_each([&](std::size_t s) {
    scene.normal_impulse[s] = {};
    scene.friction_impulse[s] = {};
  });
  scene.pushed.clear();
  for (const Contact& contact : scene.contacts) {
    if (contact.impulse == 0) continue;
    for (std::size_t k = 0; k < 5; ++k) {
      const auto s = index(contact.node[k]);
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
  totals.passes += static_cast<std::uint64_t>(step.passes);
  totals.most_contacts = std::max(totals.most_contacts, step.contacts);
  totals.normal_work += step.normal_work();
  totals.normal_work_added += std::max(0.0, step.normal_work());
  totals.largest_normal_work = std::max(totals.largest_normal_work, totals.normal_work);
  totals.friction_work += step.friction_work();
  totals.deepest_overlap = std::max(totals.deepest_overlap, step.deepest_overlap);
}

/// Once a step is solved.
class StepAccount {
 public:
  StepAccount(ContactScene& scene, Nodes& nodes, std::span<RigidMotion> bodies, std::size_t walls,
              ThreadTeam& team)
      : scene_(scene), rows_(scene.rows), nodes_(nodes), bodies_(bodies), walls_(walls), team_(team) {}

  void run() {
    team_.for_ranges(scene_.contacts.size(), contacts_a_range, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        scene_.contacts[i].impulse = row_of(i).impulse;
        scene_.contacts[i].friction = row_of(i).friction;
      }
    });
    if (scene_.log) log_contacts(scene_);
    const bool at_walls = take_over_walls();
    sum_impulses(scene_);
    count_contacts(scene_);
    if (!scene_.zone_impulse.empty()) account_zones();
    if (scene_.step.active > 0 || at_walls) account_rows();
    remember_loads();
    add_to_totals(scene_);
  }

 private:
  static constexpr std::size_t contacts_a_range = 128;

  const ConstraintRow& row_of(std::size_t contact) const {
    return rows_.rows.row[scene_.row_of_contact[contact]];
  }

  void remember_loads() {
    for (std::size_t i = 0; i < scene_.contacts.size(); ++i) {
      const Contact& contact = scene_.contacts[i];
      if (contact.impulse > 0 || contact.gap < 0) scene_.loaded.add(contact, row_of(i).normal_work);
    }
    scene_.loaded.end_step();
  }

  // \returns whether a wall pushes
  bool take_over_walls() {
    bool pushes = false;
    auto touch = scene_.walls.touch.begin();
    for (const ConstraintRow& row : rows_.rows.row) {
      if (row.wall < 0) continue;
      touch->impulse = row.impulse;
      touch->friction = row.friction;
      pushes = pushes || row.impulse > 0;
      ++touch;
    }
    return pushes;
  }

  // Before the impulses of rows are added to the bodies, which have those of zones.
  void account_zones() {
    ContactStep& step = scene_.step;
    for (std::size_t s = 0; s < scene_.zone_impulse.size(); ++s) {
      const Vector3d& impulse = scene_.zone_impulse[s];
      if (is_zero(impulse)) continue;
      scene_.pushed.insert(static_cast<int>(s));
      scene_.normal_impulse[s] += impulse;
      const auto node = index(scene_.surface.node[s]);
      const Vector3d before = vector_at(nodes_.velocity_before[node].component),
                     after = vector_at(nodes_.record[node].velocity);
      step.normal_work_before += dot(impulse, before);
      step.normal_work_after += dot(impulse, after);
      const Vector3d reaction = nodes_.free_translations(node) * impulse - impulse;
      if (scene_.log && !is_zero(reaction))
        scene_.log->supports.push_back({.node = scene_.surface.node[s], .impulse = reaction});
      const Vector3d position = vector_at(nodes_.record[node].position);
      account_support({reaction, cross(position, reaction), dot(reaction, before), dot(reaction, after)});
    }
    for (std::size_t b = 0; b < bodies_.size(); ++b) {
      const RigidMotion& body = bodies_[b];
      step.normal_work_before +=
          dot(body.impulse, body.velocity_before) + dot(body.moment, body.angular_velocity_before);
      step.normal_work_after += dot(body.impulse, body.velocity) + dot(body.moment, body.angular_velocity);
      RigidSupport support = support_against(body, body.impulse, body.moment);
      if (scene_.log)
        scene_.log->supports.push_back({.body = static_cast<int>(b), .impulse = support.impulse});
      support.moment += cross(body.centre, support.impulse);
      account_support(support);
    }
    for (std::size_t b = 0; b < rows_.block.size(); ++b) rows_.block[b].velocity = final_velocity(b);
  }
  void account_support(const RigidSupport& support) {
    ContactStep& step = scene_.step;
    step.support_impulse += support.impulse;
    step.support_moment += support.moment;
    step.support_work_before += support.work_before;
    step.support_work_after += support.work_after;
  }

  Vector3d final_velocity(std::size_t block) const {
    const auto of = index(rows_.owner[block].index);
    switch (rows_.owner[block].kind) {
      case BlockOwner::Kind::node:
        return vector_at(nodes_.record[of].velocity);
      case BlockOwner::Kind::rotation_of_node:
        return vector_at(nodes_.angular_velocity[of].component);
      case BlockOwner::Kind::body:
        return bodies_[of].velocity;
      default:
        return bodies_[of].angular_velocity;
    }
  }

  void log_supports() {
    std::vector<Vector3d>& reaction = scene_.log->reaction;
    reaction.assign(rows_.block.size(), {0, 0, 0});
    sum_reactions(rows_.rows, rows_.block, rows_.place, reaction);
    for (std::size_t b = 0; b < reaction.size(); ++b) {
      const Vector3d impulse = reaction[b];
      if (is_zero(impulse)) continue;
      const BlockOwner& owner = rows_.owner[b];
      if (owner.kind == BlockOwner::Kind::node)
        scene_.log->supports.push_back({.node = owner.index, .impulse = impulse});
      if (owner.kind == BlockOwner::Kind::body)
        scene_.log->supports.push_back({.body = owner.index, .impulse = impulse});
    }
  }

  void account_rows() {
    std::vector<ImpulseOnWall>& pushes = scene_.walls.push;
    pushes.assign(walls_, {});
    const RowWork work =
        account_work(rows_.rows, rows_.before, rows_.block, rows_.place, pushes, rows_.work, team_);
    ContactStep& step = scene_.step;
    for (const ImpulseOnWall& push : pushes) {
      step.wall_impulse -= push.impulse;
      step.wall_moment -= push.moment;
    }
    step.normal_work_before += work.normal_before;
    step.normal_work_after += work.normal_after;
    step.friction_work_before += work.friction_before;
    step.friction_work_after += work.friction_after;
    step.support_work_before += work.support_before;
    step.support_work_after += work.support_after;
    step.support_impulse += work.support_impulse;
    step.support_moment += work.support_moment;
    step.wall_work += work.walls;
    if (scene_.log) log_supports();
    if (bodies_.empty()) return;
    for (const ConstraintRow& row : rows_.rows.row) {
      if (row.impulse == 0) continue;
      RowMap(rows_.rows, row).spread(impulse_of(row), [&](int b, const Vector3d& given) {
        const BlockOwner& owner = rows_.owner[index(b)];
        if (owner.kind == BlockOwner::Kind::body) bodies_[index(owner.index)].impulse += given;
        if (owner.kind == BlockOwner::Kind::rotation_of_body) bodies_[index(owner.index)].moment += given;
      });
    }
  }

  ContactScene& scene_;
  ContactRows& rows_;
  Nodes& nodes_;
  std::span<RigidMotion> bodies_;
  std::size_t walls_;
  ThreadTeam& team_;
};

}  // namespace

void account_step(ContactScene& scene, Nodes& nodes, std::span<RigidMotion> bodies, std::size_t walls,
                  ThreadTeam& team) {
  StepAccount(scene, nodes, bodies, walls, team).run();
}

}  // namespace brio
