#pragma once
/// Scenes and their images under a rotation, with supports and loads along the axes of a coordinate system
/// that is turned with them.

#include <algorithm>
#include <map>
#include <numbers>
#include <string>
#include <vector>

#include "src/base/index.hpp"
#include "src/fields/rotation.hpp"
#include "src/model/force_sums.hpp"
#include "tests/core/scene.hpp"
#include "tests/rotation_about.hpp"

namespace brio::test {

inline const Vector3d turn_axis{1, 2, 3};
inline constexpr double turn_degrees = 37;

inline Tensor<double> turn_matrix() {
  return rotation_about(turn_degrees * std::numbers::pi / 180, turn_axis);
}
inline Vector3d turned(const Vector3d& v) { return turn_matrix() * v; }
inline Vector3d turned_vector(const Vector3d& v) { return turn_matrix() * v; }

inline Rotation turned(const std::optional<Rotation>& first) {
  if (!first) return {turn_axis, turn_degrees};
  constexpr double degree = std::numbers::pi / 180;
  const Vector3d both = rotation_vector(rotation_by(turn_degrees * degree * normalized(turn_axis)) *
                                        rotation_by(first->degrees * degree * normalized(first->axis)));
  return {both, norm(both) / degree};
}

/// The scene turned about the origin. \pre sets are those of parts
inline Deck turned(Deck deck) {
  deck.coordinate_systems = {
      {"turned", RectangularSystem{turned(Vector3d{1, 0, 0}), turned(Vector3d{0, 1, 0})}}};
  for (Part& part : deck.parts) {
    part.placement.rotate = turned(part.placement.rotate);
    part.placement.translate = turned(part.placement.translate);
    if (auto* beam = std::get_if<Beam2>(&part.element); beam != nullptr && beam->orientation)
      beam->orientation = turned(*beam->orientation);
  }
  for (InitialCondition& condition : deck.initial_conditions) {
    condition.velocity = turned(condition.velocity);
    if (condition.spin)
      condition.spin = Spin{turned(condition.spin->point), turned(condition.spin->angular_velocity)};
  }
  for (BoundaryCondition& condition : deck.boundary_conditions) {
    if (auto* wall = std::get_if<RigidWall>(&condition)) {
      for (Vector3d* vector : {&wall->point, &wall->normal, &wall->velocity}) *vector = turned(*vector);
    } else {
      std::get<PrescribedMotion>(condition).system = "turned";
    }
  }
  for (Load& load : deck.loads)
    std::visit(
        [](auto& one) {
          if constexpr (requires { one.system; }) one.system = "turned";
        },
        load);
  for (Spring& spring : deck.springs)
    for (SpringEnd* end : {&spring.from, &spring.to})
      if (end->point) end->point = turned(*end->point);
  return deck;
}

struct NodeMotionAtEnd {
  Vector3d position, velocity, angular = Vector3d{};
};

/// Of all nodes in the order of the meshes, which both scenes share.
inline std::vector<NodeMotionAtEnd> motions_of(const Model& model) {
  std::vector<NodeMotionAtEnd> motions;
  for (const PartInModel& part : model.parts)
    for (const int entry : part.node) {
      const auto node = index(entry);
      const NodeRecord& record = model.nodes.record[node];
      NodeMotionAtEnd& one = motions.emplace_back(vector_at(record.position), vector_at(record.velocity));
      if (model.nodes.has_rotations()) one.angular = vector_at(model.nodes.angular_velocity[node].component);
    }
  return motions;
}

struct Turned {
  double position = 0, velocity = 0, angular = 0;  ///< largest differences, over the largest of each
  double energy = 0;                               ///< of any kind, over the largest of all
  double reaction = 0;  ///< of the impulse of a condition or pair of parts, over the largest of all
};

inline std::vector<Vector3d> reactions_of(const Model& model) {
  std::vector<Vector3d> sums;
  if (!model.forces) return sums;
  for (const ReactionSum& sum : model.forces->reactions) sums.push_back(sum.impulse);
  for (const ContactSum& sum : model.forces->contacts) sums.push_back(sum.impulse);
  return sums;
}

inline Turned compare_turned(const Model& model, const Model& image) {
  Turned result;
  const std::vector<NodeMotionAtEnd> a = motions_of(model), b = motions_of(image);
  double size = 0, speed = 0, rate = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    size = std::max(size, norm(a[i].position));
    speed = std::max(speed, norm(a[i].velocity));
    rate = std::max(rate, norm(a[i].angular));
    result.position = std::max(result.position, norm(turned_vector(a[i].position) - b[i].position));
    result.velocity = std::max(result.velocity, norm(turned_vector(a[i].velocity) - b[i].velocity));
    result.angular = std::max(result.angular, norm(turned_vector(a[i].angular) - b[i].angular));
  }
  result.position /= size;
  result.velocity /= speed;
  if (rate > 0) result.angular /= rate;
  const EnergyBalance &e = model.energy, &f = image.energy;
  const double all = std::max({e.reference, e.internal, std::abs(e.external.at_step())});
  for (const auto& [one, other] : {std::pair(e.kinetic, f.kinetic), std::pair(e.internal, f.internal),
                                   std::pair(e.external.at_step(), f.external.at_step()),
                                   std::pair(e.contact.at_step(), f.contact.at_step()),
                                   std::pair(e.friction.at_step(), f.friction.at_step())})
    result.energy = std::max(result.energy, std::abs(one - other) / all);
  const std::vector<Vector3d> r = reactions_of(model), s = reactions_of(image);
  double largest = 0;
  for (std::size_t i = 0; i < r.size(); ++i) {
    largest = std::max(largest, std::sqrt(dot(r[i], r[i])));
    result.reaction = std::max(result.reaction, norm(turned_vector(r[i]) - s[i]));
  }
  if (largest > 0) result.reaction /= largest;
  return result;
}

