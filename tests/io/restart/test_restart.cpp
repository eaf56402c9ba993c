// A saved run that goes on writes the results of one that was not interrupted; damaged restart files are
// refused by their checksums, and the one before is taken.

#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "io/restart/deck_difference.hpp"
#include "io/restart/restart_file.hpp"
#include "io/results/read_info.hpp"
#include "io/results/read_result.hpp"
#include "io/run/run_deck.hpp"
#include "io/yaml/deck_error.hpp"

namespace brio::test {

namespace {

namespace fs = std::filesystem;

// Plates that shear a bar: plastic, contact with friction, deletion, walls, a rigid body that is driven.
constexpr const char* deck_text = R"(
materials:
  steel: {model: power_law_hardening, density: 7800, youngs_modulus: 2e11, poissons_ratio: 0.3, yield_stress: 2e8,
          hardening_constant: 5e8, hardening_exponent: 0.5}
parts:
  bar: {mesh: {box: {size: [0.4, 0.1, 0.1], elements: [8, 2, 2]}}, element: hex8, material: steel,
        deletion: {plastic_strain: 0.02}}
  hammer: {mesh: {box: {size: [0.1, 0.12, 0.05], elements: [2, 2, 1]}},
           placement: {translate: [0.1, 0, 0.0753]}, element: rigid, material: steel}
contact: {surfaces: [bar, hammer], friction: 0.2}
boundary_conditions: [{set: bar.xmin, fix: [x, y, z]}]
initial_conditions: [{part: hammer, velocity: [0, 0, -150]}]
time: {end: 4e-4}
output: {fields: {every: 1e-4}, history: {every: 1e-6}, restart: {every: 1.3e-4}}
)";

}  // namespace

