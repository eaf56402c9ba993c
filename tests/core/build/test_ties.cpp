#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "contact/surface/face_geometry.hpp"
#include "src/base/index.hpp"
#include "src/build/build_ties.hpp"
#include "src/output/observe.hpp"
#include "tests/core/build/tied_scene.hpp"
#include "tests/core/scene.hpp"
#include "tests/rotation_about.hpp"

namespace brio {
namespace {

using namespace test;

Vector3d place_of(const Model& model, std::size_t part, std::size_t mesh_node) {
  return position(model.nodes, model.parts[part].node[mesh_node]);
}

double total_energy(const Model& model) {
  return model.energy.kinetic + model.energy.internal + model.energy.hourglass + model.energy.viscous;
}

// ---- patch tests

/// Largest deviation of the axial stress from its mean, over the mean, of two boxes that are stretched
/// between planes without friction: at a uniform rate, from a uniform rate on, so that nothing accelerates.
double stretched_unevenness(Deck deck) {
  for (const char* part : {"coarse", "fine"}) {
    deck.boundary_conditions.push_back(fix(std::string(part) + ".xmin", {0}));
    deck.boundary_conditions.push_back(fix(std::string(part) + ".ymin", {1}));
    deck.boundary_conditions.push_back(fix(std::string(part) + ".xmax", {0}));
    deck.boundary_conditions.push_back(fix(std::string(part) + ".ymax", {1}));
  }
  deck.boundary_conditions.push_back(fix("coarse.zmin", {2}));
  PrescribedMotion pull = fix("fine.zmax", {2});
  constexpr double rate = 1e-3;
  pull.components[0].curve.points = {{0, 2 * rate}};
  deck.boundary_conditions.push_back(pull);
  Model model = build_model(deck);
  set_velocities(model, {0, 0, rate}, diagonal({0, 0, rate}));
  ThreadTeam team(1);
  run(model, deck, team);
  double least = HUGE_VAL, largest = -HUGE_VAL;
  for (const Block& block : model.blocks)
    for (std::size_t e = 0; e < block.element_count; ++e) {
      const double stress = block.kernel.sample(block, model.nodes, e, true).stress.zz;
      least = std::min(least, stress);
      largest = std::max(largest, stress);
    }
  EXPECT_GT(least, 0);
  return (largest - least) / (largest + least);
}

TEST(Ties, NestedMeshesPassThePatchTest) {
  EXPECT_LT(stretched_unevenness(two_boxes({2, 2, 2}, {4, 4, 4})), 1e-10);
  EXPECT_LT(stretched_unevenness(two_boxes({1, 2, 2}, {3, 4, 2})), 1e-10);
}

// Corners receive what collocated nodes carry, not what a uniform traction would give them: the known error
// of holding nodes by a surface, bound to the rows beside it.
TEST(Ties, OtherMeshesStretchUnevenlyWithinBounds) {
  const double third = stretched_unevenness(two_boxes({2, 2, 2}, {3, 3, 3}));
  EXPECT_GT(third, 1e-3);
  EXPECT_LT(third, 0.2);
  EXPECT_LT(stretched_unevenness(two_boxes({3, 3, 3}, {10, 10, 10})), 0.05);
}

// ---- waves

/// A bar of length 2 along z, pushed at its end for a while. \return share of the amplitude that comes back
/// from its middle.
double reflection(std::array<int, 3> first, std::array<int, 3> second, bool tie_second) {
  Deck deck;
  deck.materials = {{"material", elastic(0)}};
  deck.parts = {box("first", {0.1, 0.1, 1}, first, {0, 0, 0.5}, inviscid_hex8()),
                box("second", {0.1, 0.1, 1}, second, {0, 0, 1.5}, inviscid_hex8())};
  deck.connections = {tie_second ? tied("second.zmin", "first") : tied("first.zmax", "second")};
  PrescribedMotion push = fix("first.zmin", {2});
  std::vector<std::array<double, 2>>& points = push.components[0].curve.points;
  points.clear();
  constexpr double length = 5e-4;
  for (int i = 0; i <= 100; ++i) points.push_back({i * length / 100, std::pow(std::sin(M_PI * i / 100), 2)});
  deck.boundary_conditions = {push};
  deck.time.end = 1.7e-3;
  Model model = build_model(deck);
  ThreadTeam team(1);
  run(model, deck, team);
  double left = 0, all = 0;
  for (std::size_t p = 0; p < 2; ++p)
    for (int node : model.parts[p].node) {
      const double energy = model.nodes.mass[index(node)] * squared_norm(velocity(model.nodes, node));
      all += energy;
      if (p == 0) left += energy;
    }
  return std::sqrt(left / all);
}

// The finer mesh is to be tied: nodes tied to few corners load those alone.
TEST(Ties, WavePassesFromCoarseToFineAndBack) {
  EXPECT_LT(reflection({2, 2, 60}, {4, 4, 60}, true), 1e-3);
  EXPECT_LT(reflection({3, 3, 60}, {10, 10, 60}, true), 2e-3);
  EXPECT_LT(reflection({10, 10, 60}, {3, 3, 60}, false), 2e-3);
  EXPECT_LT(reflection({4, 4, 60}, {5, 5, 60}, true), 5e-3);
  EXPECT_LT(reflection({2, 2, 60}, {3, 3, 50}, true), 2e-2);
  EXPECT_GT(reflection({2, 2, 60}, {4, 4, 60}, false), 0.1);
}

// ---- momentum and energy

struct Conserved {
  double linear = 0, angular = 0, energy = 0;
};

/// Throw, spin and squeeze a scene; largest errors over its run.
Conserved thrown(const Deck& deck, double spin, double squeeze) {
  Model model = build_model(deck);
  const Tensor<double> gradient{{{squeeze, -spin, 0.3 * spin},
                                 {spin, 0.5 * squeeze, -0.7 * spin},
                                 {-0.3 * spin, 0.7 * spin, -squeeze}}};
  set_velocities(model, {3, -1, 2}, gradient);
  Conserved errors;
  Momentum start;
  double energy = 0, largest_internal = 0;
  ThreadTeam team(1);
  run(model, deck, team, [&](Model& m) {
    const Momentum now = momentum(m.nodes);
    if (m.step == 0) {
      start = now;
      energy = total_energy(m);
    }
    for (std::size_t i = 0; i < 3; ++i) {
      errors.linear =
          std::max(errors.linear, std::abs(now.total.linear[i] - start.total.linear[i]) / start.linear_size);
      errors.angular = std::max(errors.angular,
                                std::abs(now.total.angular[i] - start.total.angular[i]) / start.angular_size);
    }
    errors.energy = std::max(errors.energy, std::abs(total_energy(m) - energy) / energy);
    largest_internal = std::max(largest_internal, m.energy.internal);
  });
  EXPECT_GT(largest_internal, 1e-3 * energy);
  return errors;
}

/// What the elements themselves lose: the same of one mesh.
double error_of_elements() {
  Deck deck = two_boxes({3, 3, 3}, {3, 3, 3});
  deck.connections = {Merge{{"coarse", "fine"}, 1e-3, "deck.yaml:3:5"}};
  return thrown(deck, 50, 10).energy;
}

TEST(Ties, OnFacesKeepMomentumAndEnergy) {
  const Conserved errors = thrown(two_boxes({2, 2, 2}, {3, 3, 3}), 50, 10);
  EXPECT_LT(errors.linear, 1e-12);
  EXPECT_LT(errors.angular, 1e-12);
  EXPECT_LT(errors.energy, 1.1 * error_of_elements());
}

TEST(Ties, AwayFromFacesOfSolidsKeepMomentumAndEnergy) {
  const Conserved errors = thrown(two_boxes({2, 2, 2}, {3, 3, 3}, 0.1), 50, 10);
  EXPECT_LT(errors.linear, 1e-12);
  EXPECT_LT(errors.angular, 1e-12);
  EXPECT_LT(errors.energy, 1.1 * error_of_elements());
}

TEST(Ties, AwayFromShellsKeepMomentumAndEnergy) {
  const Conserved errors = thrown(stiffened_panel(), 20, 2);
  EXPECT_LT(errors.linear, 1e-12);
  EXPECT_LT(errors.angular, 1e-12);
  EXPECT_LT(errors.energy, 1e-3);
}

TEST(Ties, ShellsOnSolidsKeepMomentumAndEnergy) {
  Deck deck = two_boxes({2, 2, 2}, {1, 1, 1});
  deck.parts[1] = plate("fine", {0.9, 0.8}, {5, 3}, {0, 0, 0.05}, 0.1);
  deck.connections = {tied("fine", "coarse", 0.06)};
  const Conserved errors = thrown(deck, 50, 10);
  EXPECT_LT(errors.linear, 1e-12);
  EXPECT_LT(errors.angular, 1e-12);
  EXPECT_LT(errors.energy, 1e-3);
}

TEST(Ties, OfTiesKeepMomentumAndEnergy) {
  Deck deck = two_boxes({2, 2, 2}, {3, 3, 3});
  deck.parts.push_back(box("finest", {1, 1, 0.5}, {5, 5, 2}, {0, 0, 1.25}, inviscid_hex8()));
  deck.connections.push_back(tied("finest.zmin", "fine"));
  // Their faces meet where the first are tied: nodes of the third lie on tied nodes.
  deck.parts.push_back(box("side", {0.5, 1, 2}, {2, 5, 9}, {0.75, 0, 0}, inviscid_hex8()));
  deck.connections.push_back(tied("side.xmin", "fine"));
  const Conserved errors = thrown(deck, 50, 10);
  EXPECT_LT(errors.linear, 1e-12);
  EXPECT_LT(errors.angular, 1e-12);
  EXPECT_LT(errors.energy, 1.1 * error_of_elements());
}

// ---- no drift

void expect_held(const Deck& deck, double spin, double squeeze) {
  Model model = build_model(deck);
  std::vector<TiedNode> start = model.ties.node;
  const Tensor<double> gradient{
      {{squeeze, -spin, 0}, {spin, squeeze, 0.5 * spin}, {0, -0.5 * spin, -squeeze}}};
  set_velocities(model, {3, -1, 2}, gradient);
  ThreadTeam team(1);
  run(model, deck, team);
  EXPECT_GT(model.step, 100000);
  EXPECT_EQ(start.size(), model.ties.node.size());
  for (std::size_t i = 0; i < start.size(); ++i) {
    const Tie& tie = model.ties.node[i].tie;
    FaceVertices face;
    for (std::size_t k = 0; k < 4; ++k) face[k] = position(model.nodes, tie.corner[k]);
    const Vector3d x = position(model.nodes, tie.node);
    if (tie.turning) {
      EXPECT_NEAR(norm(x - point_on(tie, face)), norm(start[i].tie.arm), 1e-11);
      continue;
    }
    const auto found = project(x, face);
    ASSERT_TRUE(found.has_value());
    EXPECT_NEAR(found->gap, start[i].tie.gap, 1e-11);
    for (std::size_t k = 0; k < 4; ++k) EXPECT_NEAR(found->weight[k], start[i].tie.weight[k], 1e-10);
  }
}

TEST(TiesSlow, HoldForAHundredThousandSteps) {
  Deck deck = two_boxes({1, 1, 1}, {2, 2, 1}, 0.05);
  deck.time.end = 45;
  expect_held(deck, 50, 1);
  deck = stiffened_panel(0.03, 4);
  deck.parts[0] = plate("panel", {1, 0.1}, {4, 1}, {0, 0, 0}, 0.02);
  deck.time.end = 8;
  expect_held(deck, 20, 1);
}

// ---- symmetry

Rotation turn() { return {{1, 2, 3}, 37}; }
Tensor<double> turn_matrix() { return rotation_about(37 * M_PI / 180, Vector3d{1, 2, 3}); }

Model ran(Deck deck, const Tensor<double>& frame, int threads = 1) {
  Model model = build_model(deck);
  const Tensor<double> gradient{{{5, -20, 3}, {10, 4, -6}, {7, 8, -9}}};
  set_velocities(model, Vector3d{}, frame * gradient * transposed(frame));
  ThreadTeam team(threads);
  run(model, deck, team);
  return model;
}

void expect_same_in_another_frame(const Deck& deck) {
  const Model reference = ran(deck, identity<double>());
  Deck other = deck;
  const Tensor<double> frame = turn_matrix();
  for (Part& part : other.parts) {
    const Vector3d moved = frame * part.placement.translate;
    part.placement = {turn(), {moved[0], moved[1], moved[2]}};
  }
  const Model turned = ran(other, frame);
  for (std::size_t p = 0; p < deck.parts.size(); ++p)
    for (std::size_t i = 0; i < reference.parts[p].node.size(); ++i)
      EXPECT_LT(norm(frame * place_of(reference, p, i) - place_of(turned, p, i)), 1e-9);
}

TEST(Ties, AreTheSameInAnotherFrame) {
  Deck deck = two_boxes({2, 2, 2}, {3, 3, 3}, 0.1);
  deck.time.end = 5e-3;
  expect_same_in_another_frame(deck);
}

TEST(Ties, AreTheSameInAMirror) {
  Deck deck = two_boxes({2, 2, 2}, {3, 3, 3}, 0.1);
  deck.time.end = 5e-3;
  const Model reference = ran(deck, identity<double>());
  Tensor<double> mirror = identity<double>();
  mirror(0, 0) = -1;
  const Model mirrored = ran(deck, mirror);
  const Model start = build_model(deck);
  for (std::size_t p = 0; p < 2; ++p)
    for (std::size_t i = 0; i < start.parts[p].node.size(); ++i) {
      std::size_t image = 0;
      double closest = HUGE_VAL;
      for (std::size_t j = 0; j < start.parts[p].node.size(); ++j) {
        const double distance = norm(mirror * place_of(start, p, i) - place_of(start, p, j));
        if (distance < closest) image = j;
        closest = std::min(closest, distance);
      }
      EXPECT_LT(norm(mirror * place_of(reference, p, i) - place_of(mirrored, p, image)), 1e-9);
    }
}

TEST(Ties, AreTheSameBitsForAnyNumberOfThreads) {
  for (const Deck& deck : {two_boxes({3, 3, 3}, {7, 7, 7}, 0.1), stiffened_panel()}) {
    const Model reference = ran(deck, identity<double>());
    for (int threads : {2, 4}) {
      const Model model = ran(deck, identity<double>(), threads);
      for (std::size_t i = 0; i < model.nodes.size(); ++i)
        for (int axis = 0; axis < 3; ++axis)
          ASSERT_EQ(model.nodes.record[i].position[axis], reference.nodes.record[i].position[axis]);
    }
  }
}

// ---- stiffeners

/// Frequency over that of a beam of both sections.
double swinging(int shells, int beams) {
  constexpr double height = 0.03;  // of the axis of the beam above the middle of the panel
  Deck deck = stiffened_panel(height, beams);
  deck.parts[0] = plate("panel", {1, 0.1}, {shells, 2}, {0, 0, 0}, 0.02);
  const double panel = 0.1 * 0.02, stiffener = 0.02 * 0.04;
  const double offset = height * panel * stiffener / (panel + stiffener);
  const double inertia = (0.1 * std::pow(0.02, 3) + 0.02 * std::pow(0.04, 3)) / 12 + offset * height;
  const double frequency =
      std::pow(1.8751041, 2) * std::sqrt(1e9 * inertia / (1000 * (panel + stiffener))) / (2 * M_PI);
  deck.boundary_conditions = {fix("panel.xmin", {0, 1, 2, 3, 4, 5}),
                              fix("stiffener.start", {0, 1, 2, 3, 4, 5})};
  NodalForce push;
  push.where.set = "panel.xmax";
  push.force = {0, 0, 0.5};
  deck.loads = {push};
  constexpr int swings = 3;
  deck.time.end = (swings + 0.75) / frequency;
  Model model = build_model(deck);
  EXPECT_EQ(model.ties.found[0].count, beams + 1);
  const auto tip = index(model.parts[1].node[index(beams)]);
  const double mean = height + 1.5 / (3 * 1e9 * inertia);
  std::vector<double> crossings;
  double before = 0, time_before = 0;
  ThreadTeam team(1);
  run(model, deck, team, [&](Model& m) {
    const double above = m.nodes.record[tip].position[2] - mean;
    if (before < 0 && above >= 0)
      crossings.push_back(time_before + (m.times.time - time_before) * before / (before - above));
    before = above;
    time_before = m.times.time;
  });
  EXPECT_EQ(crossings.size(), index(swings + 1));
  EXPECT_LT(model.energy.error_max, 1e-3);
  return swings / (crossings.back() - crossings.front()) / frequency;
}

TEST(TiesSlow, StiffenedPanelSwingsAsOneBeam) {
  EXPECT_NEAR(swinging(16, 16), 1, 0.01);
  EXPECT_NEAR(swinging(16, 24), 1, 0.01);
  EXPECT_NEAR(swinging(32, 24), 1, 0.01);
  // Between nodes of a shell its deflection is straight: beams much shorter than shells cannot bend.
  EXPECT_GT(swinging(16, 48), 1.03);
}

// ---- energy and momentum balance

TEST(Ties, PartsShareNothingButWhatTheyWeigh) {
  Deck deck = two_boxes({2, 2, 2}, {3, 3, 3});
  deck.initial_conditions = {moving("coarse", {1, 2, 3}), moving("fine", {1, 2, 3})};
  Model model = build_model(deck);
  double sum = 0;
  for (double mass : model.nodes.mass) sum += mass;
  EXPECT_NEAR(sum, 2000, 1e-9);
  EXPECT_NEAR(model.parts[1].mass, 1000, 1e-9);
  EXPECT_NEAR(momentum(model.nodes).total.linear[1], 4000, 1e-9);
  EXPECT_EQ(model.ties.step_share, 1);
  ThreadTeam team(1);
  update_velocities(model, 0.1, team);
  std::vector<double> row;
  observe_history(model, row);
  const std::vector<std::string> names = history_columns(model);
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (names[i] == "fine.velocity_y") {
      EXPECT_NEAR(row[i], 2, 1e-12);
    }
  }
}

// ---- what cannot be tied

std::string fault_of(const Deck& deck) {
  try {
    build_model(deck);
  } catch (const BuildError& fault) {
    return fault.place + ": " + fault.what();
  }
  return {};
}

TEST(Ties, ToWhatIsFarAreRefused) {
  Deck deck = two_boxes({2, 2, 2}, {3, 3, 3}, 0.1);
  deck.connections = {tied("fine.zmin", "coarse", 0.05)};
  EXPECT_EQ(
      fault_of(deck),
      "deck.yaml:3:5: no node of 'fine.zmin' lies within 0.05 of the surface of 'coarse'; at least one is "
      "expected");
}

TEST(Ties, OfOneNodeToTwoFacesAreRefused) {
  Deck deck = two_boxes({2, 2, 2}, {3, 3, 3});
  deck.connections.push_back(tied("fine.zmin", "coarse"));
  EXPECT_EQ(fault_of(deck).substr(0, 50), "deck.yaml:3:5: a node of 'fine.zmin' at (-0.5, -0.");
  EXPECT_NE(fault_of(deck).find("is tied to 'coarse' already; one tie is accepted per node"),
            std::string::npos);
}

TEST(Ties, InACircleAreRefused) {
  Deck deck = two_boxes({2, 2, 2}, {2, 2, 2});
  deck.connections.push_back(tied("coarse.zmax", "fine"));
  EXPECT_NE(fault_of(deck).find("would be tied to a face whose nodes are tied to it"), std::string::npos);
}

TEST(Ties, OfSupportedNodesToFreeFacesAreRefused) {
  Deck deck = two_boxes({2, 2, 2}, {3, 3, 3});
  deck.boundary_conditions = {fix("fine.xmin", {0})};
  EXPECT_NE(fault_of(deck).find("is prescribed, but not that of the face of 'coarse' that it is tied to"),
            std::string::npos);
  deck.boundary_conditions.push_back(fix("coarse.xmin", {0}));
  EXPECT_EQ(fault_of(deck), "");
}

TEST(Ties, MayStartTurning) {
  for (Deck deck : {two_boxes({2, 2, 2}, {3, 3, 3}, 0.1), stiffened_panel()}) {
    for (const Part& part : deck.parts) {
      deck.initial_conditions.push_back(moving(part.name, {1, 2, 3}));
      deck.initial_conditions.back().spin = Spin{{0.1, 0.2, 0.3}, {20, -30, 10}};
    }
    EXPECT_EQ(fault_of(deck), "");
  }
}

TEST(Ties, OfNodesThatStartOtherwiseAreRefused) {
  Deck deck = two_boxes({2, 2, 2}, {3, 3, 3});
  deck.initial_conditions = {moving("fine", {1, 0, 0})};
  EXPECT_NE(fault_of(deck).find("starts with another velocity than the face of 'coarse' that it is tied to"),
            std::string::npos);
}

}  // namespace
}  // namespace brio
