#include "io/study/run_study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <chrono>
#include <cmath>
#include <cstring>
#include <exception>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "io/files/file_error.hpp"
#include "io/files/read_apart.hpp"
#include "io/files/text_file.hpp"
#include "io/files/utf8.hpp"
#include "io/results/read_info.hpp"
#include "io/results/read_result.hpp"
#include "io/study/measure_quantity.hpp"
#include "io/study/read_study.hpp"
#include "io/study/run_processes.hpp"
#include "src/base/index.hpp"
#include "src/forecast/pareto.hpp"

namespace brio {

namespace {

namespace fs = std::filesystem;
constexpr double nothing = std::numeric_limits<double>::quiet_NaN();

std::string contents(const fs::path& file) {
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}

// A run that was stopped, or that the file system failed, is not remembered: it is made again next time.
bool is_final(int exit_code) { return exit_code == 0 || exit_code == 3; }

// The last line that a run wrote before it failed.
std::string last_line(const fs::path& file) {
  std::string text;
  try {
    text = read_small_file(file);
  } catch (const FileError&) {
    return {};
  }
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back()))) text.pop_back();
  text.erase(0, text.rfind('\n') + 1);
  for (char& c : text)
    if (std::iscntrl(static_cast<unsigned char>(c))) c = ' ';
  return as_utf8(text);
}

// Numbers on their way from the process that read them.
std::string packed(const std::vector<double>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(double)};
}
std::vector<double> unpacked(const std::string& bytes) {
  std::vector<double> values(bytes.size() / sizeof(double));
  std::memcpy(values.data(), bytes.data(), values.size() * sizeof(double));
  return values;
}

// All that a later call builds upon. \throws FileError
void check_result(const fs::path& file, const std::string& deck_text) {
  const ResultInfo info = read_info(file);
  if (info.status != "finished" || info.exit_code != 0) throw FileError(file, "the run did not finish");
  if (info.deck_text != deck_text || info.version != BRIO_VERSION)
    throw FileError(file, "the result is of another deck or version");
  for (const char* ending : {".xdmf2", ".history.csv"})
    if (!fs::is_regular_file(fs::path(file).replace_extension(ending)))
      throw FileError(file, std::string("the result has no ") + ending);
  verify_result(file);
}

// FNV-1a, 64 bits.
std::uint64_t fingerprint(std::string_view text, std::uint64_t hash = 0xcbf29ce484222325U) {
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3U;
  return hash;
}

class StudyInRun {
 public:
  explicit StudyInRun(const StudyOptions& options)
      : options_(options), checked_(read_study(options.study.string())) {
    folder_ = options.output.empty() ? fs::path(options.study.stem().string() + ".study") : options.output;
    program_print_ = fingerprint(contents(options.program));
    table_.study = checked_.study;
    for (const StudyRun& run : checked_.runs) {
      StudyRow& row = table_.rows.emplace_back();
      row.run = run;
      row.figures.assign(checked_.study.quantities.size(), nothing);
    }
  }

  StudyOutcome outcome() {
    make_folder(folder_);
    lock_ = std::make_shared<const FolderLock>(folder_);
    make_runs();
    for (StudyRow& row : table_.rows) measure(row);
    // One result that lacks something is told in its row; where all do, what was asked for is wrong.
    if (measured_ == 0 && fault_) std::rethrow_exception(fault_);
    judge();
    return {std::move(table_), folder_, lock_};
  }

 private:
  fs::path folder_of(std::size_t run) const { return folder_ / "runs" / table_.rows[run].run.name; }
  fs::path result_of(std::size_t run) const {
    return folder_of(run) / (fs::path(checked_.deck).stem().string() + ".vtkhdf");
  }
  std::string key(std::size_t run) const {
    const std::string settings =
        fmt::format("{} {} {}", checked_.texts[run], checked_.study.threads, checked_.study.repeats) +
        checked_.meshes[run];
    return fmt::format("{:016x}", fingerprint(settings, program_print_));
  }