class Restart : public testing::Test {
 protected:
  void SetUp() override {
    folder = fs::path(testing::TempDir()) /
             (std::string("restart_") + testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::remove_all(folder);
    fs::create_directories(folder);
    std::ofstream(folder / "bar.yaml") << deck_text;
  }
  void TearDown() override { fs::remove_all(folder); }

  RunOutcome run(const std::string& output, RunOptions options = {}) const {
    options.deck = folder / "bar.yaml";
    options.output = folder / output;
    return run_deck(options);
  }
  fs::path file(const std::string& output, const std::string& ending) const {
    return folder / output / ("bar" + ending);
  }
  static std::string content(const fs::path& path) {
    std::ostringstream text;
    text << std::ifstream(path, std::ios::binary).rdbuf();
    return text.str();
  }
  void flip(const fs::path& path, std::size_t place) const {
    std::fstream bytes(path, std::ios::in | std::ios::out | std::ios::binary);
    bytes.seekg(static_cast<std::streamoff>(place));
    const char c = static_cast<char>(bytes.get() ^ 0x10);
    bytes.seekp(static_cast<std::streamoff>(place));
    bytes.put(c);
  }
  void expect_same_results(const std::string& a, const std::string& b) const {
    EXPECT_FALSE(content(file(a, ".history.csv")).empty());
    EXPECT_TRUE(content(file(a, ".history.csv")) == content(file(b, ".history.csv")));
    EXPECT_TRUE(content(file(a, ".xdmf2")) == content(file(b, ".xdmf2")));
    const ResultReader one(file(a, ".vtkhdf")), other(file(b, ".vtkhdf"));
    ASSERT_EQ(one.times(), other.times());
    EXPECT_EQ(one.history().values, other.history().values);
    for (std::size_t dump = 0; dump < one.times().size(); ++dump) {
      for (const char* field :
           {"position", "velocity", "contact_force", "stress", "equivalent_plastic_strain"})
        EXPECT_EQ(one.field(field, dump).values, other.field(field, dump).values) << field << " " << dump;
      EXPECT_EQ(one.cells(dump).connectivity, other.cells(dump).connectivity);
    }
    EXPECT_NO_THROW(verify_result(file(b, ".vtkhdf")));
  }

  fs::path folder;
};

TEST_F(Restart, GoesOnInItsResultsWithTheSameBits) {
  const RunOutcome whole = run("whole");
  ASSERT_GT(whole.summary.deleted.total(), 0);
  fs::copy(folder / "whole", folder / "again");
  RunOptions options;
  options.restart = file("again", previous_restart_ending);
  options.threads = 2;
  const RunOutcome again = run("again", options);
  expect_same_results("whole", "again");
  EXPECT_EQ(again.summary.steps, whole.summary.steps);
  EXPECT_EQ(again.summary.energy.error_relative, whole.summary.energy.error_relative);
  EXPECT_EQ(again.summary.contact.comparisons, whole.summary.contact.comparisons);
  EXPECT_EQ(again.summary.contact.constraints_total, whole.summary.contact.constraints_total);
  EXPECT_EQ(again.summary.restarted_from, options.restart.string());
}

// A stopped run shows its last state as well, which one that goes on does not.
TEST_F(Restart, OfATerminatedRunLeavesNoTraceOfIt) {
  run("whole");
  const std::atomic<int> signal = SIGTERM;
  RunOptions options;
  options.stop = &signal;
  EXPECT_EQ(run("cut", options).summary.status, "terminated");
  EXPECT_EQ(ResultReader(file("cut", ".vtkhdf")).times().size(), 1u);
  RunOptions further;
  further.restart = file("cut", restart_ending);
  EXPECT_EQ(run("cut", further).summary.status, "finished");
  expect_same_results("whole", "cut");
}

TEST_F(Restart, StopsAfterATimeAndGoesOn) {
  run("whole");
  RunOptions options;
  options.stop_after_s = 1e-9;
  const RunOutcome stopped = run("cut", options);
  EXPECT_EQ(stopped.summary.status, "stopped");
  EXPECT_EQ(stopped.summary.exit_code, 0);
  for (int i = 0; i < 3; ++i) {  // one that is stopped at once stands where it stood
    options.restart = file("cut", restart_ending);
    EXPECT_EQ(run("cut", options).summary.steps, 0);
  }
  options.stop_after_s.reset();
  run("cut", options);
  expect_same_results("whole", "cut");
}

TEST_F(Restart, WritesElsewhereFromWhereItGoesOn) {
  run("whole");
  RunOptions options;
  options.restart = file("whole", previous_restart_ending);
  run("rest", options);
  const ResultReader whole(file("whole", ".vtkhdf")), rest(file("rest", ".vtkhdf"));
  EXPECT_GT(rest.times().front(), 1.3e-4);
  EXPECT_EQ(rest.times().back(), whole.times().back());
  EXPECT_EQ(rest.field("position", rest.times().size() - 1).values,
            whole.field("position", whole.times().size() - 1).values);
}

TEST_F(Restart, TakesTheOneBeforeWhereTheLastIsDamaged) {
  run("whole");
  for (const bool torn : {true, false}) {
    fs::remove_all(folder / "again");
    fs::copy(folder / "whole", folder / "again");
    const fs::path last = file("again", restart_ending);
    if (torn)
      fs::resize_file(last, fs::file_size(last) / 2);
    else
      flip(last, fs::file_size(last) / 2);
    RunOptions options;
    options.restart = last;
    std::string notice;
    options.notice = [&](const std::string& text) { notice = text; };
    run("again", options);
    EXPECT_NE(notice.find("bar.restart.previous.h5"), std::string::npos) << notice;
    expect_same_results("whole", "again");
  }
}

// Bits of the state itself, and of anything else in the file: what is accepted is as it was written.
TEST_F(Restart, IsRefusedWhereABitOfTheStateHasChanged) {
  run("whole");
  const fs::path last = file("whole", restart_ending), damaged = folder / "damaged.h5";
  const RestartHeader header = verify_restart(last);
  std::string state;
  RestartFile whole;
  whole.path = last;
  read_restart(whole, [&](std::istream& in, std::uint64_t size) {
    state.resize(std::min<std::uint64_t>(size, 60000));
    in.read(state.data(), static_cast<std::streamsize>(state.size()));
  });
  const std::string all = content(last);
  const std::size_t begin = all.find(state);
  ASSERT_NE(begin, std::string::npos);
  constexpr std::size_t trials = 40;
  for (std::size_t i = 0; i < trials; ++i) {
    fs::copy_file(last, damaged, fs::copy_options::overwrite_existing);
    flip(damaged, begin + i * (state.size() / trials));
    EXPECT_THROW(find_restart(damaged), FileError);
  }
  std::size_t refused = 0;
  for (std::size_t i = 0; i < trials; ++i) {
    fs::copy_file(last, damaged, fs::copy_options::overwrite_existing);
    flip(damaged, 7 + i * (all.size() / trials));
    try {
      const RestartFile found = find_restart(damaged);
      EXPECT_EQ(found.header.step, header.step);
      EXPECT_EQ(found.header.record.deck_text, header.record.deck_text);
    } catch (const FileError&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 0u);
}

TEST_F(Restart, RefusesAnotherDeckByTheKeyThatDiffers) {
  run("whole");
  RunOptions options;
  options.restart = file("whole", previous_restart_ending);
  options.overrides = {"parts.bar.deletion.plastic_strain=0.2"};
  try {
    run("again", options);
    FAIL();
  } catch (const DeckError& fault) {
    EXPECT_NE(std::string(fault.what()).find("parts.bar.deletion.plastic_strain is '0.2', and was '0.02'"),
              std::string::npos)
        << fault.what();
  }
  options.overrides = {"time.end=2e-4"};
  EXPECT_THROW(run("again", options), DeckError);  // the run is beyond that
}

TEST_F(Restart, MayGoOnLonger) {
  run("whole");
  RunOptions options;
  options.restart = file("whole", restart_ending);
  options.overrides = {"time.end=5e-4", "output.fields.every=5e-5"};
  const RunOutcome longer = run("whole", options);
  EXPECT_EQ(longer.summary.time, 5e-4);
  EXPECT_EQ(ResultReader(file("whole", ".vtkhdf")).times().back(), 5e-4);
  EXPECT_LT(std::abs(longer.summary.energy.error_relative), 1e-3);
}

TEST_F(Restart, OfADeckInAFolderWhoseNameIsNotUtf8) {
  RunOptions options;
  fs::create_directory(folder / "d\xff");
  options.deck = folder / "d\xff" / "bar.yaml";
  options.output = folder / "results";
  options.stop_after_s = 1e-9;
  std::ofstream(options.deck) << deck_text;
  run_deck(options);
  EXPECT_EQ(verify_restart(file("results", restart_ending)).step, 0);
}

TEST(DeckDifference, IsOfWhatIsComputed) {
  EXPECT_EQ(deck_difference("{time: {end: 1}, a: [1, 2.0]}", "{time: {end: 2}, a: [1.0, 2], title: x}"), "");
  EXPECT_EQ(deck_difference("{a: {b: [1, 2]}}", "{a: {b: [1, 3]}}"), "a.b.1 is '3', and was '2'");
  EXPECT_EQ(deck_difference("{a: 1}", "{a: 1, contact: {}}"), "contact is '{}', and was nothing");
}

}  // namespace brio::test
