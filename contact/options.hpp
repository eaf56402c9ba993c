#pragma once
/// Settings of contact besides the list of surfaces. Every default states its reason.

#include <cmath>
#include <optional>
#include <string_view>

#include "contact/search/search.hpp"
#include "src/base/fields.hpp"

namespace brio {

/// Static and kinetic friction: it falls with the sliding velocity, mu = mu_k + (mu_s - mu_k) exp(-c |v|),
/// where mu_s is the coefficient without this.
struct KineticFriction {
  double coefficient = 0;
  double decay = 0;

  static constexpr auto fields() {
    return field_table(
        required("coefficient", &KineticFriction::coefficient, non_negative,
                 "mu_k: Coulomb coefficient of fast sliding, -"),
        required("decay", &KineticFriction::decay, positive,
                 "c in mu_k + (friction - mu_k) exp(-c v) of the sliding velocity v, time per length"));
  }

  /// mu over mu_s. \param speed of sliding, length per time
  double share(double static_coefficient, double speed) const {
    const double kinetic = coefficient / static_coefficient;
    return kinetic + (1 - kinetic) * std::exp(-decay * speed);
  }
};

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
  /// Fraction of an overlap of a tenth of the smallest edge removed in a time step as long as the longest so
  /// far, of smaller ones and in shorter steps proportionally less, ...
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
  /// Absent: friction does not depend on velocity.
  std::optional<KineticFriction> kinetic_friction{};

  static constexpr auto fields() {
    return field_table(
        optional("friction", &ContactOptions::friction, non_negative,
                 "Coulomb coefficient; with kinetic_friction that of sticking, -"),
        optional("kinetic_friction", &ContactOptions::kinetic_friction, any_number,
                 "friction that falls with the sliding velocity, of all pairs in the same ratio; absent: it "
                 "does not depend on velocity"),
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
        optional(
            "overlap_recovery", &ContactOptions::overlap_recovery, fraction,
            "fraction of an overlap of a tenth of the smallest edge that is removed in a time step as "
            "long as the longest so far, in proportion less of smaller overlaps and in shorter steps, -"),
        optional(
            "overlap_recovery_cap", &ContactOptions::overlap_recovery_cap, non_negative,
            "largest overlap removed in a time step as long as the longest so far, in smallest edges, -"),
        optional("shell_thickness_scale", &ContactOptions::shell_thickness_scale,
                 Range{.lower = 0, .upper = 2, .lower_open = true},
                 "contact thickness over thickness of shells, -"),
        optional("initial_overlap_limit", &ContactOptions::initial_overlap_limit, fraction,
                 "deepest initial overlap removed by moving nodes, in edges or thicknesses, -"),
        optional("audit", &ContactOptions::audit, any_number,
                 "brute-force contact audit: count undetected penetrations at every dump"));
  }
  constexpr std::string_view fault() const {
    return kinetic_friction && friction == 0
               ? "kinetic_friction is a share of 'friction', which is 0; accepted is friction > 0"
               : "";
  }
};

}  // namespace brio