  // The record of an earlier call, if it is one and of this run.
  std::optional<StudyRow> read_record(std::size_t run) const {
    nlohmann::json record;
    try {
      record = nlohmann::json::parse(read_small_file(folder_of(run) / "run.json"), nullptr, false);
    } catch (const FileError&) {
      return {};
    }
    const auto text = [&](const char* name) {
      return record.contains(name) && record[name].is_string() ? record[name].get<std::string>() : "";
    };
    const auto number = [&](const char* name) {
      const bool is_number = record.contains(name) && record[name].is_number();
      return is_number && record[name] >= 0.0 ? record[name].get<double>() : nothing;
    };
    if (!record.is_object() || text("key") != key(run)) return {};
    StudyRow row = table_.rows[run];
    const double exit_code = number("exit_code");
    row.exit_code = exit_code == 0 || exit_code == 3 ? static_cast<int>(exit_code) : -1;
    row.message = text("message");
    row.processor_s = number("processor_s");
    row.wall_s = number("wall_s");
    row.peak_memory_mb = number("peak_memory_mb");
    row.has_run = row.reused = true;
    if (!is_final(row.exit_code) || !std::isfinite(row.processor_s + row.wall_s + row.peak_memory_mb))
      return {};
    return row;
  }

  bool take_earlier(std::size_t run) {
    if (options_.again) return false;
    const std::optional<StudyRow> earlier = read_record(run);
    if (!earlier) return false;
    try {
      if (earlier->exit_code == 0)
        read_apart(result_of(run), [&] {
          check_result(result_of(run), checked_.texts[run]);
          return std::string();
        });
    } catch (const FileError&) {
      return false;
    }
    table_.rows[run] = *earlier;
    return true;
  }

  void remember(std::size_t run) {
    const StudyRow& row = table_.rows[run];
    const nlohmann::ordered_json record{{"run", row.run.name},
                                        {"overrides", row.run.overrides},
                                        {"exit_code", row.exit_code},
                                        {"message", row.message},
                                        {"processor_s", row.processor_s},
                                        {"wall_s", row.wall_s},
                                        {"peak_memory_mb", row.peak_memory_mb},
                                        {"key", key(run)}};
    replace_text_file(folder_of(run) / "run.json",
                      {record.dump(1, ' ', false, nlohmann::ordered_json::error_handler_t::replace), "\n"});
  }

  Command command(std::size_t run) const {
    Command result;
    result.faults = folder_of(run) / "faults.txt";
    result.arguments = {options_.program.string(),
                        "run",
                        checked_.deck,
                        "--output",
                        folder_of(run).string(),
                        "--threads",
                        std::to_string(checked_.study.threads),
                        "--quiet",
                        "--overwrite"};
    result.shared_descriptor = lock_->descriptor();
    for (const std::string& setting : table_.rows[run].run.overrides)
      result.arguments.insert(result.arguments.end(), {"--set", setting});
    return result;
  }

  // The reference first: it is as a rule the longest.
  std::vector<std::size_t> order() const {
    std::vector<std::size_t> result;
    const std::optional<std::size_t> reference = reference_run(checked_.study, checked_.runs);
    if (reference) result.push_back(*reference);
    for (std::size_t i = 0; i < table_.rows.size(); ++i)
      if (i != reference) result.push_back(i);
    return result;
  }

  void take(std::size_t run, const Ended& end) {
    StudyRow& row = table_.rows[run];
    const bool first = row.processor_s == 0;
    row.has_run = true;
    row.exit_code = end.exit_code;
    row.processor_s = first ? end.processor_s : std::min(row.processor_s, end.processor_s);
    row.wall_s = first ? end.wall_s : std::min(row.wall_s, end.wall_s);
    row.peak_memory_mb = std::max(row.peak_memory_mb, end.peak_memory_mb);
    if (end.exit_code == 0) return;
    row.message = last_line(folder_of(run) / "faults.txt");
  }

