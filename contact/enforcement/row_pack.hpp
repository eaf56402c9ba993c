#pragma once
/// Rows of up to five translations, eight side by side: node on face, face with its tilt, edge on edge,
/// walls. What an iteration does to a row stands here once, on a number-like `T`.

#include <cmath>
#include <cstdint>

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
  T majorant;      ///< D; 0: nothing can move
  T step;          ///< 1 / D, or 0
  T friction_coefficient;
};

/// Over rows; see impulse_solver.hpp.
template <class T>
struct RowSums {
  T turned = 0.0;    ///< D (y - impulse) . (impulse - last): positive where the momentum leads uphill
  T residual = 0.0;  ///< largest squared change of a relative velocity
  T largest = 0.0;   ///< velocity that an impulse stands for
};

/// One projected gradient step from the extrapolated impulses, whose relative velocity is given.
template <class T, bool with_friction>
BRIO_INLINE void change_impulse(RowUnknowns<T, with_friction>& row,
                                const T (&velocity)[RowUnknowns<T, with_friction>::axes], T momentum,
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
  sums.residual = max(sums.residual, square(row.majorant) * change);
  sums.largest = max(sums.largest, row.majorant * row.impulse[0]);
}

/// Impulse of a row as blocks need it: two rows of four, of which a block without tilt reads the first.
struct alignas(64) RowImpulse {
  double force[3];
  double slope_0;  ///< components of the force along the tangents
  double normal[3];
  double slope_1;
};

/// Eight rows. Lanes without a row have weights, step and impulses of 0.
template <bool with_friction, bool with_tilt>
struct RowPack {
  static constexpr int entries = 5;
  using Number = Lanes<double>;
  static constexpr int lanes = lane_count<double>;

  RowUnknowns<Number, with_friction> unknown;
  Number frame[with_friction ? 9 : 3];  ///< normal, tangents
  Number weight[entries];
  Number tilt[with_tilt ? 2 * entries : 1];
  alignas(64) int block[entries][lanes];
};

template <bool with_friction, bool with_tilt>
BRIO_INLINE void store_impulses(const RowPack<with_friction, with_tilt>& pack, RowImpulse* given) {
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
  transpose_lanes(force[0].v, force[1].v, force[2].v, rows);
#pragma GCC unroll 8
  for (int lane = 0; lane < 8; ++lane) store_row(given[lane].force, rows[lane]);
  if constexpr (with_tilt) {
    for (int lane = 0; lane < 8; ++lane) {
      given[lane].slope_0 = j[1][lane];
      given[lane].slope_1 = j[2][lane];
    }
  }
}

/// Relative velocities of the rows of the pack along their axes.
/// \param velocity of each block: rows of four on 32 bytes.
template <bool with_friction, bool with_tilt>
BRIO_INLINE void velocities_of(const RowPack<with_friction, with_tilt>& pack, const double* velocity,
                               Lanes<double> (&in_frame)[with_friction ? 3 : 1]) {
  using Number = Lanes<double>;
  constexpr int entries = RowPack<with_friction, with_tilt>::entries;
  const Number* n = pack.frame;
  Number u[3]{0.0, 0.0, 0.0};
  Number tilted[2]{0.0, 0.0};
#pragma GCC unroll 5
  for (int k = 0; k < entries; ++k) {
    const WideVector<double> wide = gather_rows<double>(velocity, 4, pack.block[k]);
    const Number v[3]{Number(wide.x[0]), Number(wide.y[0]), Number(wide.z[0])};
    for (int axis = 0; axis < 3; ++axis) u[axis] += pack.weight[k] * v[axis];
    if constexpr (with_tilt) {
      const Number along = n[0] * v[0] + n[1] * v[1] + n[2] * v[2];
      tilted[0] += pack.tilt[2 * k] * along;
      tilted[1] += pack.tilt[2 * k + 1] * along;
    }
  }
#pragma GCC unroll 3
  for (int axis = 0; axis < (with_friction ? 3 : 1); ++axis) {
    in_frame[axis] = n[3 * axis] * u[0] + n[3 * axis + 1] * u[1] + n[3 * axis + 2] * u[2];
    if (axis > 0) in_frame[axis] += tilted[axis - 1];
  }
}

/// \param velocity of each block, at the extrapolated impulses.
/// \param given of the rows of the pack: gets their new impulses.
template <bool with_friction, bool with_tilt>
BRIO_INLINE void change_impulses(RowPack<with_friction, with_tilt>& pack, const double* velocity,
                                 double momentum, RowSums<Lanes<double>>& sums, RowImpulse* given) {
  Lanes<double> in_frame[with_friction ? 3 : 1];
  velocities_of(pack, velocity, in_frame);
  change_impulse(pack.unknown, in_frame, Lanes<double>(momentum), sums);
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
template <bool with_friction, bool with_tilt>
BRIO_INLINE double work_of(const RowPack<with_friction, with_tilt>& pack, const double* velocity) {
  Lanes<double> in_frame[with_friction ? 3 : 1];
  velocities_of(pack, velocity, in_frame);
  const Lanes<double> work = work_of(pack.unknown, in_frame);
  double sum = 0;
  for (int lane = 0; lane < lane_count<double>; ++lane) sum += work[lane];
  return sum;
}

}  // namespace brio
