// What meets with no node near: crossed edges of solids and shells, beams.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "src/base/index.hpp"
#include "tests/core/scene.hpp"

namespace brio {
namespace {

using namespace test;

constexpr double degree = 3.141592653589793 / 180;

Placement placed(Vector3d centre, Vector3d axis = {0, 0, 1}, double degrees = 0) {
  Placement placement;
  placement.translate = centre;
  if (degrees != 0) placement.rotate = Rotation{axis, degrees};
  return placement;
}

Part block(std::string name, Placement placement, std::array<int, 3> elements = {1, 1, 1}) {
  Part part = box(std::move(name), {1, 1, 1}, elements, {0, 0, 0}, hex8());
  part.placement = placement;
  return part;
}

Part beam(std::string name, Vector3d start, Vector3d end, int elements, double radius = 0.05) {
  Beam2 element;
  element.section = CircleSection{radius};
  LineMesh mesh;
  mesh.start = start;
  mesh.end = end;
  mesh.elements = elements;
  return {std::move(name), mesh, {}, element, "material"};
}

Part sheet(std::string name, Placement placement, std::array<int, 2> elements, double thickness = 0.1) {
  Shell4 element;
  element.thickness = thickness;
  PlateMesh mesh;
  mesh.size = {1, 1};
  mesh.elements = elements;
  return {std::move(name), mesh, placement, element, "material"};
}

Part ball(std::string name, Vector3d centre) {
  ParticleMesh mesh;
  mesh.sphere = ParticleSphere{0.3, 0.06};
  return {std::move(name), mesh, placed(centre), Particle{}, "material"};
}

/// What became of two bodies of which the second was thrown down at the first.
struct LineRun {
  double lower = 0, upper = 0;  ///< mean velocities along z at the end
  double deepest = 0;
  double momentum_error = 0, angular_error = 0;
  double energy_error = 0;
  int lines = 0;       ///< most contacts of lines that pushed in a step
  int wrong_side = 0;  ///< contacts that pulled the upper body through the lower
  std::vector<double> position;
};

LineRun drop(const Part& lower, const Part& upper, double speed, double end, int threads = 1) {
  Deck deck;
  deck.materials = {{"material", elastic(0.3)}};
  deck.parts = {lower, upper};
  deck.initial_conditions = {moving(upper.name, {0, 0, -speed})};
  deck.contact = ContactSection{};
  deck.time.end = end;
  deck.time.step_scale = 0.5;  // bodies of one element are integrated as coarsely as they are made
  Model model = build_model(deck);
  ThreadTeam team(threads);
  const auto before = momentum(model.nodes).total;
  LineRun outcome;
  run(model, deck, team, [&](Model& m) {
    const auto& contacts = m.contacts[0].contacts;
    for (const Contact& contact : contacts) {
      const auto of_upper = [&](int slave) { return slave >= static_cast<int>(m.parts[0].node.size()); };
      const bool first = of_upper(contact.node[0]);
      const bool second = of_upper(contact.node[index(contact.own)]);
      if (contact.impulse > 0 && first != second && (contact.normal[2] > 0) != first) ++outcome.wrong_side;
    }
    const auto pushing = std::count_if(contacts.begin(), contacts.end(), [](const Contact& contact) {
      return contact.of_edges() && contact.impulse > 0;
    });
    outcome.lines = std::max(outcome.lines, static_cast<int>(pushing));
  });
  const auto after = momentum(model.nodes).total;
  const double scale = model.parts[1].mass * speed;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    outcome.momentum_error =
        std::max(outcome.momentum_error, std::abs(after.linear[axis] - before.linear[axis]) / scale);
    outcome.angular_error =
        std::max(outcome.angular_error, std::abs(after.angular[axis] - before.angular[axis]) / scale);
  }
  outcome.lower = mean_velocity(model, 0, 2);
  outcome.upper = mean_velocity(model, 1, 2);
  outcome.deepest = model.contacts[0].totals.deepest_overlap;
  outcome.energy_error = std::abs(model.energy.relative_error());
  for (const NodeRecord& node : model.nodes.record)
    outcome.position.insert(outcome.position.end(), node.position, node.position + 3);
  return outcome;
}

struct Meeting {
  const char* name;
  Part lower, upper;
  double separation;  ///< least difference of speeds after it, over the speed before
  double end;
  bool flat = true;  ///< they push each other up and down only, not aside
};

void PrintTo(const Meeting& meeting, std::ostream* out) { *out << meeting.name; }

class CrossedLines : public testing::TestWithParam<Meeting> {};

TEST_P(CrossedLines, BounceOffEachOther) {
  const Meeting& meeting = GetParam();
  constexpr double speed = 10;
  const LineRun outcome = drop(meeting.lower, meeting.upper, speed, meeting.end);
  EXPECT_GT(outcome.lines, 0);
  EXPECT_TRUE(outcome.wrong_side == 0 || !meeting.flat) << outcome.wrong_side;
  EXPECT_GT(outcome.upper - outcome.lower, meeting.separation * speed);
  EXPECT_LT(outcome.deepest, 2e-3) << "share of the size of a cube";
  EXPECT_LT(outcome.momentum_error, 1e-12);
  EXPECT_LT(outcome.angular_error, 1e-11);
  EXPECT_LT(outcome.energy_error, 1e-2);
}

TEST_P(CrossedLines, DoTheSameForAnyNumberOfThreads) {
  const Meeting& meeting = GetParam();
  EXPECT_EQ(drop(meeting.lower, meeting.upper, 10, meeting.end, 1).position,
            drop(meeting.lower, meeting.upper, 10, meeting.end, 3).position);
}

// A fifth of the wave speed: a quarter of an element in a step.
TEST_P(CrossedLines, DoNotPassAtHighSpeed) {
  const Meeting& meeting = GetParam();
  const LineRun outcome = drop(meeting.lower, meeting.upper, 200, 3e-3);
  EXPECT_GT(outcome.lines, 0);
  EXPECT_TRUE(outcome.wrong_side == 0 || !meeting.flat) << outcome.wrong_side;
  EXPECT_GT(outcome.upper - outcome.lower, -150);
  EXPECT_LT(outcome.deepest, 2e-2);
}

const double half_diagonal = std::sqrt(0.5);

INSTANTIATE_TEST_SUITE_P(
    OfTwo, CrossedLines,
    testing::Values(
        Meeting{"cubes_face_to_face_turned_by_45_degrees", block("a", {}),
                block("b", placed({0, 0, 1.001}, {0, 0, 1}, 45)), 0.2, 0.02},
        Meeting{"cubes_edge_on_edge", block("a", placed({0, 0, 0}, {1, 0, 0}, 45)),
                block("b", placed({0.03, 0.02, 2 * half_diagonal + 0.001}, {0, 1, 0}, 45)), 0.2, 0.02},
        Meeting{"finer_cubes_edge_on_edge", block("a", placed({0, 0, 0}, {1, 0, 0}, 45), {3, 3, 3}),
                block("b", placed({0.03, 0.02, 2 * half_diagonal + 0.001}, {0, 1, 0}, 45), {2, 2, 2}), 0.2,
                0.02},
        Meeting{"beams", beam("a", {-1, 0.03, 0}, {1, 0.03, 0}, 5),
                beam("b", {0.02, -1, 0.101}, {0.02, 1, 0.101}, 5), 0.1, 0.02},
        Meeting{"beam_on_edge_of_cube", block("a", placed({0, 0, 0}, {1, 0, 0}, 45)),
                beam("b", {0.02, -1, half_diagonal + 0.051}, {0.02, 1, half_diagonal + 0.051}, 3), 0.05,
                0.02},
        Meeting{"beam_on_edge_of_shell", sheet("a", placed({0, 0, 0}, {1, 0, 0}, 90), {2, 2}),
                beam("b", {0.02, -1, 0.601}, {0.02, 1, 0.601}, 3), 0.05, 0.02},
        Meeting{"shell_edge_on_shell_edge", sheet("a", placed({0, 0, 0}, {1, 0, 0}, 90), {3, 3}),
                sheet("b", placed({0.03, 0.02, 1.101}, {0, 1, 0}, 90), {3, 3}), 0.1, 0.02},
        Meeting{"shell_edge_on_edge_of_cube", block("a", placed({0, 0, 0}, {1, 0, 0}, 45)),
                sheet("b", placed({0.03, 0.02, half_diagonal + 0.551}, {0, 1, 0}, 90), {3, 3}), 0.1, 0.02},
        Meeting{"corner_of_cube_on_beam", beam("a", {-1, 0, 0}, {1, 0, 0}, 1),
                block("b", placed({0, 0.001, std::sqrt(0.75) + 0.051}, {1, -1, 0},
                                  std::acos(std::sqrt(1.0 / 3)) / degree)),
                0.01, 0.02},
        Meeting{"ball_of_particles_on_beam", beam("a", {-1, 0.05, 0.2}, {1, 0.05, 0.2}, 4),
                ball("b", {0.1, 0.1, 0.56}), -0.2, 0.01, false},
        Meeting{"two_balls_of_particles", ball("a", {0, 0, -0.05}), ball("b", {0.1, 0.1, 0.56}), 0.5, 0.01,
                false}),
    [](const auto& of) { return std::string(of.param.name); });

TEST(Lines, OfOneBeamThatIsBentDoNotPushEachOther) {
  Deck deck;
  deck.materials = {{"material", elastic(0.3)}};
  deck.parts = {beam("a", {0, 0, 0}, {0.4, 0, 0}, 8)};  // elements half as long as they are thick
  deck.contact = ContactSection{};
  deck.time.end = 1e-3;
  Model model = build_model(deck);
  ThreadTeam team(1);
  run(model, deck, team, [](Model& m) { ASSERT_EQ(m.contacts[0].step.active, 0); });
}

TEST(Lines, AreNotLookedAtWhereTheDeckSaysSo) {
  Deck deck;
  deck.materials = {{"material", elastic(0.3)}};
  deck.parts = {block("a", {}), block("b", placed({0, 0, 1.001}, {0, 0, 1}, 45))};
  deck.contact = ContactSection{};
  deck.contact->options.edges = false;
  deck.time.end = 1e-5;
  Model model = build_model(deck);
  ThreadTeam team(1);
  run(model, deck, team);
  EXPECT_GT(model.contacts[0].pairs.node_face.size(), 0U);
  EXPECT_EQ(model.contacts[0].pairs.edge_edge.size(), 0U);
}

}  // namespace
}  // namespace brio
