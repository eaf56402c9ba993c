/// A result file must read up to its last complete dump whatever happens to the process or the disk.

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <fstream>
#include <random>
#include <sstream>
#include <thread>

#include "io/files/hdf5_file.hpp"
#include "io/results/dump_checksums.hpp"
#include "io/results/write_results.hpp"
#include "src/base/index.hpp"
#include "tests/io/files/faults.hpp"
#include "tests/io/results/result_scene.hpp"
#include "tests/io/text_of.hpp"

namespace brio {
namespace {

using test::Fault;
using test::Folder;
using test::plan_fault;

const std::vector<std::string> two_columns{"time", "kinetic_energy"};

/// As many points as rows in a chunk, so that every dump adds a chunk to every table and index nodes split
/// soon.
Snapshot cloud(int dump) {
  constexpr std::size_t count = 256;
  Snapshot s;
  s.time = dump;
  s.topology.offset = {0};
  for (std::size_t i = 0; i < count; ++i) {
    test::add_cell(s.topology, vertex_cell, {static_cast<std::int64_t>(i)});
  }
  s.points = test::field_values(dump, 0, count, 3);
  s.point_fields = {{"velocity", 3, test::field_values(dump, 1, count, 3)}};
  s.cell_fields = {{"stress", 6, test::field_values(dump, 2, count, 6)}};
  return s;
}

void append_rows(History& history, int dump) {
  for (int i = 0; i < 3; ++i) history.append(std::vector<double>{dump + i / 3.0, 0.1 * i});
}

std::vector<double> joined(int dumps, const std::vector<double>& (*values)(const Snapshot&)) {
  std::vector<double> all;
  for (int dump = 0; dump < dumps; ++dump) {
    const Snapshot snapshot = cloud(dump);
    all.insert(all.end(), values(snapshot).begin(), values(snapshot).end());
  }
  return all;
}

/// Holds every dump that the file claims against what was written.
/// \return the number of dumps.
int verified_dumps(const std::filesystem::path& path) {
  const Hdf5File file = Hdf5File::open_to_read(path);
  const std::int64_t dumps = file.dimensions("/VTKHDF/Steps/Values").at(0);
  EXPECT_LE(dumps, file.read_integer_attribute("/VTKHDF/Steps", "NSteps"));
  const int count = static_cast<int>(dumps);
  for (int dump = 0; dump < count; ++dump) {
    EXPECT_EQ(file.read_rows("/VTKHDF/Steps/Values", dump, 1).at(0), dump);
    EXPECT_EQ(file.read_integers("/VTKHDF/Steps/PointDataOffsets/velocity", dump, 1).at(0), 256 * dump);
  }
  const auto same = [&](const char* table, const std::vector<double>& (*values)(const Snapshot&)) {
    EXPECT_TRUE(file.read_rows(table, 0, 256 * dumps) == joined(count, values))
        << table << ", dumps: " << dumps;
  };
  same("/VTKHDF/Points", [](const Snapshot& s) -> const std::vector<double>& { return s.points; });
  same("/VTKHDF/PointData/velocity",
       [](const Snapshot& s) -> const std::vector<double>& { return s.point_fields[0].values; });
  same("/VTKHDF/CellData/stress",
       [](const Snapshot& s) -> const std::vector<double>& { return s.cell_fields[0].values; });
  EXPECT_EQ(file.read_integers("/VTKHDF/Connectivity", 0, 256), cloud(0).topology.connectivity);
  EXPECT_EQ(verify_checksums(file), std::vector<std::string>{});
  return count;
}

/// The description is whole, describes no dump that is not there, and lacks no more than a tenth.
void verify_xdmf(const std::filesystem::path& path, int dumps) {
  const std::string text = test::text_of(path);
  ASSERT_TRUE(text.ends_with("</Grid>\n</Domain>\n</Xdmf>\n"));
  int described = 0;
  for (std::size_t at = text.find("<Time"); at != std::string::npos; at = text.find("<Time", at + 1))
    ++described;
  EXPECT_LE(described, dumps);
  EXPECT_GT(11 * described, 10 * (dumps - 1));
}

/// \return rows of the history, compared with those written.
int verified_rows(const std::filesystem::path& path) {
  const Hdf5File file = Hdf5File::open_to_read(path);
  const std::int64_t rows = file.dimensions("/history/values").at(0);
  const std::vector<double> values = file.read_rows("/history/values", 0, rows);
  for (std::int64_t row = 0; row < rows; ++row) {
    const std::int64_t batch = row / 3;
    const auto dump = static_cast<double>(batch);
    const double part = static_cast<double>(row % 3);
    EXPECT_EQ(values[2 * index(row)], dump + part / 3.0);
    EXPECT_EQ(values[2 * index(row) + 1], 0.1 * part);
  }
  return static_cast<int>(rows);
}

constexpr auto nothing = [] {};

/// Runs `before`, then `work` under a fault, in a process of its own. \return whether it lived to the end.
template <class Work, class Before = decltype(nothing)>
bool lives_through(Fault fault, int at, Work work, Before before = {}) {
  const pid_t child = fork();
  if (child == 0) {
    try {
      before();
      plan_fault(fault, at);
      work();
    } catch (...) {
      _exit(3);
    }
    _exit(0);
  }
  int status = 0;
  waitpid(child, &status, 0);
  EXPECT_TRUE(WIFSIGNALED(status) || WEXITSTATUS(status) == 0);
  return WIFEXITED(status);
}

/// A writer after some dumps, and its folder as it was then.
struct Running {
  Folder folder, backup;
  ResultWriter writer{folder.path(), "scene", {}, two_columns};
  History history{two_columns};

