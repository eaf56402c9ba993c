#pragma once
/// Scenes of particles.

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "tests/core/scene.hpp"

namespace brio::test {

inline Particle particle(ParticleFrame kernel) {
  Particle element;
  element.kernel = kernel;
  return element;
}
inline Particle inviscid(Particle element) {
  element.linear_bulk_viscosity = element.quadratic_bulk_viscosity = 0;
  return element;
}

inline Part particles(std::string name, const ParticleMesh& mesh, const Particle& element) {
  Part part;
  part.name = std::move(name);
  part.mesh = mesh;
  part.element = element;
  part.material = "material";
  return part;
}

inline ParticleMesh box_of_particles(Vector3d size, double spacing) {
  ParticleMesh mesh;
  mesh.box = ParticleBox{size, spacing};
  return mesh;
}

/// Yields at a strain of 0.002.
inline ElasticPlastic yielding() {
  ElasticPlastic law;
  law.density = 1000;
  law.youngs_modulus = 1e9;
  law.poissons_ratio = 0.3;
  law.yield_stress = 2e6;
  law.hardening_modulus = 1e7;
  return law;
}

/// A block that spins, and whose one end is thrown at the other.
inline Deck spinning_block(const Material& material, const Particle& element, double throw_speed) {
  Deck deck;
  deck.materials = {{"material", material}};
  deck.parts = {particles("block", box_of_particles({1, 0.75, 0.5}, 0.125), element)};
  InitialCondition turning;
  turning.where.set = "block";
  turning.velocity = {3, -2, 1};
  turning.spin = Spin{{0, 0, 0}, {20, 10, 30}};
  deck.initial_conditions = {turning};
  if (throw_speed != 0) {
    InitialCondition thrown = moving("", {-throw_speed, 0.3 * throw_speed, 0});
    thrown.where = {"", BoxRegion{{0.2, -1, -1}, {1, 1, 1}}, "block"};
    deck.initial_conditions.push_back(thrown);
  }
  deck.time.end = 0.02;
  return deck;
}

/// Runs to the end. \returns the largest energy error after the first step: at the start itself the balance
/// holds half of the work that viscous forces, which act from the start on, do in the first step.
inline double largest_energy_error(Model& model, const Deck& deck, ThreadTeam& team) {
  double largest = 0;
  run(model, deck, team, [&](Model& m) {
    if (m.step > 0) largest = std::max(largest, std::abs(m.energy.relative_error()));
  });
  return largest;
}

}  // namespace brio::test
