#pragma once
/// What a deck may say about contact beside the list of surfaces. Every default states its reason.

#include "contact/search.hpp"
#include "src/base/fields.hpp"

namespace brio {

/// How constraints are found: by the sides of faces that nodes are on, or by the least distances of features,
/// which nothing crosses.
enum class DetectionRule { sides, distance };
constexpr std::array<NamedValue<DetectionRule>, 2> named_values(DetectionRule) {
  return {{{"sides", DetectionRule::sides}, {"distance", DetectionRule::distance}}};
}

struct ContactOptions {
  /// Coulomb coefficient; none unless asked for.
  double friction = 0;
  /// Sweeps back over the constraints of a step, and as many forth: one is usable, five leave a residual
  /// below 1e-3 of an edge, ten verify.
  int passes = 5;
  SearchStrategy search = SearchStrategy::automatic;
  DetectionRule rule = DetectionRule::distance;
  /// Length by which capture boxes are grown so that the search can be skipped, over the mean edge of the
  /// surface.
  double reach_buffer = 0.2;
  /// Find first touches along the motion of the step as well; without it a fast node can pass through a thin
  /// body.
  bool velocity_check = true;
  /// Let sharp edges of solids and free edges of shells meet each other; without it crossed edges sink in as
  /// far as their nodes are apart.
  bool edges = true;
  /// Share of an old overlap of a tenth of the smallest edge that a step may remove, of shallower ones the
  /// less the shallower they are, ...
  double overlap_recovery = 0.1;
  /// ... and the most it may remove, over the smallest edge: about 0.001 of the speed of sound, so that no
  /// overlap, whatever its depth, turns into a kick.
  double overlap_recovery_cap = 1e-3;
  /// Scale of the thickness at which shells touch; 1 is the true thickness at the start. It is kept: in the
  /// hinge of a fold a shell thickens by as much as its edges shorten, and neighbours would meet that are no
  /// fold (in the crushed can contact then adds 0.7 % of the energy and misses two contacts, measured).
  double shell_thickness_scale = 1;
  /// Initial overlaps up to this share of the edge (or of the thickness of a shell) are removed by moving
  /// nodes before the first step; deeper ones are an error of the input.
  double initial_overlap_limit = 0.2;
  /// Count at every dump of fields what contact should have kept apart and did not (contact/audit/audit.hpp).
  bool audit = false;

  static constexpr auto fields() {
    return field_table(
        optional("friction", &ContactOptions::friction, non_negative, "Coulomb coefficient, -"),
        optional("passes", &ContactOptions::passes, Range{.lower = 1, .upper = 1000},
                 "sweeps back over the contact constraints of a step, and as many forth, -"),
        optional("search", &ContactOptions::search, any_number,
                 "how candidates are found; the pairs are the same"),
        optional("rule", &ContactOptions::rule, any_number, "how constraints are found"),
        optional("reach_buffer", &ContactOptions::reach_buffer,
                 Range{.lower = 0, .upper = 10, .lower_open = true},
                 "growth of capture boxes that lets the search be skipped, in mean edges, -"),
        optional("velocity_check", &ContactOptions::velocity_check, any_number,
                 "find first touches along the motion of a step"),
        optional("edges", &ContactOptions::edges, any_number,
                 "let sharp edges of solids and free edges of shells meet each other"),
        optional("overlap_recovery", &ContactOptions::overlap_recovery, fraction,
                 "share of an old overlap of a tenth of the smallest edge removed in a step, in proportion "
                 "less of shallower ones, -"),
        optional("overlap_recovery_cap", &ContactOptions::overlap_recovery_cap, non_negative,
                 "most overlap removed in a step, in smallest edges, -"),
        optional("shell_thickness_scale", &ContactOptions::shell_thickness_scale,
                 Range{.lower = 0, .upper = 2, .lower_open = true},
                 "contact thickness over thickness of shells, -"),
        optional("initial_overlap_limit", &ContactOptions::initial_overlap_limit, fraction,
                 "deepest initial overlap removed by moving nodes, in edges or thicknesses, -"),
        optional("audit", &ContactOptions::audit, any_number,
                 "count crossings of surfaces, and distances below thickness, at every dump"));
  }
};

}  // namespace brio
