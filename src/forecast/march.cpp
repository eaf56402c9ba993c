#include "src/forecast/march.hpp"

#include <algorithm>
#include <chrono>
#include <ctime>

#include "src/step/advance.hpp"

namespace brio {

namespace {

double wall_now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace

double work_clock(int threads) {
  return threads == 1 ? static_cast<double>(std::clock()) / CLOCKS_PER_SEC : wall_now();
}

double March::seconds() const {
  double sum = 0;
  for (const MarchedStep& step : steps) sum += step.seconds;
  return sum;
}

double March::waiting() const {
  const double own = seconds();
  return own > 0 ? std::max(1.0, wall_seconds / own) : 1;
}

void march(March& march, Model& model, double energy_error_limit, double budget_s, ThreadTeam& team) {
  const double end = model.control.settings.end;
  const double start = wall_now();
  const double begin = work_clock(team.size());
  double last = begin;
  march.time = model.times.time;
  march.reached_end = march.time >= end;
  bool goes_on = true;  // at least one step
  while (goes_on && !march.reached_end && march.breakdown.empty()) {
    const double size = model.times.next;
    update_positions(model, team);
    try {
      update_velocities(model, energy_error_limit, team);
    } catch (const Breakdown& breakdown) {
      march.breakdown = breakdown.what();
    }
    const double time = work_clock(team.size());
    const std::int64_t deleted = model.erosion ? model.erosion->total_deleted() : 0;
    march.steps.push_back({march.time, size, time - last, deleted});
    last = time;
    march.time = model.times.time;
    march.reached_end = march.breakdown.empty() && march.time >= end;
    goes_on = time - begin < budget_s;
  }
  march.wall_seconds += wall_now() - start;
}

double seconds_per_step(const March& march, double from_time) {
  constexpr std::size_t warm_up = 10;
  double sum = 0;
  std::size_t count = 0;
  for (std::size_t i = march.steps.size() > 2 * warm_up ? warm_up : 0; i < march.steps.size(); ++i) {
    if (march.steps[i].time < from_time) continue;
    sum += march.steps[i].seconds;
    ++count;
  }
  return count > 0 ? sum / static_cast<double>(count) : 0;
}

}  // namespace brio
