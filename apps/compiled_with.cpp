// Compiled as the kernels are, whose instruction sets these are.

#include "apps/processor.hpp"

namespace brio {

// A macro that is not defined stands for itself, and is 1 otherwise.
#define BRIO_TEXT(...) #__VA_ARGS__
#define BRIO_ANNOUNCED(macro, name, of_avx512, shown) BRIO_TEXT(macro)[0] == '1',
const bool compiled_with[instruction_sets] = {BRIO_INSTRUCTION_SETS(BRIO_ANNOUNCED)};

}  // namespace brio
