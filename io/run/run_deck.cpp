#include "io/run/run_deck.hpp"

#include <sys/resource.h>

#include <chrono>
#include <csignal>

#include "io/deck/deck_error.hpp"
#include "io/deck/read_deck.hpp"
#include "io/mesh/generate_mesh.hpp"
#include "io/results/write_results.hpp"
#include "io/run/scene_size.hpp"
#include "src/build/build.hpp"
#include "src/output/observe.hpp"
#include "src/output/output_schedule.hpp"
#include "src/output/run_warnings.hpp"
#include "src/step/advance.hpp"
#include "src/step/diagnosis.hpp"

namespace brio {

namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

double peak_memory_mb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

// Calls back now and then, and foresees the end from the speed of the last stretch.
class ProgressReporter {
 public:
  ProgressReporter(const RunOptions& options, double end) : options_(options), end_(end) {}

  void report(const Model& model, bool now) {
    if (!options_.progress) return;
    const double elapsed = seconds_since(start_);
    if (!now && elapsed - reported_ < 0.1) return;
    const double speed = elapsed > reported_ ? (model.times.time - time_) / (elapsed - reported_) : 0;
    mean_speed_ = mean_speed_ == 0 ? speed : 0.9 * mean_speed_ + 0.1 * speed;
    reported_ = elapsed;
    time_ = model.times.time;
    const std::size_t part = part_of_largest_ratio(model.part_energy);
    const PartEnergy& worst = model.part_energy[part];
    const bool hourglasses = worst.time_of_warning >= 0;
    options_.progress({.time = model.times.time,
                       .end = end_,
                       .step = model.step,
                       .dt = model.times.next,
                       .energy_error = model.energy.relative_error(),
                       .deleted = model.erosion ? model.erosion->total_deleted() : 0,
                       .hourglassing = hourglasses ? model.parts[part].name : "",
                       .hourglass_ratio = worst.largest_ratio,
                       .elapsed_s = elapsed,
                       .remaining_s = mean_speed_ > 0 ? (end_ - model.times.time) / mean_speed_ : 0});
  }

 private:
  const RunOptions& options_;
  double end_;
  Clock::time_point start_ = Clock::now();
  double reported_ = 0;
  double time_ = 0;
  double mean_speed_ = 0;
};

// Fields and history as they fall due; of a run that breaks down the last state that was good.
class Output {
 public:
  Output(const Deck& deck, Model& model, ResultWriter& writer)
      : model_(model),
        writer_(writer),
        observer_(model),
        history_(history_columns(model)),
        field_schedule_(field_schedule(deck)),
        history_schedule_(history_schedule(deck)) {}

  /// Of a state that is good. \throws Breakdown where results cannot hold it
  void write_what_is_due(bool last, ThreadTeam& team) {
    const bool row_due = history_schedule_.due(model_.times.time) || last;
    const bool fields_due = field_schedule_.due(model_.times.time) || last;
    const bool keeps = model_.step >= next_kept_;
    if (!row_due && !fields_due && !keeps) return;
    if (fields_due) audit_contacts(model_, team);
    const StageTimer timer(model_.stages, Stage::output);
    if (fields_due) watch(model_);
    observe_history(model_, row_);
    if (fields_due || keeps) {
      state_ = nullptr;  // the one before is written over
      const Snapshot& state = observer_.observe(model_);
      if (const std::string fault = what_results_cannot_hold(state); !fault.empty())
        throw Breakdown(fault + " at time " + written(model_.times.time) +
                        " is too large for the results or not a number; check units and velocities of the "
                        "deck, else try a smaller time.step_scale");
      state_ = &state;
      good_ = {.energy = model_.energy,
               .momentum = model_.momentum,
               .times = model_.times,
               .step = model_.step,
               .row = row_,
               .has_dump = fields_due};
      next_kept_ = model_.step + least_steps_between + model_.step / share_of_steps;
    }
    if (row_due) {
      history_.append(row_);
      last_row_ = model_.times.time;
    }
    if (fields_due) writer_.write(*state_);
    if (fields_due || history_.full()) writer_.write(history_);
  }

  /// After a breakdown: energy and momentum balance become those of the last good state, which is written
  /// unless it has been.
  void write_last_good_state() {
    const StageTimer timer(model_.stages, Stage::output);
    model_.energy = good_.energy;
    model_.momentum = good_.momentum;
    model_.times = good_.times;
    model_.step = good_.step;
    if (state_ == nullptr && next_kept_ == 0) return write_start();
    if (state_ == nullptr) return;
    // Rows are in the order of time: those since then were good as well.
    if (!good_.has_dump) writer_.write(*state_);
    if (last_row_ < good_.times.time) history_.append(good_.row);
    writer_.write(history_);
  }

 private:
  // Of a run that breaks down in its first step: what the deck describes, if results can hold it.
  void write_start() {
    const Snapshot& start = observer_.observe(model_);
    if (what_results_cannot_hold(start).empty()) writer_.write(start);
  }

  // A state is kept after so many steps and this share of those made: of ten thousand steps about 120.
  static constexpr std::int64_t least_steps_between = 20, share_of_steps = 50;

  /// What was true at the state that the observer holds.
  struct GoodState {
    EnergyBalance energy;
    MomentumBalance momentum;
    StepTimes times;
    std::int64_t step = 0;
    std::vector<double> row;
    bool has_dump = false;  ///< written already
  };

