#pragma once
/// Parts whose elements are deleted.

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "src/base/index.hpp"
#include "src/sweep/erosion.hpp"
#include "tests/core/scene.hpp"

namespace brio::test {

inline constexpr double yield = 1e6;
inline constexpr double hardening = 1e7;

/// Yields at a strain of 0.001.
inline ElasticPlastic tough() {
  return {.density = 1000,
          .youngs_modulus = 1e9,
          .poissons_ratio = 0.3,
          .yield_stress = yield,
          .hardening_modulus = hardening};
}
inline ElasticPlastic brittle(double strain, double opening) {
  ElasticPlastic law = tough();
  law.failure.emplace();
  law.failure->strain = strain;
  law.failure->opening_strain = opening;
  return law;
}

inline PrescribedMotion pull(std::string set, int axis, double velocity) {
  PrescribedMotion motion;
  motion.where.set = std::move(set);
  motion.components.push_back({axis, Curve{{{0, velocity}}}});
  return motion;
}

/// Cubes of edge 1 along x, fixed at one end and pulled at the other.
inline Deck pulled_bar(int elements, const Material& material, double velocity = 1) {
  Deck deck;
  deck.materials = {{"material", material}};
  deck.parts = {
      box("bar", {1.0 * elements, 1, 1}, {elements, 1, 1}, {0.5 * elements, 0, 0}, inviscid_hex8())};
  deck.boundary_conditions = {pull("bar.xmin", 0, 0), pull("bar.xmax", 0, velocity)};
  deck.time.end = 0.2;
  return deck;
}

/// Every node follows the same affine motion: uniaxial strain, all elements alike.
inline Deck stretched_bar(int elements, const Material& material, double rate) {
  Deck deck = pulled_bar(elements, material);
  deck.boundary_conditions = {fix("bar.all", {1, 2})};
  for (int i = 0; i <= elements; ++i) {
    PrescribedMotion motion = pull("", 0, rate * i);
    motion.where.region = BoxRegion{{i - 0.25, -9, -9}, {i + 0.25, 9, 9}};
    deck.boundary_conditions.push_back(motion);
  }
  return deck;
}

struct Death {
  std::int64_t step;
  DeletedElement element;
  friend bool operator==(const Death&, const Death&) = default;
};

struct Outcome {
  std::vector<Death> deaths;
  std::vector<double> positions;
  double worst_error = 0;
};

inline Outcome run_all(Model& model, const Deck& deck, int threads = 1) {
  ThreadTeam team(threads);
  Outcome outcome;
  run(model, deck, team, [&](Model& m) {
    for (const DeletedElement& element : m.erosion->deleted) outcome.deaths.push_back({m.step, element});
    outcome.worst_error = std::max(outcome.worst_error, std::abs(m.energy.relative_error()));
  });
  for (const NodeRecord& record : model.nodes.record)
    outcome.positions.insert(outcome.positions.end(), record.position, record.position + 3);
  return outcome;
}

inline double total_mass(const Model& model) {
  const MassBalance balance = mass_balance(*model.erosion, model.nodes);
  return balance.intact + balance.debris + model.erosion->dropped_mass;
}

/// A block that is torn in a velocity field: deletions spread over many steps and chunks.
inline Deck torn_block(FreeNodes free_nodes = FreeNodes::keep) {
  Deck deck;
  deck.materials = {{"material", brittle(0.01, 0.02)}, {"other", tough()}};
  deck.parts = {box("block", {1, 1, 1}, {9, 9, 9}, {0, 0, 0}, hex8()),
                box("whole", {1, 1, 1}, {3, 3, 3}, {5, 0, 0}, hex8(), "other")};
  deck.parts[0].deletion.emplace();
  deck.parts[0].deletion->free_nodes = free_nodes;
  InitialCondition left = moving("", {-30, 0, 3});
  left.where.region = BoxRegion{{-1, -1, -1}, {-0.05, 1, 1}};
  InitialCondition right = moving("", {25, 5, 0});
  right.where.region = BoxRegion{{0.05, -1, -1}, {1, 1, 1}};
  deck.initial_conditions = {left, right};
  deck.time.end = 8e-3;
  return deck;
}

/// Deletes the elements of a part for which `dies` holds, as a sweep would have asked for it.
template <class Dies>
void delete_by_hand(Model& model, std::size_t part, const Dies& dies) {
  std::vector<SweepResult> results(model.schedule.tasks.size());
  for (std::size_t t = 0; t < results.size(); ++t) {
    const SweepTask& task = model.schedule.tasks[t];
    if (task.block != part) continue;
    Block& block = model.blocks[part];
    const std::size_t first = task.chunk.first_pack * index(block.lanes);
    for (std::size_t place = first; place < first + task.chunk.element_count; ++place)
      if (dies(model.parts[part].element_order[place]))
        block.lost[first + results[t].lost++] = static_cast<int>(place);
  }
  model.energy += erode(*model.erosion, model.schedule, results, model.blocks, model.parts);
}

}  // namespace brio::test
