#include "src/step/relax.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "src/model/start_balances.hpp"
#include "src/step/advance.hpp"
#include "src/step/diagnosis.hpp"

namespace brio {

namespace {

/// Steps for which a scene without loads must stand.
constexpr int least_rest = 100;

/// What of a model waits until it is at rest: velocities, and motions that are prescribed.
class Waiting {
 public:
  explicit Waiting(Model& model)
      : record_(model.nodes.size()), angular_(model.nodes.angular_velocity), motion_(model.rigid.motion) {
    for (std::size_t i = 0; i < record_.size(); ++i)
      std::copy_n(model.nodes.record[i].velocity, 3, record_[i].begin());
    for (PrescribedNodes& given : model.prescribed) hold(given);
    for (RigidBody& body : model.rigid.body)
      for (PrescribedRigid& given : body.given) hold(given);
    for (WallInRun& wall : model.walls) {
      wall_velocity_.push_back(wall.wall.velocity);
      wall.wall.velocity = {};
    }
  }

  void give_back(Model& model) {
    std::size_t next = 0;
    for (PrescribedNodes& given : model.prescribed) give_back(given, next);
    for (RigidBody& body : model.rigid.body)
      for (PrescribedRigid& given : body.given) give_back(given, next);
    for (std::size_t w = 0; w < model.walls.size(); ++w) model.walls[w].wall.velocity = wall_velocity_[w];
    for (std::size_t i = 0; i < record_.size(); ++i)
      std::copy_n(record_[i].begin(), 3, model.nodes.record[i].velocity);
    for (std::size_t i = 0; i < model.nodes.angular_velocity.size(); ++i)
      std::copy_n(angular_[i].component, 3, model.nodes.angular_velocity[i].component);
    for (std::size_t b = 0; b < motion_.size(); ++b)
      start(model.rigid.body[b], model.rigid.motion[b], motion_[b].velocity, motion_[b].angular_velocity);
  }

 private:
  struct Motion {
    MotionKind kind;
    Curve curve;
  };
  template <class Given>
  void hold(Given& given) {
    motions_.push_back({given.kind, std::move(given.curve)});
    given.kind = MotionKind::velocity;
    given.curve = {{{0, 0}}};
  }
  template <class Given>
  void give_back(Given& given, std::size_t& next) {
    given.kind = motions_[next].kind;
    given.curve = std::move(motions_[next++].curve);
  }

  std::vector<Vector3d> record_;
  AlignedBuffer<NodeVector> angular_;
  std::vector<RigidMotion> motion_;
  std::vector<Motion> motions_;
  std::vector<Vector3d> wall_velocity_;
};

void stop_all(Model& model) {
  for (std::size_t i = 0; i < model.nodes.size(); ++i) std::fill_n(model.nodes.record[i].velocity, 3, 0.0);
  for (std::size_t i = 0; i < model.nodes.angular_velocity.size(); ++i)
    std::fill_n(model.nodes.angular_velocity[i].component, 3, 0.0);
  for (std::size_t b = 0; b < model.rigid.body.size(); ++b)
    start(model.rigid.body[b], model.rigid.motion[b], Vector3d{}, Vector3d{});
}

/// As from rest at the present time: with half of the change of velocity of this step. Velocities of zero
/// over the step would make the next change twice as large, and the highest modes unstable.
void start_from_rest(Model& model) {
  Nodes& nodes = model.nodes;
  const auto halve = [](double* velocity, const double* before) {
    for (int axis = 0; axis < 3; ++axis) velocity[axis] = 0.5 * (velocity[axis] - before[axis]);
  };
  for (std::size_t i = 0; i < nodes.size(); ++i)
    halve(nodes.record[i].velocity, nodes.velocity_before[i].component);
  for (std::size_t i = 0; i < nodes.angular_velocity.size(); ++i)
    halve(nodes.angular_velocity[i].component, nodes.angular_velocity_before[i].component);
  for (std::size_t b = 0; b < model.rigid.body.size(); ++b) {
    RigidMotion& motion = model.rigid.motion[b];
    start(model.rigid.body[b], motion, 0.5 * (motion.velocity - motion.velocity_before),
          0.5 * (motion.angular_velocity - motion.angular_velocity_before));
  }
}

double rounding_of_kinetic_energy(const Model& model) {
  const double speed = std::numeric_limits<double>::epsilon() * model.extent.width / model.times.next;
  return 100 * model.extent.mass * speed * speed;
}

/// Steps until the scene is at rest.
void come_to_rest(const Relaxation& settings, Model& model, ThreadTeam& team) {
  double last = 0;
  int since_stop = 0, longest = least_rest, quiet = 0;
  for (int step = 0; step < settings.steps; ++step) {
    update_velocities(model, std::numeric_limits<double>::infinity(), team);
    const EnergyBalance& energy = model.energy;
    const double internal = std::abs(energy.internal) + std::abs(energy.hourglass);
    const double least =
        std::max(settings.tolerance * settings.tolerance * internal, rounding_of_kinetic_energy(model));
    ++since_stop;
    quiet = energy.kinetic_half <= least ? quiet + 1 : 0;
    if (quiet > 2 * longest) return;
    if (energy.kinetic_half < last && last > least) {
      start_from_rest(model);
      longest = std::max(longest, since_stop);
      since_stop = 0;
      last = 0;
    } else {
      last = energy.kinetic_half;
    }
    update_positions(model, team);
    model.times.time = 0;
  }
  throw Breakdown("the scene has not come to rest within " + std::to_string(settings.steps) +
                  " steps: its kinetic energy is " + written(model.energy.kinetic_half) +
                  " and its internal energy " + written(model.energy.internal) +
                  "; supports against its loads, or more time.relaxation.steps are wanted");
}

void start_anew(Model& model) {
  const EnergyBalance rest = model.energy;
  model.energy = {};
  model.momentum = {};
  start_balances(model);
  model.energy.internal = rest.internal;
  model.energy.hourglass = rest.hourglass;
  model.energy.deleted = rest.deleted;
  model.energy.kinetic_start += rest.internal + rest.hourglass + rest.deleted;
  for (PartEnergy& part : model.part_energy)
    part = {.internal = part.internal, .hourglass = part.hourglass, .largest_internal = part.internal};
  if (model.forces) model.forces->begin_interval();
  model.times = {};
  model.step = 0;
  model.element_updates = 0;
  const TimeSection time = model.control.settings;
  model.control = {.settings = time};
  start_anew(model.assembled_step);
}

}  // namespace

void relax(const Relaxation& settings, Model& model, ThreadTeam& team) {
  Waiting waiting(model);
  stop_all(model);
  const bool keeps_velocities = !model.nodes.velocity_before.empty();
  if (!keeps_velocities) model.nodes.keep_velocities_before();
  come_to_rest(settings, model, team);
  if (!keeps_velocities) {
    model.nodes.velocity_before = {};
    model.nodes.angular_velocity_before = {};
  }
  waiting.give_back(model);
  for (std::size_t i = 0; i < model.nodes.size(); ++i) std::fill_n(model.nodes.force[i].component, 4, 0.0);
  for (std::size_t i = 0; i < model.nodes.moment.size(); ++i)
    std::fill_n(model.nodes.moment[i].component, 4, 0.0);
  start_anew(model);
}

}  // namespace brio
