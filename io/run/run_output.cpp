#include "io/run/run_output.hpp"

#include <cmath>
#include <utility>

#include "io/run/deal_domains.hpp"
#include "src/base/breakdown.hpp"
#include "src/domains/node_ranges.hpp"
#include "src/model/state.hpp"
#include "src/output/run_warnings.hpp"
#include "src/step/advance.hpp"
#include "src/step/diagnosis.hpp"

namespace brio {

namespace {

OutputSchedule restart_schedule(const Deck& deck) {
  return deck.output.restart ? OutputSchedule::every(deck.output.restart->every) : OutputSchedule::at({});
}

}  // namespace

RunOutput::RunOutput(const Deck& deck, Model& model, ResultWriter& writer, std::function<void()> after_write)
    : model_(model),
      writer_(writer),
      after_write_(std::move(after_write)),
      observer_(model, deck.output.fields_.variables),
      history_(history_columns(model)),
      written_{History(history_.columns()), History(history_.columns())},
      field_schedule_(field_schedule(deck)),
      history_schedule_(history_schedule(deck)),
      restart_schedule_(restart_schedule(deck)) {
  restart_schedule_.due(0);  // a run that has not begun is saved in its deck
}

void RunOutput::keep(const Snapshot& state, bool has_dump) {
  state_ = &state;
  good_ = {.energy = model_.energy,
           .momentum = model_.momentum,
           .times = model_.times,
           .step = model_.step,
           .row = row_,
           .has_dump = has_dump};
}

void RunOutput::begin_writing(const Snapshot* fields) {
  finish_writing(1);
  History& rows = written_[next_written_];
  next_written_ = 1 - next_written_;
  last_written_ = fields;
  std::swap(history_, rows);
  writing_.start([this, fields, &rows] {
    if (fields != nullptr)
      writer_.write(*fields, rows);
    else
      writer_.write(rows);
  });
}

void RunOutput::finish_writing(std::size_t left) {
  writing_.finish(left);
  if (writing_.have_ended()) after_write_();
}

void RunOutput::write_now(const Snapshot* fields) {
  begin_writing(fields);
  finish_writing();
}

void RunOutput::write_what_is_due(ThreadTeam& team) {
  if (writing_.have_ended()) finish_writing();  // a disk that is full ends the run now, not at the next dump
  const std::optional<double> fields = field_schedule_.due_within(model_.times.time, model_.times.next);
  write(history_schedule_.due(model_.times.time), fields, team);
}

void RunOutput::write_last_state(ThreadTeam& team) {
  std::optional<double> fields;
  if (last_dump_ < model_.times.time) fields = model_.times.time;
  write(last_row_ < model_.times.time, fields, team);
  const StageTimer timer(model_.stages, Stage::output);
  write_now(nullptr);
}

// Nothing where another process writes.
const Snapshot& RunOutput::observe_fields(double time, ThreadTeam& team) {
  static const Snapshot nothing;
  if (!writer_.writes()) return nothing;
  if (!writing_.have_ended() && last_written_ != nullptr && last_written_ == state_) observer_.turn();
  state_ = nullptr;  // one before is filled anew
  return observer_.observe(model_, time, team);
}

void RunOutput::write(bool row, std::optional<double> fields, ThreadTeam& team) {
  const bool keeps = model_.step >= next_kept_;
  if (!row && !fields && !keeps) return;
  if (fields) audit_contacts(model_, team);
  const StageTimer timer(model_.stages, Stage::output);
  if (fields || keeps)
    exchange_state(model_);
  else
    exchange_nodes(model_.nodes);
  if (fields) watch(model_);
  observe_history(model_, history_sums_, row_, team);
  if (fields || keeps) {
    finish_writing(1);
    const Snapshot& state = observe_fields(fields.value_or(model_.times.time), team);
    // Of several processes the one that writes has looked at the fields, and all end where it finds a fault.
    const std::string fault = writer_.writes() ? what_results_cannot_hold(state) : "";
    if (is_on_any_rank(!fault.empty(), model_))
      throw Breakdown(fault + " at time " + written(model_.times.time) +
                      " is too large for the results or not a number; check units and velocities of the "
                      "deck, else try a smaller time.step_scale");
    keep(state, fields.has_value());
    next_kept_ = model_.step + least_steps_between + model_.step / share_of_steps;
  }
  if (row) {
    history_.append(row_);
    if (model_.forces) model_.forces->begin_interval();
    last_row_ = model_.times.time;
  }
  if (fields) {
    model_.impulse_sums.begin_interval();
    last_dump_ = model_.times.time;
  }
  if (fields || history_.full()) begin_writing(fields ? state_ : nullptr);
}

bool RunOutput::is_save_due() { return restart_schedule_.due(model_.times.time); }

// The order in which a saved run is read.
template <class Archive>
void RunOutput::serialize(Archive& archive, double& seconds) {
  archive.section(10);
  archive(seconds, model_.stages, observer_, row_, last_row_, last_dump_, next_kept_, writer_);
  archive.section(11);
}

void RunOutput::save(const std::filesystem::path& folder, const std::string& name, const RunRecord& record,
                     double seconds) {
  const StageTimer timer(model_.stages, Stage::output);
  write_now(nullptr);
  exchange_state(model_);
  if (!writer_.writes()) return;
  writer_.note_position();
  write_restart(folder, name, {.record = record, .time = model_.times.time, .step = model_.step},
                [&](std::ostream& out) {
                  StateWriter archive(out);
                  serialize(archive, seconds);
                  save_state(model_, out);
                });
}

double RunOutput::restore(const RestartFile& restart, bool continues_results) {
  double seconds = 0;
  const ResultWriter fresh = writer_;
  read_restart(restart, [&](std::istream& in, std::uint64_t size) {
    StateReader archive(in, size);
    serialize(archive, seconds);
    restore_state(model_, in, archive.left());
  });
  observer_.follow(model_);
  restart_schedule_.due(model_.times.time);
  if (!continues_results) {
    writer_ = fresh;
    last_row_ = last_dump_ = -1;
    return seconds;
  }
  writer_.return_to_position();
  field_schedule_.due_within(model_.times.time, model_.times.next);
  history_schedule_.due(model_.times.time);
  keep(observer_.observe(model_), last_dump_ == model_.times.time);
  return seconds;
}

void RunOutput::write_last_good_state() {
  const StageTimer timer(model_.stages, Stage::output);
  finish_writing();
  model_.energy = good_.energy;
  model_.momentum = good_.momentum;
  model_.times = good_.times;
  model_.step = good_.step;
  if (state_ == nullptr && next_kept_ == 0) return write_start();
  if (state_ == nullptr) return;
  // Rows are in the order of time: those since then were good as well.
  if (last_row_ < good_.times.time) history_.append(good_.row);
  write_now(good_.has_dump ? nullptr : state_);
}

// Of a run that breaks down in its first step: what the deck describes, if results can hold it.
void RunOutput::write_start() {
  const Snapshot& start = observer_.observe(model_);
  if (what_results_cannot_hold(start).empty()) writer_.write(start);
}

}  // namespace brio
