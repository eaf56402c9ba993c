// NAME.log, beside the results.

#include "tests/system/bar_deck.hpp"
#include "tests/system/program.hpp"

namespace brio {
namespace {

class ProgramLog : public test::Program {
 protected:
  std::string log(const std::string& folder = "bar.results") const { return read(folder + "/bar.log"); }
  void SetUp() override {
    test::Program::SetUp();
    write("bar.yaml", test::bar_deck);
  }
};

TEST_F(ProgramLog, HoldsCommandProgressAndOutcomeOfAQuietRun) {
  ASSERT_EQ(brio("run bar.yaml --quiet --threads 1 --set 'title=A bar'").exit_code, 0);
  const std::string text = log();
  for (const char* part :
       {"brio ", "threads 1\n", " run bar.yaml --quiet --threads 1 --set 'title=A bar'\n",
        "\ntime 2.0000e-03  step 48  ", "  100.0 %", "\nfinished at time ", "\nenergy: kinetic "})
    EXPECT_NE(text.find(part), std::string::npos) << part << " in:\n" << text;
}

TEST_F(ProgramLog, OfAnEarlierRunIsMovedWithItsResults) {
  ASSERT_EQ(brio("run bar.yaml --quiet").exit_code, 0);
  const std::string first = log();
  ASSERT_EQ(brio("run bar.yaml --quiet").exit_code, 0);
  EXPECT_EQ(log("bar.results.previous"), first);
  EXPECT_NE(log(), "");
  ASSERT_EQ(brio("run bar.yaml --overwrite").exit_code, 0);
  EXPECT_NE(log().find("--overwrite\n"), std::string::npos);
}

TEST_F(ProgramLog, GoesOnWithARunThatGoesOn) {
  ASSERT_EQ(brio("run bar.yaml --stop-after 1e-9").exit_code, 0);
  ASSERT_EQ(brio("run bar.yaml --restart bar.results/bar.restart.h5").exit_code, 0);
  const std::string text = log();
  const std::size_t stopped = text.find("stopped at time 0"), finished = text.find("finished at time ");
  ASSERT_NE(stopped, std::string::npos) << text;
  ASSERT_NE(finished, std::string::npos) << text;
  EXPECT_LT(stopped, finished);
}

TEST_F(ProgramLog, IsNotMadeWhereNothingRuns) {
  write("bad.yaml", "title: [");
  EXPECT_EQ(brio("run bad.yaml").exit_code, 2);
  EXPECT_FALSE(fs::exists(folder_ / "bad.results"));
}

}  // namespace
}  // namespace brio
