#pragma once
/// The result folder of a run:
///   NAME.vtkhdf        dumps as a transient VTKHDF unstructured grid, `/history`, `/deck`
///   NAME.xdmf2         the same dumps for ParaView versions that do not read a transient VTKHDF file, by
///   part;
///                      the last tenth of them when the run is saved or ends
///   NAME.history.csv   the history as a table
///   NAME.summary.json  the end state
///   NAME.log           what the program said, written by whoever runs it
///
/// Every call leaves complete files, so that a running job can be looked at; a process that is killed at
/// any moment leaves files that read up to the last complete dump, and a full disk takes back only the dump
/// that did not fit. The results of an earlier run under the same name stay until the first dump of the new
/// run is complete, and are then moved to the folder NAME.previous beside this one, or removed if that was
/// asked for; until then the new files end in `.partial`. Other files of the folder are not touched. A folder
/// in which another process writes is refused.

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "io/files/file_error.hpp"
#include "io/files/folder_lock.hpp"
#include "io/files/run_record.hpp"
#include "io/files/table_rows.hpp"
#include "io/results/write_vtkhdf.hpp"
#include "io/results/write_xdmf.hpp"
#include "src/deck/deck.hpp"
#include "src/output/history.hpp"
#include "src/output/snapshot.hpp"
#include "src/output/summary.hpp"

namespace brio {

class Hdf5File;

struct ResultSettings {
  bool writes = true;   ///< whether there are files at all: of several processes one writes
  int compression = 0;  ///< gzip level of points and fields; 0 is about ten times faster
  Sync sync = Sync::never;
  bool overwrite = false;  ///< whether results of an earlier run are removed, not moved aside
  /// Called when results of an earlier run were moved aside. \param lost whether others, which had been moved
  /// aside before, were removed for them.
  std::function<void(const std::filesystem::path& to, bool lost)> moved_aside{};
  std::function<void()> published{};  ///< called when the files have their names, at the first dump
};

class ResultWriter {
 public:
  /// Makes the folder and the files under their `.partial` names, so that a folder that cannot be written is
  /// known before anything is computed. Copies of a writer hold the folder together. \throws FileError
  ResultWriter(std::filesystem::path folder, const std::string& name, const RunRecord& record,
               const std::vector<std::string>& history_columns, ResultSettings settings = {});

  bool writes() const { return settings_.writes; }

  /// Goes on with the results that a saved run has written to a folder: restored by `serialize`, then brought
  /// back by `return_to_position` to where they stood when it was saved.
  ResultWriter(std::filesystem::path folder, const std::string& name, ResultSettings settings);

  /// Of what is written: all of it is on the disk. Call before the writer is saved. \throws FileError
  void note_position();
  /// Take back what was written after the run was saved. \throws FileError where less is there
  void return_to_position();
  /// Saved and restored (src/base/state_archive.hpp).
  template <class Archive>
  void serialize(Archive& archive) {
    archive(dumps_, xdmf_, tables_, history_bytes_);
  }

  /// Append a dump. \throws FileError; dumps before stay readable.
  void write(const Snapshot& snapshot);

  /// Append the pending rows to the result file and the CSV file, and clear them. \throws FileError
  void write(History& history);

  /// Both, as one after the other.
  void write(const Snapshot& snapshot, History& history);

  /// The end of the run. \throws FileError
  void write(const Summary& summary);

  std::filesystem::path vtkhdf() const { return path(".vtkhdf"); }
  std::filesystem::path xdmf() const { return path(".xdmf2"); }
  std::filesystem::path history_csv() const { return path(".history.csv"); }
  std::filesystem::path summary() const { return path(".summary.json"); }
  std::filesystem::path log() const { return path(".log"); }

 private:
  std::filesystem::path path(const char* ending) const { return folder_ / (name_ + ending); }
  /// Where the file grows at present.
  std::filesystem::path current(const char* ending) const;
  /// The result file while it is open to append: HDF5 would read what it knows of it again for each dump.
  /// Copies open their own.
  struct OpenFile {
    OpenFile() = default;
    OpenFile(const OpenFile& /*other*/) {}
    OpenFile& operator=(const OpenFile& /*other*/) {
      file.reset();
      return *this;
    }
    ~OpenFile() = default;
    std::shared_ptr<Hdf5File> file;
  };

  template <class Append>
  void transact(const Append& append);
  void close();
  void append(Hdf5File& file, const Snapshot& snapshot);
  void append(Hdf5File& file, History& history);
  void publish();
  void remove_earlier() const;
  void move_earlier_aside() const;
  bool sync_each_time() const { return settings_.sync == Sync::dumps; }

  std::filesystem::path folder_;
  std::string name_;
  ResultSettings settings_;
  std::shared_ptr<const FolderLock> lock_;
  OpenFile file_;
  bool published_ = false;
  VtkhdfWriter dumps_;
  XdmfWriter xdmf_;
  std::vector<TableRows> tables_;    ///< of the result file, when the run was saved
  std::uint64_t history_bytes_ = 0;  ///< of the CSV file, likewise
};

}  // namespace brio
