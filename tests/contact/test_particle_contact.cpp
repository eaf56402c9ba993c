// A particle against places of a fixed cube: a sphere on its faces, edges, corners and seams.

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "contact/scene.hpp"

namespace brio {
namespace {

constexpr double particle_radius = 0.05;
constexpr double mass = 0.7;
constexpr double speed = 10;

/// Where on the surface of the cube of side 1 about the origin, and the unit vector from there to the
/// particle.
struct Throw {
  const char* name;
  Vector3d aim;
  Vector3d from;
};

void PrintTo(const Throw& given, std::ostream* out) { *out << given.name; }

/// The cube, of 2 x 2 x 2 hexahedra, fixed, and one particle after it.
class Scene {
 public:
  Scene(const Vector3d& x, const Vector3d& v) {
    std::vector<Vector3d> position;
    for (int k = 0; k < 3; ++k)
      for (int j = 0; j < 3; ++j)
        for (int i = 0; i < 3; ++i) position.emplace_back(0.5 * i - 0.5, 0.5 * j - 0.5, 0.5 * k - 0.5);
    for (int k = 0; k < 2; ++k)
      for (int j = 0; j < 2; ++j)
        for (int i = 0; i < 2; ++i) {
          const int n = i + 3 * j + 9 * k;
          for (int corner : {n, n + 1, n + 4, n + 3, n + 9, n + 10, n + 13, n + 12}) cube_.push_back(corner);
        }
    particle_.push_back(static_cast<int>(position.size()));
    position.push_back(x);
    nodes = Nodes(position.size(), false);
    nodes.prescribed = AlignedBuffer<std::uint8_t>(position.size());
    nodes.velocity_before = AlignedBuffer<NodeVector>(position.size());
    for (std::size_t n = 0; n < position.size(); ++n) {
      const bool thrown = n + 1 == position.size();
      for (int axis = 0; axis < 3; ++axis) {
        nodes.record[n].position[axis] = position[n][axis];
        nodes.record[n].velocity[axis] = thrown ? v[axis] : 0;
      }
      nodes.mass[n] = mass;
      nodes.record[n].inverse_mass = thrown ? 1 / mass : 0;
    }
    const std::vector<SurfacePart> parts{{.name = "cube", .connectivity = cube_, .thickness = {}},
                                         {.name = "particle",
                                          .nodes_per_element = 1,
                                          .connectivity = particle_,
                                          .thickness = {2 * particle_radius}}};
    scene = make_contact_scene({}, parts, nodes);
  }

  /// \returns the impulse on the particle.
  Vector3d step(double dt) {
    NodeRecord& own = nodes.record[nodes.size() - 1];
    for (int axis = 0; axis < 3; ++axis)
      nodes.velocity_before[nodes.size() - 1].component[axis] = own.velocity[axis];
    resolve(scene, nodes, dt, team_);
    for (int axis = 0; axis < 3; ++axis) own.position[axis] += dt * own.velocity[axis];
    Vector3d impulse{};
    for (const Contact& contact : scene.contacts)
      impulse += contact.impulse * contact.normal + contact.friction;
    return impulse;
  }
  Vector3d particle() const { return vector_at(nodes.record[nodes.size() - 1].position); }

  Nodes nodes{0, false};
  ContactScene scene;

 private:
  std::vector<int> cube_, particle_;
  ThreadTeam team_{1};
};

class OneParticle : public testing::TestWithParam<Throw> {};

// The same impulse stops it everywhere, and it comes to rest at its radius.
TEST_P(OneParticle, IsStoppedByOneImpulse) {
  const auto& [name, aim, from] = GetParam();
  for (const double dt : {1e-5, 1e-3, 2e-2}) {  // 1e-4, 0.01 and 0.2 of the cube a step
    const double gap = 0.37 * speed * dt;
    // The skin of the cube; the diameter of the particle is the smallest edge.
    const double touching = particle_radius + skin_share * 2 * particle_radius;
    Scene scene(aim + (touching + gap) * from, -speed * from);
    Vector3d impulse{};
    for (int i = 0; i < 20; ++i) impulse += scene.step(dt);
    EXPECT_NEAR(dot(impulse, from), mass * speed, 1e-10 * mass * speed) << dt;
    EXPECT_LT(norm(impulse - dot(impulse, from) * from), 1e-10 * mass * speed) << dt;
    EXPECT_NEAR(dot(scene.particle() - aim, from), touching, 1e-10) << dt;
    EXPECT_EQ(scene.scene.totals.most_contacts, 1) << dt;
  }
}

const double half = std::sqrt(0.5);
const double third = std::sqrt(1.0 / 3);

INSTANTIATE_TEST_SUITE_P(Hits, OneParticle,
                         testing::Values(Throw{"middle_of_a_face", {0.25, 0.25, 0.5}, {0, 0, 1}},
                                         Throw{"face", {0.21, 0.37, 0.5}, {0, 0, 1}},
                                         Throw{"seam_of_coplanar_faces", {0.25, 0, 0.5}, {0, 0, 1}},
                                         Throw{"seam_but_for_rounding", {0.25, 1e-16, 0.5}, {0, 0, 1}},
                                         Throw{"where_four_faces_meet", {0, 0, 0.5}, {0, 0, 1}},
                                         Throw{"edge", {0.5, 0.2, 0.5}, {half, 0, half}},
                                         Throw{"node_of_an_edge", {0.5, 0, 0.5}, {half, 0, half}},
                                         Throw{"corner", {0.5, 0.5, 0.5}, {third, third, third}}),
                         [](const auto& of) { return std::string(of.param.name); });

}  // namespace
}  // namespace brio
