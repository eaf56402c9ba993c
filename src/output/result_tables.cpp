#include "src/output/result_tables.hpp"

namespace brio {

namespace {

constexpr HistoryColumn common[] = {
    {"time", "time", "of the row"},
    {"step", "-", "number of time steps until then"},
    {"dt", "time", "the time step that follows"},
    {"kinetic", "energy", "kinetic energy at this time, from the velocities of both half steps beside it"},
    {"internal", "energy", "elastic and plastic work on elements that live"},
    {"hourglass", "energy", "work against hourglass modes"},
    {"viscous", "energy", "dissipated by bulk and hourglass viscosity and by mass-proportional damping"},
    {"deleted", "energy", "energy of deleted elements, and kinetic energy of removed nodes"},
    {"contact", "energy", "dissipated by normal impulses of contact and walls"},
    {"friction", "energy", "dissipated by friction"},
    {"external", "energy", "work of loads, supports and moving walls on the scene"},
    {"total", "energy", "sum of kinetic to friction"},
    {"error_relative", "-",
     "error of the energy balance: (total - kinetic energy at the start - external), over the largest energy "
     "so "
     "far"},
    {"contact_added_max", "energy",
     "largest work of contact on the scene so far; near 0 where contact adds no energy"},
    {"momentum_x", "impulse", "linear momentum"},
    {"angular_momentum_x", "moment time", "angular momentum about the origin"},
    {"linear_imbalance", "-",
     "largest component of (momentum - that at the start - impulses of loads, supports and walls), over the "
     "largest sum of |m v| so far"},
    {"angular_imbalance", "-", "the same of angular momentum"},
    {"support_impulse_x", "impulse", "impulse of all supports on the scene since the start"},
    {"wall_impulse_x", "impulse", "impulse of all rigid walls on the scene since the start"},
    {"deleted_elements", "-", "since the start"}};

constexpr HistoryColumn further[] = {
    {"PART.velocity_x", "velocity",
     "mean velocity of a part: momentum over mass; of the first hundred parts"},
    {"added_mass", "mass", "by mass scaling, so far"},
    {"missed_contacts", "-",
     "crossings, distances too close and bodies inside of others, summed over audited dumps"},
    {"crossings", "-", "pairs of faces that intersect, summed over audited dumps"},
    {"deleted_by_CAUSE", "-", "deleted elements by cause: damage, plastic_strain, distortion"},
    {"PROBE.displacement_x", "length", "of the node of a probe since the start"},
    {"PROBE.velocity_x", "velocity", "of the node of a probe, at the last half step"},
    {"PART.centre_x", "length", "centre of mass of a rigid part"},
    {"PART.rotation_x", "radian", "rotation vector of a rigid part since the start, its angle at most pi"},
    {"PART.kinetic", "energy",
     "of a part, from the velocities of the last half step; of a node that parts share each has all"},
    {"PART.internal", "energy", "elastic and plastic work on a part so far, also on what was deleted since"},
    {"PART.hourglass", "energy", "work against its hourglass modes, likewise"},
    {"spring.NAME.elongation", "length",
     "present length of a spring less that at the start or as given; between sets the mean of its pairs"},
    {"spring.NAME.force", "force",
     "of spring and dashpot; positive: it pulls; between sets the sum of its pairs"},
    {"spring.NAME.angle", "radian", "of a torsional spring, of its second end less the first about its axis"},
    {"spring.NAME.moment", "moment", "of a torsional spring and dashpot"},
    {"spring.NAME.broken", "-", "pairs of a spring between sets that have broken"},
    {"reaction.NAME_x", "force", "force of a named support or wall on the scene, mean since the last row"},
    {"contact.PART.PART_x", "force",
     "force of contact on the first part by the second, normal and friction, mean since the last row; of a "
     "part on itself the sum of the sizes"},
    {"contact.PART.PART.friction_x", "force",
     "what of it is friction; impact zones, which end sliding without friction, have none"},
    {"section.NAME_x", "force",
     "internal force through a plane, on what lies behind it by what lies ahead, mean since the last row"},
    {"section.NAME_mx", "moment",
     "its moment about the centre of the cut elements, mean since the last row"}};

constexpr SummaryKey summary[] = {
    {"version", "", "of the program"},
    {"deck", "", "path of the deck"},
    {"status", "", "`finished`, `stopped`, `interrupted`, `terminated` or `failed`"},
    {"exit_code", "", "with which the program ended"},
    {"steps", "-", "time steps made"},
    {"time", "time", "reached"},
    {"dt.min, dt.max, dt.last", "time", "smallest, largest and last time step"},
    {"nodes", "-", "at the start"},
    {"elements.KIND", "-", "elements at the start by kind"},
    {"deleted.KIND", "-", "deleted elements by kind"},
    {"deleted_by_cause.CAUSE", "-", "deleted elements by cause"},
    {"energy.KIND", "energy",
     "at the end, as the columns of the history; `total_start`: at the start; `error_relative`: of the "
     "balance"},
    {"hourglass_ratio_max.value", "-",
     "largest hourglass energy of a part over its largest internal energy until then"},
    {"hourglass_ratio_max.part, hourglass_ratio_max.time", "", "which part, and when"},
    {"mass.start", "mass", "all of the scene; the sum of the next three"},
    {"mass.intact, mass.debris, mass.deleted", "mass",
     "of nodes with elements, of free point masses, of removed nodes"},
    {"mass.of_deleted_elements", "mass", "rests on their nodes"},
    {"momentum.linear, momentum.angular", "impulse, moment time", "at the end; about the origin"},
    {"contact.searches, contact.comparisons, contact.candidate_pairs", "-",
     "searches for pairs, boxes compared in them, pairs found in them"},
    {"contact.bodies", "-", "connected pieces of surface"},
    {"contact.constraints_total", "-", "contact constraints, summed over steps"},
    {"contact.passes_mean", "-",
     "iterations of the contact solver in a step, weighted by the fraction of rows"},
    {"contact.certified_share", "-", "fraction of tests settled by a separating plane"},
    {"contact.last_resort_uses", "-", "impact zones"},
    {"contact.unresolved", "-", "steps that ended with something about to cross"},
    {"contact.active_max", "-", "most constraints with an impulse in a step"},
    {"contact.penetration_max", "length", "largest penetration of a contact distance, skins included"},
    {"contact.missed", "-", "sum of crossings, too_close and swallowed over audited dumps"},
    {"contact.audited_dumps, contact.crossed_dumps", "-", "dumps audited, and those with any crossing"},
    {"contact.deep_crossings, contact.too_close, contact.swallowed", "-",
     "findings of the contact audit ([contact.md](contact.md))"},
    {"contact.deepest_crossing, contact.deepest_too_close", "", "depth, time, node and parts of the worst"},
    {"crossings", "-", "pairs of faces that intersect, summed over audited dumps"},
    {"ties.nodes, ties.released, ties.failed", "-", "tied nodes; released in the run; of these, by force"},
    {"mass_scaling.added, mass_scaling.share, mass_scaling.parts", "mass, -, mass",
     "mass added, over that of all elements, and by part"},
    {"wall_s.total, wall_s.by_stage.STAGE", "second", "wall time of the run, and by stage of the time step"},
    {"element_updates_per_s", "1/second", "elements times steps over wall time"},
    {"peak_memory_mb", "MB", "of the process"},
    {"threads", "-", "used, of each rank"},
    {"ranks", "-", "processes that computed the scene together (mpirun)"},
    {"active_features", "", "what the scene switched on"},
    {"warnings", "", "what makes results doubtful, as sentences"},
    {"restarted_from", "", "restart file that the run went on from"}};

}  // namespace

std::span<const HistoryColumn> common_columns() { return common; }
std::span<const HistoryColumn> further_columns() { return further; }
std::span<const SummaryKey> summary_table() { return summary; }

}  // namespace brio
