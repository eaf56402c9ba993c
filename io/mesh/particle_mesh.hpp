#pragma once
/// Particles on cubic lattices inside simple shapes.

#include <string_view>
#include <vector>

#include "src/deck/deck.hpp"
#include "src/deck/mesh.hpp"

namespace brio {

/// One particle an element, each with its volume; together they have exactly that of the shape.
Mesh particle_mesh(const ParticleMesh& fill);

/// Names of its sets.
std::vector<std::string_view> particle_set_names(const ParticleMesh& fill);

}  // namespace brio
