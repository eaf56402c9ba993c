#pragma once
/// Parts that begin with the state of an earlier result.
///
/// Their meshes lie at the deformed positions, so that sets, contact and connections are those of the
/// deformed part. Elements get their masses at the positions of the mesh before it was deformed: mass does
/// not change with the volume.

#include <array>
#include <span>
#include <vector>

#include "src/deck/initial_state.hpp"
#include "src/deck/mesh.hpp"
#include "src/model/model.hpp"

namespace brio {

/// As long as it lives, nodes of meshes with reference positions lie there.
class AtReference {
 public:
  AtReference(std::span<const Mesh> meshes, Model& model);
  ~AtReference();
  AtReference(const AtReference&) = delete;
  AtReference& operator=(const AtReference&) = delete;

 private:
  struct Place {
    int node;
    Vector3d position;
  };
  Model& model_;
  std::vector<Place> deformed_;
};

/// What elements remember; their masses stay. \pre elements have started
/// \throws BuildError where elements of the result remember other things
void set_states(std::span<const PartState> states, Model& model);

/// Velocities of nodes, and angular ones, where the state has them.
void set_velocities(const PartState& state, Model& model);

/// The energy that elements bring with them is internal energy of the start. \pre balances are set
void add_energies(std::span<const PartState> states, Model& model);

}  // namespace brio
