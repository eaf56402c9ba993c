#include "src/forecast/memory.hpp"

#include <sys/resource.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <optional>
#include <string>

#if defined(__GLIBC__)
#include <malloc.h>
#endif

namespace brio {

namespace {

namespace fs = std::filesystem;
constexpr double megabyte = 1 << 20;

// The number after a word of a file.
std::optional<double> number_after(const fs::path& file, const std::string& key) {
  std::ifstream text(file);
  for (std::string word; text >> word;)
    if (double number = 0; word == key && text >> number) return number;
  return {};
}

// A line of /proc/self/status, in kB there.
double status_mb(const std::string& key) { return number_after("/proc/self/status", key).value_or(0) / 1024; }

// A file that holds one number; none where it says `max` or is not there.
std::optional<double> number_in(const fs::path& file) {
  std::ifstream text(file);
  double number = 0;
  return text >> number ? std::optional(number) : std::nullopt;
}

// What a control group leaves: files that the kernel only keeps for later are given back on demand.
double left_in_group_mb(const fs::path& group, const char* limit, const char* used, const char* files) {
  const std::optional<double> most = number_in(group / limit);
  if (!most) return std::numeric_limits<double>::infinity();
  const double given_back = number_after(group / "memory.stat", files).value_or(0);
  return std::max(0.0, *most - number_in(group / used).value_or(0) + given_back) / megabyte;
}

// Of a group of /proc/self/cgroup and all those it is in.
double left_in_groups_mb(const fs::path& system) {
  double left = std::numeric_limits<double>::infinity();
  std::ifstream text(system / "proc/self/cgroup");
  for (std::string line; std::getline(text, line);) {
    const std::size_t first = line.find(':'), second = line.find(':', first + 1);
    if (second == std::string::npos) continue;
    const bool unified = second == first + 1;
    if (!unified && line.substr(first + 1, second - first - 1) != "memory") continue;
    const fs::path root = system / (unified ? "sys/fs/cgroup" : "sys/fs/cgroup/memory");
    fs::path inside = fs::path(line.substr(second + 1)).relative_path();
    while (true) {
      left = std::min(
          left, unified ? left_in_group_mb(root / inside, "memory.max", "memory.current", "inactive_file")
                        : left_in_group_mb(root / inside, "memory.limit_in_bytes", "memory.usage_in_bytes",
                                           "total_inactive_file"));
      if (inside.empty()) break;
      inside = inside.parent_path();
    }
  }
  return left;
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

double available_memory_mb(const fs::path& system) {
  double left = left_in_groups_mb(system);
  const fs::path machine = system / "proc/meminfo";
  if (const std::optional<double> kilobytes = number_after(machine, "MemAvailable:"))
    left = std::min(left, (*kilobytes + number_after(machine, "SwapFree:").value_or(0)) / 1024);
  rlimit space{};
  if (getrlimit(RLIMIT_AS, &space) == 0 && space.rlim_cur != RLIM_INFINITY)
    left =
        std::min(left, std::max(0.0, static_cast<double>(space.rlim_cur) / megabyte - status_mb("VmSize:")));
  return left;
}

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
