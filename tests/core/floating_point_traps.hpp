#pragma once
/// Stops a test where a floating-point operation is invalid, divides by zero or overflows.

#include <cfenv>

namespace brio::test {

/// While it lives, the calling thread and every thread started meanwhile traps (a thread inherits the
/// environment of the one that starts it; so a ThreadTeam of more than one is made after it). What a trap
/// stops is the program: gdb shows the line.
class FloatingPointTraps {
 public:
  FloatingPointTraps() {
    std::fegetenv(&before_);
    std::feclearexcept(FE_ALL_EXCEPT);
    feenableexcept(FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW);
  }
  ~FloatingPointTraps() { std::fesetenv(&before_); }
  FloatingPointTraps(const FloatingPointTraps&) = delete;
  FloatingPointTraps& operator=(const FloatingPointTraps&) = delete;

 private:
  std::fenv_t before_;
};

}  // namespace brio::test
