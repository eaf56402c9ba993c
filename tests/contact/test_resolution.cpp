#include <gtest/gtest.h>

#include <bit>
#include <random>

#include "contact/scene.hpp"
#include "contact/surface/face_geometry.hpp"
#include "src/base/floating_point.hpp"
#include "src/base/index.hpp"
#include "tests/contact/spring_model.hpp"
#include "tests/rotation_about.hpp"

namespace brio::test {
namespace {

constexpr double thickness = 0.1;
constexpr double usual_friction = 0.5;

enum class Kind { solid, shell, beam, particle, rigid };
constexpr Kind all_kinds[] = {Kind::solid, Kind::shell, Kind::beam, Kind::particle, Kind::rigid};

/// Pieces of unit size whose nodes nothing holds together but contact; nodes of shells and beams turn.
class FreePieces {
 public:
  std::vector<SurfacePart> parts;
  Nodes nodes;
  ContactScene scene;
  std::vector<RigidMotion> bodies;
  Ties ties;

  explicit FreePieces(unsigned seed) : random_(seed) {}

  double number() { return std::uniform_real_distribution<double>(-1, 1)(random_); }
  Vector3d vector() {
    const double x = number(), y = number();
    return {x, y, number()};
  }

  /// A piece about a centre, turned at random.
  void add(Kind kind, const Vector3d& centre, const Vector3d& velocity) {
    const Tensor<double> turn = rotation_about(std::numbers::pi * vector().x, vector());
    const auto add_node = [&](const Vector3d& x, double inertia, double mass) {
      nodes_.push_back({centre + turn * x, velocity + 0.1 * vector(), mass, inertia});
      connectivity_.back().push_back(static_cast<int>(nodes_.size()) - 1);
    };
    connectivity_.emplace_back();
    SurfacePart part;
    part.name = "part " + std::to_string(parts.size());
    switch (kind) {
      case Kind::rigid:
        part.rigid = static_cast<int>(bodies.size());
        add_body(centre, velocity);
        [[fallthrough]];
      case Kind::solid:
        for (int k = 0; k < 8; ++k)
          add_node({k % 4 == 0 || k % 4 == 3 ? -0.5 : 0.5, k % 4 < 2 ? -0.5 : 0.5, k < 4 ? -0.5 : 0.5}, 0,
                   part.rigid < 0 ? 1 + 0.5 * number() : 0);
        break;
      case Kind::shell:
        for (int k = 0; k < 4; ++k)
          add_node({k == 0 || k == 3 ? -0.5 : 0.5, k < 2 ? -0.5 : 0.5, 0}, 0.1, 1 + 0.5 * number());
        part.nodes_per_element = 4;
        part.thickness = {thickness};
        break;
      case Kind::beam:
        for (const double x : {-0.5, 0.5}) add_node({x, 0, 0}, 0.1, 1 + 0.5 * number());
        part.nodes_per_element = 2;
        part.thickness = {thickness};
        break;
      case Kind::particle:
        add_node({0, 0, 0}, 0, 1);
        part.nodes_per_element = 1;
        part.thickness = {thickness};
        break;
    }
    if (part.rigid >= 0) rigid_nodes_.push_back(connectivity_.back());
    parts.push_back(part);
  }