  explicit Running(int dumps) {
    for (int dump = 0; dump < dumps; ++dump) write_dump(dump);
    copy(folder.path(), backup.path());
  }
  void write_dump(int dump) {
    writer.write(cloud(dump));
    append_rows(history, dump);
    writer.write(history);
  }
  void restore() { copy(backup.path(), folder.path()); }

  /// All but the lock, which a writer holds. A file that is there stays the same one, which a writer may have
  /// open.
  static void copy(const std::filesystem::path& from, const std::filesystem::path& to) {
    const auto is_lock = [](const auto& entry) { return entry.path().filename() == ".brio.lock"; };
    for (const auto& old : std::filesystem::directory_iterator(to))
      if (!is_lock(old) && !std::filesystem::exists(from / old.path().filename()))
        std::filesystem::remove(old.path());
    for (const auto& entry : std::filesystem::directory_iterator(from))
      if (!is_lock(entry))
        std::filesystem::copy_file(entry.path(), to / entry.path().filename(),
                                   std::filesystem::copy_options::overwrite_existing);
  }
};

/// Kill the process in place of every single operation of a dump. 64 chunks fill an index node: the next one
/// splits.
void kill_at_each_operation_of_dump(int before, bool is_file_open) {
  Running run(is_file_open ? before - 1 : before);
  run.writer.note_position();  // closes the file
  const auto open_file = [&] {
    if (is_file_open) run.write_dump(before - 1);
  };
  int at = 0;
  int reached = before;
  for (bool alive = false; !alive; ++at) {
    SCOPED_TRACE(testing::Message() << "killed at operation " << at << " of dump " << before);
    run.restore();
    alive = lives_through(
        Fault::kill, at, [&] { run.write_dump(before); }, open_file);
    const int dumps = verified_dumps(run.writer.vtkhdf());
    EXPECT_GE(dumps, reached);  // once the new dump is there, it stays
    EXPECT_LE(dumps, before + 1);
    reached = dumps;
    verify_xdmf(run.writer.xdmf(), dumps);
    const int rows = verified_rows(run.writer.vtkhdf());
    EXPECT_TRUE(rows == 3 * before || rows == 3 * before + 3);
    if (testing::Test::HasFailure()) return;
  }
  EXPECT_GT(at, 20);
  EXPECT_EQ(reached, before + 1);
}

TEST(KilledWriterSlow, LeavesTheDumpsBeforeWhereverItDies) {
  for (const int before : {2, 64, 65}) kill_at_each_operation_of_dump(before, true);
}

TEST(KilledWriterSlow, LeavesTheDumpsBeforeAFileThatItOpens) {
  for (const int before : {1, 64}) kill_at_each_operation_of_dump(before, false);
}

/// Else a kill could leave one half as it was: then its count knows rows whose keys are not there.
TEST(KilledWriter, FindsNoIndexNodeOfATableAcrossTwoPages) {
  const Folder folder;
  ResultWriter writer(folder.path(), "scene", {}, two_columns);
  for (int dump = 0; dump < 130; ++dump) writer.write(cloud(dump));
  writer.note_position();  // closes the file
  const std::string bytes = test::text_of(writer.vtkhdf());
  const std::string_view signature("TREE\x01", 5);  // then level, number of children, two neighbours
  constexpr std::size_t page = 4096;
  int nodes = 0;
  for (std::size_t at = bytes.find(signature); at != std::string::npos; at = bytes.find(signature, at + 1)) {
    ++nodes;
    EXPECT_EQ(at % page, 0U) << "node at byte " << at;
  }
  EXPECT_GT(nodes, 20);
}

/// A compressed chunk that is written again may move; so none is.
TEST(KilledWriter, LeavesCompressedDumpsWhereverItDies) {
  const Folder folder, backup;
  constexpr int before = 3;
  ResultWriter writer(folder.path(), "scene", {}, two_columns, {.compression = 6});
  for (int dump = 0; dump < before; ++dump) writer.write(test::mixed_snapshot(dump, 0));
  writer.note_position();  // closes the file
  Running::copy(folder.path(), backup.path());
  int at = 0;
  for (bool alive = false; !alive; ++at) {
    Running::copy(backup.path(), folder.path());
    alive = lives_through(Fault::kill, at, [&] { writer.write(test::mixed_snapshot(before, 0)); });
    const Hdf5File file = Hdf5File::open_to_read(writer.vtkhdf());
    for (std::int64_t dump = 0; dump < file.dimensions("/VTKHDF/Steps/Values").at(0); ++dump) {
      const Snapshot expected = test::mixed_snapshot(static_cast<int>(dump), 0);
      const auto row = file.read_integers("/VTKHDF/Steps/CellDataOffsets/stress", dump, 1).at(0);
      ASSERT_EQ(file.read_rows("/VTKHDF/CellData/stress", row, 8), expected.cell_fields[0].values)
          << "dump " << dump << ", killed at operation " << at;
    }
    ASSERT_EQ(verify_checksums(file), std::vector<std::string>{});
  }
  EXPECT_GT(at, 20);
}

/// Until the first dump is there, the results of the run before stay as they are; then they are in the folder
/// beside, or partly here and partly there, but never lost.
TEST(KilledWriter, LosesNothingOfTheEarlierRun) {
  const Folder backup, folder;
  const auto results = folder / "results", aside = folder / "results.previous";
  {
    Running run(2);
    run.writer.write(Summary{});
    Running::copy(run.folder.path(), backup.path());
  }
  int at = 0;
  for (bool alive = false; !alive; at += 3) {
    SCOPED_TRACE(testing::Message() << "killed at operation " << at);
    std::filesystem::remove_all(aside);
    std::filesystem::remove_all(results);
    std::filesystem::create_directories(results);
    Running::copy(backup.path(), results);
    alive = lives_through(Fault::kill, at, [&] {
      ResultWriter again(results, "scene", {}, two_columns);
      again.write(cloud(0));
    });
    const bool moved = std::filesystem::exists(aside / "scene.vtkhdf");
    EXPECT_EQ(verified_dumps((moved ? aside : results) / "scene.vtkhdf"), 2);
    for (const char* name : {"scene.xdmf2", "scene.summary.json", "scene.history.csv"}) {
      const bool is_aside = std::filesystem::exists(aside / name);
      EXPECT_EQ(test::text_of((is_aside ? aside : results) / name), test::text_of(backup / name)) << name;
    }
    if (moved) {
      EXPECT_FALSE(std::filesystem::exists(results / "scene.summary.json"));
      if (std::filesystem::exists(results / "scene.vtkhdf")) verified_dumps(results / "scene.vtkhdf");
    }
    if (HasNonfatalFailure()) return;
  }
  EXPECT_GT(at, 30);
  EXPECT_EQ(verified_dumps(results / "scene.vtkhdf"), 1);
  EXPECT_EQ(verified_dumps(aside / "scene.vtkhdf"), 2);
}

TEST(KilledWriter, LeavesTheDumpsBeforeAtRandomMoments) {
  std::mt19937 random(1);
  std::uniform_int_distribution<int> microseconds(2000, 60000);
  int largest = 0;
  for (int repeat = 0; repeat < 12; ++repeat) {
    const Folder folder;
    const pid_t child = fork();
    if (child == 0) {
      ResultWriter writer(folder.path(), "scene", {}, two_columns);
      for (int dump = 0;; ++dump) writer.write(cloud(dump));
    }
    std::this_thread::sleep_for(std::chrono::microseconds(microseconds(random)));
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
    if (!std::filesystem::exists(folder / "scene.vtkhdf")) continue;
    largest = std::max(largest, verified_dumps(folder / "scene.vtkhdf"));
  }
  EXPECT_GT(largest, 0);
}

TEST(FullDisk, TakesBackOnlyTheDumpThatDidNotFit) {
  for (const int before : {1, 64}) {
    int at = 0;
    for (bool failed = true; failed; at += 3) {
      SCOPED_TRACE(testing::Message() << "full at operation " << at << " of dump " << before);
      Running run(before);
      plan_fault(Fault::no_space, at);
      try {
        run.writer.write(cloud(before));
        failed = false;
      } catch (const FileError& error) {
        EXPECT_NE(std::string(error.what()).find("No space left on device"), std::string::npos)
            << error.what();
        EXPECT_NE(std::string(error.what()).find(run.folder.path().string()), std::string::npos)
            << error.what();
      }
      plan_fault(Fault::none, 0);
      const int dumps = verified_dumps(run.writer.vtkhdf());
      EXPECT_GE(dumps, before);
      if (!failed) {
        EXPECT_EQ(dumps, before + 1);
      }
      verify_xdmf(run.writer.xdmf(), dumps);
      if (HasNonfatalFailure()) return;
    }
    EXPECT_GT(at, 20);
  }
}

TEST(FullDisk, LeavesTheHistoryWithItsRowsBefore) {
  Running run(2);
  const std::string csv = test::text_of(run.writer.history_csv());
  for (int at = 0; at < 40; ++at) {
    run.restore();
    History history(two_columns);
    append_rows(history, 2);
    plan_fault(Fault::no_space, at);
    bool failed = false;
    try {
      run.writer.write(history);
    } catch (const FileError&) {
      failed = true;
    }
    plan_fault(Fault::none, 0);
    const int rows = verified_rows(run.writer.vtkhdf());
    if (failed) {
      EXPECT_TRUE(rows == 6 || rows == 9);
      EXPECT_EQ(test::text_of(run.writer.history_csv()), csv);
    } else {
      EXPECT_EQ(rows, 9);
      return;
    }
  }
  FAIL() << "the disk was never large enough";
}

/// The limit of the system, not a fault of ours: files may grow to 1 MB.
TEST(FullDisk, LimitOfTheFileSizeIsReportedAndTheFileReads) {
  const Folder folder;
  const pid_t child = fork();
  if (child == 0) {
    std::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{1 << 20, 1 << 20};
    if (setrlimit(RLIMIT_FSIZE, &limit) != 0) _exit(1);
    try {
      ResultWriter writer(folder.path(), "scene", {}, two_columns);
      for (int dump = 0; dump < 1000; ++dump) writer.write(cloud(dump));
    } catch (const FileError& error) {
      _exit(std::string(error.what()).find("File too large") == std::string::npos ? 2 : 42);
    }
    _exit(0);
  }
  int status = 0;
  waitpid(child, &status, 0);
  EXPECT_EQ(WEXITSTATUS(status), 42);
  const int dumps = verified_dumps(folder / "scene.vtkhdf");
  EXPECT_GT(dumps, 20);
  verify_xdmf(folder / "scene.xdmf2", dumps);
}

/// As somebody whom permissions concern.
class WithoutPrivileges {
 public:
  WithoutPrivileges() : user_(geteuid()) {
    constexpr uid_t nobody = 65534;
    if (user_ == 0) {
      EXPECT_EQ(seteuid(nobody), 0);
    }
  }
  ~WithoutPrivileges() { EXPECT_EQ(seteuid(user_), 0); }
  WithoutPrivileges(const WithoutPrivileges&) = delete;
  WithoutPrivileges& operator=(const WithoutPrivileges&) = delete;

