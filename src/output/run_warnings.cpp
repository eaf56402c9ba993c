#include "src/output/run_warnings.hpp"

#include <cmath>
#include <variant>

#include "src/base/index.hpp"
#include "src/model/node_name.hpp"
#include "src/step/diagnosis.hpp"

namespace brio {

namespace {

std::string warning_of_pairs(const Model& model, const ParticleSearch& search) {
  return "part '" + model.parts[search.block].name +
         "': " + written(std::round(100 * search.paired.largest_share)) + " % of the particles at time " +
         written(search.paired.time) +
         " were closer to another than half of their spacing; in tension and in thin sheets particles with "
         "an updated-Lagrangian kernel gather in pairs, and their stress is too low; 'kernel: "
         "total_lagrangian' sustains tension";
}

std::string warning_of_hourglassing(const Model& model, std::size_t part) {
  const PartEnergy& energy = model.part_energy[part];
  const bool is_one_point_brick = std::holds_alternative<Hex8>(model.blocks[part].element);
  const std::string percent = written(std::round(100 * energy.largest_ratio));
  return "part '" + model.parts[part].name + "': hourglass energy passed " +
         written(100 * model.hourglass_warning) + " % of the internal energy at time " +
         written(energy.time_of_warning) + " and " +
         (energy.largest_ratio >= 1 ? "exceeded it" : "was " + percent + " % of it") + " at time " +
         written(energy.time_of_largest) +
         "; hourglass control resists deformation there more than the material does; try smaller elements" +
         (is_one_point_brick ? ", hex8_full in place of hex8," : "") +
         " or loads spread over more nodes (limit: numerics.hourglass_warning)";
}

std::string warning_of_crossing(const Model& model, const ContactScene::Unresolved& unresolved) {
  const auto name = [&](int node) { return name_of_node(model, index(node)); };
  const std::string pair = unresolved.node[0] < 0
                               ? std::string("a node pushed behind a rigid wall")
                               : name(unresolved.node[0]) + " and " + name(unresolved.node[1]);
  return "contact: in " + std::to_string(unresolved.steps) + (unresolved.steps == 1 ? " step" : " steps") +
         " surfaces were not kept from crossing, first at time " + written(unresolved.time) + ": " + pair +
         "; check whether prescribed motions drive them into each other; try a smaller time step "
         "(time.step_scale)";
}

}  // namespace

void watch(Model& model) {
  for (ParticleSearch& search : model.particle_searches) {
    const double share = share_of_paired(*model.blocks[search.block].cloud, model.nodes);
    if (share <= search.paired.largest_share) continue;
    search.paired = {share, model.times.time};
  }
}

std::vector<std::string> run_warnings(const Model& model) {
  std::vector<std::string> warnings;
  for (std::size_t p = 0; p < model.part_energy.size(); ++p)
    if (model.part_energy[p].time_of_warning >= 0) warnings.push_back(warning_of_hourglassing(model, p));
  for (const ParticleSearch& search : model.particle_searches)
    if (search.paired.largest_share >= PairedParticles::worth_a_warning)
      warnings.push_back(warning_of_pairs(model, search));
  for (const ContactScene& scene : model.contacts)
    if (scene.unresolved.steps > 0) warnings.push_back(warning_of_crossing(model, scene.unresolved));
  return warnings;
}

}  // namespace brio
