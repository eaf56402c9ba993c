#pragma once
/// When output is due.

#include <algorithm>
#include <cmath>
#include <vector>

namespace brio {

/// Due at the start, then at every multiple of an interval or at given times; the end is the caller's.
class OutputSchedule {
 public:
  static OutputSchedule every(double interval) { return OutputSchedule(interval, {}); }
  static OutputSchedule at(std::vector<double> times) {
    std::sort(times.begin(), times.end());
    return OutputSchedule(0, std::move(times));
  }

  /// True at the first step whose time has come; then waits for the next.
  bool due(double time) {
    const double slack = 1e-9 * interval_;
    if (time + slack < next_) return false;
    if (interval_ > 0) {
      next_ = interval_ * (std::floor((time + slack) / interval_) + 1);
    } else {
      while (index_ < times_.size() && times_[index_] <= time) ++index_;
      next_ = index_ < times_.size() ? times_[index_] : HUGE_VAL;
    }
    return true;
  }

 private:
  OutputSchedule(double interval, std::vector<double> times)
      : interval_(interval), times_(std::move(times)) {}

  double interval_;
  std::vector<double> times_;
  std::size_t index_ = 0;
  double next_ = 0;
};

}  // namespace brio
