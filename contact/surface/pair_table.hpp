#pragma once
/// Rules for pairs of parts: another coefficient of friction, or exclusion from contact. Empty without rules.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "src/base/index.hpp"

namespace brio {

struct SurfacePart;

/// A rule for two parts, by their numbers in the surface; for a part and itself where they are the same.
struct PairRule {
  int part[2] = {0, 0};
  std::optional<double> friction{};  ///< Coulomb coefficient; none: that of all
  bool touch = true;
};

class PairTable {
 public:
  PairTable() = default;
  /// Later rules for the same pair take the place of earlier ones. A node of several parts counts as one of
  /// the first.
  PairTable(std::span<const PairRule> rules, std::span<const SurfacePart> parts, std::size_t node_count);

  /// Whether contact of a node with faces of a part is excluded.
  bool apart(int global_node, int face_part) const {
    return !apart_.empty() && apart_[place(global_node, face_part)] != 0;
  }
  /// Coefficient for a node and faces of a part. \param all without a rule
  double friction(int global_node, int face_part, double all) const {
    return friction_.empty() ? all : friction_[place(global_node, face_part)].value_or(all);
  }

  /// The same for two parts.
  bool parts_apart(int part, int other) const {
    return !apart_.empty() && apart_[place_of(part, other)] != 0;
  }
  double friction_of_parts(int part, int other, double all) const {
    return friction_.empty() ? all : friction_[place_of(part, other)].value_or(all);
  }

 private:
  std::size_t place_of(int part, int other) const { return index(part) * parts_ + index(other); }
  std::size_t place(int global_node, int face_part) const {
    return place_of(part_of_node_[index(global_node)], face_part);
  }

  std::size_t parts_ = 0;
  std::vector<int> part_of_node_;                ///< of each global node of the surface's parts
  std::vector<std::uint8_t> apart_;              ///< of each pair; empty: all may touch
  std::vector<std::optional<double>> friction_;  ///< of each pair; empty: the same for all
};

}  // namespace brio
