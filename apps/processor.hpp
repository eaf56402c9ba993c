#pragma once
/// Whether this processor has the instructions that the program was compiled with; without them it would end
/// with SIGILL and no word.

namespace brio {

/// What compilers use unasked: the macro that announces it, the compiler's name, whether it is a part of
/// AVX-512, the name for people.
#define BRIO_INSTRUCTION_SETS(X)                      \
  X(__SSE3__, "sse3", false, "SSE3")                  \
  X(__SSSE3__, "ssse3", false, "SSSE3")               \
  X(__SSE4_1__, "sse4.1", false, "SSE4.1")            \
  X(__SSE4_2__, "sse4.2", false, "SSE4.2")            \
  X(__POPCNT__, "popcnt", false, "POPCNT")            \
  X(__SSE4A__, "sse4a", false, "SSE4a")               \
  X(__FMA4__, "fma4", false, "FMA4")                  \
  X(__XOP__, "xop", false, "XOP")                     \
  X(__BMI__, "bmi", false, "BMI")                     \
  X(__BMI2__, "bmi2", false, "BMI2")                  \
  X(__AVX__, "avx", false, "AVX")                     \
  X(__AVX2__, "avx2", false, "AVX2")                  \
  X(__FMA__, "fma", false, "FMA")                     \
  X(__GFNI__, "gfni", false, "GFNI")                  \
  X(__AVX512F__, "avx512f", true, "F")                \
  X(__AVX512CD__, "avx512cd", true, "CD")             \
  X(__AVX512ER__, "avx512er", true, "ER")             \
  X(__AVX512PF__, "avx512pf", true, "PF")             \
  X(__AVX512VL__, "avx512vl", true, "VL")             \
  X(__AVX512BW__, "avx512bw", true, "BW")             \
  X(__AVX512DQ__, "avx512dq", true, "DQ")             \
  X(__AVX512IFMA__, "avx512ifma", true, "IFMA")       \
  X(__AVX512VBMI__, "avx512vbmi", true, "VBMI")       \
  X(__AVX512VBMI2__, "avx512vbmi2", true, "VBMI2")    \
  X(__AVX512VNNI__, "avx512vnni", true, "VNNI")       \
  X(__AVX512BITALG__, "avx512bitalg", true, "BITALG") \
  X(__AVX512VPOPCNTDQ__, "avx512vpopcntdq", true, "VPOPCNTDQ")

#define BRIO_COUNT(...) +1
inline constexpr int instruction_sets = BRIO_INSTRUCTION_SETS(BRIO_COUNT);
#undef BRIO_COUNT

/// Those that the program is compiled with.
extern const bool compiled_with[instruction_sets];

inline constexpr int complaint_size = 512;
/// What a processor lacks, as a line for people.
/// \return its length; 0: nothing is lacking
int complain_of_processor(const bool (&needed)[instruction_sets], const bool (&present)[instruction_sets],
                          char (&line)[complaint_size]);

}  // namespace brio
