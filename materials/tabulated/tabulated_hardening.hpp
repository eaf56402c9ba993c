#pragma once
/// Hardening by a table (yield_table.hpp): where each lane stands in it, and where a falling line meets it.
///
/// At the strain rate of the step, which is known before the return, the yield stress is a polygon in the
/// plastic strain. A falling line that is steeper than any softening crosses it once, on the piece that
/// begins with the last row below the line: a bisection over the rows and one division, without iteration.

#include <cstddef>
#include <limits>
#include <type_traits>

#include "materials/hardening.hpp"
#include "materials/tabulated/yield_table.hpp"
#include "src/base/index.hpp"

namespace brio {

namespace tabulated {

template <class T>
BRIO_INLINE double lane_of(const T& x, int lane) {
  if constexpr (std::is_floating_point_v<T>) {
    return x;
  } else {
    return static_cast<double>(x[lane]);
  }
}
template <class T>
BRIO_INLINE void set_lane_of(T& x, int lane, double value) {
  if constexpr (std::is_floating_point_v<T>) {
    x = value;
  } else {
    x.set(lane, static_cast<RealOf<T>>(value));
  }
}

/// The last of 0, ..., count - 1 that is before what is sought; 0 if none is. \pre count > 0
template <class IsBefore>
BRIO_INLINE int last_before(std::size_t count, const IsBefore& is_before) {
  std::size_t first = 0;
  while (count > 1) {
    const std::size_t half = count / 2;
    first = is_before(first + half) ? first + half : first;
    count -= half;
  }
  return static_cast<int>(first);
}

}  // namespace tabulated

/// The table in one step: hardening.hpp says what it provides.
template <class T>
struct TabulatedHardening {
  static constexpr HardeningShape shape = HardeningShape::piecewise_straight;
  static constexpr int lanes = NumberTraits<T>::lanes;

  const YieldTable* table;
  T lower, upper{};       ///< factors of the curves of the rates below and above that of the step
  int curve[lanes] = {};  ///< of the rate below

  /// The lowest of all.
  double initial_yield_stress() const { return table->lowest_stress(); }

  BRIO_CALLED HardeningPoint<T> at(T plastic_strain) const {
    const Piece piece = piece_at(plastic_strain);
    return {plastic_strain, piece.stress + piece.slope * (plastic_strain - piece.start), piece.slope};
  }

  BRIO_CALLED HardeningPoint<T> meet(HardeningPoint<T> near, T effective_stress, T stiffness) const {
    const double* strain = table->strain();
    const Piece piece = gather([&](int lane) {
      const double height = tabulated::lane_of(effective_stress, lane);
      const double fall = tabulated::lane_of(stiffness, lane);
      const double from = tabulated::lane_of(near.plastic_strain, lane);
      return tabulated::last_before(table->size(), [&](std::size_t row) {
        return height - fall * (strain[row] - from) > stress_at(row, lane);
      });
    });
    // Of the piece, continued to where the line starts.
    const T before = piece.stress + piece.slope * (near.plastic_strain - piece.start);
    const T end = near.plastic_strain + (effective_stress - before) / (stiffness + piece.slope);
    return {end, piece.stress + piece.slope * (end - piece.start), piece.slope};
  }

  /// Plastic strain up to which the curve is straight from a point on.
  BRIO_CALLED T end_of_piece(const HardeningPoint<T>& point) const {
    return piece_at(point.plastic_strain).end;
  }

  /// Between the curves of the two rates next to that of the step, linearly in the logarithm of the rate; the
  /// curve of the lowest rate below it, of the highest above. \pre table->curves() > 1
  BRIO_CALLED void set_rate(T log_rate) {
    const double* rates = table->log_rate();
    T below, above;
    for (int lane = 0; lane < lanes; ++lane) {
      const double rate = tabulated::lane_of(log_rate, lane);
      curve[lane] =
          tabulated::last_before(table->curves() - 1, [&](std::size_t k) { return rates[k] <= rate; });
      tabulated::set_lane_of(below, lane, rates[curve[lane]]);
      tabulated::set_lane_of(above, lane, rates[curve[lane] + 1]);
    }
    upper = min(max((log_rate - below) / (above - below), 0.0), 1.0);
    lower = 1.0 - upper;
  }

 private:
  struct Piece {
    T start, end;     ///< plastic strains
    T stress, slope;  ///< at the start
  };

  BRIO_INLINE double blend(const double* (YieldTable::*values)(std::size_t) const, std::size_t row,
                           int lane) const {
    const auto first = index(curve[lane]);
    const double value = tabulated::lane_of(lower, lane) * (table->*values)(first)[row];
    if (table->curves() == 1) return value;
    return value + tabulated::lane_of(upper, lane) * (table->*values)(first + 1)[row];
  }
  BRIO_INLINE double stress_at(std::size_t row, int lane) const {
    return blend(&YieldTable::stress, row, lane);
  }

  template <class RowOfLane>
  BRIO_INLINE Piece gather(const RowOfLane& row_of_lane) const {
    const double* strain = table->strain();
    Piece piece;
    for (int lane = 0; lane < lanes; ++lane) {
      const auto row = index(row_of_lane(lane));
      const bool is_last = row + 1 == table->size();
      tabulated::set_lane_of(piece.start, lane, strain[row]);
      tabulated::set_lane_of(piece.end, lane,
                             is_last ? double{std::numeric_limits<RealOf<T>>::max()} : strain[row + 1]);
      tabulated::set_lane_of(piece.stress, lane, stress_at(row, lane));
      tabulated::set_lane_of(piece.slope, lane, blend(&YieldTable::slope, row, lane));
    }
    return piece;
  }
  BRIO_INLINE Piece piece_at(T plastic_strain) const {
    const double* strain = table->strain();
    return gather([&](int lane) {
      const double value = tabulated::lane_of(plastic_strain, lane);
      return tabulated::last_before(table->size(), [&](std::size_t row) { return strain[row] <= value; });
    });
  }
};

/// The curve of the lowest rate: what is asked beside the update of stress.
struct SlowHardening {
  const YieldTable* table;

  double initial_yield_stress() const { return table->lowest_stress(); }
  template <class T>
  BRIO_INLINE HardeningPoint<T> at(T plastic_strain) const {
    return TabulatedHardening<T>{table, T(1.0), T(0.0)}.at(plastic_strain);
  }
};

}  // namespace brio
