#include "materials/tabulated/yield_table.hpp"

#include <algorithm>
#include <cmath>

namespace brio {

namespace {

using Rows = std::span<const std::array<double, 2>>;

double slope_between(const std::array<double, 2>& a, const std::array<double, 2>& b) {
  return (b[1] - a[1]) / (b[0] - a[0]);
}

/// Slope from `strain` on.
double slope_at(Rows rows, double strain, BeyondTable beyond) {
  const auto next = std::upper_bound(rows.begin(), rows.end(), strain,
                                     [](double value, const auto& row) { return value < row[0]; });
  if (next != rows.end()) return slope_between(*(next - 1), *next);
  if (beyond == BeyondTable::constant || rows.size() == 1) return 0;
  return slope_between(rows[rows.size() - 2], rows.back());
}

double stress_at(Rows rows, double strain, BeyondTable beyond) {
  const auto next = std::upper_bound(rows.begin(), rows.end(), strain,
                                     [](double value, const auto& row) { return value < row[0]; });
  const std::array<double, 2>& row = *(next - 1);
  return row[1] + slope_at(rows, strain, beyond) * (strain - row[0]);
}

}  // namespace

YieldTable::YieldTable(std::span<const YieldCurve> curves, BeyondTable beyond) {
  for (const YieldCurve& curve : curves)
    for (const auto& row : curve.rows) strain_.push_back(row[0]);
  std::sort(strain_.begin(), strain_.end());
  strain_.erase(std::unique(strain_.begin(), strain_.end()), strain_.end());
  for (const YieldCurve& curve : curves) {
    log_rate_.push_back(curve.rate > 0 ? std::log(curve.rate) : 0);
    for (const double strain : strain_) {
      stress_.push_back(stress_at(curve.rows, strain, beyond));
      slope_.push_back(slope_at(curve.rows, strain, beyond));
    }
  }
  lowest_stress_ = *std::min_element(stress_.begin(), stress_.end());
  steepest_softening_ = std::min(*std::min_element(slope_.begin(), slope_.end()), 0.0);
}

bool YieldTable::falls_in_the_end() const {
  for (std::size_t curve = 0; curve < curves(); ++curve)
    if (slope(curve)[size() - 1] < 0) return true;
  return false;
}

SharedYieldTable yield_table(std::span<const std::array<double, 2>> rows, BeyondTable beyond) {
  const YieldCurve curve{rows};
  return {std::make_shared<const YieldTable>(std::span(&curve, 1), beyond)};
}

}  // namespace brio
