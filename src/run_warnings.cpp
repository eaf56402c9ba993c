#include "src/run_warnings.hpp"

#include <cstdio>

namespace brio {

namespace {

std::string names_of_parts(const Model& model, std::size_t block) {
  std::string names;
  for (const PartInModel& part : model.parts)
    if (part.rigid < 0 && part.block == block) names += (names.empty() ? "'" : ", '") + part.name + "'";
  return names;
}

std::string warning_of_pairs(const Model& model, const ParticleSearch& search) {
  char figures[200];
  std::snprintf(figures, sizeof figures,
                "%.0f %% of the particles at time %.4g were closer to another than half of their spacing",
                100 * search.paired.largest_share, search.paired.time);
  return "part " + names_of_parts(model, search.block) + ": " + figures +
         "; in tension and in thin sheets particles whose kernel is of now gather in pairs, and their stress "
         "is too low; 'kernel: total_lagrangian' holds tension";
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
