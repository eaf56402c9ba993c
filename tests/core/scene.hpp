#pragma once
/// Small scenes for tests of the whole step, without files.

#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <vector>

#include "io/mesh/generate_mesh.hpp"
#include "src/base/index.hpp"
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

inline Part box(std::string name, Vector3d size, std::array<int, 3> elements, Vector3d centre,
                Element element, std::string material = "material") {
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

inline InitialCondition moving(std::string part, Vector3d velocity) {
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

/// A number of time steps further; a model as built gets its first velocities before.
inline void make_steps(Model& model, std::int64_t count, double energy_error_limit, ThreadTeam& team) {
  brio::run(model, energy_error_limit, team, [count](Model&) mutable { return count-- > 0; });
}

/// Calls look(i) for a number of complete states, i from 0, that of entry first.
template <class Look>
void look_at_steps(Model& model, int count, double energy_error_limit, ThreadTeam& team, const Look& look) {
  brio::run(model, energy_error_limit, team, [&, i = 0](Model&) mutable {
    look(i);
    return ++i < count;
  });
}

/// Steps to the end time; `look` is called at every step once velocities and balances are complete.
inline void run(Model& model, const Deck& deck, ThreadTeam& team,
                const std::function<void(Model&)>& look = {}) {
  brio::run(model, deck.numerics.energy_error_limit, team, [&](Model& now) {
    if (look) look(now);
    for (const ContactScene& scene : now.contacts)
      EXPECT_EQ(scene.unresolved.steps, 0) << "surfaces cross at step " << now.step;
    return true;
  });
}

inline Vector3d momentum_of(const Model& model) { return momentum(model.nodes).total.linear; }

/// Mean velocity of a part along an axis.
inline double mean_velocity(const Model& model, std::size_t part, std::size_t axis) {
  double sum = 0;
  for (int node : model.parts[part].node)
    sum += model.nodes.mass[index(node)] * model.nodes.record[index(node)].velocity[axis];
  return sum / model.parts[part].mass;
}

}  // namespace brio::test
