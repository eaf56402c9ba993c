#include <algorithm>

#include "src/build/build.hpp"

namespace brio {

void prepare_output(const Deck& deck, Model& model) {
  const HistoryOutput& history = deck.output.history;
  if (std::ranges::count(deck.output.fields_.variables, rotation_field) > 0 && model.nodes.has_rotations())
    model.rotations = start_rotations(model.blocks, model.nodes);
  model.probes = place_probes(deck, model.parts, model.nodes);
  model.tells_rigid_bodies = history.rigid_bodies;
  if (model.tells_rigid_bodies && model.rigid.empty())
    throw BuildError("output.history.rigid_bodies: no part is rigid; accepted where one is");
  model.tells_part_energies = history.part_energies;
  if (!history.forces) return;
  for (ContactScene& scene : model.contacts) scene.log = make_impulse_log(*history.forces, deck, model);
  model.forces = make_force_sums(*history.forces, deck, model);
}

}  // namespace brio
