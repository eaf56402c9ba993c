#pragma once
/// Lanes of a pack whose elements are to be deleted, and the energy of their last step.
///
/// An element is deleted in the step in which a criterion holds, before its forces act. Its energy is
/// integrated by the trapezoidal rule: one half of the increment belongs to the forces at the start of the
/// step, which acted, and one half to those at its end, which do not. That half, f . v dt/2, is subtracted.
/// The energy of the element then equals the work of its forces, and energy is balanced as exactly as without
/// deletion.

#include <cmath>

#include "elements/base/motion.hpp"
#include "elements/block.hpp"
#include "elements/deletion.hpp"
#include "elements/solid/mean_gradient.hpp"
#include "materials/failing.hpp"
#include "src/base/gather.hpp"
#include "src/base/index.hpp"

namespace brio {

/// Mean over the points of an element of what `value` gives for each.
template <class T, class Point, class Value>
BRIO_INLINE T mean_over_points(int points, const Point* point, const Value& value) {
  T sum(0.0);
  for (int p = 0; p < points; ++p) sum += value(point[p].history);
  return sum * (1.0 / points);
}

/// Smallest over the corners of a hexahedron of the triple product of the edges that leave it; zero, not
/// less, at an edge that has no length because its nodes are one.
template <class T>
BRIO_INLINE T smallest_corner(const T (&position)[3][8]) {
  constexpr int along[8][3] = {{1, 3, 4}, {2, 0, 5}, {3, 1, 6}, {0, 2, 7},
                               {7, 5, 0}, {4, 6, 1}, {5, 7, 2}, {6, 4, 3}};
  T smallest(HUGE_VAL);
  for (int corner = 0; corner < 8; ++corner) {
    T e[3][3];
    for (int edge = 0; edge < 3; ++edge)
      for (int i = 0; i < 3; ++i) e[edge][i] = position[i][along[corner][edge]] - position[i][corner];
    const T product = e[0][0] * (e[1][1] * e[2][2] - e[1][2] * e[2][1]) +
                      e[0][1] * (e[1][2] * e[2][0] - e[1][0] * e[2][2]) +
                      e[0][2] * (e[1][0] * e[2][1] - e[1][1] * e[2][0]);
    smallest = where(product < smallest, product, smallest);
  }
  return smallest;
}

/// Lanes whose elements are to be deleted.
template <Floating Real>
struct LostLanes {
  LaneMask<Real> any, by_damage, by_plastic_strain;
};

template <class Kind, class Law, Floating Real, class Header, class Point>
BRIO_INLINE LostLanes<Real> lost_lanes(const Kind& kind, const Law& law, const Deletion& deletion,
                                       const Header& header, const Point* point,
                                       const MotionOf<Kind, Lanes<Real>>& motion, Lanes<Real> stable_step) {
  using T = Lanes<Real>;
  const T zero(0.0);
  const LaneMask<Real> none = T(1.0) < zero;
  LostLanes<Real> lanes{none, none, none};
  LaneMask<Real> lost = deletion.inverted ? stable_step <= zero : stable_step < T(-HUGE_VAL);
  if (deletion.minimum_step) lost = lost | ((stable_step < T(*deletion.minimum_step)) & (stable_step > zero));
  if constexpr (can_fail<Law>) {
    int stations = 1;
    if constexpr (Kind::kernel_traits.stations) stations = kind.stations();
    const int points = kind.points() / stations;
    T failed = zero;
    for (int station = 0; station < stations; ++station)
      failed = max(failed, mean_over_points<T>(points, point + station * points, [&](const auto& history) {
                     return where(law.has_failed(history), 1.0, zero);
                   }));
    constexpr double rounding = 1e-6;
    lanes.by_damage = failed >= T(law.failure->failed_points - rounding);
    lost = lost | lanes.by_damage;
  }
  if constexpr (Law::traits.equivalent_plastic_strain) {
    if (deletion.plastic_strain) {
      const T strain = mean_over_points<T>(
          kind.points(), point, [](const auto& history) { return history.equivalent_plastic_strain; });
      lanes.by_plastic_strain = strain > T(*deletion.plastic_strain);
      lost = lost | lanes.by_plastic_strain;
    }
  }
  if constexpr (Kind::traits.cell == hexahedron_cell) {
    if (deletion.corner_inverted) lost = lost | (smallest_corner(motion.position) < zero);
    if (deletion.volume_ratio) {
      const T volume = mean_gradient(modes(motion.position)).volume;
      const auto shrunk = volume * T(law.density) < T(*deletion.volume_ratio) * header.mass;
      lost = lost | (shrunk & (stable_step > zero));
    }
  }
  lanes.any = lost;
  return lanes;
}

/// Lists the elements of the first `count` lanes that are to be deleted, and counts them by cause.
/// \param first_of_chunk place of the chunk's first element \param first_of_pack of the pack's
template <Floating Real>
void list_lost(const LostLanes<Real>& lost, int count, std::size_t first_of_chunk, std::size_t first_of_pack,
               Block& block, SweepResult& result) {
  for (int lane = 0; lane < count; ++lane) {
    if (lost.any.v[lane] == 0) continue;
    block.lost[first_of_chunk + result.lost++] = static_cast<int>(first_of_pack) + lane;
    DeletionCause cause = DeletionCause::distortion;
    if (lost.by_plastic_strain.v[lane] != 0) cause = DeletionCause::plastic_strain;
    if (lost.by_damage.v[lane] != 0) cause = DeletionCause::damage;
    ++result.lost_by[index(cause)];
  }
}

/// Adds to the energies that the elements of a pack have received: `held` has internal energies of all
/// lanes, then hourglass energies.
template <Floating Real>
BRIO_INLINE void hold(const Increment<Lanes<Real>>& increment, double* held) {
  constexpr int groups = lane_count<Real> / 8;
  Row8 energy[2 * groups];
  widen(increment.internal_energy, energy);
  widen(increment.hourglass_energy, energy + groups);
  for (int group = 0; group < 2 * groups; ++group) {
    Row8 sum;
    double* place = static_cast<double*>(__builtin_assume_aligned(held + 8 * group, 64));
    __builtin_memcpy(&sum, place, sizeof sum);
    sum += energy[group];
    __builtin_memcpy(place, &sum, sizeof sum);
  }
}

}  // namespace brio
