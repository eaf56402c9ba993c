// Supports and loads along the axes of local coordinate systems: a turned scene moves as the scene turned.

#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "src/base/index.hpp"
#include "src/model/state.hpp"
#include "src/step/relax.hpp"
#include "src/sweep/erosion.hpp"
#include "tests/core/supports/turned_scene.hpp"

namespace brio {
namespace {

using namespace test;

constexpr double same = 1e-10;

PrescribedMotion moved(std::string set, MotionKind kind, int axis, Curve curve, std::string name = "") {
  PrescribedMotion motion;
  motion.where.set = std::move(set);
  motion.kind = kind;
  motion.components = {{axis, std::move(curve)}};
  motion.name = std::move(name);
  return motion;
}

NodalForce pushing(std::string set, Vector3d force) {
  NodalForce load;
  load.where.set = std::move(set);
  load.force = force;
  load.factor = Curve{{{0, 0}, {5e-4, 1}}};
  return load;
}

NodalMoment turning(std::string set, Vector3d moment) {
  NodalMoment load;
  load.where.set = std::move(set);
  load.moment = moment;
  return load;
}

ForceOutput reactions_and_contact() {
  ForceOutput forces;
  forces.reactions.all = true;
  return forces;
}

// Symmetry planes on three sides, a force and gravity.
Deck block_on_three_planes() {
  Deck deck;
  deck.materials = {{"material", elastic(0.3)}};
  deck.parts = {box("block", {1, 0.5, 0.25}, {6, 3, 2}, {0.5, 0.25, 0.125}, hex8())};
  deck.boundary_conditions = {fix("block.xmin", {0}), fix("block.ymin", {1}), fix("block.zmin", {2})};
  deck.loads = {pushing("block.xmax", {1e4, -2e4, 3e4}), Gravity{{3e3, 2e3, -1e4}}};
  deck.output.history.forces = reactions_and_contact();
  deck.time.end = 2e-3;
  return deck;
}

TEST(SkewSupports, ABlockOnThreePlanesIsTurned) { expect_turned(block_on_three_planes(), same); }

TEST(SkewSupports, PrescribedMotionsAreTurned) {
  const Curve rising{{{0, 0}, {1e-3, 20}}};
  for (const MotionKind kind : {MotionKind::velocity, MotionKind::acceleration, MotionKind::displacement}) {
    Deck deck = block_on_three_planes();
    const double scale = kind == MotionKind::acceleration ? 1e3 : kind == MotionKind::displacement ? 1e-3 : 1;
    Curve curve = rising;
    curve.points.back()[1] *= scale;
    deck.boundary_conditions.push_back(moved("block.xmax", kind, 0, curve, "ram"));
    deck.boundary_conditions.push_back(moved("block.zmax", kind, 2, curve));
    expect_turned(deck, same);
  }
}

Deck shell_strip() {
  Shell4 shell;
  shell.thickness = 0.02;
  Deck deck;
  deck.materials = {{"material", elastic(0.3)}};
  deck.parts = {{"strip", PlateMesh{{1, 0.25}, {10, 3}}, {}, shell, "material"}};
  deck.parts[0].placement.translate = {0.5, 0.125, 0};
  deck.boundary_conditions = {fix("strip.xmin", {0, 1, 2, 3, 4, 5}), fix("strip.ymin", {1, 3, 5}),
                              moved("strip.xmax", MotionKind::velocity, 4, Curve{{{0, 0}, {1e-3, 50}}})};
  deck.loads = {pushing("strip.ymax", {30, -20, 50}), turning("strip.ymax", {3, 2, 1})};
  deck.output.history.forces = reactions_and_contact();
  deck.time.end = 3e-3;
  return deck;
}

TEST(SkewSupports, ShellsAreTurnedWithTheirRotations) { expect_turned(shell_strip(), same); }

TEST(SkewSupports, BeamsAreTurnedWithTheirRotations) {
  Beam2 beam;
  beam.section = RectangleSection{.width = 0.05, .height = 0.02};
  beam.orientation = {0, 0.1, 1};
  Deck deck;
  deck.materials = {{"material", elastic(0.3)}};
  deck.parts = {{"strip", LineMesh{{0, 0, 0}, {1, 0, 0}, 12}, {}, beam, "material"}};
  deck.boundary_conditions = {fix("strip.start", {0, 1, 2, 3, 5}), fix("strip.end", {1, 4}),
                              moved("strip.start", MotionKind::velocity, 4, Curve{{{0, -20}}})};
  deck.loads = {pushing("strip.end", {300, 0, 500}), turning("strip.end", {30, 20, 10})};
  deck.output.history.forces = reactions_and_contact();
  deck.time.end = 3e-3;
  expect_turned(deck, same);
}

// ---- directions that are not at right angles

/// A block thrown between two planes at 60 degrees, on which two of its sides stand.
Deck block_between_planes(double second_velocity = 0) {
  Deck deck;
  deck.materials = {{"material", elastic(0.3)}};
  deck.parts = {box("block", {1, 1, 0.5}, {2, 2, 1}, {0.5, 0.5, 0.25}, hex8())};
  const double c = 0.5, s = std::sqrt(3.0) / 2;
  deck.coordinate_systems = {{"plane", RectangularSystem{{s, -c, 0}, {0, 0, 1}}}};
  PrescribedMotion first = fix("block.ymin", {1}), second = fix("block.xmin", {0});
  first.name = "first";
  second.name = "second";
  second.system = "plane";
  if (second_velocity != 0) second.components[0].curve = Curve{{{0, second_velocity}}};
  deck.boundary_conditions = {first, second};
  deck.initial_conditions = {moving("block", {-3, -5, 7})};
  deck.output.history.forces = reactions_and_contact();
  deck.time.end = 1e-3;
  return deck;
}

TEST(SkewSupports, TwoPlanesLeaveTheirEdgeOnlyTheLineOfBoth) {
  const Deck deck = block_between_planes(2);
  Model model = build_model(deck);
  const double c = 0.5, s = std::sqrt(3.0) / 2;
  int edge = 0;
  ThreadTeam team(1);
  test::run(model, deck, team, [&](Model& now) {
    edge = 0;
    for (std::size_t i = 0; i < now.nodes.size(); ++i) {
      const double* v = now.nodes.record[i].velocity;
      if (now.nodes.prescribed_translations(i) != 3) continue;
      ++edge;
      EXPECT_NEAR(v[1], 0, 1e-13);
      EXPECT_NEAR(s * v[0] - c * v[1], 2, 1e-13);
    }
  });
  EXPECT_EQ(edge, 2);
  EXPECT_LT(model.energy.error_max, 1e-3);
  model.momentum.now = momentum(model.nodes).total;
  EXPECT_LT(model.momentum.linear_imbalance(), 1e-13);
  EXPECT_LT(model.momentum.angular_imbalance(), 1e-13);
  // Each plane pushes along its own normal.
  const Vector3d first = model.forces->reactions[0].impulse, second = model.forces->reactions[1].impulse;
  const double size = std::sqrt(dot(first, first) + dot(second, second));
  EXPECT_GT(std::abs(first[1]), 0.1 * size);
  EXPECT_NEAR(first[0], 0, 1e-13 * size);
  EXPECT_NEAR(first[2], 0, 1e-13 * size);
  EXPECT_GT(std::abs(second[0]), 0.1 * size);
  EXPECT_NEAR(second[0] * c + second[1] * s, 0, 1e-13 * size);
  // Together they are what the momentum balance knows of supports.
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_NEAR(first[i] + second[i], model.momentum.supports.linear[i], 1e-12 * size);
}

// The first impulse is known: m (v - v of the initial velocity), with least change.
TEST(SkewSupports, TheFirstImpulseIsTheLeastThatGivesBothComponents) {
  const Deck deck = block_between_planes(2);
  Model model = build_model(deck);
  ThreadTeam team(1);
  update_velocities(model, 1, team);
  const double c = 0.5, s = std::sqrt(3.0) / 2;
  for (std::size_t i = 0; i < model.nodes.size(); ++i) {
    const double* v = model.nodes.record[i].velocity;
    Vector3d expected{-3, -5, 7};
    const Vector3d n{s, -c, 0};
    const int held = model.nodes.prescribed_translations(i);
    const bool on_first = std::abs(model.nodes.record[i].position[1]) < 1e-9;
    if (held == 3) {
      expected = Vector3d{2 / s, 0, 7};
    } else if (held != 0) {
      expected = on_first ? Vector3d{-3, 0, 7} : expected + (2 - dot(n, expected)) * n;
    }
    EXPECT_LT(norm(vector_at(v) - expected), 1e-14 * 10) << i;
  }
}

// ---- sectors

/// Wall of a tube between radii 1 and 1.5, of hexahedra from the x axis on.
struct TubeSector {
  Deck deck;
  std::vector<Mesh> meshes;
  TubeSector(double degrees, int around, Element element = hex8()) {
    deck.materials = {{"material", elastic(0.3)}};
    deck.parts = {box("wall", {1, 1, 1}, {8, around, 1}, {0.5, 0.5, 0.5}, element)};
    meshes = {generate_mesh(deck.parts[0].mesh, deck.parts[0].placement)};
    const double angle = degrees * std::numbers::pi / 180;
    for (Vector3d& x : meshes[0].position) {
      const double r = 1 + 0.5 * x[0], phi = angle * x[1];
      x = {r * std::cos(phi), r * std::sin(phi), 0.1 * x[2]};
    }
    deck.loads = {Pressure{"wall.xmin", Curve{{{0, 1e6}}}}};
    deck.boundary_conditions = {fix("wall.zmin", {2}), fix("wall.zmax", {2})};
    deck.time.end = 2e-3;
  }
  void hold_tangentially(const std::string& set) {
    deck.coordinate_systems = {{"axle", CylindricalSystem{{0, 0, 3}, {0, 0, 2}}}};
    PrescribedMotion motion = fix(set, {1});
    motion.system = "axle";
    deck.boundary_conditions.push_back(motion);
  }
  Model model() const { return build(deck, meshes); }
};

TEST(SkewSupports, AThirdOfAQuarterTubeMovesAsTheQuarter) {
  TubeSector quarter(90, 12), sector(30, 4);
  quarter.deck.boundary_conditions.push_back(fix("wall.ymin", {1}));
  quarter.deck.boundary_conditions.push_back(fix("wall.ymax", {0}));
  sector.hold_tangentially("wall.ymin");
  sector.hold_tangentially("wall.ymax");
  Model one = quarter.model(), other = sector.model();
  ThreadTeam team(1);
  test::run(one, quarter.deck, team);
  test::run(other, sector.deck, team);
  EXPECT_EQ(one.step, other.step);
  double largest = 0, apart = 0;
  std::map<std::array<long, 3>, Vector3d> start_of;
  for (std::size_t i = 0; i < quarter.meshes[0].position.size(); ++i) {
    const auto& x = quarter.meshes[0].position[i];
    const auto rounded = [](double v) { return std::lround(1e6 * v); };
    start_of[{rounded(x[0]), rounded(x[1]), rounded(x[2])}] =
        vector_at(one.nodes.record[index(one.parts[0].node[i])].position);
  }
  for (std::size_t i = 0; i < sector.meshes[0].position.size(); ++i) {
    const auto& x = sector.meshes[0].position[i];
    const auto rounded = [](double v) { return std::lround(1e6 * v); };
    const Vector3d end = vector_at(other.nodes.record[index(other.parts[0].node[i])].position);
    const auto& in_quarter = start_of.at({rounded(x[0]), rounded(x[1]), rounded(x[2])});
    largest = std::max(largest, norm(end - x));
    apart = std::max(apart, norm(end - in_quarter));
  }
  EXPECT_GT(largest, 1e-3);
  EXPECT_LE(apart, 1e-10);
  EXPECT_NEAR(other.energy.internal, one.energy.internal / 3, 1e-10 * one.energy.internal);
}

// Lame, plane strain: u = p a^2 (1 + nu) / (E (b^2 - a^2)) ((1 - 2 nu) r + b^2 / r), and the reaction of a
// cut plane is the integral of the hoop stress, p a over the height.
TEST(SkewSupports, ASectorAtRestUnderPressureIsThatOfLame) {
  TubeSector sector(30, 4, Hex8Full{});
  sector.hold_tangentially("wall.ymin");
  sector.hold_tangentially("wall.ymax");
  std::get<PrescribedMotion>(sector.deck.boundary_conditions[2]).name = "start";
  std::get<PrescribedMotion>(sector.deck.boundary_conditions[3]).name = "end";
  sector.deck.output.history.forces = reactions_and_contact();
  sector.deck.time.relaxation.emplace();
  sector.deck.time.end = 1e-5;
  ThreadTeam team(1);
  Model model = sector.model();
  relax(*sector.deck.time.relaxation, model, team);
  test::run(model, sector.deck, team);
  const double p = 1e6, a = 1, b = 1.5, e = 1e9, nu = 0.3;
  for (std::size_t i = 0; i < sector.meshes[0].position.size(); ++i) {
    const auto& x = sector.meshes[0].position[i];
    const double r = std::hypot(x[0], x[1]);
    const double* end = model.nodes.record[index(model.parts[0].node[i])].position;
    const double u = std::hypot(end[0], end[1]) - r;
    const double exact = p * a * a * (1 + nu) / (e * (b * b - a * a)) * ((1 - 2 * nu) * r + b * b / r);
    EXPECT_NEAR(u, exact, 0.01 * exact) << r;
    EXPECT_NEAR(std::atan2(end[1], end[0]), std::atan2(x[1], x[0]), 1e-7);
  }
  const Vector3d at_end = model.forces->reactions[3].impulse;
  const double size = std::sqrt(dot(at_end, at_end)) / model.forces->duration;
  EXPECT_NEAR(size, p * a * 0.1, 0.01 * p * a * 0.1);
  const double phi = std::numbers::pi / 6;
  EXPECT_NEAR(at_end[0] * std::cos(phi) + at_end[1] * std::sin(phi), 0, 1e-12 * size);
}

// A ring of shells, a twelfth of it; symmetry planes hold a translation and two rotations.
TEST(SkewSupports, AnArcOfShellsMovesAsTheWholeRing) {
  Shell4 shell;
  shell.thickness = 0.02;
  Deck ring;
  ring.materials = {{"material", elastic(0.3)}};
  ring.parts = {{"ring", CylinderMesh{1, 0.2, {72, 2}, {}}, {}, shell, "material"}};
  ring.boundary_conditions = {fix("ring.bottom", {2})};
  ring.loads = {Pressure{"ring.all", Curve{{{0, -1e5}}}}};
  ring.time.end = 5e-3;
  Deck arc = ring;
  std::get<CylinderMesh>(arc.parts[0].mesh) = CylinderMesh{1, 0.2, {6, 2}, 30};
  arc.coordinate_systems = {{"axle", CylindricalSystem{{0, 0, 0}, {0, 0, 1}}}};
  for (const char* set : {"ring.start", "ring.end"}) {
    PrescribedMotion motion = fix(set, {1, 3, 5});
    motion.system = "axle";
    arc.boundary_conditions.push_back(motion);
  }
  ThreadTeam team(1);
  const auto mesh_of = [](const Deck& deck) {
    return std::vector<Mesh>{generate_mesh(deck.parts[0].mesh, deck.parts[0].placement)};
  };
  const std::vector<Mesh> whole = mesh_of(ring), part = mesh_of(arc);
  Model one = build(ring, whole), other = build(arc, part);
  test::run(one, ring, team);
  test::run(other, arc, team);
  double moved = 0, apart = 0;
  for (std::size_t i = 0; i < part[0].position.size(); ++i)
    for (std::size_t j = 0; j < whole[0].position.size(); ++j) {
      const auto& x = part[0].position[i];
      const auto& y = whole[0].position[j];
      if (std::hypot(x[0] - y[0], x[1] - y[1], x[2] - y[2]) > 1e-9) continue;
      const Vector3d a = vector_at(other.nodes.record[index(other.parts[0].node[i])].position);
      const Vector3d b = vector_at(one.nodes.record[index(one.parts[0].node[j])].position);
      moved = std::max(moved, norm(a - x));
      apart = std::max(apart, norm(a - b));
    }
  EXPECT_GT(moved, 1e-3);
  EXPECT_LE(apart, 1e-10);
}

// ---- loads

TEST(SkewSupports, ForcesAlongACylindricalSystemAreRadialTangentialAndAxial) {
  TubeSector sector(90, 6);
  sector.deck.coordinate_systems = {{"axle", CylindricalSystem{{0, 0, 3}, {0, 0, 2}}}};
  NodalForce force;
  force.where.set = "wall.xmax";
  force.force = {2, 3, 5};
  force.system = "axle";
  sector.deck.loads = {force};
  const Model model = sector.model();
  ActiveLoad load = model.loads[0];
  Nodes nodes = model.nodes;
  apply(load, 0, nodes);
  int seen = 0;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const double* x = nodes.record[i].position;
    const double* f = nodes.force[i].component;
    if (std::hypot(x[0], x[1]) < 1.5 - 1e-9) {
      EXPECT_EQ(f[0], 0);
      continue;
    }
    ++seen;
    EXPECT_NEAR(f[0], (2 * x[0] - 3 * x[1]) / 1.5, 1e-14);
    EXPECT_NEAR(f[1], (2 * x[1] + 3 * x[0]) / 1.5, 1e-14);
    EXPECT_NEAR(f[2], 5, 1e-14);
  }
  EXPECT_EQ(seen, 14);
}

TEST(SkewSupports, ForcesOfRemovedNodesAreRemovedWithThem) {
  NodalLoad forces;
  forces.nodes = {2, 5, 7};
  forces.own_force = {{2, 0, 0}, {5, 0, 0}, {7, 0, 0}};
  ActiveLoad load{forces, {}};
  remove_nodes(load, std::vector<int>{1, 5});
  const auto& left = std::get<NodalLoad>(load.load);
  EXPECT_EQ(left.nodes, (std::vector<int>{2, 7}));
  EXPECT_EQ(left.own_force, (std::vector<Vector3d>{{2, 0, 0}, {7, 0, 0}}));
}

// ---- what is refused

std::string fault_of_scene(const Deck& deck) {
  try {
    build_model(deck);
  } catch (const BuildError& fault) {
    return fault.what();
  }
  return "";
}

PrescribedMotion along(std::string system, std::string set, int axis, double velocity) {
  PrescribedMotion motion = fix(std::move(set), {axis});
  motion.components[0].curve = Curve{{{0, velocity}}};
  motion.system = std::move(system);
  return motion;
}

/// A block whose side xmin moves along the x axes of systems at these angles.
Deck driven_block(std::vector<std::pair<double, double>> degrees_and_velocities) {
  Deck deck;
  deck.materials = {{"material", elastic(0.3)}};
  deck.parts = {box("block", {1, 1, 1}, {2, 2, 2}, {0, 0, 0}, hex8())};
  for (const auto& [degrees, velocity] : degrees_and_velocities) {
    const std::string name = "s" + std::to_string(deck.coordinate_systems.size());
    const double phi = degrees * std::numbers::pi / 180;
    deck.coordinate_systems.push_back(
        {name, RectangularSystem{{std::cos(phi), std::sin(phi), 0}, {0, 0, 1}}});
    deck.boundary_conditions.push_back(along(name, "block.xmin", 0, velocity));
  }
  deck.time.end = 1e-3;
  return deck;
}

TEST(SkewSupports, MotionsAlongOneDirectionMustBeEqual) {
  EXPECT_EQ(fault_of_scene(driven_block({{20, 3}, {20, 3}})), "");
  EXPECT_EQ(fault_of_scene(driven_block({{20, 3}, {200, -3}})), "");
  EXPECT_NE(fault_of_scene(driven_block({{20, 3}, {20, 4}})).find("is prescribed here and, otherwise"),
            std::string::npos);
  EXPECT_NE(fault_of_scene(driven_block({{20, 3}, {200, 3}})).find("is prescribed here and, otherwise"),
            std::string::npos);
  EXPECT_NE(fault_of_scene(driven_block({{20, 3}, {20.01, 3}})).find("nearly the same"), std::string::npos);
}

// Of the velocity (3, 2): its component along any direction of the plane is that of both others.
TEST(SkewSupports, AThirdMotionInThePlaneOfTwoMustBeTheirSum) {
  const auto component = [](double degrees) {
    const double phi = degrees * std::numbers::pi / 180;
    return 3 * std::cos(phi) + 2 * std::sin(phi);
  };
  const Deck accepted = driven_block({{10, component(10)}, {75, component(75)}, {130, component(130)}});
  EXPECT_EQ(fault_of_scene(accepted), "");
  Model model = build_model(accepted);
  ThreadTeam team(1);
  update_velocities(model, 1, team);
  int seen = 0;
  for (std::size_t i = 0; i < model.nodes.size(); ++i) {
    if (model.nodes.prescribed_translations(i) == 0) continue;
    ++seen;
    EXPECT_NEAR(model.nodes.record[i].velocity[0], 3, 1e-14);
    EXPECT_NEAR(model.nodes.record[i].velocity[1], 2, 1e-14);
  }
  EXPECT_EQ(seen, 9);
  EXPECT_NE(
      fault_of_scene(driven_block({{10, component(10)}, {75, component(75)}, {130, 1.001 * component(130)}}))
          .find("is prescribed here and, otherwise"),
      std::string::npos);
}

// An acceleration and a velocity agree where the velocity at the start does.
TEST(SkewSupports, MotionsOfDifferentKindsMustAgree) {
  Deck deck = driven_block({{20, 0}, {200, 0}});
  const auto motion = [&](std::size_t i) -> PrescribedMotion& {
    return std::get<PrescribedMotion>(deck.boundary_conditions[i]);
  };
  motion(0).components[0].curve = Curve{{{0, 3}, {1e-3, 5}}};
  motion(1).components[0].curve = Curve{{{0, -2000}}};
  motion(1).kind = MotionKind::acceleration;
  EXPECT_NE(fault_of_scene(deck).find("is prescribed here and, otherwise"), std::string::npos);
  const double phi = std::numbers::pi / 9;
  deck.initial_conditions = {moving("block", {3 * std::cos(phi), 3 * std::sin(phi), 7})};
  EXPECT_EQ(fault_of_scene(deck), "");
  std::swap(deck.boundary_conditions[0], deck.boundary_conditions[1]);
  EXPECT_EQ(fault_of_scene(deck), "");
  deck.initial_conditions = {moving("block", {-3 * std::cos(phi), -3 * std::sin(phi), 7})};
  EXPECT_NE(fault_of_scene(deck).find("is prescribed here and, otherwise"), std::string::npos);
}

// Nodes that go with the velocity (speed, 0), given by two components that are not at right angles.
TEST(SkewSupports, MotionsThroughAWallAreRefused) {
  const auto towards_wall = [](double speed) {
    const auto along_x = [&](double degrees) { return speed * std::cos(degrees * std::numbers::pi / 180); };
    Deck deck = driven_block({{10, along_x(10)}, {75, along_x(75)}});
    deck.boundary_conditions.push_back(RigidWall{{-0.7, 0, 0}, {1, 0, 0}, {}, 0});
    return fault_of_scene(deck);
  };
  EXPECT_EQ(towards_wall(-199), "");
  const std::string fault = towards_wall(-300);
  EXPECT_NE(fault.find("through the rigid wall"), std::string::npos) << fault;
  EXPECT_NE(fault.find("it would be 0.1 behind it at time 0.001"), std::string::npos) << fault;
}

TEST(SkewSupports, AxesThatDifferFromPlaceToPlaceAreNotThoseOfARigidPart) {
  Deck deck = driven_block({});
  deck.parts.push_back(box("ram", {1, 1, 1}, {1, 1, 1}, {0, 0, 3}, Rigid{}));
  deck.coordinate_systems = {{"axle", CylindricalSystem{{5, 0, 0}, {0, 0, 1}}}};
  deck.boundary_conditions = {along("axle", "ram", 2, 0)};
  EXPECT_NE(fault_of_scene(deck).find("accepted is a rectangular system"), std::string::npos);
  deck.boundary_conditions.clear();
  NodalMoment moment;
  moment.where.set = "ram";
  moment.moment = {1, 0, 0};
  moment.system = "axle";
  deck.loads = {moment};
  EXPECT_NE(fault_of_scene(deck).find("accepted is a rectangular system"), std::string::npos);
}

TEST(SkewSupports, NodesOnTheAxisHaveNoRadialDirection) {
  Deck deck;
  deck.materials = {{"material", elastic(0.3)}};
  deck.parts = {box("block", {1, 1, 1}, {2, 2, 2}, {0, 0, 0}, hex8())};
  deck.coordinate_systems = {{"axle", CylindricalSystem{{0, 0, 0}, {0, 0, 1}}}};
  deck.boundary_conditions = {along("axle", "block.zmin", 2, 0)};
  EXPECT_EQ(fault_of_scene(deck), "");
  deck.boundary_conditions = {along("axle", "block.zmin", 1, 0)};
  EXPECT_NE(fault_of_scene(deck).find("lies on the axis of 'axle'"), std::string::npos);
  deck.boundary_conditions.clear();
  NodalForce force;
  force.where.set = "block.zmin";
  force.system = "axle";
  force.force = {0, 1, 0};
  deck.loads = {force};
  EXPECT_NE(fault_of_scene(deck).find("lies on the axis of 'axle'"), std::string::npos);
}

// ---- state

TEST(SkewSupports, ARunThatIsRestoredGoesOnWithTheSameBits) {
  TubeSector sector(30, 4);
  sector.hold_tangentially("wall.ymin");
  sector.hold_tangentially("wall.ymax");
  NodalForce force;
  force.where.set = "wall.xmax";
  force.force = {1e4, 2e4, 0};
  force.system = "axle";
  sector.deck.loads.push_back(force);
  sector.deck.output.history.forces = reactions_and_contact();
  ThreadTeam team(1);
  Model whole = sector.model(), restored = sector.model();
  make_steps(whole, 50, 1, team);
  std::ostringstream saved;
  save_state(whole, saved);
  std::istringstream in(saved.str());
  restore_state(restored, in, saved.str().size());
  make_steps(whole, 50, 1, team);
  make_steps(restored, 50, 1, team);
  std::ostringstream first, second;
  save_state(whole, first);
  save_state(restored, second);
  EXPECT_EQ(first.str(), second.str());
}

}  // namespace
}  // namespace brio
