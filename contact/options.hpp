#pragma once
/// Settings of contact besides the list of surfaces. Every default states its reason.

#include "contact/search/search.hpp"
#include "src/base/fields.hpp"

namespace brio {

struct ContactOptions {
  /// Coulomb coefficient; none unless asked for.
  double friction = 0;
  /// Largest number of iterations over the constraints of a time step, in tens.
  int passes = 20;
  /// Converged: no relative velocity changes by more than this fraction of the largest that corresponds to an
  /// impulse.
  double tolerance = 1e-3;
  SearchStrategy search = SearchStrategy::automatic;
  /// Search margin (Verlet skin) of boxes, over the mean edge of the surface.
  double reach_buffer = 0.2;
  /// Continuous collision detection in each time step; without it fast bodies pass through thin ones.
  bool velocity_check = true;
  /// Edge-edge contact of faces; without it crossed edges penetrate up to the distance of their nodes.
  bool edges = true;
  /// Fraction of an overlap of a tenth of the smallest edge removed in a time step, of smaller ones
  /// proportionally less, ...
  double overlap_recovery = 0.1;
  /// ... and the largest length removed, over the smallest edge: about 0.001 of the speed of sound, so that
  /// no overlap of any depth causes an impact.
  double overlap_recovery_cap = 1e-3;
  /// Scale of the contact thickness of shells; 1 is the initial thickness. It stays constant: in the hinge of
  /// a fold a shell thickens by as much as its edges shorten, and neighbours that are no fold would be in
  /// contact (in the crushed can contact then adds 0.7 % of the energy and misses two contacts, measured).
  double shell_thickness_scale = 1;
  /// Initial overlaps up to this share of the edge (or of the thickness of a shell) are removed by moving
  /// nodes before the first step; deeper ones are an error of the input.
  double initial_overlap_limit = 0.2;
  /// Contact audit: count undetected penetrations at every dump of fields (contact/audit/audit.hpp).
  bool audit = false;

  static constexpr auto fields() {
    return field_table(
        optional("friction", &ContactOptions::friction, non_negative, "Coulomb coefficient, -"),
        optional("passes", &ContactOptions::passes, Range{.lower = 1, .upper = 1000},
                 "largest number of iterations over the contact constraints of a time step, in tens, -"),
        optional(
            "tolerance", &ContactOptions::tolerance, Range{.lower = 0, .upper = 1, .lower_open = true},
            "iterations end once no relative velocity changes by more than this fraction of the largest, -"),
        optional(
            "search", &ContactOptions::search, any_number,
            "search strategy for surfaces that intersect at the start; the result does not depend on it"),
        optional("reach_buffer", &ContactOptions::reach_buffer,
                 Range{.lower = 0, .upper = 10, .lower_open = true},
                 "search margin (Verlet skin) of the bounding boxes, in mean edges, -"),
        optional("velocity_check", &ContactOptions::velocity_check, any_number,
                 "continuous collision detection: find and prevent crossings within a time step"),
        optional("edges", &ContactOptions::edges, any_number, "edge-edge contact of solids and shells"),
        optional("overlap_recovery", &ContactOptions::overlap_recovery, fraction,
                 "fraction of an overlap of a tenth of the smallest edge that is removed in a time step, in "
                 "proportion less of smaller ones, -"),
        optional("overlap_recovery_cap", &ContactOptions::overlap_recovery_cap, non_negative,
                 "largest overlap removed in a time step, in smallest edges, -"),
        optional("shell_thickness_scale", &ContactOptions::shell_thickness_scale,
                 Range{.lower = 0, .upper = 2, .lower_open = true},
                 "contact thickness over thickness of shells, -"),
        optional("initial_overlap_limit", &ContactOptions::initial_overlap_limit, fraction,
                 "deepest initial overlap removed by moving nodes, in edges or thicknesses, -"),
        optional("audit", &ContactOptions::audit, any_number,
                 "brute-force contact audit: count undetected penetrations at every dump"));
  }
};

}  // namespace brio
