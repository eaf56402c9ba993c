// The stable time step of assembled elements, against eigenvalues of the assembled stiffness.

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "src/base/index.hpp"
#include "tests/core/scene.hpp"

#include <Eigen/Dense>

namespace brio {
namespace {

using namespace test;

constexpr double poissons_ratio = 0.3;

template <class Kind>
Kind without_viscosity() {
  Kind kind;
  kind.linear_bulk_viscosity = 0;
  if constexpr (requires { kind.quadratic_bulk_viscosity; }) kind.quadratic_bulk_viscosity = 0;
  if constexpr (requires { kind.drilling_viscosity; }) kind.drilling_viscosity = 0;
  return kind;
}

struct MeshScene {
  Deck deck;
  std::vector<Mesh> meshes;

  MeshScene(const Part& part) {
    deck.materials = {{"material", elastic(poissons_ratio)}};
    deck.parts = {part};
    deck.time.end = 1e3;
    meshes = {generate_mesh(part.mesh, part.placement)};
  }
  MeshScene& distort(double by, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> any(-by, by);
    for (auto& x : meshes[0].position)
      for (double& component : x) component += any(random);
    return *this;
  }
  Model model() const { return build(deck, meshes); }
};

Part cubes(const Element& element, std::array<int, 3> elements) {
  return box("body", {1.0 * elements[0], 1.0 * elements[1], 1.0 * elements[2]}, elements, {0, 0, 0}, element);
}
Part shell_plate(double thickness, std::array<int, 2> elements) {
  PlateMesh mesh;
  mesh.size = {1.0 * elements[0], 1.0 * elements[1]};
  mesh.elements = elements;
  auto shell = without_viscosity<Shell4>();
  shell.thickness = thickness;
  return {"body", mesh, {}, shell, "material"};
}

std::size_t freedoms(const Model& model) {
  return (model.nodes.has_rotations() ? 6 : 3) * model.nodes.size();
}

double* component_of(AlignedBuffer<NodeVector>& linear, AlignedBuffer<NodeVector>& angular,
                     std::size_t freedom, std::size_t nodes) {
  AlignedBuffer<NodeVector>& rows = freedom < 3 * nodes ? linear : angular;
  return rows[freedom % (3 * nodes) / 3].component + freedom % 3;
}

Eigen::VectorXd all_components(AlignedBuffer<NodeVector>& linear, AlignedBuffer<NodeVector>& angular,
                               std::size_t count, std::size_t nodes) {
  Eigen::VectorXd all(static_cast<Eigen::Index>(count));
  for (std::size_t k = 0; k < count; ++k)
    all[static_cast<Eigen::Index>(k)] = *component_of(linear, angular, k, nodes);
  return all;
}

/// Forces on the nodes after velocities of one, from rest and over a step, of each freedom.
Eigen::MatrixXd forces_of_velocities(const Model& model, double step) {
  const std::size_t count = freedoms(model), n = model.nodes.size();
  constexpr double speed = 1e-9;
  Eigen::MatrixXd forces(count, count);
  for (std::size_t k = 0; k < count; ++k) {
    Nodes nodes = model.nodes;
    std::vector<Block> blocks = model.blocks;
    for (NodeRecord& record : nodes.record) std::fill_n(record.velocity, 3, 0.0);
    if (k < 3 * n) {
      nodes.record[k / 3].velocity[k % 3] = speed / step;
    } else {
      nodes.angular_velocity[(k - 3 * n) / 3].component[k % 3] = speed / step;
    }
    for (const SweepTask& task : model.schedule.tasks)
      blocks[task.block].kernel.sweep(blocks[task.block], task.chunk, nodes, step);
    forces.col(static_cast<Eigen::Index>(k)) = -all_components(nodes.force, nodes.moment, count, n) / speed;
  }
  return forces;
}

Eigen::MatrixXd products(Model& model) {
  const std::size_t count = freedoms(model), n = model.nodes.size();
  const std::size_t turning = model.nodes.has_rotations() ? n : 0;
  Eigen::MatrixXd all(count, count);
  for (std::size_t k = 0; k < count; ++k) {
    AlignedBuffer<NodeVector> u(n), w(turning), force(n), moment(turning);
    *component_of(u, w, k, n) = 1;
    for (const SweepTask& task : model.schedule.tasks)
      model.blocks[task.block].kernel.multiply_stiffness(model.blocks[task.block], task.chunk, model.nodes,
                                                         {u.data(), w.data()}, {force.data(), moment.data()});
    all.col(static_cast<Eigen::Index>(k)) = -all_components(force, moment, count, n);
  }
  return all;
}

double largest_eigenvalue_of(const Eigen::MatrixXd& matrix, const Model& model) {
  const std::size_t n = model.nodes.size();
  Eigen::VectorXd root(matrix.rows());
  for (std::size_t k = 0; k < freedoms(model); ++k)
    root[static_cast<Eigen::Index>(k)] =
        1 / std::sqrt(k < 3 * n ? model.nodes.mass[k / 3] : model.nodes.rotational_inertia[(k - 3 * n) / 3]);
  const Eigen::MatrixXd scaled =
      root.asDiagonal() * (0.5 * (matrix + matrix.transpose())) * root.asDiagonal();
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(scaled, Eigen::EigenvaluesOnly)
      .eigenvalues()
      .maxCoeff();
}

/// Of a model at rest: its stiffnesses of nodes, and the bounds of its elements.
struct Bounds {
  std::vector<double> stiffness_by_mass;
  double nodal = 0;
  double elements = 0;  ///< stable time step
};
Bounds bounds_of(Model& model, double step) {
  Bounds bounds;
  bounds.elements = HUGE_VAL;
  for (const SweepTask& task : model.schedule.tasks)
    bounds.elements =
        std::min(bounds.elements, model.blocks[task.block]
                                      .kernel.sweep(model.blocks[task.block], task.chunk, model.nodes, step)
                                      .stable_step);
  for (std::size_t i = 0; i < model.nodes.size(); ++i) {
    double now = -model.nodes.force[i].component[3] / model.nodes.mass[i];
    if (model.nodes.has_rotations())
      now = std::max(now, -model.nodes.moment[i].component[3] / model.nodes.rotational_inertia[i]);
    bounds.stiffness_by_mass.push_back(now);
    bounds.nodal = std::max(bounds.nodal, now);
  }
  return bounds;
}

std::vector<MeshScene> small_scenes() {
  std::vector<MeshScene> scenes;
  for (unsigned seed = 0; seed < 4; ++seed) {
    scenes.push_back(MeshScene(cubes(without_viscosity<Hex8>(), {3, 2, 2})).distort(0.06 * seed, seed));
    scenes.push_back(MeshScene(cubes(without_viscosity<Hex8Full>(), {3, 2, 2})).distort(0.06 * seed, seed));
    scenes.push_back(MeshScene(shell_plate(0.03 * (1 + 5 * seed), {3, 3})).distort(0.06 * seed, seed));
  }
  return scenes;
}

TEST(AssembledStep, ProductsAreForcesOfSmallMotions) {
  for (const MeshScene& scene : small_scenes()) {
    Model model = scene.model();
    const Eigen::MatrixXd product = products(model), forces = forces_of_velocities(model, 1e-30);
    EXPECT_LT((product - forces).norm(), 1e-5 * forces.norm());
    EXPECT_LT((product - product.transpose()).norm(), 1e-5 * product.norm());
  }
}

// Stress, and what hourglass control has stored, are no part of it: as of a model that begins in that shape.
TEST(AssembledStep, ProductsAreThoseOfThePresentShape) {
  for (const Element& element :
       {Element(without_viscosity<Hex8>()), Element(without_viscosity<Hex8Full>())}) {
    MeshScene scene(cubes(element, {3, 2, 2}));
    Model model = scene.model();
    std::mt19937 random(5);
    std::uniform_real_distribution<double> any(-100, 100);
    for (NodeRecord& node : model.nodes.record)
      for (std::size_t i = 0; i < 3; ++i) node.velocity[i] = any(random);
    ThreadTeam team(1);
    make_steps(model, 4, 1e9, team);
    Mesh& mesh = scene.meshes[0];
    double moved = 0;
    for (std::size_t i = 0; i < mesh.position.size(); ++i) {
      const auto node = index(model.parts[0].node[i]);
      for (std::size_t k = 0; k < 3; ++k) {
        moved = std::max(moved, std::abs(mesh.position[i][k] - model.nodes.record[node].position[k]));
        mesh.position[i][k] = model.nodes.record[node].position[k];
      }
    }
    ASSERT_GT(moved, 0.1);
    Model fresh = scene.model();
    const auto highest = [](Model& m) { return largest_eigenvalue_of(products(m), m); };
    // Masses are those of the start.
    for (std::size_t i = 0; i < mesh.position.size(); ++i)
      fresh.nodes.mass[index(fresh.parts[0].node[i])] = model.nodes.mass[index(model.parts[0].node[i])];
    EXPECT_NEAR(highest(model), highest(fresh), 1e-6 * highest(fresh));
  }
}

TEST(AssembledStep, NodalBoundLiesBetweenTheAssembledElementsAndTheWorst) {
  double least = 2, most = 0;
  for (const MeshScene& scene : small_scenes()) {
    Model model = scene.model();
    const double exact = largest_eigenvalue_of(forces_of_velocities(model, 1e-30), model);
    const Bounds bounds = bounds_of(model, 1);
    const double of_elements = 4 / (bounds.elements * bounds.elements);
    EXPECT_GE(bounds.nodal, exact * (1 - 1e-6));
    EXPECT_LE(bounds.nodal, of_elements * (1 + 1e-9));
    least = std::min(least, bounds.nodal / of_elements);
    most = std::max(most, bounds.nodal / of_elements);
  }
  EXPECT_LT(least, 0.8) << "distorted elements have the mass of their neighbours";
  EXPECT_GT(most, 0.999) << "in regular meshes all are alike";
}

// dt^2 K + 2 dt C <= 4 M at the time step that follows, longer or shorter than the last, and near its limit
// where both are alike.
TEST(AssembledStep, NodalBoundCountsDamping) {
  for (const double viscosity : {0.06, 0.5}) {
    Hex8 element;
    element.linear_bulk_viscosity = viscosity;
    const MeshScene damped(MeshScene(cubes(element, {3, 2, 2})).distort(0.15, 3));
    const MeshScene undamped(MeshScene(cubes(without_viscosity<Hex8>(), {3, 2, 2})).distort(0.15, 3));
    const Eigen::MatrixXd k = forces_of_velocities(undamped.model(), 1e-30);
    Model model = damped.model();
    const double critical = 2 / std::sqrt(largest_eigenvalue_of(k, model));
    const Eigen::MatrixXd c = critical * (forces_of_velocities(model, critical) - k);
    for (const double share : {0.3, 0.9, 2.0}) {
      double last = share * critical, left = 0;
      for (int step = 0; step < 20; ++step) {
        Model now = damped.model();
        const double stable = stable_step_of(bounds_of(now, last).nodal, last);
        left = largest_eigenvalue_of(stable * stable * k + 2 * stable * c, model) / 4;
        EXPECT_LE(left, 1 + 1e-6) << viscosity << ' ' << share << ' ' << step;
        last = stable;
      }
      EXPECT_GT(left, 0.4) << viscosity << ' ' << share;
    }
  }
}

double estimate_of(Model& model) {
  const Bounds bounds = bounds_of(model, 1);
  LanczosVectors vectors = make_lanczos_vectors(model.nodes, model.extent.width);
  ThreadTeam team(2);
  return assembled_frequency_squared(vectors, bounds.stiffness_by_mass, model.schedule, model.blocks,
                                     model.nodes, team);
}

TEST(AssembledStep, EstimateIsTheHighestFrequency) {
  std::vector<MeshScene> scenes = small_scenes();
  for (unsigned seed = 0; seed < 3; ++seed) {
    scenes.push_back(MeshScene(cubes(without_viscosity<Hex8>(), {6, 5, 4})).distort(0.1 * seed, seed));
    scenes.push_back(MeshScene(shell_plate(seed == 1 ? 1.0 : 0.05, {8, 7})).distort(0.1 * seed, seed));
  }
  for (const MeshScene& scene : scenes) {
    Model model = scene.model();
    const double exact = largest_eigenvalue_of(products(model), model);
    const double estimate = estimate_of(model);
    EXPECT_GT(estimate, 0.99 * exact);
    EXPECT_LT(estimate, 1.0301 * exact) << "the margin, and nothing from above";
  }
}

// Plane waves have up to omega^2 = 4 (lambda + 2 mu) / (rho h^2), (1 - nu) / (1 + nu) of one cube's; free
// edges and corners a little more.
TEST(AssembledStep, EstimateOfManyCubesIsThatOfPlaneWaves) {
  Model model = MeshScene(cubes(without_viscosity<Hex8>(), {24, 20, 16})).model();
  const double modulus = 1e9 * (1 - poissons_ratio) / ((1 + poissons_ratio) * (1 - 2 * poissons_ratio));
  const double of_waves = 4 * modulus / 1000;
  const double estimate = estimate_of(model);
  EXPECT_GT(estimate, of_waves);
  EXPECT_LT(estimate, 1.08 * of_waves);
  Model other = MeshScene(cubes(without_viscosity<Hex8>(), {24, 20, 16})).model();
  const Bounds bounds = bounds_of(other, 1);
  EXPECT_NEAR(of_waves * bounds.elements * bounds.elements / 4, 0.7 / 1.3, 1e-9);
}

// Whatever the order of the nodes in memory; axes and place matter to where the search begins.
TEST(AssembledStep, EstimateIsTheSameOfATurnedScene) {
  for (Part part : {cubes(without_viscosity<Hex8>(), {4, 3, 2}), shell_plate(0.1, {4, 3})}) {
    Model model = MeshScene(part).model();
    part.placement.rotate = Rotation{{0.3, 1, 0.2}, 37};
    part.placement.translate = {5, -3, 2};
    Model turned = MeshScene(part).model();
    EXPECT_NEAR(estimate_of(turned) / estimate_of(model), 1, 0.01);
  }
}

/// Stirred at a thousandth of the speed of sound. \returns largest over first total energy
double growth_of_energy(Model& model, int steps) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> any(-1, 1);
  for (NodeRecord& node : model.nodes.record)
    for (std::size_t i = 0; i < 3; ++i) node.velocity[i] = any(random);
  ThreadTeam team(2);
  double first = 0, most = 0;
  look_at_steps(model, steps, 1e9, team, [&](int) {
    const double total = model.energy.kinetic_half + model.energy.internal + model.energy.hourglass;
    if (first == 0) first = total;
    most = std::max(most, total);
  });
  return most / first;
}

// Steps of 0.95 times the estimate leave a frequency of up to 0.97 of the critical one: its energy at half
// steps swings by 1 / (1 - 0.97^2).
TEST(AssembledStep, VibrationsStayBoundedAtTheLongestTimeStep) {
  std::vector<MeshScene> scenes{MeshScene(cubes(without_viscosity<Hex8>(), {6, 6, 6})),
                                MeshScene(cubes(without_viscosity<Hex8>(), {5, 4, 4})).distort(0.2, 1),
                                MeshScene(cubes(without_viscosity<Hex8Full>(), {4, 4, 4})).distort(0.1, 2),
                                MeshScene(shell_plate(0.05, {8, 8})).distort(0.2, 3)};
  for (MeshScene& scene : scenes) {
    scene.deck.time.step_scale = 0.95;
    Model model = scene.model();
    EXPECT_LT(growth_of_energy(model, 20000), 20);
    EXPECT_GT(model.assembled_step.gain, 1.1);
    EXPECT_GT(model.assembled_step.frequency_squared, 0);
  }
}

// The foot of a bar is crushed until the time step is a tenth of the first one.
TEST(AssembledStep, FollowsElementsThatAreCrushedBetweenEstimates) {
  Hex8 element;
  Deck deck;
  PowerLawHardening law;
  law.density = 1000;
  law.youngs_modulus = 1e9;
  law.poissons_ratio = poissons_ratio;
  law.yield_stress = 2e6;
  law.hardening_constant = 1e6;
  law.hardening_exponent = 0.5;
  deck.materials = {{"material", law}};
  deck.parts = {box("bar", {4, 1, 1}, {32, 8, 8}, {2, 0, 0}, element)};
  deck.initial_conditions = {moving("bar", {-300, 0, 0})};
  deck.boundary_conditions = {RigidWall{{-1e-9, 0, 0}, {1, 0, 0}, {}, 0}};
  deck.time.end = 4e-3;
  deck.time.step_scale = 0.95;
  Model model = build_model(deck);
  ThreadTeam team(2);
  run(model, deck, team);
  Model nodal = build_model(deck);
  nodal.assembled_step.vectors = {};
  run(nodal, deck, team);
  EXPECT_LT(model.control.least, 0.1 * model.control.largest);
  EXPECT_LT(12 * model.step, 10 * nodal.step);
  EXPECT_NEAR(model.energy.internal, nodal.energy.internal, 0.01 * nodal.energy.internal)
      << "of first order in the time step of an impact at 0.3 of the speed of waves";
  EXPECT_LT(model.energy.error_max, 5e-3);
}

TEST(AssembledStep, IsNotEstimatedWithoutAMarginNorForAGivenStep) {
  MeshScene scene(cubes(Hex8{}, {4, 4, 4}));
  EXPECT_FALSE(scene.model().assembled_step.vectors.empty());
  scene.deck.time.step_scale = 1;
  EXPECT_TRUE(scene.model().assembled_step.vectors.empty());
  scene.deck.time.step_scale = 0.9;
  scene.deck.time.step = 1e-6;
  EXPECT_TRUE(scene.model().assembled_step.vectors.empty());
}

}  // namespace
}  // namespace brio