  Model& model_;
  ResultWriter& writer_;
  FieldObserver observer_;
  History history_;
  std::vector<double> row_;
  double last_row_ = -1;  ///< its time
  OutputSchedule field_schedule_, history_schedule_;
  const Snapshot* state_ = nullptr;
  GoodState good_;
  std::int64_t next_kept_ = 0;
};

/// \return what breaks down, empty if nothing does
template <class Action>
std::string fault_of(const Action& action) {
  try {
    action();
  } catch (const Breakdown& breakdown) {
    return breakdown.what();
  }
  return {};
}

// From a first step that is made to the end, a failure or a stop.
// \param fault of the first step \return why it ended early, empty if it did not.
std::string run_to_end(const Deck& deck, const RunOptions& options, Model& model, Output& output,
                       ThreadTeam& team, std::string fault, Summary& state) {
  ProgressReporter progress(options, deck.time.end);
  state.status = "finished";
  while (true) {
    const int signal = options.stop != nullptr ? options.stop->load() : 0;
    const bool at_end = model.times.time >= deck.time.end;
    if (fault.empty()) fault = fault_of([&] { output.write_what_is_due(at_end || signal != 0, team); });
    if (!fault.empty()) {
      state.status = "failed";
      state.exit_code = 3;
      output.write_last_good_state();
      return fault;
    }
    progress.report(model, at_end || signal != 0);
    if (at_end) return "";
    if (signal != 0) {
      state.status = signal == SIGINT ? "interrupted" : "terminated";
      state.exit_code = 128 + signal;
      return state.status + " at time " + std::to_string(model.times.time);
    }
    fault = fault_of([&] {
      update_positions(model, team);
      update_velocities(model, deck.numerics.energy_error_limit, team);
    });
  }
}

}  // namespace

Model build_scene(const Deck& deck, int threads) {
  check_scene_size(deck);
  try {
    std::vector<Mesh> meshes;
    meshes.reserve(deck.parts.size());
    for (const Part& part : deck.parts) meshes.push_back(generate_mesh(part.mesh, part.placement));
    return build(deck, meshes, threads);
  } catch (const BuildError& fault) {
    throw DeckError((fault.place.empty() ? deck.file : fault.place) + ": " + fault.what());
  } catch (const std::bad_alloc&) {
    refuse_memory(deck);
  }
}

Deck load_deck(const std::filesystem::path& path, const std::vector<std::string>& overrides, int threads,
               Model& model) {
  Deck deck = read_deck(path, overrides);
  model = build_scene(deck, threads);
  return deck;
}

void make_first_step(const Deck& deck, Model& model, ThreadTeam& team) {
  update_velocities(model, deck.numerics.energy_error_limit, team);
  constexpr double most_steps = 0x1p53;
  const double steps_to_end = deck.time.end / model.times.next;
  if (steps_to_end > most_steps)
    throw DeckError((deck.time.place.empty() ? deck.file : deck.time.place) + ": 'end' is " +
                    written(deck.time.end) + ", which takes " + written(steps_to_end) + " time steps of " +
                    written(model.times.next) + "; at most " + written(most_steps) +
                    " are accepted: beyond, a step no longer changes the time");
}

RunOutcome run_deck(const RunOptions& options) {
  const auto start = Clock::now();
  Model model;
  const Deck deck = load_deck(options.deck, options.overrides, options.threads, model);
  if (options.built) options.built();
  ThreadTeam team(options.threads);
  const std::string fault = fault_of([&] { make_first_step(deck, model, team); });
  const std::string name = options.deck.stem().string();
  RunOutcome outcome;
  outcome.folder = options.output.empty() ? std::filesystem::path(name + ".results") : options.output;
  ResultWriter writer(
      outcome.folder, name,
      {.title = deck.title,
       .deck_path = options.deck.string(),
       .deck_text = deck.text,
       .overrides = options.overrides,
       .version = BRIO_VERSION,
       .threads = options.threads},
      history_columns(model),
      {.sync = deck.output.sync, .overwrite = options.overwrite, .moved_aside = options.moved_aside});
  outcome.vtkhdf = writer.vtkhdf();
  outcome.xdmf = writer.xdmf();
  outcome.summary_file = writer.summary();
  outcome.initial_overlaps = model.initial_overlaps;
  Output output(deck, model, writer);
  Summary state;
  outcome.message = run_to_end(deck, options, model, output, team, fault, state);
  const Impulse momentum_of_good = model.momentum.now;

  outcome.summary = observe_end(model);
  outcome.summary.warnings = run_warnings(model);
  if (state.exit_code == 3)  // that of the last good state, not of the nodes as they are
    outcome.summary.momentum = {momentum_of_good.linear, momentum_of_good.angular};
  outcome.summary.version = BRIO_VERSION;
  outcome.summary.deck = options.deck.string();
  outcome.summary.status = state.status;
  outcome.summary.exit_code = state.exit_code;
  outcome.summary.threads = options.threads;
  outcome.summary.peak_memory_mb = peak_memory_mb();
  outcome.summary.wall_s.total = seconds_since(start);
  outcome.summary.element_updates_per_s =
      static_cast<double>(model.element_updates) / outcome.summary.wall_s.total;
  writer.write(outcome.summary);
  return outcome;
}

}  // namespace brio
