// Compiled for every processor, and runs before all that is not: constructors of this priority come before
// those of static objects. Nothing is called that stands in a header, since the linker may keep what another
// source made of it.

#include <unistd.h>

#include "apps/processor.hpp"

namespace brio {

namespace {

struct Line {
  char* end;

  void add(const char* text) {
    while (*text != '\0') *end++ = *text++;
  }
};

struct InstructionSet {
  bool of_avx512;
  const char* shown;
};
#define BRIO_SHOWN(macro, name, of_avx512, shown) {of_avx512, shown},
const InstructionSet sets[instruction_sets] = {BRIO_INSTRUCTION_SETS(BRIO_SHOWN)};

#if defined(__x86_64__)
#define BRIO_PRESENT(macro, name, of_avx512, shown) __builtin_cpu_supports(name) != 0,
#else
#define BRIO_PRESENT(macro, name, of_avx512, shown) true,
#endif

[[gnu::constructor(101)]] void check_processor() {
#if defined(__x86_64__)
  __builtin_cpu_init();
#endif
  const bool present[instruction_sets] = {BRIO_INSTRUCTION_SETS(BRIO_PRESENT)};
  char line[complaint_size];
  const int length = complain_of_processor(compiled_with, present, line);
  if (length == 0) return;
  const auto written = write(STDERR_FILENO, line, static_cast<unsigned>(length));
  static_cast<void>(written);  // the exit code says the same
  _exit(2);
}

}  // namespace

int complain_of_processor(const bool (&needed)[instruction_sets], const bool (&present)[instruction_sets],
                          char (&line)[complaint_size]) {
  Line text{line};
  bool any = false, in_avx512 = false;
  for (int i = 0; i < instruction_sets; ++i) {
    if (!needed[i] || present[i]) continue;
    text.add(any ? ", " : "brio: this program was built for processors with ");
    if (sets[i].of_avx512 && !in_avx512) text.add("AVX-512 (");
    in_avx512 = sets[i].of_avx512;  // these come last
    any = true;
    text.add(sets[i].shown);
  }
  if (!any) return 0;
  if (in_avx512) text.add(")");
  text.add(", which this one lacks; build with -DBRIO_NATIVE=OFF or on this machine\n");
  return static_cast<int>(text.end - line);
}

}  // namespace brio
