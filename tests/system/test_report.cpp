// `brio report`: one page of a result.

#include "tests/system/bar_deck.hpp"
#include "tests/system/program.hpp"

namespace brio {
namespace {

using ProgramReport = test::Program;

TEST_F(ProgramReport, WritesAPageBesideTheResult) {
  write("bar.yaml", test::bar_deck);
  ASSERT_EQ(brio("run bar.yaml --quiet").exit_code, 0);
  const Ending ending = brio("report bar.results");
  ASSERT_EQ(ending.exit_code, 0) << ending.faults;
  EXPECT_EQ(ending.output, "bar.html\n");
  const std::string page = read("bar.html");
  EXPECT_TRUE(page.starts_with("<!DOCTYPE html>"));
  EXPECT_TRUE(page.ends_with("</html>\n"));
  EXPECT_EQ(
      brio("report bar.results --frames 2 --fields von_mises,velocity_x --output 'a page.html'").exit_code,
      0);
  const std::string small = read("a page.html");
  EXPECT_LT(small.size(), page.size());
  EXPECT_NE(small.find("\"name\":\"velocity_x\""), std::string::npos);
}

TEST_F(ProgramReport, SaysWhatIsAtFault) {
  write("bar.yaml", test::bar_deck);
  ASSERT_EQ(brio("run bar.yaml --quiet").exit_code, 0);
  const Ending unknown = brio("report bar.results --fields von_mieses");
  EXPECT_EQ(unknown.exit_code, 4);
  EXPECT_NE(unknown.faults.find("von_mises"), std::string::npos) << unknown.faults;
  EXPECT_EQ(brio("report nothing.results").exit_code, 4);
  EXPECT_EQ(brio("report bar.yaml").exit_code, 4);
  EXPECT_EQ(brio("report bar.results --frames 0").exit_code, 2);
  EXPECT_EQ(brio("report bar.results --output nowhere/bar.html").exit_code, 4);
  EXPECT_EQ(read("bar.html"), "") << "nothing was written";
}

TEST_F(ProgramReport, EndsCleanlyOnADamagedResult) {
  write("bar.yaml", test::bar_deck);
  ASSERT_EQ(brio("run bar.yaml --quiet").exit_code, 0);
  const std::string whole = read("bar.results/bar.vtkhdf");
  write("bar.results/bar.vtkhdf", whole.substr(0, whole.size() / 2));
  const Ending ending = brio("report bar.results");
  EXPECT_EQ(ending.exit_code, 4);
  EXPECT_NE(ending.faults.find("bar.vtkhdf"), std::string::npos) << ending.faults;
}

}  // namespace
}  // namespace brio
