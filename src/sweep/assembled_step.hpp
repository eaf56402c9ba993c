#pragma once
/// Stable time step of the assembled elements, never shorter than the least of elements by themselves.
///
/// A step dt is stable where A = dt^2 K + 2 dt C <= 4 M as quadratic forms (elements/solid/solid.hpp).
///
/// Nodal time step. The least stable time step of any element satisfies this with the mass that every element
/// gives to its nodes. But M is the sum of M_e for any division of the nodal masses among the elements of a
/// node. Divided in proportion to the stiffness k_e = m_e omega_e^2 that an element gives to its nodes,
///
///     omega^2 <= max over nodes of sum_e k_e / m,     likewise of rotational stiffness over inertia,
///
/// the mean over the elements of a node, weighted by mass, in place of the largest of all elements: one that
/// is crushed has the mass of its neighbours beside it. Damping is counted at the last time step r, k_e = m_e
/// (omega_e^2 + 2 damping_e / r), since A(dt) <= (dt/r)^2 A(r) for dt >= r, and dt/r A(r) below.
///
/// Estimate. Neighbours do not vibrate in their highest modes at once: of a block of cubes the highest
/// frequency is 0.73 times that of one (Poisson's ratio 0.3). Where the time step keeps a margin
/// (step_scale), Lanczos' method finds it now and then, and until it does again the growth of the nodal bound
/// is added (Weyl's inequality), where that is above the estimate at all. What is stable is not yet accurate:
/// where an element would be strained by more than 2 % in the longer time step, the nodal one is kept, and so
/// it is in the first hundred steps.

#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "src/sweep/assembled_spectrum.hpp"
#include "src/sweep/step_size.hpp"

namespace brio {

/// Of the nodes of a range.
struct NodalBound {
  double largest = 0;
  double growth = 0;  ///< largest since the estimate, of what is above it
};

/// Squares of frequencies are 1/time^2; with damping they are of stiffnesses that count it at the last time
/// step.
struct AssembledStep {
  double gain = 1;               ///< over the least stable time step of elements, when last looked at
  double frequency_squared = 0;  ///< estimate without damping; 0: none
  double damping = 0;            ///< what damping added at most when it was made
  std::int64_t estimated_at = 0, next_estimate = 100, interval = 0;  ///< steps
  std::vector<double> reference;   ///< stiffness over mass of each node when it was made
  std::vector<NodalBound> bounds;  ///< scratch, one a range of nodes
  LanczosVectors vectors;          ///< empty: no estimates

  /// Saved and restored (src/base/state_archive.hpp).
  template <class Archive>
  void serialize(Archive& archive) {
    archive(gain, frequency_squared, damping, estimated_at, next_estimate, interval, reference);
  }
};

/// With estimates where the time step keeps a margin and all elements that have a bound by themselves can
/// multiply their stiffness. \param is_used whether assembled elements bound the time step at all \param
/// length of the scene
AssembledStep make_assembled_step(const TimeSection& time, bool is_used, std::span<const Block> blocks,
                                  const Nodes& nodes, double length);
/// For a new run of the same scene.
void start_anew(AssembledStep& assembled);

/// What the sweep found of elements whose nodes have a stiffness.
struct ElementBounds {
  double stable_step = HUGE_VAL;   ///< least
  double damping = 0;              ///< largest that damping adds to the square of a frequency
  double strain_rate_squared = 0;  ///< largest
};

/// After the sweep. \param last time step; 0: none yet \param step number of steps
double assembled_stable_step(AssembledStep& assembled, const ElementBounds& elements, double last,
                             std::int64_t step, SweepSchedule& schedule, std::span<Block> blocks,
                             const Nodes& nodes, ThreadTeam& team);

/// Stable time step with a bound that counts damping at the time step `last`; 0: at a shorter one than
/// results.
double stable_step_of(double frequency_squared, double last);

}  // namespace brio