  void make_runs() {
    const auto begin = std::chrono::steady_clock::now();
    std::vector<std::size_t> run_of_command;
    std::vector<Command> commands;
    for (const std::size_t run : order()) {
      if (take_earlier(run)) continue;
      make_folder(folder_of(run));
      remove_file(folder_of(run) / "run.json");
      for (int i = 0; i < checked_.study.repeats; ++i) {
        run_of_command.push_back(run);
        commands.push_back(command(run));
      }
    }
    std::vector<int> left(table_.rows.size(), checked_.study.repeats);
    std::size_t done = 0;
    // Repeats of a run write the same folder: one after the other.
    const int jobs = checked_.study.repeats > 1 ? 1 : options_.jobs;
    run_processes(commands, jobs, options_.stop, [&](const Ended& end) {
      const std::size_t run = run_of_command[end.command];
      take(run, end);
      if (--left[run] == 0 && is_final(end.exit_code)) remember(run);
      ++done;
      const double elapsed = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
      if (options_.progress)
        options_.progress({done, commands.size(), elapsed,
                           elapsed / static_cast<double>(done) * static_cast<double>(commands.size() - done),
                           table_.rows[run]});
    });
  }

  void measure(StudyRow& row) {
    const auto run = index(&row - table_.rows.data());
    if (!row.has_run || row.exit_code != 0) return;
    try {
      std::vector<double> figures =
          unpacked(read_apart(result_of(run), [&] { return packed(measured(run)); }));
      row.steps = figures.at(row.figures.size());
      figures.pop_back();
      row.figures = std::move(figures);
    } catch (const FileError& fault) {
      row.message = fault.what();
      fault_ = std::current_exception();
      return;
    }
    ++measured_;
  }

  // One figure a quantity, then the number of steps.
  std::vector<double> measured(std::size_t run) const {
    std::vector<double> figures =
        measure_quantities(checked_.study.quantities, result_of(run), checked_.parts);
    figures.push_back(read_summary(result_of(run)).at("steps").get<double>());
    return figures;
  }

  void judge() {
    const Study& study = checked_.study;
    const std::optional<std::size_t> reference = reference_run(study, checked_.runs);
    for (std::size_t q = 0; q < study.quantities.size(); ++q)
      table_.references.push_back(
          study.quantities[q].reference.value_or(reference ? table_.rows[*reference].figures[q] : nothing));
    std::vector<CostAndError> all;
    for (StudyRow& row : table_.rows) {
      row.is_reference = reference && &row == &table_.rows[*reference];
      double square = 0;
      for (std::size_t q = 0; q < study.quantities.size(); ++q) {
        const double scale = study.quantities[q].scale.value_or(std::abs(table_.references[q]));
        row.errors.push_back(std::abs(row.figures[q] - table_.references[q]) / scale);
        square += row.errors.back() * row.errors.back();
      }
      row.error = std::sqrt(square / static_cast<double>(study.quantities.size()));
      const bool counts = row.exit_code == 0 && !row.run.is_another_problem;
      all.push_back({counts ? row.processor_s : nothing, row.error});
    }
    const std::vector<bool> front = pareto_front(all);
    for (std::size_t i = 0; i < all.size(); ++i) {
      table_.rows[i].on_front = front[i];
      // A run that is its own reference has no error to compare.
      table_.rows[i].beats_default = !table_.rows[i].is_reference && beats(all[i], all[0], beating_share);
    }
  }

  const StudyOptions& options_;
  CheckedStudy checked_;
  StudyTable table_;
  fs::path folder_;
  std::shared_ptr<const FolderLock> lock_;
  std::uint64_t program_print_ = 0;
  std::size_t measured_ = 0;
  std::exception_ptr fault_;
};

}  // namespace

int StudyOutcome::exit_code() const {
  int worst = 0;
  for (const StudyRow& row : table.rows)
    if (row.exit_code != 0) worst = std::max(worst, row.exit_code == 4 ? 4 : 3);
  return worst;
}

StudyOutcome run_study(const StudyOptions& options) { return StudyInRun(options).outcome(); }

}  // namespace brio
