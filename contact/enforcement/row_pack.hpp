#pragma once
/// Rows of translations and rotations, eight in lanes. The iteration of a row is written once, on a
/// number-like `T`.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "contact/enforcement/constraint_row.hpp"
#include "src/base/gather.hpp"
#include "src/base/lanes.hpp"

namespace brio {

/// Impulses in the frame of a row: along the normal and, with friction, along both tangents.
template <class T, bool with_friction>
struct RowUnknowns {
  static constexpr int axes = with_friction ? 3 : 1;
  T impulse[axes];
  T last[axes];    ///< an iteration before
  T offset[axes];  ///< relative velocity of the blocks that is asked for
  T change;        ///< squared, of the relative velocity in the last iteration
  T majorant;      ///< D; 0: nothing can move
  T step;          ///< 1 / D, or 0
  T friction_coefficient;
};

/// Over rows; see impulse_solver.hpp.
template <class T>
struct RowSums {
  T turned = 0.0;    ///< D (y - impulse) . (impulse - last): positive where the momentum leads uphill
  T counted = 0.0;   ///< rows that changed by more than is counted
  T residual = 0.0;  ///< largest squared change of a relative velocity
  T largest = 0.0;   ///< velocity that an impulse stands for
};

/// One projected gradient step from the extrapolated impulses, whose relative velocity is given.
/// \param least squared change of a relative velocity that is counted.
template <class T, bool with_friction>
BRIO_INLINE void change_impulse(RowUnknowns<T, with_friction>& row,
                                const T (&velocity)[RowUnknowns<T, with_friction>::axes], T momentum, T least,
                                RowSums<T>& sums) {
  constexpr int axes = RowUnknowns<T, with_friction>::axes;
  T from[axes];
  T wanted[axes];
#pragma GCC unroll 3
  for (int axis = 0; axis < axes; ++axis) {
    from[axis] = row.impulse[axis] + momentum * (row.impulse[axis] - row.last[axis]);
    wanted[axis] = from[axis] - row.step * (velocity[axis] - row.offset[axis]);
    row.last[axis] = row.impulse[axis];
  }
  row.impulse[0] = max(wanted[0], 0.0);
  if constexpr (with_friction) {
    const T limit = row.friction_coefficient * row.impulse[0];
    const T size = sqrt(wanted[1] * wanted[1] + wanted[2] * wanted[2]);
    const auto slides = size > limit;
    const T scale = where(slides, limit / where(slides, size, 1.0), 1.0);
    row.impulse[1] = scale * wanted[1];
    row.impulse[2] = scale * wanted[2];
  }
  T change(0.0);
  T turned(0.0);
#pragma GCC unroll 3
  for (int axis = 0; axis < axes; ++axis) {
    change += square(row.impulse[axis] - from[axis]);
    turned += (from[axis] - row.impulse[axis]) * (row.impulse[axis] - row.last[axis]);
  }
  sums.turned += row.majorant * turned;
  row.change = square(row.majorant) * change;
  sums.counted += where(least < row.change, T(1.0), 0.0);
  sums.residual = max(sums.residual, row.change);
  sums.largest = max(sums.largest, row.majorant * row.impulse[0]);
}

/// Impulse of a row as blocks need it: two rows of four, of which a block without tilt reads the first.
struct alignas(64) RowImpulse {
  double force[3];
  double slope_0;  ///< components of the force along the tangents
  double normal[3];
  double slope_1;
};

/// Entries of eight rows side by side, one of each row. A row without one reads some block of its island with
/// weight 0.
struct TranslationLanes {
  Lanes<double> weight;
  int block[lane_count<double>];
};
struct TiltLanes {
  Lanes<double> along[2];  ///< tangents
};
struct RotationLanes {
  Lanes<double> arm[3];
  int block[lane_count<double>];
};

/// Of all packs, pack after pack: as many as the row of a pack that has most.
struct PackEntries {
  std::vector<TranslationLanes> translation;
  std::vector<TiltLanes> tilt;  ///< beside the translations, of packs that tilt
  std::vector<RotationLanes> rotation;
};

/// Eight rows. Lanes without a row have weights, step and impulses of 0.
template <bool with_friction>
struct RowPack {
  using Number = Lanes<double>;

