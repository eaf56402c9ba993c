#include "io/results/write_results.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <system_error>
#include <utility>

#include "io/files/hdf5_file.hpp"
#include "io/files/text_file.hpp"
#include "io/results/dump_checksums.hpp"
#include "io/results/write_history.hpp"
#include "io/results/write_summary.hpp"

namespace brio {
namespace {

/// The data last of all: what describes them must not stand beside others.
constexpr std::array endings{".restart.h5", ".restart.previous.h5", ".xdmf2", ".summary.json",
                             ".log",        ".history.csv",         ".vtkhdf"};

}  // namespace

ResultWriter::ResultWriter(std::filesystem::path folder, const std::string& name, const RunRecord& record,
                           const std::vector<std::string>& history_columns, ResultSettings settings)
    : folder_(std::move(folder)),
      name_(name),
      settings_(std::move(settings)),
      dumps_(settings_.compression),
      xdmf_(name + ".vtkhdf") {
  if (!writes()) return;
  make_folder(folder_);
  lock_ = std::make_shared<const FolderLock>(folder_);
  Hdf5File file = Hdf5File::create(current(".vtkhdf"));
  write_record(file, record);
  create_history(file, history_columns);
  create_checksums(file);
  file.close();
  create_history_csv(current(".history.csv"), history_columns);
}

ResultWriter::ResultWriter(std::filesystem::path folder, const std::string& name, ResultSettings settings)
    : folder_(std::move(folder)),
      name_(name),
      settings_(std::move(settings)),
      lock_(settings_.writes ? std::make_shared<const FolderLock>(folder_) : nullptr),
      published_(true),
      dumps_(settings_.compression),
      xdmf_(name + ".vtkhdf") {}

void ResultWriter::note_position() {
  if (!writes()) return;
  lock_->check();
  close();
  if (xdmf_.is_behind()) xdmf_.write(xdmf(), sync_each_time());
  for (const std::filesystem::path& file : {vtkhdf(), history_csv()}) sync_to_disk(file);
  const Hdf5File file = Hdf5File::open_to_read(vtkhdf());
  tables_ = file.tables();
  history_bytes_ = std::filesystem::file_size(history_csv());
}

void ResultWriter::return_to_position() {
  if (!writes()) return;
  lock_->check();
  if (std::filesystem::file_size(history_csv()) < history_bytes_)
    throw FileError(history_csv(), "is shorter than it was when the run was saved");
  {
    Hdf5File file = Hdf5File::open_to_append(vtkhdf(), settings_.sync != Sync::never);
    for (const TableRows& table : tables_) file.expect_rows(table);
    file.write_attribute("/VTKHDF/Steps", "NSteps", dumps_.dumps());
    file.commit();
    for (const TableRows& table : tables_) file.truncate(table);
    file.close();
  }
  std::error_code error;
  std::filesystem::resize_file(history_csv(), history_bytes_, error);
  if (error) throw FileError(history_csv(), "cannot shorten it: " + error.message());
  xdmf_.write(xdmf(), sync_each_time());
  remove_file(summary());
}

std::filesystem::path ResultWriter::current(const char* ending) const {
  std::filesystem::path result = path(ending);
  if (!published_) result += ".partial";
  return result;
}

void ResultWriter::remove_earlier() const {
  for (const char* ending : endings) remove_file(path(ending));
}

/// Wherever this is interrupted, no description stands beside data of another run, and the earlier results
/// are all there.
void ResultWriter::move_earlier_aside() const {
  const auto exists = [](const std::filesystem::path& file) {
    return std::filesystem::exists(std::filesystem::symlink_status(file));
  };
  if (std::none_of(endings.begin(), endings.end(), [&](const char* end) { return exists(path(end)); }))
    return;
  std::filesystem::path aside = std::filesystem::canonical(folder_);
  aside += ".previous";
  make_folder(aside);
  if (std::filesystem::is_symlink(aside))
    throw FileError(aside, "is a symbolic link: the results of the earlier run are not moved there");
  const FolderLock lock(aside);
  bool lost = false;
  for (const char* ending : endings) {
    const std::filesystem::path old = aside / (name_ + ending);
    lost = lost || exists(old);
    remove_file(old);
  }
  for (const char* ending : endings)
    if (exists(path(ending))) rename_file(path(ending), aside / (name_ + ending));
  if (settings_.sync != Sync::never) sync_to_disk(aside);
  if (settings_.moved_aside) settings_.moved_aside(aside, lost);
}

void ResultWriter::publish() {
  settings_.overwrite ? remove_earlier() : move_earlier_aside();
  rename_file(current(".vtkhdf"), vtkhdf());
  rename_file(current(".history.csv"), history_csv());
  published_ = true;
  if (settings_.published) settings_.published();
  if (sync_each_time()) sync_to_disk(folder_);
}

// After a failure the file is closed, which takes it back to its last commit.
template <class Append>
void ResultWriter::transact(const Append& append) {
  lock_->check();
  const std::filesystem::path path = current(".vtkhdf");
  std::shared_ptr<Hdf5File> file = std::exchange(file_.file, nullptr);
  if (file && (file->path() != path || !file->is_at_path())) file.reset();
  if (!file) file = std::make_shared<Hdf5File>(Hdf5File::open_to_append(path, sync_each_time()));
  append(*file);
  file->commit();
  file_.file = std::move(file);
}

void ResultWriter::close() {
  if (const std::shared_ptr<Hdf5File> file = std::exchange(file_.file, nullptr)) file->close();
}

void ResultWriter::append(Hdf5File& file, const Snapshot& snapshot) {
  const StoredDump dump = dumps_.append(file, snapshot);
  if (!published_) publish();
  xdmf_.append(dump);
  if (xdmf_.is_due()) xdmf_.write(xdmf(), sync_each_time());
}

void ResultWriter::append(Hdf5File& file, History& history) {
  append_history(file, history);
  file.commit();
  append_history_csv(current(".history.csv"), history, sync_each_time());
  history.clear_pending();
}

void ResultWriter::write(const Snapshot& snapshot) {
  if (!writes()) return;
  transact([&](Hdf5File& file) { append(file, snapshot); });
}

void ResultWriter::write(History& history) {
  if (!writes()) return history.clear_pending();
  if (history.pending_rows() == 0) return;
  transact([&](Hdf5File& file) { append(file, history); });
}

void ResultWriter::write(const Snapshot& snapshot, History& history) {
  if (!writes()) return history.clear_pending();
  transact([&](Hdf5File& file) {
    append(file, snapshot);
    if (history.pending_rows() > 0) append(file, history);
  });
}

void ResultWriter::write(const Summary& end_state) {
  if (!writes()) return;
  lock_->check();
  close();
  if (!published_) publish();  // a run that failed before its first dump has ended as well
  const bool sync = settings_.sync != Sync::never;
  if (xdmf_.is_behind()) xdmf_.write(xdmf(), sync_each_time());
  if (sync)
    for (const std::filesystem::path& file : {vtkhdf(), history_csv(), xdmf()})
      if (std::filesystem::exists(file)) sync_to_disk(file);
  write_summary(summary(), end_state, sync);
}

}  // namespace brio
