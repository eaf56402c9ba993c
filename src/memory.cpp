#include "src/memory.hpp"

#include <algorithm>
#include <fstream>
#include <string>

#if defined(__GLIBC__)
#include <malloc.h>
#endif

namespace brio {

namespace {

// A line of /proc/self/status, in kB there.
double status_mb(const std::string& key) {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;)
    if (double kilobytes = 0; word == key && status >> kilobytes) return kilobytes / 1024;
  return 0;
}

// Of the program before it has built anything.
double program_mb() {
  static const double size = resident_memory_mb();
  return size;
}

}  // namespace

std::size_t heap_bytes() {
#if defined(__GLIBC__)
  const struct mallinfo2 info = mallinfo2();
  return info.uordblks + info.hblkhd;
#else
  return 0;
#endif
}

double resident_memory_mb() { return status_mb("VmRSS:"); }
double peak_resident_memory_mb() { return status_mb("VmHWM:"); }

// What earlier scenes have freed is given back first, so that it is not taken again unseen.
MemoryWatch::MemoryWatch() {
#if defined(__GLIBC__)
  malloc_trim(0);
#endif
  std::ofstream("/proc/self/clear_refs") << 5;  // the peak is from now on
  program_mb();
  before_ = resident_memory_mb();
}

double MemoryWatch::peak_mb() const {
  return program_mb() + std::max(0.0, peak_resident_memory_mb() - before_);
}

}  // namespace brio