 private:
  uid_t user_;
};

template <class Work>
std::string message_of_file_error(Work work) {
  try {
    work();
  } catch (const FileError& error) {
    return error.what();
  }
  return "no error";
}

TEST(ExtremesReadOnlyFolder, IsAnErrorBeforeAnythingIsComputed) {
  using std::filesystem::perms;
  const Folder folder;
  std::filesystem::permissions(folder.path(), perms::owner_read | perms::owner_exec | perms::others_read |
                                                  perms::others_exec | perms::group_read | perms::group_exec);
  const WithoutPrivileges nobody;
  const std::string existing =
      message_of_file_error([&] { ResultWriter(folder.path(), "scene", {}, two_columns); });
  EXPECT_EQ(existing, folder.path().string() + ": cannot lock the folder: Permission denied");
  const std::string missing =
      message_of_file_error([&] { ResultWriter(folder / "new", "scene", {}, two_columns); });
  EXPECT_NE(missing.find("cannot make the folder: Permission denied"), std::string::npos) << missing;
}

TEST(ResultFolder, ThatIsAFileIsAnError) {
  const Folder folder;
  std::ofstream(folder / "taken") << "text";
  const std::string message =
      message_of_file_error([&] { ResultWriter(folder / "taken", "scene", {}, two_columns); });
  EXPECT_NE(message.find("taken: cannot make the folder"), std::string::npos) << message;
  EXPECT_EQ(test::text_of(folder / "taken"), "text");
}

TEST(ResultFolder, TakenAwayDuringTheRunIsAnError) {
  Running run(1);
  std::filesystem::remove_all(run.folder.path());
  const std::string message = message_of_file_error([&] { run.writer.write(cloud(1)); });
  EXPECT_NE(message.find("the folder was moved, removed or taken"), std::string::npos) << message;
}

/// Not to the file that was open, which nobody sees any more.
TEST(ResultFolder, ResultFileTakenAwayDuringTheRunIsAnError) {
  Running run(1);
  std::filesystem::rename(run.writer.vtkhdf(), run.folder / "moved");
  const std::string message = message_of_file_error([&] { run.writer.write(cloud(1)); });
  EXPECT_NE(message.find("scene.vtkhdf: cannot open the file: No such file"), std::string::npos) << message;
  EXPECT_EQ(verified_dumps(run.folder / "moved"), 1);
}

/// HDF5 opens one file once for both: what one takes back is taken from the other too.
TEST(Transaction, OfAFileThatAnotherHasTakenBackIsAnError) {
  const Folder folder;
  const auto path = folder / "table.h5";
  {
    Hdf5File file = Hdf5File::create(path);
    file.create_table("/table", {H5T_IEEE_F64LE, 0, 1});
    file.close();
  }
  Hdf5File kept = Hdf5File::open_to_append(path);
  { const Hdf5File taken_back = Hdf5File::open_to_append(path); }
  const double value = 1;
  const std::string message = message_of_file_error([&] {
    kept.append_rows("/table", 1, H5T_NATIVE_DOUBLE, &value);
    kept.commit();
  });
  EXPECT_NE(message.find("table.h5: cannot"), std::string::npos) << message;
}

/// One row a chunk, so that index nodes of one and two levels split (the first at row 64, the second near row
/// 3700), and a commit, but for the rows between. Where that takes more operations than usual, the process is
/// killed in place of every one of them.
TEST(TransactionSlow, NoRowIsLostWhereverAnIndexNodeSplits) {
  constexpr int usual_operations = 5;
  const Folder folder;
  const auto file_path = folder / "table.h5";
  const auto before_path = folder / "before.h5";
  const auto victim_path = folder / "victim.h5";
  constexpr int first_between = 150, last_between = 3650;
  const auto append = [](const std::filesystem::path& path, int first, int last) {
    Hdf5File file = Hdf5File::open_to_append(path);
    for (double value = first; value <= last; ++value)
      file.append_rows("/table", 1, H5T_NATIVE_DOUBLE, &value);
    file.close();
  };
  {
    Hdf5File file = Hdf5File::create(file_path);
    file.create_table("/table", {H5T_IEEE_F64LE, 0, 1});
    file.close();
  }
  const auto copy = [](const std::filesystem::path& from, const std::filesystem::path& to) {
    std::filesystem::copy_file(from, to, std::filesystem::copy_options::overwrite_existing);
  };
  int splits = 0;
  for (int row = 0; row < 3800; ++row) {
    if (row == first_between) {
      append(file_path, first_between, last_between);
      row = last_between;
      continue;
    }
    copy(file_path, before_path);
    plan_fault(Fault::none, 0);
    append(file_path, row, row);
    const int operations = test::operations_since_plan();
    if (operations <= usual_operations) continue;
    ++splits;
    for (int at = 0; at < operations; ++at) {
      copy(before_path, victim_path);
      EXPECT_FALSE(lives_through(Fault::kill, at, [&] { append(victim_path, row, row); }));
      const Hdf5File file = Hdf5File::open_to_read(victim_path);
      const std::int64_t rows = file.dimensions("/table").at(0);
      ASSERT_TRUE(rows == row || rows == row + 1);
      const std::vector<double> values = file.read_rows("/table", 0, row);
      for (int i = 0; i < row; ++i) {
        ASSERT_EQ(values[index(i)], i) << "row " << row << ", killed at operation " << at;
      }
    }
  }
  EXPECT_GT(splits, 10);
}

}  // namespace
}  // namespace brio
