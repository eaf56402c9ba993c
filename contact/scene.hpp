#pragma once
/// A contact scene: surfaces in contact with each other and themselves, and the contact history.
///
///     ContactScene scene = make_contact_scene(options, parts, nodes);
///     each step, positions at n, velocities predicted for n+1/2:  resolve(scene, nodes, dt, team);
///
/// Only velocities are changed. Arrays are reused: nothing is allocated for fewer pairs and contacts than
/// before.

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "contact/detection/crossing_guard.hpp"
#include "contact/detection/proximity.hpp"
#include "contact/enforcement/contact_rows.hpp"
#include "contact/enforcement/impulse_solver.hpp"
#include "contact/enforcement/nodes_at_walls.hpp"
#include "contact/enforcement/recovery.hpp"
#include "contact/erosion.hpp"
#include "contact/features/feature_motion.hpp"
#include "contact/features/features.hpp"
#include "contact/impulse_log.hpp"
#include "contact/options.hpp"
#include "contact/pair.hpp"
#include "contact/pairs/feature_pairs.hpp"
#include "contact/surface/slave_set.hpp"
#include "contact/surface/surface.hpp"
#include "src/base/nodes.hpp"
#include "src/base/parallel.hpp"

namespace brio {

/// Contact in the last step. Work is that of all impulses J, J.v with the relative velocities of the half
/// step before and of the half step after; the mean of both is the energy added by contact (negative:
/// dissipated).
struct ContactStep {
  double normal_work_before = 0;
  double normal_work_after = 0;
  double friction_work_before = 0;
  double friction_work_after = 0;
  int contacts = 0;            ///< constraints, closed or about to close
  int active = 0;              ///< of these, with an impulse
  double deepest_overlap = 0;  ///< at the beginning of the step
  int passes = 0;
  double residual = 0;  ///< change of a relative velocity in the last iteration
  bool searched = false;
  double search_seconds = 0;  ///< wall time
  /// Reactions of the supports of prescribed components of motion.
  double support_work_before = 0;
  double support_work_after = 0;
  Vector3d support_impulse{};
  Vector3d support_moment{};  ///< about the origin
  Vector3d wall_impulse{};    ///< of walls on nodes
  Vector3d wall_moment{};     ///< about the origin
  double wall_work = 0;       ///< of moving walls on nodes

  double normal_work() const { return 0.5 * (normal_work_before + normal_work_after); }
  double friction_work() const { return 0.5 * (friction_work_before + friction_work_after); }

  /// Saved and restored (src/base/state_archive.hpp).
  template <class Archive>
  void serialize(Archive& archive) {
    archive(normal_work_before, normal_work_after, friction_work_before, friction_work_after, contacts,
            active, deepest_overlap, passes, residual, searched, support_work_before, support_work_after,
            support_impulse, support_moment, wall_impulse, wall_moment, wall_work);
  }
};

/// Sums and extremes over all steps.
struct ContactTotals {
  double normal_work = 0;          ///< net
  double normal_work_added = 0;    ///< sum of the positive steps
  double largest_normal_work = 0;  ///< largest net sum so far: energy added by contact
  double friction_work = 0;        ///< not positive, except for rounding and supports
  double deepest_overlap = 0;
  std::uint64_t steps = 0;
  std::uint64_t contacts = 0;  ///< sum over the steps, as are passes
  std::uint64_t passes = 0;
  int most_contacts = 0;
  int unused = 0;  // no byte of a saved state is left undefined
};

struct ContactScene {
  // Compiled once: they are a third of the code of a source that takes them.
  ContactScene();
  ContactScene(const ContactScene&);
  ContactScene(ContactScene&&) noexcept;
  ContactScene& operator=(const ContactScene&);
  ContactScene& operator=(ContactScene&&) noexcept;
  ~ContactScene();

  ContactOptions options;
  Surface surface;
  Lists excluded;
  std::optional<ContactErosion> erosion;  ///< of scenes whose elements may be deleted

  SurfaceFeatures features;
  FeatureMotion motion;
  FeaturePairs pairs;
  Proximity proximity;
  CrossingGuard guard;
  std::vector<Contact> contacts;  ///< of the last step, by Contact::slave
  std::vector<Contact> last;      ///< of the step before, while one is resolved
  double last_dt = 0;
  double longest_dt = 0;  ///< of all steps so far

  ContactRows rows;  ///< of this step
  std::vector<std::size_t> row_of_contact;
  /// Constraints of this step beyond those that were found ahead: chains by first node.
  struct {
    std::vector<int> last_of_node;  ///< in `contacts`, by slave node; -1: none
    std::vector<int> before;        ///< the one before in its chain, of each
  } added;
  NodesAtWalls walls;
  ImpulseSolver solver;
  std::vector<Vector3d> zone_impulse;  ///< of each slave node, in this step; empty: no zone
  std::vector<int> zone_of;            ///< of each slave node and body
  std::uint64_t steps_with_hits = 0, rounds = 0, zones = 0;
  /// Steps that ended with an unresolved crossing, and the first such pair.
  struct Unresolved {
    std::uint64_t steps = 0;
    std::array<int, 2> node{-1, -1};  ///< global, of either side
    double time = -1;                 ///< kept by the caller
  } unresolved;

  LoadedNodes loaded;
  SlaveSet in_contact;                   ///< nodes moved by rows in this step
  std::vector<Vector3d> velocity;        ///< of each slave node; up to date for those in contact
  SlaveSet pushed;                       ///< nodes with an impulse in the last step
  std::vector<Vector3d> normal_impulse;  ///< of each slave node, in the last step
  std::vector<Vector3d> friction_impulse;

  ContactStep step;
  ContactTotals totals;
  std::optional<ImpulseLog> log;  ///< if the caller asks for it

  /// Saved and restored (src/base/state_archive.hpp); the surface only where it can change.
  template <class Archive>
  void serialize(Archive& archive) {
    if (erosion) archive(surface, excluded, *erosion, features);
    archive(motion, pairs, proximity, guard, contacts, last_dt, longest_dt, walls, steps_with_hits, rounds,
            zones, unresolved, loaded, in_contact, velocity, pushed, normal_impulse, friction_impulse, step,
            totals);
  }
};

/// \throws std::invalid_argument for elements without surface.
ContactScene make_contact_scene(const ContactOptions& options, std::span<const SurfacePart> parts,
                                const Nodes& nodes);

/// Correct the predicted velocities of all surface nodes so that no surfaces cross in this time step.
/// \param bodies rigid bodies, by the numbers that the parts of the surface name. Their nodes carry the
/// velocities of their bodies on entry; on return the bodies are corrected, and their nodes are left to the
/// caller
/// \param ties tied nodes, passed to `exclude_tied_pairs` before; they move with their faces on entry and on
/// return \param walls as they are at the start of the step, always the same ones
void resolve(ContactScene& scene, Nodes& nodes, double dt, ThreadTeam& team,
             std::span<RigidMotion> bodies = {}, const Ties& ties = {},
             std::span<const ContactWall> walls = {});

/// Exclude contact between tied nodes and their main surface. \param part_of_surface of each part of the
/// ties: its number in the surface, or -1
void exclude_tied_pairs(ContactScene& scene, const Ties& ties, const std::vector<int>& part_of_surface);
/// Allow contact of released nodes from the next call of `resolve` on.
void release_tied_pairs(ContactScene& scene, const Ties& ties);

}  // namespace brio
