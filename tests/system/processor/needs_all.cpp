// A program compiled for a processor that nobody makes: one with all instruction sets. Whatever it says past
// the check of the processor is a fault.

#include <unistd.h>

#include "apps/processor.hpp"

namespace {

int say(const char* text, unsigned long length) { return write(STDOUT_FILENO, text, length) < 0 ? 1 : 0; }

[[maybe_unused]] const int static_object = say("static object\n", 14);

}  // namespace

namespace brio {

#define BRIO_NEEDED(...) true,
const bool compiled_with[instruction_sets] = {BRIO_INSTRUCTION_SETS(BRIO_NEEDED)};

}  // namespace brio

int main() { return say("main\n", 5); }
