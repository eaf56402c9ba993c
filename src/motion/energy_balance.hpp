#pragma once
/// Energy balance and momentum balance of the whole model.
///
/// At step n each force gives a node the impulse J, by which its velocity changes from v- to v+ (at the half
/// steps n-1/2 and n+1/2). The work J.(v- + v+)/2 of all forces sums exactly to the change of kinetic energy.
/// At the time of step n the first half, J.v-/2, has been done, so that the kinetic energy is m v-.v+/2. This
/// is consistent with the trapezoidal rule of the element energies (Belytschko, Liu, Moran 2000,
/// section 6.2).

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>

#include "src/base/index.hpp"
#include "src/base/tensor.hpp"

namespace brio {

/// Work done by one kind of force.
struct Work {
  double half = 0;    ///< up to the half step before the present step
  double before = 0;  ///< J.v- of the present step
  double after = 0;   ///< J.v+ of the present step

  double at_step() const { return half + 0.5 * before; }
  void begin_step() {
    half += 0.5 * (before + after);
    before = after = 0;
  }
  Work& operator+=(const Work& other) {
    half += other.half;
    before += other.before;
    after += other.after;
    return *this;
  }
};

/// Linear impulse or momentum, and angular about the origin.
struct Impulse {
  Vector3d linear{};
  Vector3d angular{};

  void add(const Vector3d& position, const Vector3d& impulse) {
    linear += impulse;
    angular += cross(position, impulse);
  }
  Impulse& operator+=(const Impulse& other) {
    linear += other.linear;
    angular += other.angular;
    return *this;
  }
  Impulse& operator*=(double factor) {
    for (std::size_t i = 0; i < 3; ++i) {
      linear[i] *= factor;
      angular[i] *= factor;
    }
    return *this;
  }
};

/// What a stage of a time step adds to the balances of energy and momentum.
struct Contribution {
  double internal = 0;  ///< to the energies of elements
  double hourglass = 0;
  double viscous = 0;
  double deleted = 0;
  Work external{}, contact{}, friction{}, damping{};
  Impulse loads{}, supports{}, walls{};
  Impulse dropped{};         ///< momentum of removed nodes
  double kinetic_start = 0;  ///< of mass that is there from the start
  Impulse start{};           ///< its momentum

  Contribution& operator+=(const Contribution& other) {
    internal += other.internal;
    hourglass += other.hourglass;
    viscous += other.viscous;
    deleted += other.deleted;
    external += other.external;
    contact += other.contact;
    friction += other.friction;
    damping += other.damping;
    loads += other.loads;
    supports += other.supports;
    walls += other.walls;
    dropped += other.dropped;
    kinetic_start += other.kinetic_start;
    start += other.start;
    return *this;
  }
};

struct EnergyBalance {
  double kinetic_start = 0;
  double kinetic_half = 0;  ///< m v.v/2 at the last half step
  double kinetic = 0;       ///< at the time of the step
  double internal = 0;      ///< elastic and plastic
  double hourglass = 0;
  double viscous = 0;  ///< of bulk and hourglass viscosity
  double deleted = 0;  ///< energy of deleted elements, and kinetic energy of removed nodes
  Work external;       ///< loads, supports, moving walls
  Work contact;        ///< normal impulses of contact and walls; negative: dissipated
  Work friction;
  Work damping;                  ///< mass-proportional damping; negative: dissipated
  double reference = 0;          ///< largest sum of energies so far, at least that of rounding errors
  double contact_added_max = 0;  ///< largest work of contact so far; near 0 if contact adds no energy
  double error_max = 0;

  /// Dissipated by viscosity and by damping.
  double all_viscous() const { return viscous - damping.at_step(); }
  double sum() const {
    return kinetic + internal + hourglass + all_viscous() + deleted - contact.at_step() - friction.at_step();
  }
  /// (Energy now - energy at the start - external work) / reference.
  double relative_error() const {
    return reference > 0 ? (sum() - kinetic_start - external.at_step()) / reference : 0;
  }

  void begin_step() {
    for (Work* work : {&external, &contact, &friction, &damping}) work->begin_step();
  }
  EnergyBalance& operator+=(const Contribution& stage) {
    kinetic_start += stage.kinetic_start;
    internal += stage.internal;
    hourglass += stage.hourglass;
    viscous += stage.viscous;
    deleted += stage.deleted;
    external += stage.external;
    contact += stage.contact;
    friction += stage.friction;
    damping += stage.damping;
    return *this;
  }
  /// All contributions of the step are in: keeps the largest values so far.
  void end_step() {
    reference = std::max({reference, kinetic_start, std::abs(sum()), internal});
    contact_added_max = std::max(contact_added_max, contact.at_step());
    error_max = std::max(error_max, std::abs(relative_error()));
  }
};

/// Energies of a part with its deleted elements, and the largest ratio so far of its hourglass energy to its
/// largest internal energy up to then (of a body that springs back little internal energy remains).
struct PartEnergy {
  double internal = 0;
  double hourglass = 0;
  double largest_internal = 0;
  double largest_ratio = 0;
  double time_of_largest = 0;
  double time_of_warning = -1;  ///< when the ratio passed the limit first; negative: never

  /// The ratio is at most 1000. \param least hourglass energies below it are ignored
  void note_ratio(double time, double least, double limit) {
    largest_internal = std::max(largest_internal, internal);
    if (!(hourglass > least)) return;
    const double ratio = hourglass / std::max(largest_internal, 1e-3 * hourglass);
    if (ratio > limit && time_of_warning < 0) time_of_warning = time;
    if (ratio <= largest_ratio) return;
    largest_ratio = ratio;
    time_of_largest = time;
  }
};

/// Index of the part with the largest ratio; the first where all are equal.
inline std::size_t part_of_largest_ratio(std::span<const PartEnergy> parts) {
  const auto largest = std::max_element(parts.begin(), parts.end(), [](const auto& a, const auto& b) {
    return a.largest_ratio < b.largest_ratio;
  });
  return index(largest - parts.begin());
}

struct MomentumBalance {
  Impulse start, now;  ///< at the last half step, with positions of the step that follows it
  Impulse loads, supports, walls;
  Impulse dropped;          ///< momentum of removed nodes
  double linear_scale = 0;  ///< largest sum of |m v| so far: reference of the imbalance
  double angular_scale = 0;

  MomentumBalance& operator+=(const Contribution& stage) {
    start += stage.start;
    loads += stage.loads;
    supports += stage.supports;
    walls += stage.walls;
    dropped += stage.dropped;
    return *this;
  }

  /// Largest component of (momentum now + dropped - start - impulses from outside) / scale.
  double linear_imbalance() const { return imbalance(&Impulse::linear, linear_scale); }
  double angular_imbalance() const { return imbalance(&Impulse::angular, angular_scale); }

 private:
  double imbalance(Vector3d Impulse::*kind, double scale) const {
    double largest = 0;
    for (std::size_t i = 0; i < 3; ++i)
      largest = std::max(largest, std::abs((now.*kind)[i] - (start.*kind)[i] - (loads.*kind)[i] -
                                           (supports.*kind)[i] - (walls.*kind)[i] + (dropped.*kind)[i]));
    return scale > 0 ? largest / scale : largest;
  }
};

}  // namespace brio