  void start(const ContactOptions& options) {
    nodes = Nodes(nodes_.size(), true);
    nodes.keep_velocities_before();
    for (std::size_t n = 0; n < nodes_.size(); ++n) {
      for (int axis = 0; axis < 3; ++axis) {
        nodes.record[n].position[axis] = nodes_[n].position[axis];
        nodes.record[n].velocity[axis] = nodes_[n].velocity[axis];
        nodes.angular_velocity[n].component[axis] = nodes_[n].inertia > 0 ? number() : 0;
      }
      nodes.mass[n] = nodes_[n].mass;
      nodes.record[n].inverse_mass = nodes_[n].mass > 0 ? 1 / nodes_[n].mass : 0;
      nodes.rotational_inertia[n] = nodes_[n].inertia;
      nodes.angular_velocity[n].component[3] = nodes_[n].inertia > 0 ? 1 / nodes_[n].inertia : 0;
    }
    for (std::size_t p = 0; p < parts.size(); ++p) parts[p].connectivity = connectivity_[p];
    scene = make_contact_scene(options, parts, nodes);
    if (bodies.empty()) return;
    scene.surface.rigid_of_node.assign(nodes.size(), -1);
    for (std::size_t b = 0; b < bodies.size(); ++b)
      for (int node : rigid_nodes_[b]) scene.surface.rigid_of_node[index(node)] = int(b);
    carry_bodies();
  }

  void resolve(double dt) {
    for (std::size_t n = 0; n < nodes.size(); ++n) {
      std::copy(nodes.record[n].velocity, nodes.record[n].velocity + 3, nodes.velocity_before[n].component);
      nodes.angular_velocity_before[n] = nodes.angular_velocity[n];
    }
    for (RigidMotion& body : bodies) {
      body.velocity_before = body.velocity;
      body.angular_velocity_before = body.angular_velocity;
      body.impulse = {};
      body.moment = {};
    }
    brio::resolve(scene, nodes, dt, team_, bodies, ties);
    carry_bodies();
  }
  void move(double dt) {
    for (std::size_t n = 0; n < nodes.size(); ++n)
      for (int axis = 0; axis < 3; ++axis)
        nodes.record[n].position[axis] += dt * nodes.record[n].velocity[axis];
    for (RigidMotion& body : bodies) body.centre += dt * body.velocity;
  }

  Vector3d x(std::size_t n) const { return vector_at(nodes.record[n].position); }
  Vector3d v(std::size_t n) const { return vector_at(nodes.record[n].velocity); }
  Vector3d momentum() const {
    Vector3d sum{};
    for (std::size_t n = 0; n < nodes.size(); ++n) sum += nodes.mass[n] * v(n);
    for (const RigidMotion& body : bodies) sum += body.mass * body.velocity;
    return sum;
  }
  Vector3d angular_momentum() const {
    Vector3d sum{};
    for (std::size_t n = 0; n < nodes.size(); ++n)
      sum += nodes.mass[n] * cross(x(n), v(n)) +
             nodes.rotational_inertia[n] * vector_at(nodes.angular_velocity[n].component);
    for (const RigidMotion& body : bodies)
      sum += cross(body.centre, body.mass * body.velocity) + body.inertia * body.angular_velocity;
    return sum;
  }
  double size_of_motion() const {
    double sum = 0;
    for (std::size_t n = 0; n < nodes.size(); ++n) sum += nodes.mass[n] * norm(v(n)) * (1 + norm(x(n)));
    for (const RigidMotion& body : bodies) sum += body.mass * norm(body.velocity) * (1 + norm(body.centre));
    return sum;
  }
  double kinetic_energy() const {
    double sum = 0;
    for (std::size_t n = 0; n < nodes.size(); ++n)
      sum += 0.5 * nodes.mass[n] * squared_norm(v(n)) +
             0.5 * nodes.rotational_inertia[n] * squared_norm(vector_at(nodes.angular_velocity[n].component));
    for (const RigidMotion& body : bodies)
      sum += 0.5 * body.mass * squared_norm(body.velocity) +
             0.5 * dot(body.angular_velocity, body.inertia * body.angular_velocity);
    return sum;
  }

 private:
  struct OneNode {
    Vector3d position, velocity;
    double mass, inertia;
  };

