// The can whose steel is a table of its power law.

#include <gtest/gtest.h>

#include <cmath>

#include "io/deck/read_deck.hpp"
#include "io/run/run_deck.hpp"
#include "src/base/index.hpp"
#include "src/step/advance.hpp"

namespace brio {
namespace {

/// Rows of a power law at strains that grow by 9 %: between them the curve is a chord, at most 0.02 % of the
/// hardening below.
TabulatedPlasticity table_of(const PowerLawHardening& law) {
  std::vector<std::array<double, 2>> rows{{0, law.yield_stress}};
  for (double strain = 1e-9; strain < 10; strain *= 1.09)
    rows.push_back({strain, law.hardening().at(strain).stress});
  return {law.density, law.youngs_modulus, law.poissons_ratio, yield_table(rows)};
}

struct End {
  double plate_velocity, plastic_work, deepest;
};

End crush(const Deck& deck) {
  Model model = build_scene(deck, 2);
  ThreadTeam team(2);
  while (true) {
    update_velocities(model, deck.numerics.energy_error_limit, team);
    if (model.times.time >= deck.time.end) break;
    update_positions(model, team);
  }
  End end{0, model.part_energy[0].internal, 1e9};
  for (const int node : model.parts[1].node)
    end.plate_velocity +=
        model.nodes.mass[index(node)] * model.nodes.record[index(node)].velocity[2] / model.parts[1].mass;
  for (const int node : model.parts[0].node)
    end.deepest = std::min(end.deepest, -std::abs(model.nodes.record[index(node)].position[0]));
  return end;
}

TEST(TabulatedCanSlow, IsCrushedLikeThatOfThePowerLaw) {
  Deck deck =
      read_deck(BRIO_SOURCE_DIR "/inputs/can_buckling.yaml",
                {"parts.can.mesh.cylinder.elements=[48, 30]", "time.end=1e-3", "contact.audit=false"});
  const End power_law = crush(deck);
  deck.materials[0].second = table_of(std::get<PowerLawHardening>(deck.materials[0].second));
  const End table = crush(deck);
  EXPECT_NEAR(table.plate_velocity, power_law.plate_velocity, 1e-3 * std::abs(power_law.plate_velocity));
  EXPECT_NEAR(table.plastic_work, power_law.plastic_work, 1e-3 * power_law.plastic_work);
  EXPECT_NEAR(table.deepest, power_law.deepest, 1e-3 * std::abs(power_law.deepest));
}

}  // namespace
}  // namespace brio
