/// A result folder belongs to one writer at a time, and nothing in it is written through a link.

#include <gtest/gtest.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <sstream>

#include "io/files/folder_lock.hpp"
#include "io/files/text_file.hpp"
#include "io/results/read_info.hpp"
#include "io/results/write_results.hpp"
#include "tests/io/files/faults.hpp"
#include "tests/io/results/result_scene.hpp"
#include "tests/io/text_of.hpp"

namespace brio {
namespace {

namespace fs = std::filesystem;
using test::Folder;
using test::mixed_snapshot;

template <class Work>
std::string fault_of(const Work& work) {
  try {
    work();
  } catch (const FileError& error) {
    return error.what();
  }
  return "no error";
}

ResultWriter writer_of(const fs::path& folder, const ResultSettings& settings = {}) {
  return {folder, "scene", {"title", "deck.yaml", "text", {}, "0.1.0", 1}, {"time", "energy"}, settings};
}

void write_run(const fs::path& folder, int dumps, const ResultSettings& settings = {}) {
  ResultWriter writer = writer_of(folder, settings);
  History history({"time", "energy"});
  for (int dump = 0; dump < dumps; ++dump) {
    writer.write(mixed_snapshot(dump, 0));
    history.append(std::vector<double>{1.0 * dump, 1});
    writer.write(history);
  }
  writer.write(Summary{});
}

std::size_t dumps_in(const fs::path& folder) { return read_info(folder).times.size(); }

TEST(FolderLock, RefusesASecondWriterAndNamesTheFirst) {
  const Folder folder;
  ResultWriter first = writer_of(folder.path());
  first.write(mixed_snapshot(0, 0));
  const std::string message = fault_of([&] { writer_of(folder.path()); });
  EXPECT_NE(message.find("process " + std::to_string(getpid()) + " on "), std::string::npos) << message;
  EXPECT_NE(message.find(", since 2"), std::string::npos) << message;
  first.write(mixed_snapshot(1, 0));
  EXPECT_EQ(dumps_in(folder.path()), 2u);
}

TEST(FolderLock, IsGoneWithItsOwnerHoweverItEnds) {
  const Folder folder;
  { const FolderLock lock(folder.path()); }
  EXPECT_TRUE(fs::is_empty(folder.path()));
  const pid_t child = fork();
  if (child == 0) {
    const FolderLock lock(folder.path());
    raise(SIGKILL);
  }
  waitpid(child, nullptr, 0);
  EXPECT_TRUE(fs::exists(folder / ".brio.lock")) << "the file stays, and means nothing";
  const FolderLock lock(folder.path());
  EXPECT_NE(test::text_of(folder / ".brio.lock").find(std::to_string(getpid())), std::string::npos);
}

/// A child process of a dead owner holds the lock a moment longer.
TEST(FolderLock, WaitsForTheChildrenOfADeadOwner) {
  const Folder folder;
  const pid_t owner = fork();
  if (owner == 0) {
    const FolderLock lock(folder.path());
    const pid_t heir = fork();
    if (heir == 0) usleep(200000);
    _exit(0);
  }
  waitpid(owner, nullptr, 0);
  EXPECT_EQ(fault_of([&] { const FolderLock lock(folder.path()); }), "no error");
}

TEST(FolderLock, OfManyAtOnceOneGetsIt) {
  const Folder folder;
  for (int repeat = 0; repeat < 20; ++repeat) {
    int ready[2], go[2];
    ASSERT_EQ(pipe(ready) + pipe(go), 0);
    std::vector<pid_t> children;
    for (int i = 0; i < 6; ++i) {
      const pid_t child = fork();
      if (child == 0) {
        close(go[1]);
        char byte = 0;
        (void)!read(go[0], &byte, 1);  // until the other end closes
        int result = 4;
        try {
          const FolderLock lock(folder.path());
          result = 0;
          usleep(20000);
          _exit(result);
        } catch (const FileError&) {
        }
        _exit(result);
      }
      children.push_back(child);
    }
    close(go[0]);
    close(go[1]);
    int winners = 0;
    for (const pid_t child : children) {
      int status = 0;
      waitpid(child, &status, 0);
      winners += WEXITSTATUS(status) == 0 ? 1 : 0;
    }
    close(ready[0]);
    close(ready[1]);
    EXPECT_GE(winners, 1);
  }
}

TEST(FolderLock, OfAFolderThatAnotherTookIsNoLongerGood) {
  const Folder folder;
  const fs::path results = folder / "results";
  ResultWriter first = writer_of(results);
  first.write(mixed_snapshot(0, 0));
  fs::rename(results, folder / "elsewhere");
  write_run(results, 3);
  EXPECT_NE(fault_of([&] { first.write(mixed_snapshot(1, 0)); }).find("moved, removed or taken"),
            std::string::npos);
  EXPECT_EQ(dumps_in(results), 3u);
  EXPECT_EQ(verify_result(results), verify_result(results / "scene.vtkhdf"));
}

TEST(EarlierResults, AreMovedAsideAndSaid) {
  const Folder folder;
  const fs::path results = folder / "results", aside = folder / "results.previous";
  std::vector<bool> told;
  const ResultSettings settings{.moved_aside = [&](const fs::path& to, bool lost) {
    EXPECT_EQ(to, fs::canonical(aside));
    told.push_back(lost);
  }};
  write_run(results, 1, settings);
  EXPECT_TRUE(told.empty());
  std::ofstream(results / "notes.txt") << "mine";
  write_run(results, 2, settings);
  EXPECT_EQ(told, (std::vector<bool>{false}));
  EXPECT_EQ(dumps_in(results), 2u);
  EXPECT_EQ(dumps_in(aside), 1u);
  for (const char* name : {"scene.vtkhdf", "scene.xdmf2", "scene.history.csv", "scene.summary.json"})
    EXPECT_TRUE(fs::exists(aside / name)) << name;
  write_run(results, 3, settings);
  EXPECT_EQ(told, (std::vector<bool>{false, true})) << "the first are lost now";
  EXPECT_EQ(dumps_in(aside), 2u);
  EXPECT_EQ(test::text_of(results / "notes.txt"), "mine");
}

TEST(EarlierResults, AreReplacedOnDemand) {
  const Folder folder;
  const fs::path results = folder / "results";
  write_run(results, 1);
  write_run(results, 2, {.overwrite = true});
  EXPECT_EQ(dumps_in(results), 2u);
  EXPECT_FALSE(fs::exists(folder / "results.previous"));
}

TEST(EarlierResults, AreNotMovedThroughALink) {
  const Folder folder;
  const fs::path results = folder / "results";
  write_run(results, 1);
  fs::create_directories(folder / "other");
  fs::create_directory_symlink(folder / "other", folder / "results.previous");
  EXPECT_NE(fault_of([&] { write_run(results, 2); }).find("symbolic link"), std::string::npos);
  EXPECT_EQ(dumps_in(results), 1u);
  EXPECT_TRUE(fs::is_empty(folder / "other"));
}

/// Links under every name that a run writes, also dangling ones, which would be created.
TEST(Links, AreReplacedAndNotFollowed) {
  const Folder folder;
  const fs::path results = folder / "results", victim = folder / "victim", absent = folder / "absent";
  fs::create_directories(results);
  std::ofstream(victim) << "precious";
  int which = 0;
  for (const char* name :
       {"scene.vtkhdf.partial", "scene.history.csv.partial", "scene.history.csv.partial.partial",
        "scene.xdmf2.partial", "scene.summary.json.partial", "scene.xdmf2", "scene.summary.json"})
    fs::create_symlink(which++ % 2 == 0 ? victim : absent, results / name);
  write_run(results, 2);
  EXPECT_EQ(test::text_of(victim), "precious");
  EXPECT_FALSE(fs::exists(absent));
  EXPECT_EQ(dumps_in(results), 2u);
  for (const char* ending : {".vtkhdf", ".xdmf2", ".history.csv", ".summary.json"})
    EXPECT_TRUE(fs::is_regular_file(fs::symlink_status(results / (std::string("scene") + ending)))) << ending;
}

TEST(Links, ThatAppearDuringTheRunAreRefused) {
  const Folder folder;
  const fs::path results = folder / "results", victim = folder / "victim";
  ResultWriter writer = writer_of(results);
  writer.write(mixed_snapshot(0, 0));
  fs::rename(results / "scene.vtkhdf", victim);
  fs::create_symlink(victim, results / "scene.vtkhdf");
  const std::string before = test::text_of(victim);
  EXPECT_NE(fault_of([&] { writer.write(mixed_snapshot(1, 0)); }).find("cannot open"), std::string::npos);
  EXPECT_EQ(test::text_of(victim), before);
}

TEST(Links, InPlaceOfTheLockAreRefused) {
  const Folder folder;
  fs::create_symlink(folder / "absent", folder / ".brio.lock");
  EXPECT_NE(fault_of([&] { const FolderLock lock(folder.path()); }).find("cannot lock"), std::string::npos);
  EXPECT_FALSE(fs::exists(folder / "absent"));
}

TEST(SmallFiles, OtherThanRegularOnesAreRefusedWithoutWaiting) {
  const Folder folder;
  ASSERT_EQ(mkfifo((folder / "pipe").c_str(), 0600), 0);
  EXPECT_NE(fault_of([&] { read_small_file(folder / "pipe"); }).find("not a regular file"),
            std::string::npos);
  EXPECT_NE(fault_of([&] { read_small_file("/dev/zero"); }).find("not a regular file"), std::string::npos);
  EXPECT_NE(fault_of([&] { read_small_file(folder.path()); }).find("not a regular file"), std::string::npos);
}

/// By calls of fsync and fdatasync.
TEST(Sync, IsForcedWhenItIsWanted) {
  const Folder folder;
  const auto syncs = [&](Sync sync, const auto& work) {
    ResultWriter writer = writer_of(folder / "results", {.sync = sync, .overwrite = true});
    writer.write(mixed_snapshot(0, 0));
    History history({"time", "energy"});
    history.append(std::vector<double>{0, 1});
    test::plan_fault(test::Fault::none, 0);
    work(writer, history);
    return test::syncs_since_plan();
  };
  const auto dump = [](ResultWriter& writer, History&) { writer.write(mixed_snapshot(1, 0)); };
  const auto row = [](ResultWriter& writer, History& history) { writer.write(history); };
  const auto end = [](ResultWriter& writer, History&) { writer.write(Summary{}); };
  EXPECT_EQ(syncs(Sync::never, dump) + syncs(Sync::never, row) + syncs(Sync::never, end), 0);
  EXPECT_EQ(syncs(Sync::end, dump) + syncs(Sync::end, row), 0);
  EXPECT_EQ(syncs(Sync::end, end), 5) << "three files, the summary, the folder";
  EXPECT_EQ(syncs(Sync::dumps, dump), 8)
      << "before and after each of three commits, the description, the folder";
  EXPECT_EQ(syncs(Sync::dumps, row), 5) << "before and after each of two commits, the table as text";
  EXPECT_EQ(syncs(Sync::dumps, end), 5);
}

}  // namespace
}  // namespace brio
