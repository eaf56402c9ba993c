// Streams that are full, closed or without a reader; signals; what the system refuses.

#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <thread>

#include "tests/system/program.hpp"

namespace brio {
namespace {

namespace fs = std::filesystem;

const std::string cube_deck = R"(title: A cube that meets a wall
materials:
  rubber: {model: elastic, density: 1000, youngs_modulus: 1e9, poissons_ratio: 0.3}
parts:
  cube: {mesh: {box: {size: [1, 1, 1], elements: [4, 4, 4]}}, element: hex8, material: rubber}
initial_conditions: [{part: cube, velocity: [0, 0, -10]}]
boundary_conditions: [{rigid_wall: {point: [0, 0, -0.6], normal: [0, 0, 1]}}]
time: {end: 0.003}
)";
const std::string cube_study = R"(
deck: cube.yaml
quantities: {kinetic: {history: kinetic, reference: 1}}
knobs: {step: {short: {time.step_scale: 0.5}}}
)";

class Streams : public test::Program {
 protected:
  // A command of the shell in the folder, where $brio is the program. \return its exit code; -1: a signal.
  int shell(const std::string& command) const {
    const std::string whole = "cd '" + folder_.string() + "' && brio='" BRIO_PROGRAM "' && " + command;
    const int status = std::system(whole.c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
};

TEST_F(Streams, OutputThatCannotBeWrittenEndsEveryCommandWithFour) {
  write("cube.yaml", cube_deck);
  write("cube.study.yaml", cube_study);
  ASSERT_EQ(shell("\"$brio\" run cube.yaml --quiet --output kept"), 0);
  for (const char* arguments :
       {"run cube.yaml", "run cube.yaml --json --quiet", "check cube.yaml --coarse-run=0",
        "check cube.yaml --coarse-run=0 --json", "info kept", "schema", "schema --markdown", "schema --study",
        "--help", "--version", "run --help", "study --help", "study cube.study.yaml --quiet"})
    for (const char* output : {"> /dev/full", ">&-"}) {
      EXPECT_EQ(shell(std::string("\"$brio\" ") + arguments + " " + output + " 2> faults.txt"), 4)
          << arguments << output;
      EXPECT_NE(read("faults.txt").find("standard output: cannot be written"), std::string::npos)
          << arguments << output << read("faults.txt");
    }
  EXPECT_EQ(summary("cube")["status"], "finished");
  EXPECT_EQ(brio("info cube.results").exit_code, 0);
}

TEST_F(Streams, NothingToPrintIsNoFault) {
  write("cube.yaml", cube_deck);
  EXPECT_EQ(shell("\"$brio\" run cube.yaml --quiet > /dev/full 2> faults.txt"), 0) << read("faults.txt");
}

TEST_F(Streams, ErrorOutputThatCannotBeWrittenChangesNothing) {
  write("cube.yaml", cube_deck);
  write("bad.yaml", "title: no deck\n");
  write("cube.study.yaml", cube_study);
  for (const char* errors : {"2> /dev/full", "2>&-"}) {
    EXPECT_EQ(shell(std::string("\"$brio\" run cube.yaml > output.txt ") + errors), 0) << errors;
    EXPECT_NE(read("output.txt").find("finished at time 0.003"), std::string::npos);
    EXPECT_EQ(brio("info cube.results").exit_code, 0);
    EXPECT_EQ(shell(std::string("\"$brio\" run bad.yaml ") + errors), 2) << errors;
    EXPECT_EQ(shell(std::string("\"$brio\" run cube.yaml --set time.step=1 ") + errors + " > output.txt"), 3)
        << errors;
    EXPECT_EQ(shell(std::string("\"$brio\" info nothing ") + errors), 4) << errors;
    EXPECT_EQ(shell(std::string("\"$brio\" study cube.study.yaml --again > output.txt ") + errors), 0)
        << errors;
  }
}

// The first files that are opened would take the place of what is closed, and messages would go into them.
TEST_F(Streams, MessagesNeverGoIntoResultsWhereAllStreamsAreClosed) {
  write("cube.yaml", cube_deck);
  ASSERT_EQ(shell("\"$brio\" run cube.yaml --quiet --output open"), 0);
  EXPECT_EQ(shell("\"$brio\" run cube.yaml --output closed <&- >&- 2>&-"), 4);
  EXPECT_EQ(read("open/cube.history.csv"), read("closed/cube.history.csv"));
  EXPECT_EQ(brio("info closed").exit_code, 0);
}

TEST_F(Streams, ReaderThatWentAwayEndsNoRun) {
  write("cube.yaml", cube_deck);
  const auto ends_with = [&](const std::string& command) {
    shell("( sleep 0.3; " + command + "; echo $? > code.txt ) | true");
    return read("code.txt");
  };
  EXPECT_EQ(ends_with("\"$brio\" schema 2> faults.txt"), "4\n");
  EXPECT_EQ(ends_with("\"$brio\" run cube.yaml 2> faults.txt"), "4\n");
  EXPECT_EQ(summary("cube")["status"], "finished");
  EXPECT_EQ(ends_with("\"$brio\" run cube.yaml --output other 2>&1 > output.txt"), "0\n");
  EXPECT_EQ(brio("info other").exit_code, 0);
}

class Signals : public Streams {
 protected:
  // Starts a run that would take for ever, sends signals once it has a dump, and returns its exit code.
  int run_until(const std::vector<int>& signals, void (*hang_up)(int) = SIG_DFL) {
    write("cube.yaml", cube_deck);
    const pid_t child = fork();
    if (child == 0) {
      std::signal(SIGHUP, hang_up);
      fs::current_path(folder_);
      execl(BRIO_PROGRAM, BRIO_PROGRAM, "run", "cube.yaml", "--quiet", "--set", "time.end=1e6", "--threads",
            "1", nullptr);
      _exit(99);
    }
    for (int i = 0; i < 2000 && !fs::exists(folder_ / "cube.results" / "cube.vtkhdf"); ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    for (const int signal : signals) {
      kill(child, signal);
      std::this_thread::sleep_for(std::chrono::milliseconds(200));
    }
    int status = 0;
    waitpid(child, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
};

TEST_F(Signals, HangUpClosesResultsFirst) {
  EXPECT_EQ(run_until({SIGHUP}), 129);
  EXPECT_EQ(summary("cube")["status"], "terminated");
  EXPECT_EQ(summary("cube")["exit_code"], 129);
  EXPECT_EQ(brio("info cube.results").exit_code, 0);
}

TEST_F(Signals, HangUpThatTheCallerIgnoresIsIgnored) {
  EXPECT_EQ(run_until({SIGHUP, SIGTERM}, SIG_IGN), 143);
  EXPECT_EQ(summary("cube")["exit_code"], 143);
}

TEST_F(Signals, OfAPipeEndsNoRun) { EXPECT_EQ(run_until({SIGPIPE, SIGINT}), 130); }

using Refused = Streams;

TEST_F(Refused, DeckWithoutPartsByEveryCommand) {
  write("empty.yaml", "materials: {}\nparts: {}\ntime: {end: 1}\n");
  write("empty.study.yaml",
        "deck: empty.yaml\nquantities: {k: {history: kinetic, reference: 1}}\nknobs: {a: {b: "
        "{time.end: 2}}}\n");
  for (const char* arguments : {"check empty.yaml", "run empty.yaml", "study empty.study.yaml"}) {
    const Ending ending = brio(arguments);
    EXPECT_EQ(ending.exit_code, 2) << arguments;
    EXPECT_NE(ending.faults.find("empty.yaml:2:8: 'parts' is empty"), std::string::npos) << ending.faults;
  }
}

// The limits of the address space would end a program that is checked for addresses.
#if !defined(__SANITIZE_ADDRESS__)
TEST_F(Refused, MemoryThatIsNotThereBeforeItIsTaken) {
  write("cube.yaml", cube_deck);
  for (const char* command : {"run", "check"}) {
    const Ending ending =
        brio(std::string(command) + " cube.yaml --set parts.cube.mesh.box.elements=[200,200,200]",
             "ulimit -v 2000000; ");
    EXPECT_EQ(ending.exit_code, 2);
    EXPECT_NE(ending.faults.find("cube.yaml:5:3: the scene needs about "), std::string::npos)
        << ending.faults;
    EXPECT_NE(ending.faults.find(" MB are available"), std::string::npos) << ending.faults;
  }
  EXPECT_FALSE(fs::exists(folder_ / "cube.results"));
}

TEST_F(Refused, ThreadsThatTheSystemDoesNotGive) {
  write("cube.yaml", cube_deck);
  for (const char* command : {"run", "check --coarse-run=0"}) {
    const Ending ending = brio(std::string(command) + " cube.yaml --threads 1000", "ulimit -v 2000000; ");
    EXPECT_EQ(ending.exit_code, 4);
    EXPECT_NE(ending.faults.find("cannot start 1000 threads"), std::string::npos) << ending.faults;
  }
}
#endif

TEST_F(Refused, SizesBeyondAnyMachineAtOnce) {
  write("cube.yaml", cube_deck);
  for (const char* setting :
       {"parts.cube.mesh.box.elements=[1000000000,1000000000,1000000000]",
        "parts.cube.mesh.box.elements=[2147483647,1,1]",
        "parts.cube.mesh={sphere: {radius: 1, elements: 2147483646}}",
        "parts.cube.mesh={tube: {inner_radius: 1, outer_radius: 2, height: 1, elements: [65536, 65536, "
        "65536]}}",
        "parts.cube.mesh={rod: {radius: 1, length: 1, elements: [2147483646, 2147483647]}}"}) {
    const Ending ending = brio("check cube.yaml --set '" + std::string(setting) + "'", "ulimit -t 1; ");
    EXPECT_EQ(ending.exit_code, 2) << setting;
    EXPECT_NE(ending.faults.find("too fine"), std::string::npos) << ending.faults;
  }
  for (const char* setting : {"output.fields.every=1e-300", "output.history.every=1e-300",
                              "output.fields.every=1e300", "output.fields.times=[0, 1e300]"})
    EXPECT_EQ(
        brio("run cube.yaml --quiet --set time.end=1e-4 --set '" + std::string(setting) + "'").exit_code, 0)
        << setting;
}

}  // namespace
}  // namespace brio
