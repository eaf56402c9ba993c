#include "io/write_results.hpp"

#include <fmt/format.h>

#include <system_error>
#include <utility>

#include "io/hdf5_file.hpp"
#include "io/write_history.hpp"
#include "io/write_summary.hpp"

namespace brio {
namespace {

void write_record(Hdf5File& file, const RunRecord& record) {
  file.create_group("/deck");
  file.write_text("/deck/title", record.title);
  file.write_text("/deck/path", record.deck_path);
  file.write_text("/deck/text", record.deck_text);
  file.write_texts("/deck/overrides", record.overrides);
  file.write_text("/deck/version", record.version);
  file.write_attribute("/deck", "threads", record.threads);
}

void remove_file(const std::filesystem::path& path) {
  std::error_code error;
  std::filesystem::remove(path, error);
  if (error) throw FileError(path, "cannot remove the file of an earlier run: " + error.message());
}

void rename_file(const std::filesystem::path& from, const std::filesystem::path& to) {
  std::error_code error;
  std::filesystem::rename(from, to, error);
  if (error) throw FileError(to, "cannot rename " + from.filename().string() + ": " + error.message());
}

}  // namespace

ResultWriter::ResultWriter(std::filesystem::path folder, const std::string& name, const RunRecord& record,
                           const std::vector<std::string>& history_columns, int compression)
    : folder_(std::move(folder)), name_(name), dumps_(compression), xdmf_(name + ".vtkhdf") {
  std::error_code error;
  std::filesystem::create_directories(folder_, error);
  if (error) throw FileError(folder_, "cannot make the folder: " + error.message());
  Hdf5File file = Hdf5File::create(current(".vtkhdf"));
  write_record(file, record);
  create_history(file, history_columns);
  file.close();
  create_history_csv(current(".history.csv"), history_columns);
}

std::filesystem::path ResultWriter::current(const char* ending) const {
  std::filesystem::path result = path(ending);
  if (!published_) result += ".partial";
  return result;
}

/// The old description goes before the old data does: it must not describe the new.
void ResultWriter::publish() {
  remove_file(xdmf());
  remove_file(summary());
  remove_file(history_csv());
  rename_file(current(".vtkhdf"), vtkhdf());
  rename_file(current(".history.csv"), history_csv());
  published_ = true;
}

void ResultWriter::write(const Snapshot& snapshot) {
  Hdf5File file = Hdf5File::open_to_append(current(".vtkhdf"));
  const StoredDump dump = dumps_.append(file, snapshot);
  file.close();
  if (!published_) publish();
  xdmf_.append(dump);
  xdmf_.write(xdmf());
}

void ResultWriter::write(History& history) {
  if (history.pending_rows() == 0) return;
  Hdf5File file = Hdf5File::open_to_append(current(".vtkhdf"));
  append_history(file, history);
  file.close();
  append_history_csv(current(".history.csv"), history);
  history.clear_pending();
}

void ResultWriter::write(const Summary& end_state) const { write_summary(summary(), end_state); }

}  // namespace brio
