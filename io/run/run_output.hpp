#pragma once
/// What a run writes while it goes on: fields, history and restart files as they fall due; of a run that
/// breaks down the last state that was good. Fields and rows are written by a thread of their own while steps
/// go on: one write at a time, and at most one that waits.

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "io/restart/restart_file.hpp"
#include "io/results/write_results.hpp"
#include "src/base/parallel.hpp"
#include "src/deck/deck.hpp"
#include "src/model/model.hpp"
#include "src/output/observe.hpp"
#include "src/output/output_schedule.hpp"

namespace brio {

class RunOutput {
 public:
  /// \param model as built: its positions are the reference of displacements \param after_write called by the
  /// thread of the run when all writes have ended
  RunOutput(const Deck& deck, Model& model, ResultWriter& writer, std::function<void()> after_write);

  /// Of a state that is good. \throws Breakdown where results cannot hold it
  void write_what_is_due(ThreadTeam& team);
  /// What was not due at the last state, which is written whole; after the run was saved, since one that goes
  /// on from there does not write it. \throws Breakdown
  void write_last_state(ThreadTeam& team);

  /// Save the run as it is, with the position of its results. \param seconds that it has taken
  void save(const std::filesystem::path& folder, const std::string& name, const RunRecord& record,
            double seconds);
  /// Whether a restart file is due.
  bool is_save_due();
  /// Restore model and results. \param continues_results whether results go on in the files of the saved run;
  /// else they begin here \returns seconds that the run had taken
  double restore(const RestartFile& restart, bool continues_results);

  /// The model has broken down: its balances become those of the last good state, which is written unless it
  /// is there already.
  void write_last_good_state();

 private:
  /// Begin to write rows, and fields unless null. \throws FileError of the write before
  void begin_writing(const Snapshot* fields);
  /// Until at most so many writes are unfinished. \throws FileError
  void finish_writing(std::size_t left = 0);
  /// Write rows, and fields unless null. \throws FileError
  void write_now(const Snapshot* fields);
  /// \param fields the time of them, if they are due
  void write(bool row, std::optional<double> fields, ThreadTeam& team);
  const Snapshot& observe_fields(double time, ThreadTeam& team);
  void keep(const Snapshot& state, bool has_dump);
  void write_start();

  // A state is kept after so many steps and this share of those made: of ten thousand steps about 120.
  static constexpr std::int64_t least_steps_between = 50, share_of_steps = 50;

  /// What was true at the state that the observer holds.
  struct GoodState {
    EnergyBalance energy;
    MomentumBalance momentum;
    StepTimes times;
    std::int64_t step = 0;
    std::vector<double> row;
    bool has_dump = false;  ///< written already
  };

  template <class Archive>
  void serialize(Archive& archive, double& seconds);

  Model& model_;
  ResultWriter& writer_;
  std::function<void()> after_write_;
  FieldObserver observer_;
  History history_;                         ///< rows that gather
  std::array<History, 2> written_;          ///< those of the unfinished writes
  std::size_t next_written_ = 0;            ///< that no write reads
  const Snapshot* last_written_ = nullptr;  ///< that the last write reads
  HistorySums history_sums_;
  std::vector<double> row_;
  double last_row_ = -1, last_dump_ = -1;  ///< their times
  OutputSchedule field_schedule_, history_schedule_, restart_schedule_;
  const Snapshot* state_ = nullptr;
  GoodState good_;
  std::int64_t next_kept_ = 0;
  BackgroundJobs writing_;  ///< read the states and rows above: end before them
};

}  // namespace brio
