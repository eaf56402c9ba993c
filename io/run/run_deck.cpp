#include "io/run/run_deck.hpp"

#include <sys/resource.h>

#include <chrono>
#include <csignal>

#include "io/deck/read_deck.hpp"
#include "io/mesh/generate_mesh.hpp"
#include "io/restart/deck_difference.hpp"
#include "io/restart/restart_file.hpp"
#include "io/results/read_result.hpp"
#include "io/results/write_results.hpp"
#include "io/run/deal_domains.hpp"
#include "io/run/initial_state.hpp"
#include "io/run/run_output.hpp"
#include "io/run/scene_size.hpp"
#include "io/yaml/deck_error.hpp"
#include "src/base/index.hpp"
#include "src/build/build.hpp"
#include "src/output/observe.hpp"
#include "src/output/run_warnings.hpp"
#include "src/step/advance.hpp"
#include "src/step/diagnosis.hpp"
#include "src/step/relax.hpp"

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

std::string critical_of(const Model& model) {
  if (const int spring = model.springs.critical; spring >= 0)
    return "spring " + model.springs.spring[index(spring)].name;
  const PartInModel& part = model.parts[model.control.critical_block];
  return part.name + " " + std::to_string(part.number_of_element(model.control.critical_element));
}

// Calls back now and then, and foresees the end from the speed of the last stretch.
class ProgressReporter {
 public:
  ProgressReporter(const RunOptions& options, double time, double end)
      : options_(options), end_(end), time_(time) {}

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
                       .critical = critical_of(model),
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
  double time_;
  double mean_speed_ = 0;
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

/// Why a run ends before its end time.
struct Stop {
  const char* status;
  int exit_code;
};

/// From a first step, or a restored one, to the end, a failure or a stop.
class Run {
 public:
  Run(const Deck& deck, const RunOptions& options, Model& model, RunOutput& output, ThreadTeam& team,
      Clock::time_point start)
      : deck_(deck), options_(options), model_(model), output_(output), team_(team), start_(start) {}

  /// Where restart files go.
  std::filesystem::path folder;
  RunRecord record;
  double seconds_before = 0;  ///< that the run had taken when it was saved

  /// \param fault of the first step \param is_restored whether what is due at this step is written already
  /// \return why it ended early, empty if it did not.
  std::string go_on(std::string fault, bool is_restored, Summary& state) {
    ProgressReporter progress(options_, model_.times.time, deck_.time.end);
    std::optional<Stop> stop;
    const auto observe = [&](Model&) {
      stop = stop_wanted();
      const bool last = is_at_end() || stop.has_value();
      write(is_restored, last, stop.has_value());
      is_restored = false;
      if (!last) balance_load(model_);
      progress.report(model_, last);
      return !stop;
    };
    if (fault.empty())
      fault = fault_of([&] { run(model_, deck_.numerics.energy_error_limit, team_, observe); });
    if (!fault.empty()) {
      state.status = "failed";
      state.exit_code = 3;
      output_.write_last_good_state();
      return fault;
    }
    state.status = "finished";
    if (!stop || is_at_end()) return "";
    state.status = stop->status;
    state.exit_code = stop->exit_code;
    return stop->exit_code == 0 ? "" : state.status + " at time " + std::to_string(model_.times.time);
  }
  double seconds() const { return seconds_before + seconds_since(start_); }

 private:
  bool is_at_end() const { return model_.times.time >= deck_.time.end; }

  std::optional<Stop> stop_wanted() {
    constexpr int at_limit = -1;
    int signal = options_.stop != nullptr ? options_.stop->load() : 0;
    if (signal == 0)
      signal = options_.stop_after_s && seconds_since(start_) >= *options_.stop_after_s ? at_limit : goes_on;
    if (options_.ranks != nullptr) signal = agreed(signal, *options_.ranks);
    if (signal == goes_on) return {};
    if (signal == at_limit) return Stop{"stopped", 0};
    return Stop{signal == SIGINT ? "interrupted" : "terminated", 128 + signal};
  }

  // What all ranks wanted a step ago: it rides with what the step exchanges.
  int agreed(int signal, Ranks& ranks) {
    if (ranks.has_noted()) ranks.share(Ranks::Kind::agreement);
    signal_of_rank_.resize(index(ranks.count()), goes_on);
    const int known = *std::ranges::max_element(signal_of_rank_);
    if (known != goes_on || is_at_end()) return known;
    signal_of_rank_[index(ranks.number())] = signal;
    for (int rank = 0; rank < ranks.count(); ++rank) ranks.note(rank, &signal_of_rank_[index(rank)], 1);
    return known;
  }

