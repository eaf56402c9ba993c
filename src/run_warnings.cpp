#include "src/run_warnings.hpp"

#include <cmath>

#include "src/diagnosis.hpp"

namespace brio {

namespace {

std::string warning_of_pairs(const Model& model, const ParticleSearch& search) {
  return "part '" + model.parts[search.block].name +
         "': " + written(std::round(100 * search.paired.largest_share)) + " % of the particles at time " +
         written(search.paired.time) +
         " were closer to another than half of their spacing; in tension and in thin sheets particles whose "
         "kernel is of now gather in pairs, and their stress is too low; 'kernel: total_lagrangian' holds "
         "tension";
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
  for (const ParticleSearch& search : model.particle_searches)
    if (search.paired.largest_share >= PairedParticles::worth_a_warning)
      warnings.push_back(warning_of_pairs(model, search));
  return warnings;
}

}  // namespace brio
