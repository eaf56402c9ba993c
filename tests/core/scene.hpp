#pragma once
/// Small scenes for tests of the whole step, without files.

#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <vector>

#include "io/mesh/generate_mesh.hpp"
#include "src/build/build.hpp"
#include "src/step/advance.hpp"

namespace brio::test {

/// Unit material with wave speed 1000: E 1e9, density 1000.
inline Elastic elastic(double poissons_ratio = 0.0) {
  Elastic law;
  law.density = 1000;
  law.youngs_modulus = 1e9;
  law.poissons_ratio = poissons_ratio;
  return law;
}

inline Hex8 hex8() { return {}; }
/// A hexahedron without bulk viscosity.
inline Hex8 inviscid_hex8() {
  Hex8 element;
  element.linear_bulk_viscosity = element.quadratic_bulk_viscosity = 0;
  return element;
}

inline Part box(std::string name, Triple size, std::array<int, 3> elements, Triple centre, Element element,
                std::string material = "material") {
  BoxMesh mesh;
  mesh.size = size;
  mesh.elements = elements;
  Placement placement;
  placement.translate = centre;
  return {std::move(name), mesh, placement, element, std::move(material)};
}

inline PrescribedMotion fix(std::string set, std::vector<int> axes) {
  PrescribedMotion motion;
  motion.where.set = std::move(set);
  for (int axis : axes) motion.components.push_back({axis, Curve{{{0, 0}}}});
  return motion;
}

inline InitialCondition moving(std::string part, Triple velocity) {
  InitialCondition condition;
  condition.where.set = std::move(part);
  condition.velocity = velocity;
  return condition;
}

inline Model build_model(const Deck& deck) {
  std::vector<Mesh> meshes;
  for (const Part& part : deck.parts) meshes.push_back(generate_mesh(part.mesh, part.placement));
  return build(deck, meshes);
}

/// Steps to the end time; `look` is called at every step once velocities and balances are complete.
inline void run(Model& model, const Deck& deck, ThreadTeam& team,
                const std::function<void(Model&)>& look = {}) {
  while (true) {
    update_velocities(model, deck.numerics.energy_error_limit, team);
    if (look) look(model);
    for (const ContactScene& scene : model.contacts)
      EXPECT_EQ(scene.unresolved.steps, 0) << "surfaces cross at step " << model.step;
    if (model.times.time >= deck.time.end) return;
    update_positions(model, team);
  }
}

inline Vector momentum_of(const Model& model) { return momentum(model.nodes).total.linear; }

/// Mean velocity of a part along an axis.
inline double mean_velocity(const Model& model, std::size_t part, std::size_t axis) {
  double sum = 0;
  for (int node : model.parts[part].node)
    sum += model.nodes.mass[static_cast<std::size_t>(node)] *
           model.nodes.record[static_cast<std::size_t>(node)].velocity[axis];
  return sum / model.parts[part].mass;
}

}  // namespace brio::test