  // A run that is saved here goes on as if it had not ended: what is written of the last state comes after.
  void write(bool is_restored, bool last, bool stops) {
    if (!is_restored) output_.write_what_is_due(team_);
    const bool due = !is_restored && output_.is_save_due();
    if (stops || (deck_.output.restart && (due || last)))
      output_.save(folder, options_.deck.stem().string(), record, seconds());
    if (last) output_.write_last_state(team_);
  }

  const Deck& deck_;
  const RunOptions& options_;
  Model& model_;
  RunOutput& output_;
  ThreadTeam& team_;
  Clock::time_point start_;
  static constexpr int goes_on = -2;
  std::vector<int> signal_of_rank_;  ///< as known to all
};

// A state fits the mesh that it was saved with, and no other.
void expect_same_meshes(const RestartFile& restart, const Deck& deck) {
  const std::vector<std::string>& saved = restart.header.record.mesh_checksums;
  for (const std::string& mesh : deck.mesh_checksums)
    if (std::find(saved.begin(), saved.end(), mesh) == saved.end())
      throw DeckError(deck.file + ": the file '" + mesh.substr(0, mesh.rfind(' ')) + "' has changed since " +
                      restart.path.string() + " was saved; accepted is the file as it was");
}

/// The restart file, if one is given. \throws DeckError where the deck is not that of the saved run,
/// FileError
std::optional<RestartFile> restart_of(const RunOptions& options, const Deck& deck) {
  if (options.restart.empty()) return {};
  RestartFile restart = find_restart(options.restart);
  if (options.notice && !restart.instead_of.empty())
    options.notice(restart.instead_of + "; going on from " + restart.path.string());
  const std::string difference = deck_difference(restart.header.record.deck_text, deck.text);
  if (!difference.empty())
    throw DeckError(deck.file + ": a saved run goes on with the deck that it was saved with: " + difference +
                    " in " + restart.path.string() +
                    "; accepted are changes of title, units, output and time.end");
  expect_same_meshes(restart, deck);
  if (restart.header.time > deck.time.end)
    throw DeckError(deck.file + ": the run that " + restart.path.string() + " has saved is at time " +
                    written(restart.header.time) + " already; accepted is a time.end that is not before it");
  return restart;
}

// Rows of other tables cannot be appended.
void expect_same_columns(const std::filesystem::path& results, const RestartFile& restart,
                         const std::vector<std::string>& columns, const Deck& deck) {
  const Deck saved = parse_deck(restart.header.record.deck_text, deck.file);  // meshes are beside the deck
  if (ResultReader(results).history_columns() == columns &&
      saved.output.fields_.variables == deck.output.fields_.variables)
    return;
  throw DeckError(
      deck.file + ": history or fields in " + results.string() +
      " have other columns than this run; accepted are the same probes and forces of "
      "output.history and the same output.fields.variables, or results in another folder (--output)");
}

// Which the program that writes them reads.
bool writes_states(const Deck& deck) {
  const std::vector<std::string>& wanted = deck.output.fields_.variables;
  return std::find(wanted.begin(), wanted.end(), state_variable) != wanted.end();
}

bool is_same_folder(const std::filesystem::path& a, const std::filesystem::path& b) {
  std::error_code error;
  return std::filesystem::equivalent(a.empty() ? "." : a, b.empty() ? "." : b, error);
}

}  // namespace

