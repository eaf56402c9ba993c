#pragma once
/// Nodes whose motion is written to the history.

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "src/deck/deck.hpp"
#include "src/motion/energy_balance.hpp"
#include "src/sweep/erosion.hpp"

namespace brio {

struct ProbeInRun {
  std::string name;
  std::size_t node = 0;
  Vector3d at_start{};  ///< its position
};

/// The node nearest to a point, the first of equals. \param part empty: of all parts
/// \throws BuildError where the part is not there
std::size_t nearest_node(const Vector3d& point, const std::optional<std::string>& part, const Deck& deck,
                         std::span<const PartInModel> parts, const Nodes& nodes);

/// The nodes nearest to the probes. \throws BuildError where a part is not there.
std::vector<ProbeInRun> place_probes(const Deck& deck, std::span<const PartInModel> parts,
                                     const Nodes& nodes);

/// NAME.displacement_x to NAME.velocity_z, six a probe.
void add_columns(std::span<const ProbeInRun> probes, std::vector<std::string>& columns);
/// Displacement at the time of the step, velocity of the half step that follows it.
void add_values(std::span<const ProbeInRun> probes, const Nodes& nodes, std::vector<double>& row);

}  // namespace brio
