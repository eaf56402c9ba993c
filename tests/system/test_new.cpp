// `brio new`: a first deck.

#include "tests/system/program.hpp"

namespace brio {
namespace {

using ProgramNew = test::Program;

TEST_F(ProgramNew, WritesADeckThatRunsAndHasTheColumnThatItNames) {
  const Ending written = brio("new ball");
  ASSERT_EQ(written.exit_code, 0) << written.faults;
  EXPECT_EQ(written.output, "ball.yaml\nnext: brio run ball.yaml\n");
  const std::string deck = read("ball.yaml");
  EXPECT_EQ(deck.find("NAME"), std::string::npos);
  EXPECT_NE(deck.find("brio run ball.yaml"), std::string::npos);
  const Ending run = brio("run ball.yaml --quiet --threads 1 --set time.end=4e-5");
  ASSERT_EQ(run.exit_code, 0) << run.faults;
  EXPECT_EQ(run.faults, "");
  EXPECT_LT(last_row("ball.results/ball.history.csv").at("contact.sheet.ball_z"), 0);
}

TEST_F(ProgramNew, ReplacesNothing) {
  write("mine.yaml", "title: mine\n");
  for (const std::string name : {"mine", "mine.yaml"}) {
    const Ending ending = brio("new " + name);
    EXPECT_EQ(ending.exit_code, 2);
    EXPECT_EQ(ending.faults, "mine.yaml: is there already; accepted: a name that is not taken\n");
  }
  EXPECT_EQ(read("mine.yaml"), "title: mine\n");
  EXPECT_EQ(brio("new ''").exit_code, 2);
  EXPECT_EQ(brio("new nowhere/ball").exit_code, 4);
}

// The part, the deck and the commands of docs/first_scene.md, as they stand there.
TEST_F(ProgramNew, FirstSceneOfTheManualRuns) {
  if (std::system("gmsh --version > /dev/null 2>&1") != 0) GTEST_SKIP() << "gmsh is not installed";
  std::ifstream page(BRIO_SOURCE_DIR "/docs/first_scene.md");
  std::map<std::string, std::string> block;
  std::vector<std::string> commands;
  std::string kind;
  for (std::string line; std::getline(page, line);) {
    if (line.rfind("```", 0) == 0) {
      kind = line.substr(3);
    } else if (!kind.empty()) {
      block[kind] += line + "\n";
    } else if (line.rfind("    brio ", 0) == 0) {
      commands.push_back(line.substr(9, line.find('#') - 9));
    } else if (line.rfind("    gmsh ", 0) == 0) {
      write("bracket.geo", block.at("geo"));
      ASSERT_EQ(std::system(("cd '" + folder_.string() + "' && " + line + " > gmsh.txt").c_str()), 0);
    }
  }
  write("bracket.yaml", block.at("yaml"));
  ASSERT_EQ(commands.size(), 6u);
  for (std::string command : commands) {
    if (command.rfind("run", 0) == 0) command += " --quiet --threads 1 --set time.end=2e-5";
    if (command.rfind("check", 0) == 0) command += " --coarse-run=0 --threads 1";
    const Ending ending = brio(command);
    EXPECT_EQ(ending.exit_code, 0) << command << ": " << ending.faults;
    EXPECT_EQ(ending.faults, "") << command;
  }
  EXPECT_TRUE(fs::exists(folder_ / "forces.svg"));
}

}  // namespace
}  // namespace brio
