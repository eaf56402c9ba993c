#pragma once
/// Memory of this process, as the system tells it: Linux with the GNU C library. Elsewhere everything is 0.

#include <cstddef>
#include <filesystem>
#include <type_traits>
#include <utility>

namespace brio {

/// Bytes that are allocated now.
std::size_t heap_bytes();

/// Bytes that an object holds beside its own size: those that a copy of it takes.
template <class T>
std::size_t bytes_held(const T& object) {
  const std::size_t before = heap_bytes();
  const T copy = object;
  const std::size_t after = heap_bytes();
  return after > before ? after - before : 0;
}

/// The same of an object that is no longer needed: those that its end gives back.
template <class T>
requires(!std::is_reference_v<T>) std::size_t bytes_freed(T&& object) {
  const std::size_t before = heap_bytes();
  { const T gone = std::move(object); }
  const std::size_t after = heap_bytes();
  return before > after ? before - after : 0;
}

double resident_memory_mb();
/// The most that was resident since the process began, or since the last MemoryWatch was made.
double peak_resident_memory_mb();

/// What this process can still take: what the machine has left, swap included, but no more than its control
/// groups (versions 1 and 2) and the limit of its address space leave. Infinite where the system does not
/// say. \param system root of the files that say it
double available_memory_mb(const std::filesystem::path& system = "/");

/// What a process that does nothing else takes at most from now on: made before a scene is built, asked when
/// it has been.
class MemoryWatch {
 public:
  MemoryWatch();
  double peak_mb() const;

 private:
  double before_;
};

}  // namespace brio
