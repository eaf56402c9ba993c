#pragma once
/// The end state of a run in figures, for scripts. The names are a contract: they may grow in number, not
/// change.

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "elements/deletion.hpp"
#include "elements/kinds.hpp"

namespace brio {

/// Elements by the summary key of their kind, in the order of the kinds.
class ElementCounts {
 public:
  ElementCounts() {
    for (const std::string_view key : summary_keys(Element{})) by_key_.emplace_back(key, 0);
  }
  /// \pre key of a kind
  std::int64_t& operator[](std::string_view key) {
    return std::ranges::find(by_key_, key, &Count::first)->second;
  }
  std::int64_t operator[](std::string_view key) const {
    return std::ranges::find(by_key_, key, &Count::first)->second;
  }
  std::int64_t total() const {
    std::int64_t sum = 0;
    for (const Count& count : by_key_) sum += count.second;
    return sum;
  }
  using Count = std::pair<std::string_view, std::int64_t>;
  const std::vector<Count>& by_key() const { return by_key_; }

 private:
  std::vector<Count> by_key_;
};

struct Summary {
  struct StepSizes {
    double min = 0, max = 0, last = 0;
  };
  struct Energies {
    double kinetic = 0, internal = 0, hourglass = 0, viscous = 0, contact = 0, friction = 0, external = 0,
           deleted = 0;
    double total_start = 0;     ///< at the beginning of the run
    double error_relative = 0;  ///< error of the energy balance, over the largest energy in it
  };
  /// Mass of nodes with elements, of free point masses, of removed nodes: their sum is the initial mass.
  struct Masses {
    double start = 0, intact = 0, debris = 0, deleted = 0;
    double of_deleted_elements = 0;  ///< rests on their nodes
  };
  struct Momenta {
    Vector3d linear{}, angular{};  ///< angular: about the origin
  };
  /// Where the contact audit found the worst of a kind.
  struct DeepestContact {
    double depth = 0;  ///< a length
    double time = 0;
    std::int64_t node = -1;            ///< as in the results
    std::array<std::string, 2> parts;  ///< that of the node, and the other
  };
  /// Contact audits, summed over the dumps of fields.
  struct ContactAudits {
    std::int64_t audited_dumps = 0, crossed_dumps = 0;
    std::int64_t crossings = 0, deep_crossings = 0, too_close = 0, swallowed = 0;
    std::optional<DeepestContact> deepest_crossing, deepest_too_close;  ///< where there is any
  };
  struct ContactCounts {
    std::int64_t searches = 0, comparisons = 0, candidate_pairs = 0, active_max = 0;
    double penetration_max = 0;           ///< a length
    std::int64_t missed = 0;              ///< all that audits found
    std::optional<ContactAudits> audits;  ///< where the deck asks for them
    std::int64_t bodies = 0;              ///< that the surface consists of
    std::int64_t constraints_total = 0;   ///< sum over steps
    double passes_mean = 0;               ///< iterations of the solver a step
    double certified_share = 0;           ///< fraction of pairs that a separating plane settled
    std::int64_t last_resort_uses = 0;    ///< impact zones
    std::int64_t unresolved = 0;          ///< steps that ended with something about to cross
  };
  struct HourglassRatio {
    double value = 0;  ///< hourglass energy of a part over its largest internal energy until then
    std::string part;  ///< empty: no hourglass energy worth mention
    double time = 0;
  };
  struct TieCounts {
    std::int64_t nodes = 0;     ///< tied at the start
    std::int64_t released = 0;  ///< of these, because elements were deleted or they failed
    std::int64_t failed = 0;    ///< of the released, by force
  };
  struct MassScaling {
    double added = 0, share = 0;  ///< share: over the mass of all elements at the start
    std::map<std::string, double> parts;
  };
  struct WallTimes {
    double total = 0;  ///< seconds
    std::map<std::string, double> by_stage;
  };

  std::string version;
  std::string deck;
  std::string status;  ///< "finished", "stopped", "interrupted", "terminated" or "failed"
  int exit_code = 0;
  int ranks = 1;               ///< processes
  std::string restarted_from;  ///< restart file that the run went on from; empty: it began
  std::int64_t steps = 0;
  double time = 0;
  StepSizes dt;
  std::int64_t nodes = 0;
  ElementCounts elements;  ///< at the start
  ElementCounts deleted;
  CountByCause deleted_by_cause{};
  Energies energy;
  HourglassRatio hourglass_ratio_max;  ///< of all parts and times
  Masses mass;
  Momenta momentum;
  ContactCounts contact;
  std::optional<TieCounts> ties;            ///< where the deck ties something
  std::optional<MassScaling> mass_scaling;  ///< where the deck asks for it
  WallTimes wall_s;
  double element_updates_per_s = 0;
  double peak_memory_mb = 0;
  int threads = 1;
  std::vector<std::string> active_features;
  std::vector<std::string> warnings;  ///< what makes results doubtful, as sentences
};

}  // namespace brio
