#pragma once
/// Runs of the program as processes of their own, several side by side.

#include <atomic>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace brio {

/// A command and where its complaints go. No shell sees it.
struct Command {
  std::vector<std::string> arguments;  ///< the program first, by its path or as the system finds it
  std::filesystem::path faults;        ///< file for its error stream; what it prints is dropped
  std::filesystem::path folder{};      ///< where it runs; empty: where this process does
  int shared_descriptor = -1;          ///< that stays open in it, such as that of a lock; -1: none
};

struct Ended {
  std::size_t command = 0;  ///< its place in the list
  int exit_code = 0;        ///< 128 + signal where it was killed
  double processor_s = 0;   ///< user and system
  double wall_s = 0;
  double peak_memory_mb = 0;
};

/// Starts the commands in their order, at most `jobs` at once, and none beside others that memory would not
/// hold, judged by the largest that has ended. With a stop set, none is started any more, and those that run
/// are told to end (SIGTERM). When this process dies, the system kills them. \param ended called as each ends
/// \throws FileError where a file for the error stream cannot be made; std::system_error where the system
/// starts no process. Those that run are then killed.
void run_processes(const std::vector<Command>& commands, int jobs, const std::atomic<int>* stop,
                   const std::function<void(const Ended&)>& ended);

}  // namespace brio
