#pragma once
/// A whole run: deck in, results out.

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "src/base/parallel.hpp"
#include "src/deck/deck.hpp"
#include "src/domains/ranks.hpp"
#include "src/model/model.hpp"
#include "src/output/summary.hpp"

namespace brio {

/// Where a run stands; for a progress line.
struct Progress {
  double time = 0;
  double end = 0;
  std::int64_t step = 0;
  double dt = 0;
  std::string critical;  ///< what sets the stable time step: part and number of an element, or a spring
  double energy_error = 0;
  std::int64_t deleted = 0;  ///< elements
  std::string hourglassing;  ///< part whose hourglass energy is beyond the limit most; empty: none
  double hourglass_ratio = 0;
  double elapsed_s = 0;
  double remaining_s = 0;  ///< if the rest goes on like the last part
};

/// With fewer nodes than a thousand a thread, threads cost more than they gain. \param by_size whether a
/// small scene has fewer than `threads`
int threads_of(const Model& model, int threads, bool by_size);

struct RunOptions {
  std::filesystem::path deck;
  std::vector<std::string> overrides;  ///< KEY.PATH=VALUE
  std::filesystem::path output;        ///< result folder; empty: NAME.results where the program runs
  int threads = 1;
  bool threads_by_size = false;          ///< whether a small scene has fewer threads (`threads_of`)
  bool overwrite = false;                ///< whether results of an earlier run are removed, not moved aside
  std::filesystem::path restart;         ///< restart file of a run that goes on; empty: one that begins
  std::optional<double> stop_after_s{};  ///< wall time after which the run is saved and stops
  std::function<void(const std::string&)>
      notice{};  ///< called with what the user should know of meshes and a restart
  std::function<void(const std::filesystem::path& to, bool lost)> moved_aside{};  ///< as of ResultSettings
  /// Called when the results stand under their names: where a log goes, and whether it goes on.
  std::function<void(const std::filesystem::path& log, bool goes_on)> published{};
  const std::atomic<int>* stop = nullptr;  ///< set to a signal's number to end the run after the present step
  Ranks* ranks = nullptr;       ///< processes that compute the scene together, of which the first writes
  std::function<void()> built;  ///< called before the first file is made
  std::function<void(const Progress&)> progress;  ///< called about ten times a second
};

struct RunOutcome {
  Summary summary;
  std::vector<InitialOverlap> initial_overlaps;  ///< removed before the first step
  std::string message;                           ///< why the run ended early; empty if it reached its end
  std::filesystem::path folder;
  std::filesystem::path vtkhdf, xdmf, summary_file;
};

/// Parts of a deck meshed and the scene put together. \throws DeckError
Model build_scene(const Deck& deck, int threads = 1);

/// A deck read, its parts meshed and the scene put together. \throws DeckError
Deck load_deck(const std::filesystem::path& path, const std::vector<std::string>& overrides, int threads,
               Model& model);

/// The first step of a scene, with which it is known how many there will be.
/// \throws DeckError where these are so many that the time stops advancing, Breakdown
void make_first_step(const Deck& deck, Model& model, ThreadTeam& team);

/// Runs to the end time, a numerical failure, or a stop. Nothing is written before the first step
/// is made.
/// \throws DeckError for what the deck gets wrong, FileError for what the file system refuses.
RunOutcome run_deck(const RunOptions& options);

}  // namespace brio
