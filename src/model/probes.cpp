#include "src/model/probes.hpp"

#include <limits>

#include "src/deck/part_index.hpp"

namespace brio {

namespace {

Vector position_of(const Nodes& nodes, std::size_t node) {
  const double* x = nodes.record[node].position;
  return {x[0], x[1], x[2]};
}

}  // namespace

std::vector<ProbeInRun> place_probes(const Deck& deck, std::span<const PartInModel> parts,
                                     const Nodes& nodes) {
  std::vector<ProbeInRun> probes;
  for (const Probe& wanted : deck.output.history.probes) {
    ProbeInRun& probe = probes.emplace_back();
    probe.name = wanted.name;
    double least = std::numeric_limits<double>::infinity();
    const auto look = [&](const PartInModel& part) {
      for (const int entry : part.node) {
        const auto node = static_cast<std::size_t>(entry);
        Vector distance = position_of(nodes, node);
        for (std::size_t i = 0; i < 3; ++i) distance[i] -= wanted.point[i];
        const double square = dot(distance, distance);
        if (square >= least) continue;
        least = square;
        probe.node = node;
      }
    };
    if (wanted.part) {
      look(parts[part_index(*wanted.part, deck)]);
    } else {
      for (const PartInModel& part : parts) look(part);
    }
    probe.at_start = position_of(nodes, probe.node);
  }
  return probes;
}

void add_columns(std::span<const ProbeInRun> probes, std::vector<std::string>& columns) {
  for (const ProbeInRun& probe : probes)
    for (const char* quantity : {".displacement_x", ".displacement_y", ".displacement_z", ".velocity_x",
                                 ".velocity_y", ".velocity_z"})
      columns.push_back(probe.name + quantity);
}

void add_values(std::span<const ProbeInRun> probes, const Nodes& nodes, std::vector<double>& row) {
  for (const ProbeInRun& probe : probes) {
    const NodeRecord& record = nodes.record[probe.node];
    for (std::size_t i = 0; i < 3; ++i) row.push_back(record.position[i] - probe.at_start[i]);
    for (std::size_t i = 0; i < 3; ++i) row.push_back(record.velocity[i]);
  }
}

}  // namespace brio
