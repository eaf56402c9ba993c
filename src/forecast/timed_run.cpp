#include "src/forecast/timed_run.hpp"

#include <algorithm>
#include <chrono>
#include <ctime>
#include <utility>

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

double TimedRun::seconds() const {
  double sum = 0;
  for (const TimedStep& step : steps) sum += step.seconds;
  return sum;
}

double TimedRun::waiting() const {
  const double own = seconds();
  return own > 0 ? std::max(1.0, wall_seconds / own) : 1;
}

void continue_run(TimedRun& timed, Model& model, double energy_error_limit, double budget_s,
                  ThreadTeam& team) {
  const double end = model.control.settings.end;
  const double start = wall_now();
  const double begin = work_clock(team.size());
  double last = begin;
  TimedStep step{model.times.time, model.times.next, 0, 0};
  const auto note = [&](double now) {
    step.seconds = now - last;
    step.deleted = model.erosion ? model.erosion->total_deleted() : 0;
    timed.steps.push_back(step);
    last = now;
  };
  bool is_entry = true;
  const auto observe = [&](Model& now) {
    const double time = work_clock(team.size());
    if (!is_entry) note(time);
    step = {now.times.time, now.times.next, 0, 0};
    return std::exchange(is_entry, false) || time - begin < budget_s;  // at least one step
  };
  try {
    run(model, energy_error_limit, team, observe);
    timed.reached_end = model.times.time >= end;
  } catch (const Breakdown& breakdown) {
    timed.breakdown = breakdown.what();
    note(work_clock(team.size()));
  }
  timed.time = model.times.time;
  timed.wall_seconds += wall_now() - start;
}

double seconds_per_step(const TimedRun& run, double from_time) {
  constexpr std::size_t warm_up = 10;
  double sum = 0;
  std::size_t count = 0;
  for (std::size_t i = run.steps.size() > 2 * warm_up ? warm_up : 0; i < run.steps.size(); ++i) {
    if (run.steps[i].time < from_time) continue;
    sum += run.steps[i].seconds;
    ++count;
  }
  return count > 0 ? sum / static_cast<double>(count) : 0;
}

}  // namespace brio