  void add_body(const Vector3d& centre, const Vector3d& velocity) {
    RigidMotion body;
    body.centre = centre + 0.1 * vector();
    body.velocity = velocity;
    body.angular_velocity = vector();
    body.mass = 5;
    const Tensor<double> root = identity<double>() + 0.2 * outer_product(vector(), vector());
    body.inertia = root * transposed(root);
    const double inverse_mass = 1 / body.mass;
    body.inverse_mass = {inverse_mass, inverse_mass, inverse_mass};
    body.inverse_inertia = inverse(body.inertia);
    bodies.push_back(body);
  }
  void carry_bodies() {
    for (std::size_t b = 0; b < bodies.size(); ++b)
      for (int node : rigid_nodes_[b]) {
        const auto n = index(node);
        const Vector3d velocity = bodies[b].velocity_at(x(n) - bodies[b].centre);
        for (int axis = 0; axis < 3; ++axis) nodes.record[n].velocity[axis] = velocity[axis];
      }
  }

  std::mt19937 random_;
  std::vector<OneNode> nodes_;
  std::vector<std::vector<int>> connectivity_, rigid_nodes_;
  ThreadTeam team_{1};
};

ContactOptions by_distance(double coefficient = usual_friction) {
  ContactOptions options;
  options.friction = coefficient;
  options.passes = 100;
  return options;
}

class Kinds : public testing::TestWithParam<std::tuple<Kind, Kind>> {};

TEST_P(Kinds, KeepMomentumAndAngularMomentumWithFriction) {
  const auto [first, second] = GetParam();
  int met = 0;
  double rubbed = 0;
  for (unsigned seed = 1; seed <= 12; ++seed) {
    std::srand(seed);
    FreePieces pieces(seed);
    const double r = 0.05 * pieces.number();
    pieces.add(first, {2.6 + r, 1.84, 1.2}, {0.5, 0.2, -1});
    pieces.add(second, {3, 2, -0.4}, {0, 0, 1});
    pieces.start(by_distance());
    const double dt = 2e-3;
    for (int step = 0; step < 900 && met < 20 * static_cast<int>(seed); ++step) {
      const Vector3d linear = pieces.momentum(), angular = pieces.angular_momentum();
      pieces.resolve(dt);
      const double size = pieces.size_of_motion();
      EXPECT_LE(norm(pieces.momentum() - linear), 1e-12 * size) << "seed " << seed << " step " << step;
      EXPECT_LE(norm(pieces.angular_momentum() - angular), 1e-12 * size)
          << "seed " << seed << " step " << step;
      met += pieces.scene.step.active > 0;
      rubbed -= pieces.scene.step.friction_work();
      pieces.move(dt);
    }
  }
  EXPECT_GT(met, 2);
  const bool particles = first == Kind::particle && second == Kind::particle;
  if (particles)
    EXPECT_EQ(rubbed, 0) << "nothing of two particles could take the couple of friction";
  else
    EXPECT_GT(rubbed, 0);
}

INSTANTIATE_TEST_SUITE_P(All, Kinds,
                         testing::Combine(testing::ValuesIn(all_kinds), testing::ValuesIn(all_kinds)));

TEST(Resolution, AccountsForTheEnergyLostByMotion) {
  for (const Kind kind : all_kinds) {
    FreePieces pieces(7);
    std::srand(7);
    pieces.add(kind, {0, 0, 1}, {0.4, 0.2, -1});
    pieces.add(Kind::shell, {0, 0, -0.2}, {0, 0, 1});
    pieces.start(by_distance());
    int met = 0;
    for (int step = 0; step < 600; ++step) {
      const double before = pieces.kinetic_energy();
      pieces.resolve(2e-3);
      const ContactStep& did = pieces.scene.step;
      EXPECT_NEAR(pieces.kinetic_energy() - before, did.normal_work() + did.friction_work(), 1e-12 * before);
      met += did.active > 0;
      pieces.move(2e-3);
    }
    EXPECT_GT(met, 0);
  }
}

/// Nodes of a block from `first` on and their mirror images across x = 0.
void expect_mirrored(const SpringModel& model, double tolerance) {
  for (int a = 0; a < model.count(); ++a) {
    double best = infinity;
    for (int b = 0; b < model.count(); ++b)
      best =
          std::min(best, norm(Vector3d{-model.x(b).x, model.x(b).y, model.x(b).z} - model.x(a)) +
                             0.01 * norm(Vector3d{-model.v(b).x, model.v(b).y, model.v(b).z} - model.v(a)));
    ASSERT_LE(best, tolerance) << "node " << a;
  }
}

TEST(Resolution, KeepsTheSymmetryOfMirrorImages) {
  SpringModel model;
  model.add_box({6, 5, 2}, {3, 2.5, 0.6}, 1, shifted({-1.5, -1.25, -0.6}));
  const int first = model.add_box({4, 3, 2}, {1.7, 1.3, 0.8}, 1, shifted({-0.85, -0.6, 0.05}));
  model.throw_from(first, {0, 0.6, -2});
  model.stiffness = 300;
  model.start(by_distance());
  double rubbed = 0;
  for (int step = 0; step < 400; ++step) {
    model.step(1e-3);
    rubbed -= model.scene.step.friction_work();
    SCOPED_TRACE(step);
    expect_mirrored(model, 1e-12);
    if (HasFatalFailure()) return;
  }
  EXPECT_GT(rubbed, 0);
}

TEST(Resolution, OfABrickAtRestOnAFlatFaceIsOneCheck) {
  SpringModel model;
  const int first = model.add_box({1, 1, 2}, {1, 1, 0.5}, 1, shifted({0, 0, -0.5}));
  model.add_box({3, 3, 2}, {0.8, 0.8, 0.5}, 1, shifted({0.1, 0.1, 0.0012}));
  model.gravity = {0, 0, -1};
  model.damping = 20;
  model.stiffness = 30;
  model.start(by_distance());
  model.hold(first, first + 12);
  for (int step = 0; step < 1500; ++step) model.step(1e-3);
  int solved = 0;  // closest points on a face that is flat but for rounding lie on either triangulation
  for (int step = 0; step < 3000; ++step) {
    model.step(1e-3);
    EXPECT_GE(model.scene.step.active, 16);
    if (model.scene.step.passes > 1) ++solved;
  }
  EXPECT_LE(solved, 30) << "one step in a hundred";
}

// A sheet whose nodes are tied above the faces of a box, and a block that slides onto it.
TEST(Resolution, PushesWhatHoldsTiedNodes) {
  for (const double height : {0.0, 0.02}) {
    SpringModel model;
    model.add_box({2, 2, 1}, {2, 2, 0.5}, 1, shifted({0, 0, -0.5}));
    const int held = model.add_sheet({3, 3}, {1.5, 1.5}, 0.02, 1, shifted({0.21, 0.23, height}));
    const int block = model.add_box({1, 1, 1}, {0.4, 0.4, 0.4}, 1, shifted({0.7, 0.8, height + 0.013}));
    model.throw_from(block, {0.5, 0.3, -1});
    model.start(by_distance());
    Ties ties;
    const Surface& surface = model.scene.surface;
    for (int n = held; n < block; ++n)
      for (const Face& face : surface.face) {
        if (face.part != 0) continue;
        const FaceVertices corners = vertices(model.nodes, face);
        std::optional<Tie> tie = project(model.x(n), corners);
        if (!tie || std::abs(tie->gap) > 0.1) continue;
        tie->node = n;
        tie->corner = face.node;
        ties.node.push_back({.tie = *tie, .face_part = 0});
        break;
      }
    ASSERT_EQ(ties.node.size(), 16u);
    ties.moved_mass.resize(model.nodes.size());
    number(ties, model.nodes.size());
    condense(ties, model.nodes);
    ties.found.resize(1);
    exclude_tied_pairs(model.scene, ties, {0, 1, 2});
    double pushed = 0;
    for (int step = 0; step < 40; ++step) {
      for (std::size_t n = 0; n < model.nodes.size(); ++n)
        std::copy(model.nodes.record[n].velocity, model.nodes.record[n].velocity + 3,
                  model.nodes.velocity_before[n].component);
      const Vector3d linear = model.momentum(), angular = model.angular_momentum();
      const double energy = model.kinetic_energy();
      resolve(model.scene, model.nodes, 1e-3, model.alone(), {}, ties);
      EXPECT_LE(norm(model.momentum() - linear), 1e-13);
      EXPECT_LE(norm(model.angular_momentum() - angular), 1e-13);
      const ContactStep& did = model.scene.step;
      EXPECT_NEAR(model.kinetic_energy() - energy, did.normal_work() + did.friction_work(), 1e-12);
      for (int n = held; n < block; ++n)
        if (norm(model.scene.normal_impulse[index(surface.slave(n))]) > 0) pushed += 1;
      model.move(1e-3);
      place(ties, model.nodes, 1e-3);
    }
    EXPECT_GT(pushed, 0);
  }
}

TEST(Resolution, HasTheSameBitsForAnyNumberOfThreads) {
  std::vector<double> reference;
  for (const int threads : {1, 2, 3, 8}) {
    SpringModel model;
    model.add_box({6, 6, 2}, {3, 3, 0.8}, 1, shifted({-1.5, -1.5, -0.8}));
    const int first = model.add_box({5, 5, 2}, {2.1, 2.2, 0.8}, 1, shifted({-1, -1.1, 0.03}));
    model.throw_from(first, {0.3, 0.6, -2});
    model.stiffness = 300;
    model.start(by_distance());
    ThreadTeam team(threads);
    for (int step = 0; step < 100; ++step) model.step(1e-3, team);
    std::vector<double> now;
    for (int n = 0; n < model.count(); ++n)
      for (int axis = 0; axis < 3; ++axis) now.push_back(model.v(n)[axis]);
    if (reference.empty()) reference = now;
    EXPECT_TRUE(std::equal(now.begin(), now.end(), reference.begin(), [](double a, double b) {
      return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
    })) << threads;
  }
}

// The edges of two cubes cross at 4e-6 of their length, are pressed together, and one tilts while the other
// slides: where they meet then it is by the turn of their normal, of second order.
TEST(Resolution, OpensEdgesThatNearlyTouchAndTurn) {
  ThreadTeam team(1);
  SpringModel model;
  model.stiffness = 0;
  const double half = std::sqrt(0.5), tilt = 2e-2, slide = 4e-3, press = 1e-3, dt = 0.1;
  const int lower = model.add_box({1, 1, 1}, {1, 1, 1}, 1, [&](const Vector3d& x) -> Vector3d {
    const Vector3d y = x - Vector3d{0.5, 1, 1};
    return {y[0], half * (y[1] - y[2]), half * (y[1] + y[2])};
  });
  const int upper = model.add_box({1, 1, 1}, {1, 1, 1}, 1, [&](const Vector3d& x) -> Vector3d {
    const Vector3d y = x - Vector3d{0, 0.5, 0};
    return {half * (y[0] - y[2]), y[1], half * (y[0] + y[2]) + 4e-6};
  });
  model.start({});
  for (int n = lower; n < upper; ++n)
    model.set_velocity(n, Vector3d{-model.x(n)[2], 0, model.x(n)[0]} * (tilt / dt));
  for (int n = upper; n < model.count(); ++n) model.set_velocity(n, Vector3d{slide, 0, -press} / dt);
  const Vector3d momentum = model.momentum(), angular = model.angular_momentum();
  model.step(dt, team);
  EXPECT_GE(model.scene.rounds, 1U);
  EXPECT_LE(model.scene.rounds, 4U);
  EXPECT_EQ(model.scene.zones, 0U);
  EXPECT_LT(norm(model.momentum() - momentum), 1e-13);
  EXPECT_LT(norm(model.angular_momentum() - angular), 1e-13);
}

}  // namespace
}  // namespace brio::test
