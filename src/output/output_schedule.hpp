#pragma once
/// When output is due.

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "src/deck/deck.hpp"

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
      const double passed = std::floor((time + slack) / interval_);
      next_ = std::isfinite(passed) ? interval_ * (passed + 1) : time;  // intervals too short to be counted
    } else {
      while (index_ < times_.size() && times_[index_] <= time) ++index_;
      next_ = index_ < times_.size() ? times_[index_] : HUGE_VAL;
    }
    return true;
  }

  /// The time that is due at a step or before the next, none if none is; then waits for one that is not.
  std::optional<double> due_within(double time, double step) {
    const double end = time + (1 - 1e-9) * step;  // what rounding takes for the next step is due there
    if (!(next_ < end)) return {};
    const double asked = next_;
    if (interval_ > 0) {
      double passed = std::floor(end / interval_);
      if (interval_ * passed >= end) --passed;
      next_ =
          std::isfinite(passed) ? std::max(interval_ * (passed + 1), std::nextafter(asked, HUGE_VAL)) : end;
    } else {
      while (index_ < times_.size() && times_[index_] < end) ++index_;
      next_ = index_ < times_.size() ? times_[index_] : HUGE_VAL;
    }
    return std::max(asked, time);
  }

  /// How often it is due from the start to an end, which is due in any case, by steps that are short.
  double count(double end) const {
    if (interval_ > 0) {
      const double whole = std::floor(end / interval_ + 1e-9);
      return whole + (end - whole * interval_ > 1e-9 * interval_ ? 2 : 1);
    }
    double count = 1, last = 0;
    for (const double time : times_) {
      if (time <= last || time > end) continue;
      ++count;
      last = time;
    }
    return last < end ? count + 1 : count;
  }

 private:
  OutputSchedule(double interval, std::vector<double> times)
      : interval_(interval), times_(std::move(times)) {}

  double interval_;
  std::vector<double> times_;
  std::size_t index_ = 0;
  double next_ = 0;
};

inline OutputSchedule field_schedule(const Deck& deck) {
  const FieldOutput& fields = deck.output.fields_;
  return fields.times.empty() ? OutputSchedule::every(fields.every.value_or(deck.time.end / 20))
                              : OutputSchedule::at(fields.times);
}
inline OutputSchedule history_schedule(const Deck& deck) {
  return OutputSchedule::every(deck.output.history.every.value_or(deck.time.end / 1000));
}

}  // namespace brio