/// Largest velocity of a node along a direction in which it is held, over the largest of all.
inline double slip_of_supports(const Model& model) {
  double slip = 0, speed = 0;
  for (std::size_t i = 0; i < model.nodes.size(); ++i) {
    const double* v = model.nodes.record[i].velocity;
    speed = std::max(speed, std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]));
  }
  for (const PrescribedNodes& given : model.prescribed) {
    if (given.turns() || given.curve != Curve{{{0, 0}}}) continue;
    for (std::size_t k = 0; k < given.nodes.size(); ++k) {
      const double* v = model.nodes.record[index(given.nodes[k])].velocity;
      slip = std::max(slip, std::abs(dot(given.direction_of(k), {v[0], v[1], v[2]})));
    }
  }
  return speed > 0 ? slip / speed : 0;
}

/// Runs a scene and its image. \param tolerance of all differences
inline Turned expect_turned(const Deck& deck, double tolerance) {
  const Deck image = turned(deck);
  ThreadTeam team(1);
  Model one = build_model(deck), other = build_model(image);
  double slip = 0;
  run(one, deck, team);
  run(other, image, team, [&](Model& now) { slip = std::max(slip, slip_of_supports(now)); });
  EXPECT_EQ(one.step, other.step);
  const Turned found = compare_turned(one, other);
  EXPECT_LE(found.position, tolerance);
  EXPECT_LE(found.velocity, tolerance);
  EXPECT_LE(found.angular, tolerance);
  EXPECT_LE(found.energy, tolerance);
  EXPECT_LE(found.reaction, tolerance);
  EXPECT_LE(slip, 1e-14);
  EXPECT_NEAR(one.energy.error_max, other.energy.error_max, 1e-10);
  for (Model* model : {&one, &other}) {
    Momentum now = momentum(model->nodes);
    add_momentum(model->rigid, now);
    model->momentum.now = now.total;
    model->momentum.linear_scale = std::max(model->momentum.linear_scale, now.linear_size);
    model->momentum.angular_scale = std::max(model->momentum.angular_scale, now.angular_size);
    EXPECT_LT(model->momentum.linear_imbalance(), 1e-12);
    EXPECT_LT(model->momentum.angular_imbalance(), 1e-12);
  }
  if (one.forces && !one.forces->contacts.empty()) {
    EXPECT_TRUE(std::ranges::any_of(one.forces->contacts,
                                    [](const ContactSum& sum) { return dot(sum.impulse, sum.impulse) > 0; }));
  }
  return found;
}

}  // namespace brio::test
