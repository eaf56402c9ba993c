// `brio plot`: curves of histories.

#include "tests/system/bar_deck.hpp"
#include "tests/system/program.hpp"

namespace brio {
namespace {

using ProgramPlot = test::Program;

TEST_F(ProgramPlot, DrawsEnergiesOrTheColumnsThatAreNamed) {
  write("bar.yaml", test::bar_deck);
  ASSERT_EQ(brio("run bar.yaml --quiet").exit_code, 0);
  const Ending energies = brio("plot bar.results");
  ASSERT_EQ(energies.exit_code, 0) << energies.faults;
  EXPECT_EQ(energies.output, "bar.plot.svg\n");
  const std::string drawn = read("bar.plot.svg");
  for (const char* name : {">kinetic<", ">internal<", ">time<"})
    EXPECT_NE(drawn.find(name), std::string::npos) << name;
  EXPECT_EQ(drawn.find(">friction<"), std::string::npos) << "which is zero";

  const Ending one =
      brio("plot bar.results support_impulse_x --against bar.velocity_x --scale -2 --output 'the curve.svg'");
  ASSERT_EQ(one.exit_code, 0) << one.faults;
  EXPECT_NE(read("the curve.svg").find("support_impulse_x"), std::string::npos);
  const auto row = last_row("bar.results/bar.history.csv");
  std::istringstream commands(read("the curve.gp"));
  double x = 0, y = 0;
  for (std::string line; std::getline(commands, line) && line != "EOD";) std::istringstream(line) >> x >> y;
  EXPECT_NEAR(x, row.at("bar.velocity_x"), 1e-8 * std::abs(x));
  EXPECT_NEAR(y, -2 * row.at("support_impulse_x"), 1e-8 * std::abs(y));
  ASSERT_EQ(brio("plot bar.results kinetic --against=-bar.velocity_x --output turned.svg").exit_code, 0);
  const std::string turned = read("turned.gp");
  const std::size_t end = turned.rfind('\n', turned.find("\nEOD") - 1);
  EXPECT_NEAR(std::stod(turned.substr(end)), -row.at("bar.velocity_x"), 1e-8 * std::abs(x));
}

TEST_F(ProgramPlot, DrawsSeveralResultsInOneAndFiltersThem) {
  write("bar.yaml", test::bar_deck);
  ASSERT_EQ(brio("run bar.yaml --quiet").exit_code, 0);
  ASSERT_EQ(brio("run bar.yaml --quiet --output other.results --set time.step_scale=0.5").exit_code, 0);
  const Ending both = brio("plot bar.results other.results kinetic --filter 1000 --output both.svg");
  ASSERT_EQ(both.exit_code, 0) << both.faults;
  const std::string commands = read("both.gp");
  EXPECT_NE(commands.find("$curve1"), std::string::npos);
  EXPECT_EQ(commands.find("$curve2"), std::string::npos);
}

TEST_F(ProgramPlot, NamesTheColumnsThatThereAre) {
  write("bar.yaml", test::bar_deck);
  ASSERT_EQ(brio("run bar.yaml --quiet").exit_code, 0);
  const Ending ending = brio("plot bar.results kinetik");
  EXPECT_NE(ending.exit_code, 0);
  EXPECT_NE(ending.faults.find("kinetic"), std::string::npos) << ending.faults;
  EXPECT_NE(brio("plot nothing.results").exit_code, 0);
  EXPECT_NE(brio("plot bar.results kinetic --filter 1e9").faults.find("too few rows"), std::string::npos);
}

}  // namespace
}  // namespace brio
