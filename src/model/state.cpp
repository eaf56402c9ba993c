#include "src/model/state.hpp"

namespace brio {

namespace {

// The parts of a state, in order. Marks between them tell where one that does not fit begins.
template <class Archive>
void serialize(Archive& archive, Model& model) {
  archive.section(1);
  archive(model.step, model.element_updates, model.times, model.control, model.assembled_step);
  archive(model.energy, model.part_energy, model.momentum);
  archive.section(2);
  archive(model.nodes, model.rotations, model.blocks, model.parts, model.schedule);
  archive(model.particle_searches, model.loads, model.springs, model.ties, model.rigid);
  archive.section(3);
  archive(model.contacts, model.contact_audits, model.impulse_sums);
  archive.section(4);
  archive(model.erosion, model.added_mass);
  std::vector<double> forces;
  if (model.forces) forces = model.forces->impulses();
  archive(forces);
  if (model.forces) model.forces->set_impulses(forces);
  archive.section(5);
}

/// Sizes that the deck determines.
struct Sizes {
  std::size_t nodes, rotations, blocks, parts, loads, springs, bodies, contacts;
  bool erodes, adds_mass;
  explicit Sizes(const Model& model)
      : nodes(model.nodes.size()),
        rotations(model.rotations.size()),
        blocks(model.blocks.size()),
        parts(model.parts.size()),
        loads(model.loads.size()),
        springs(model.springs.spring.size()),
        bodies(model.rigid.body.size()),
        contacts(model.contacts.size()),
        erodes(model.erosion.has_value()),
        adds_mass(model.added_mass.has_value()) {}
  bool operator==(const Sizes&) const = default;
};

}  // namespace

void save_state(const Model& model, std::ostream& out) {
  StateWriter writer(out);
  serialize(writer, const_cast<Model&>(model));  // a writer changes nothing
}

void restore_state(Model& model, std::istream& in, std::uint64_t size) {
  const Sizes built(model);
  StateReader reader(in, size);
  serialize(reader, model);
  if (!(Sizes(model) == built) || !reader.at_end())
    throw StateError("the saved state does not fit the model");
  model.sweep_results.resize(model.schedule.tasks.size());
}

}  // namespace brio