  RowUnknowns<Number, with_friction> unknown;
  Number frame[with_friction ? 9 : 3];  ///< normal, tangents
  EntryRange translation, tilt, rotation;
};

template <bool with_friction>
BRIO_INLINE void store_impulses(const RowPack<with_friction>& pack, RowImpulse* given) {
  using Number = Lanes<double>;
  const Number* n = pack.frame;
  const Number* j = pack.unknown.impulse;
  Number force[3];
#pragma GCC unroll 3
  for (int axis = 0; axis < 3; ++axis) {
    force[axis] = j[0] * n[axis];
    if constexpr (with_friction) force[axis] += j[1] * n[3 + axis] + j[2] * n[6 + axis];
  }
  Row4 rows[8];
  transpose_lanes(force[0].v, force[1].v, force[2].v, Row8{}, rows);
#pragma GCC unroll 8
  for (int lane = 0; lane < 8; ++lane) store_row(given[lane].force, rows[lane]);
  if constexpr (with_friction) {
    if (pack.tilt.size() == 0) return;
    for (int lane = 0; lane < 8; ++lane) {
      given[lane].slope_0 = j[1][lane];
      given[lane].slope_1 = j[2][lane];
    }
  }
}

/// Relative velocities of the rows of the pack along their axes.
/// \param velocity of each block: rows of four on 32 bytes.
template <bool with_friction>
BRIO_INLINE void velocities_of(const RowPack<with_friction>& pack, const PackEntries& entries,
                               const double* velocity, Lanes<double> (&in_frame)[with_friction ? 3 : 1]) {
  using Number = Lanes<double>;
  const Number* n = pack.frame;
  Number u[3]{0.0, 0.0, 0.0};
  Number tilted[2]{0.0, 0.0};
  const auto tilt_with = [&](std::uint32_t k, const Number(&v)[3]) {
    const TiltLanes& tilt = entries.tilt[pack.tilt.begin + k];
    const Number along = n[0] * v[0] + n[1] * v[1] + n[2] * v[2];
    tilted[0] += tilt.along[0] * along;
    tilted[1] += tilt.along[1] * along;
  };
  for (std::uint32_t k = 0; k < pack.translation.size(); ++k) {
    const TranslationLanes& entry = entries.translation[pack.translation.begin + k];
    const WideVector<double> wide = gather_rows<double>(velocity, 4, entry.block);
    const Number v[3]{Number(wide.x[0]), Number(wide.y[0]), Number(wide.z[0])};
#pragma GCC unroll 3
    for (int axis = 0; axis < 3; ++axis) u[axis] += entry.weight * v[axis];
    if constexpr (with_friction)
      if (k < pack.tilt.size()) tilt_with(k, v);
  }
  for (std::uint32_t k = pack.rotation.begin; k < pack.rotation.end; ++k) {
    const RotationLanes& entry = entries.rotation[k];
    const WideVector<double> wide = gather_rows<double>(velocity, 4, entry.block);
    const Number w[3]{Number(wide.x[0]), Number(wide.y[0]), Number(wide.z[0])};
    u[0] += w[1] * entry.arm[2] - w[2] * entry.arm[1];
    u[1] += w[2] * entry.arm[0] - w[0] * entry.arm[2];
    u[2] += w[0] * entry.arm[1] - w[1] * entry.arm[0];
  }
#pragma GCC unroll 3
  for (int axis = 0; axis < (with_friction ? 3 : 1); ++axis) {
    in_frame[axis] = n[3 * axis] * u[0] + n[3 * axis + 1] * u[1] + n[3 * axis + 2] * u[2];
    if (axis > 0) in_frame[axis] += tilted[axis - 1];
  }
}

/// \param velocity of each block, at the extrapolated impulses.
/// \param given of the rows of the pack: gets their new impulses.
template <bool with_friction>
BRIO_INLINE void change_impulses(RowPack<with_friction>& pack, const PackEntries& entries,
                                 const double* velocity, double momentum, double least,
                                 RowSums<Lanes<double>>& sums, RowImpulse* given) {
  Lanes<double> in_frame[with_friction ? 3 : 1];
  velocities_of(pack, entries, velocity, in_frame);
  change_impulse(pack.unknown, in_frame, Lanes<double>(momentum), Lanes<double>(least), sums);
  store_impulses(pack, given);
}

/// Work of the impulses at these velocities, over what is asked for.
template <class T, bool with_friction>
BRIO_INLINE T work_of(const RowUnknowns<T, with_friction>& row,
                      const T (&velocity)[RowUnknowns<T, with_friction>::axes]) {
  T work(0.0);
  for (int axis = 0; axis < RowUnknowns<T, with_friction>::axes; ++axis)
    work += row.impulse[axis] * (velocity[axis] - row.offset[axis]);
  return work;
}
template <bool with_friction>
BRIO_INLINE double work_of(const RowPack<with_friction>& pack, const PackEntries& entries,
                           const double* velocity) {
  Lanes<double> in_frame[with_friction ? 3 : 1];
  velocities_of(pack, entries, velocity, in_frame);
  const Lanes<double> work = work_of(pack.unknown, in_frame);
  double sum = 0;
  for (int lane = 0; lane < lane_count<double>; ++lane) sum += work[lane];
  return sum;
}

}  // namespace brio