Model build_scene(const Deck& deck, int threads) {
  check_scene_size(deck);
  try {
    std::vector<Mesh> meshes;
    meshes.reserve(deck.parts.size());
    for (const Part& part : deck.parts) meshes.push_back(generate_mesh(part.mesh, part.placement));
    const std::vector<PartState> states = read_initial_states(deck, meshes);
    return build(deck, meshes, threads, states);
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
  for (std::string& sum : checksums_of_results(deck)) deck.mesh_checksums.push_back(std::move(sum));
  return deck;
}

void make_first_step(const Deck& deck, Model& model, ThreadTeam& team) {
  if (deck.time.relaxation) relax(*deck.time.relaxation, model, team);
  update_velocities(model, deck.numerics.energy_error_limit, team);
  constexpr double most_steps = 0x1p53;
  const double steps_to_end = deck.time.end / model.times.next;
  if (steps_to_end > most_steps)
    throw DeckError((deck.time.place.empty() ? deck.file : deck.time.place) + ": 'end' is " +
                    written(deck.time.end) + ", which takes " + written(steps_to_end) + " time steps of " +
                    written(model.times.next) + "; at most " + written(most_steps) +
                    " are accepted: beyond, a step no longer changes the time");
}

int threads_of(const Model& model, int threads, bool by_size) {
  constexpr std::size_t nodes_a_thread = 1000;  // those of rigid parts too: they are in contact
  const std::size_t wanted = std::max<std::size_t>(model.nodes.size() / nodes_a_thread, 1);
  return by_size && wanted < index(threads) ? static_cast<int>(wanted) : threads;
}

RunOutcome run_deck(const RunOptions& options) {
  const auto start = Clock::now();
  Model model;
  const Deck deck = load_deck(options.deck, options.overrides, options.threads, model);
  const std::optional<RestartFile> restart = restart_of(options, deck);
  if (options.notice)
    for (const std::string& notice : deck.mesh_notices) options.notice(notice);
  if (options.built) options.built();
  const int threads = threads_of(model, options.threads, options.threads_by_size);
  ThreadTeam team(threads);
  if (options.ranks != nullptr) deal_domains(model, *options.ranks);
  // A first step finds what is wrong with a scene, and what a restored state does not hold.
  const std::string fault = restart ? "" : fault_of([&] { make_first_step(deck, model, team); });
  const std::string name = options.deck.stem().string();
  RunOutcome outcome;
  outcome.folder = options.output.empty() ? std::filesystem::path(name + ".results") : options.output;
  const RunRecord record{.title = deck.title,
                         .deck_path = options.deck.string(),
                         .deck_text = deck.text,
                         .overrides = options.overrides,
                         .version = BRIO_VERSION,
                         .threads = threads,
                         .mesh_checksums = deck.mesh_checksums,
                         .program = writes_states(deck) ? program_checksum_text() : ""};
  const auto published = [&options, log = outcome.folder / (name + ".log")](bool goes_on) {
    if (options.published) options.published(log, goes_on);
  };
  // Told by this thread, whichever writes.
  std::vector<std::function<void()>> news;
  const auto tell = [&news] {
    for (const std::function<void()>& one : news) one();
    news.clear();
  };
  const auto moved_aside = [&](const std::filesystem::path& to, bool lost) {
    if (options.moved_aside) news.emplace_back([&options, to, lost] { options.moved_aside(to, lost); });
  };
  const ResultSettings settings{.writes = options.ranks == nullptr || options.ranks->number() == 0,
                                .sync = deck.output.sync,
                                .overwrite = options.overwrite,
                                .moved_aside = moved_aside,
                                .published = [&] { news.emplace_back([published] { published(false); }); }};
  const std::filesystem::path results = outcome.folder / (name + ".vtkhdf");
  const bool continues_results = restart && is_same_folder(restart->path.parent_path(), outcome.folder) &&
                                 std::filesystem::exists(results);
  if (continues_results) {
    expect_same_columns(results, *restart, history_columns(model), deck);
    if (settings.writes) published(true);
  }
  if (options.ranks != nullptr) options.ranks->largest(0);  // all have looked before the first one writes
  ResultWriter writer = continues_results
                            ? ResultWriter(outcome.folder, name, settings)
                            : ResultWriter(outcome.folder, name, record, history_columns(model), settings);
  outcome.vtkhdf = writer.vtkhdf();
  outcome.xdmf = writer.xdmf();
  outcome.summary_file = writer.summary();
  outcome.initial_overlaps = model.initial_overlaps;
  RunOutput output(deck, model, writer, tell);
  Run run(deck, options, model, output, team, start);
  run.folder = outcome.folder;
  run.record = record;
  if (restart) run.seconds_before = output.restore(*restart, continues_results);
  Summary state;
  outcome.message = run.go_on(fault, continues_results, state);
  const Impulse momentum_of_good = model.momentum.now;

  exchange_state(model);
  outcome.summary = observe_end(model);
  outcome.summary.warnings = run_warnings(model);
  if (state.exit_code == 3)  // that of the last good state, not of the nodes as they are
    outcome.summary.momentum = {momentum_of_good.linear, momentum_of_good.angular};
  outcome.summary.version = BRIO_VERSION;
  outcome.summary.deck = options.deck.string();
  outcome.summary.status = state.status;
  outcome.summary.exit_code = state.exit_code;
  if (restart) outcome.summary.restarted_from = restart->path.string();
  outcome.summary.threads = threads;
  if (options.ranks != nullptr) outcome.summary.ranks = options.ranks->count();
  outcome.summary.peak_memory_mb = peak_memory_mb();
  outcome.summary.wall_s.total = run.seconds();
  outcome.summary.element_updates_per_s =
      static_cast<double>(model.element_updates) / outcome.summary.wall_s.total;
  writer.write(outcome.summary);
  tell();
  return outcome;
}

}  // namespace brio
