#pragma once
/// Yield stress against equivalent plastic strain as a table, or one table a strain rate.

#include <array>
#include <cstddef>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "src/base/fields.hpp"

namespace brio {

/// The yield stress beyond the last row.
enum class BeyondTable {
  constant,   ///< that of the last row (Abaqus)
  last_slope  ///< continued along the last two rows (LS-DYNA)
};
constexpr std::array<NamedValue<BeyondTable>, 2> named_values(BeyondTable) {
  return {{{"constant", BeyondTable::constant}, {"last_slope", BeyondTable::last_slope}}};
}

/// Rows of (equivalent plastic strain, yield stress), measured at one strain rate.
struct YieldCurve {
  std::span<const std::array<double, 2>> rows;
  double rate = 0;  ///< 1/time
};

/// All curves on one grid of strains: linear interpolation between the rows of each is kept exactly, since
/// the grid has the strains of all of them.
class YieldTable {
 public:
  /// \pre curves is not empty; strains of each start at 0 and increase, stresses are positive, rates are
  /// positive and increase where there are several.
  YieldTable(std::span<const YieldCurve> curves, BeyondTable beyond);

  std::size_t size() const { return strain_.size(); }
  std::size_t curves() const { return log_rate_.size(); }

  /// Of the grid: [size].
  const double* strain() const { return strain_.data(); }
  /// [curve][strain]
  const double* stress(std::size_t curve) const { return stress_.data() + curve * size(); }
  /// From a strain to the next; from the last on, as the table is continued: [curve][strain].
  const double* slope(std::size_t curve) const { return slope_.data() + curve * size(); }
  /// Natural logarithm of the rate of each curve.
  const double* log_rate() const { return log_rate_.data(); }

  double lowest_stress() const { return lowest_stress_; }
  double steepest_softening() const { return steepest_softening_; }  ///< least slope; 0 where none softens
  bool falls_in_the_end() const;

 private:
  std::vector<double> strain_, stress_, slope_, log_rate_;
  double lowest_stress_ = 0, steepest_softening_ = 0;
};

/// A table as laws hold it, which are copied for every chunk of elements: by reference.
struct SharedYieldTable {
  std::shared_ptr<const YieldTable> table{};

  const YieldTable* operator->() const { return table.get(); }
  const YieldTable& operator*() const { return *table; }
};

/// A table of one curve. \pre as of YieldTable
SharedYieldTable yield_table(std::span<const std::array<double, 2>> rows,
                             BeyondTable beyond = BeyondTable::constant);

}  // namespace brio
