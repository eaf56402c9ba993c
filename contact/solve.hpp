#pragma once
/// Enforcement by sequential impulses (projected Gauss-Seidel on velocities, with accumulated impulses
/// clamped; Moreau 1988, Jean 1999, Catto 2005). Each contact requires of the velocities at the end of the
/// step that
///     gap + dt normal . (v_node - sum w v_corner) >= 0,      impulse >= 0,
/// and where it began with an overlap, that a little of that be removed. Friction keeps the tangential
/// impulse within the disk of radius friction coefficient times the normal impulse (Coulomb), sticking where
/// it can. Impulses on the node and on the corners are equal and opposite and act along the line through both
/// at the beginning of the step, so linear and angular momentum are kept to rounding.
///
/// Sweeps are few and start from the impulses of the last step, so impulses lag behind what they should be. A
/// number of sweeps backwards and as many forwards change impulses by a symmetric matrix times what is
/// missing: then the lag only takes energy from bodies that rest on each other. With forward sweeps alone the
/// matrix is not symmetric, and they shake themselves.

#include <span>
#include <vector>

#include "contact/options.hpp"
#include "contact/pair.hpp"

namespace brio {

/// Motion of one slave node as the solver sees it.
struct alignas(64) ContactMotion {
  double velocity[3];
  double inverse_mass[3];  ///< per axis; 0 where the motion is prescribed
};

/// The inverse mass of a contact in its normal and in two tangential directions.
struct ContactFrame {
  Eigen::Vector3d tangent[2];
  double normal_mass;  ///< effective mass; 0 where nothing can move
  double tangent_mass[2];
  double target;  ///< least normal relative velocity
};

struct Solver {
  std::vector<ContactFrame> frame;
  /// Overlaps of this share of the smallest edge and more are opened by the full share of the options.
  double deep_share = 0.1;
  int passes_done = 0;  ///< in the last solve
  double residual = 0;  ///< largest change of a relative velocity in the last pass of the last solve
};

/// Start from the impulses of the last step, carried over to contacts of the same node and body that push
/// about the same way, scaled by the ratio of the steps.
void warm_start(std::span<const Contact> last, double step_ratio, std::span<Contact> contacts);

/// Solve for the impulses of the contacts and change the velocities in `motion` (by slave node) accordingly.
/// \param smallest_edge scale of tolerances and of overlap recovery.
void solve(Solver& solver, const ContactOptions& options, double smallest_edge, double dt,
           std::span<Contact> contacts, std::span<ContactMotion> motion);

struct MixedMotion;
/// The same where rigid bodies take part.
void solve(Solver& solver, const ContactOptions& options, double smallest_edge, double dt,
           std::span<Contact> contacts, const MixedMotion& motion);

struct HeldMotion;
/// The same where held nodes take part.
void solve(Solver& solver, const ContactOptions& options, double smallest_edge, double dt,
           std::span<Contact> contacts, const HeldMotion& motion);

}  // namespace brio
