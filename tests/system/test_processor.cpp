// A program that was compiled for a newer processor says so where it is started on an older one.

#include <algorithm>
#include <string>

#include "apps/processor.hpp"
#include "src/base/index.hpp"
#include "tests/system/program.hpp"

namespace brio {
namespace {

struct Sets {
  bool has[instruction_sets] = {};
};

#define BRIO_NAME(macro, name, of_avx512, shown) name,
const std::string compilers_names[] = {BRIO_INSTRUCTION_SETS(BRIO_NAME)};

Sets sets_of(const std::vector<std::string>& wanted) {
  Sets sets;
  for (const std::string& name : wanted) {
    const auto found = std::find(std::begin(compilers_names), std::end(compilers_names), name);
    EXPECT_NE(found, std::end(compilers_names)) << name;
    sets.has[found - std::begin(compilers_names)] = true;
  }
  return sets;
}

std::string complaint(const Sets& needed, const Sets& present) {
  char line[complaint_size];
  return {line, index(complain_of_processor(needed.has, present.has, line))};
}

TEST(Processor, ThatHasWhatIsNeededOrMoreIsWelcome) {
  EXPECT_EQ(complaint({}, {}), "");
  EXPECT_EQ(complaint(sets_of({"avx2", "fma"}), sets_of({"avx", "avx2", "fma", "avx512f"})), "");
}

TEST(Processor, ThatLacksSomethingIsToldWhat) {
  const std::string advice = ", which this one lacks; build with -DBRIO_NATIVE=OFF or on this machine\n";
  const Sets avx2 = sets_of({"avx", "avx2"});
  EXPECT_EQ(complaint(avx2, {}), "brio: this program was built for processors with AVX, AVX2" + advice);
  EXPECT_EQ(complaint(sets_of({"avx2", "fma", "avx512f", "avx512dq"}), avx2),
            "brio: this program was built for processors with FMA, AVX-512 (F, DQ)" + advice);
  EXPECT_EQ(complaint(sets_of({"avx512vl"}), avx2),
            "brio: this program was built for processors with AVX-512 (VL)" + advice);
}

TEST(Processor, AllThatItMayLackFitsTheLine) {
  Sets all;
  std::fill(std::begin(all.has), std::end(all.has), true);
  EXPECT_LT(complaint(all, {}).size(), index(complaint_size));
}

TEST(Processor, InstructionsAreThoseOfTheFlags) {
  Sets announced;
  for (int i = 0; i < instruction_sets; ++i) announced.has[i] = compiled_with[i];
#if defined(__AVX2__) && defined(__FMA__)
  EXPECT_NE(complaint(announced, {}).find("AVX2, FMA"), std::string::npos);
#else
  EXPECT_EQ(complaint(announced, {}).find("AVX2, FMA"), std::string::npos);
#endif
}

using NewerProcessor = test::Program;

TEST_F(NewerProcessor, ProgramForOneEndsBeforeItsFirstStaticObject) {
  const std::string command =
      "cd '" + folder_.string() + "' && '" BRIO_NEEDS_ALL "' > output.txt 2> faults.txt";
  const int status = std::system(command.c_str());
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 2);
  EXPECT_EQ(read("output.txt"), "");
  EXPECT_TRUE(read("faults.txt").starts_with("brio: this program was built for processors with "));
}

}  // namespace
}  // namespace brio
