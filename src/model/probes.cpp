#include "src/model/probes.hpp"

#include <limits>

#include "src/base/index.hpp"
#include "src/deck/part_index.hpp"

namespace brio {

std::size_t nearest_node(const Vector3d& point, const std::optional<std::string>& part, const Deck& deck,
                         std::span<const PartInModel> parts, const Nodes& nodes) {
  std::size_t nearest = 0;
  double least = std::numeric_limits<double>::infinity();
  const auto look = [&](const PartInModel& of) {
    for (const int entry : of.node) {
      const auto node = index(entry);
      Vector3d distance = position(nodes, node);
      for (std::size_t i = 0; i < 3; ++i) distance[i] -= point[i];
      const double square = dot(distance, distance);
      if (square >= least) continue;
      least = square;
      nearest = node;
    }
  };
  if (part)
    look(parts[part_index(*part, deck)]);
  else
    for (const PartInModel& of : parts) look(of);
  return nearest;
}

std::vector<ProbeInRun> place_probes(const Deck& deck, std::span<const PartInModel> parts,
                                     const Nodes& nodes) {
  std::vector<ProbeInRun> probes;
  for (const Probe& wanted : deck.output.history.probes) {
    const std::size_t node = nearest_node(wanted.point, wanted.part, deck, parts, nodes);
    probes.push_back({.name = wanted.name, .node = node, .at_start = position(nodes, node)});
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
