#pragma once
/// Contact thickness of the elements of a part.

#include <vector>

#include "src/deck/deck.hpp"
#include "src/deck/mesh.hpp"

namespace brio {

/// Thickness of shells, diameter of beams and particles, of each element; of solids nothing. The
/// contact radius of a particle is half its spacing in the lattice. \throws BuildError where shells or beams
/// are so thick for their mesh that each would be a candidate of hundreds of others
std::vector<double> contact_thickness(const Part& part, const Mesh& mesh);

}  // namespace brio
