#include "src/initial/initial_state.hpp"

#include <algorithm>
#include <string>

#include "elements/element_state.hpp"
#include "src/base/breakdown.hpp"
#include "src/base/index.hpp"

namespace brio {

namespace {

NodeRecord& record_of(Model& model, int node) { return model.nodes.record[index(node)]; }

void put(const Vector3d& values, double* place) { std::copy(values.begin(), values.end(), place); }

double energy_of(const Block& block, const Nodes& nodes, std::size_t element) {
  return block.kernel.sample(block, nodes, element, false).internal_energy;
}

void set_state(const PartState& state, std::size_t of_mesh, std::size_t slot, Block& block) {
  if (!state.element.empty()) {
    const std::size_t components = state_components(block);
    write_state(state.element.data() + of_mesh * components, slot, block);
  }
  if (!state.stress.empty()) write_stress(state.stress[of_mesh], slot, block);
  if (!state.plastic_strain.empty()) write_plastic_strain(state.plastic_strain[of_mesh], slot, block);
}

// Of the same element, points and law; a material that fails remembers more than one that does not.
void expect_same_size(const PartState& state, const Model& model) {
  const PartInModel& part = model.parts[state.part];
  const std::size_t given = state.element.size() / part.element_slot.size();
  const std::size_t wanted = state_components(model.blocks[part.block]);
  if (state.element.empty() || given == wanted) return;
  throw BuildError("the state of part '" + part.name + "' has " + std::to_string(given) +
                       " numbers an element in the result, and " + std::to_string(wanted) +
                       " here; accepted are the same element, material model, hardening and failure",
                   state.place);
}

template <class Visit>
void for_each_element(const PartState& state, Model& model, const Visit& visit) {
  const PartInModel& part = model.parts[state.part];
  for (std::size_t e = 0; e < part.element_slot.size(); ++e)
    visit(e, index(part.element_slot[e]), model.blocks[part.block]);
}

}  // namespace

AtReference::AtReference(std::span<const Mesh> meshes, Model& model) : model_(model) {
  for (std::size_t p = 0; p < meshes.size(); ++p)
    for (std::size_t i = 0; i < meshes[p].reference.size(); ++i) {
      const int node = model.parts[p].node[i];
      double* position = record_of(model, node).position;
      deformed_.push_back({node, {position[0], position[1], position[2]}});
      put(meshes[p].reference[i], position);
    }
}

// Backwards: of a node that two parts share the first place is the deformed one.
AtReference::~AtReference() {
  for (std::size_t i = deformed_.size(); i-- > 0;)
    put(deformed_[i].position, record_of(model_, deformed_[i].node).position);
}

void set_states(std::span<const PartState> states, Model& model) {
  for (const PartState& state : states) {
    expect_same_size(state, model);
    for_each_element(state, model, [&](std::size_t of_mesh, std::size_t slot, Block& block) {
      set_state(state, of_mesh, slot, block);
    });
  }
}

void set_velocities(const PartState& state, Model& model) {
  const PartInModel& part = model.parts[state.part];
  for (std::size_t i = 0; i < state.velocity.size(); ++i)
    put(state.velocity[i], record_of(model, part.node[i]).velocity);
  for (std::size_t i = 0; i < state.angular_velocity.size(); ++i)
    put(state.angular_velocity[i], model.nodes.angular_velocity[index(part.node[i])].component);
}

void add_energies(std::span<const PartState> states, Model& model) {
  for (const PartState& state : states) {
    double sum = 0;
    for_each_element(state, model, [&](std::size_t, std::size_t slot, Block& block) {
      const double energy = energy_of(block, model.nodes, slot);
      if (block.loses_elements) hold_energy(energy, slot, block);
      sum += energy;
    });
    model.energy.internal += sum;
    model.energy.kinetic_start += sum;
    model.part_energy[state.part].internal += sum;
  }
}

}  // namespace brio
