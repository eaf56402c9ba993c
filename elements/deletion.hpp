#pragma once
/// Criteria of element deletion besides failure of the material, and treatment of free nodes.

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include "src/base/fields.hpp"

namespace brio {

/// Why an element is deleted: the first of these that holds.
enum class DeletionCause { damage, plastic_strain, distortion };
inline constexpr std::array<std::string_view, 3> deletion_causes{"damage", "plastic_strain", "distortion"};
/// By DeletionCause.
using CountByCause = std::array<std::int64_t, deletion_causes.size()>;

/// Treatment of a node whose last element is deleted.
enum class FreeNodes {
  keep,  ///< it is retained as a free point mass
  drop   ///< it is removed; its mass, momentum and kinetic energy count as deleted
};
constexpr std::array<NamedValue<FreeNodes>, 2> named_values(FreeNodes) {
  return {{{"keep", FreeNodes::keep}, {"drop", FreeNodes::drop}}};
}

struct Deletion {
  std::optional<double> minimum_step{};
  bool inverted = false;
  bool corner_inverted = false;
  std::optional<double> plastic_strain{};
  std::optional<double> volume_ratio{};
  FreeNodes free_nodes = FreeNodes::keep;
  std::optional<double> debris_radius{};

  static constexpr auto fields() {
    return field_table(
        optional("minimum_step", &Deletion::minimum_step, positive,
                 "an element whose stable time step falls below it is deleted, time"),
        optional("inverted", &Deletion::inverted, any_number,
                 "whether an element that inverts is deleted; otherwise it stops the run"),
        optional("corner_inverted", &Deletion::corner_inverted, any_number,
                 "whether an element with a negative Jacobian at a corner is deleted, though its volume is "
                 "positive; hexahedra only"),
        optional("plastic_strain", &Deletion::plastic_strain, positive,
                 "an element whose equivalent plastic strain, mean of its integration points, exceeds it is "
                 "deleted, -"),
        optional("volume_ratio", &Deletion::volume_ratio,
                 Range{.lower = 0, .upper = 1, .lower_open = true, .upper_open = true},
                 "an element whose volume falls below this fraction of the initial volume is deleted; "
                 "hexahedra only, -"),
        optional("free_nodes", &Deletion::free_nodes, any_number,
                 "whether nodes without remaining elements are kept as free point masses or removed"),
        optional(
            "debris_radius", &Deletion::debris_radius, positive,
            "contact radius of nodes without remaining elements; without it they have no contact, length"));
  }

  constexpr bool names_a_criterion() const {
    return minimum_step || inverted || corner_inverted || plastic_strain || volume_ratio;
  }
};

}  // namespace brio
