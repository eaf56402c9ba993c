#pragma once
/// The books: energies, momenta and impulses.
///
/// Every force acts at step n by an impulse J on a node whose velocity goes from v- to v+ (half steps n-1/2
/// and n+1/2). Its work J.(v- + v+)/2 sums to the change of kinetic energy exactly; at the time of step n
/// itself the first half, J.v-/2, is done. Kinetic energy at n then is m v-.v+/2, and what is lent and what
/// is kept agree with the trapezoid rule that elements use (Belytschko, Liu, Moran 2000, section 6.2).

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>

namespace brio {

using Vector = std::array<double, 3>;

inline Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
inline double dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
inline void add_to(Vector& sum, const Vector& a) {
  for (std::size_t i = 0; i < 3; ++i) sum[i] += a[i];
}

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
};

struct EnergyBook {
  double kinetic_start = 0;
  double kinetic_half = 0;  ///< m v.v/2 at the last half step
  double kinetic = 0;       ///< at the time of the step
  double internal = 0;      ///< elastic and plastic
  double hourglass = 0;
  double viscous = 0;
  double deleted = 0;  ///< what deleted elements had received, and motion of nodes that were dropped
  Work external;       ///< loads, supports, moving walls
  Work contact;        ///< normal impulses of contact and walls; negative: taken out of motion
  Work friction;
  double reference = 0;          ///< largest sum of energies so far, or what rounding makes if that is more
  double contact_added_max = 0;  ///< largest work of contact so far; what a faithful contact keeps near 0
  double error_max = 0;

  double sum() const {
    return kinetic + internal + hourglass + viscous + deleted - contact.at_step() - friction.at_step();
  }
  /// What there is, less what there was and what was put in, over the largest sum so far.
  double relative_error() const {
    return reference > 0 ? (sum() - kinetic_start - external.at_step()) / reference : 0;
  }
};

/// What a part has received, with its deleted elements, and the largest ratio of its hourglass energy to its
/// internal energy so far. That is the largest internal energy up to then: of a body that springs back,
/// little is left.
struct PartEnergy {
  double internal = 0;
  double hourglass = 0;
  double largest_internal = 0;
  double largest_ratio = 0;
  double time_of_largest = 0;
  double time_of_warning = -1;  ///< when the ratio passed the limit first; negative: never

  /// At most 1000. \param least energy that matters
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

/// Which part has had the largest ratio; the first where all are equal.
inline std::size_t part_of_largest_ratio(std::span<const PartEnergy> parts) {
  const auto largest = std::max_element(parts.begin(), parts.end(), [](const auto& a, const auto& b) {
    return a.largest_ratio < b.largest_ratio;
  });
  return static_cast<std::size_t>(largest - parts.begin());
}

/// Momentum of the system and what it received from outside, with moments about the origin.
struct Impulse {
  Vector linear{};
  Vector angular{};

  void add(const Vector& position, const Vector& impulse) {
    add_to(linear, impulse);
    add_to(angular, cross(position, impulse));
  }
  void add(const Impulse& other) {
    add_to(linear, other.linear);
    add_to(angular, other.angular);
  }
};

struct MomentumBook {
  Impulse start, now;  ///< at the last half step, with positions of the step that follows it
  Impulse loads, supports, walls;
  Impulse dropped;          ///< what left with nodes
  double linear_scale = 0;  ///< largest sum of |m v| so far: what an imbalance is measured against
  double angular_scale = 0;

  /// Largest component of now + dropped - start - received, over the scale.
  double linear_imbalance() const { return imbalance(&Impulse::linear, linear_scale); }
  double angular_imbalance() const { return imbalance(&Impulse::angular, angular_scale); }

 private:
  double imbalance(Vector Impulse::*kind, double scale) const {
    double largest = 0;
    for (std::size_t i = 0; i < 3; ++i)
      largest = std::max(largest, std::abs((now.*kind)[i] - (start.*kind)[i] - (loads.*kind)[i] -
                                           (supports.*kind)[i] - (walls.*kind)[i] + (dropped.*kind)[i]));
    return scale > 0 ? largest / scale : largest;
  }
};

}  // namespace brio
