#include "io/run_processes.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <fstream>
#include <limits>
#include <map>
#include <system_error>

extern char** environ;

namespace brio {

namespace {

using Clock = std::chrono::steady_clock;

struct Started {
  std::size_t command;
  Clock::time_point at;
};

pid_t start(const Command& command) {
  std::vector<std::string> words = command.arguments;
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_addopen(&files, 0, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&files, 1, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_addopen(&files, 2, command.faults.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666);
  if (!command.folder.empty()) posix_spawn_file_actions_addchdir_np(&files, command.folder.c_str());
  pid_t child = 0;
  const int error = posix_spawnp(&child, arguments[0], &files, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&files);
  if (error != 0) throw std::system_error(error, std::generic_category(), "cannot start " + words[0]);
  return child;
}

// Of /proc/meminfo, in MB; all there can be where the system does not say.
double available_memory_mb() {
  std::ifstream text("/proc/meminfo");
  for (std::string key, rest; text >> key; std::getline(text, rest)) {
    double kilobytes = 0;
    if (key == "MemAvailable:" && text >> kilobytes) return kilobytes / 1024;
  }
  return std::numeric_limits<double>::infinity();
}

double seconds(const timeval& time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

}  // namespace

void run_processes(const std::vector<Command>& commands, int jobs, const std::atomic<int>* stop,
                   const std::function<void(const Ended&)>& ended) {
  std::map<pid_t, Started> running;
  std::size_t next = 0;
  double largest_mb = 0;
  const auto may_start = [&] {
    if (next == commands.size() || (stop != nullptr && *stop != 0)) return false;
    if (running.empty()) return true;
    return static_cast<int>(running.size()) < jobs && available_memory_mb() > 1.5 * largest_mb;
  };
  while (true) {
    while (may_start()) {
      running.emplace(start(commands[next]), Started{next, Clock::now()});
      ++next;
    }
    if (running.empty()) return;
    int status = 0;
    rusage usage{};
    const pid_t child = wait4(-1, &status, 0, &usage);
    if (child < 0 && errno == EINTR) continue;
    const auto found = running.find(child);
    if (found == running.end()) continue;
    Ended end;
    end.command = found->second.command;
    end.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    end.processor_s = seconds(usage.ru_utime) + seconds(usage.ru_stime);
    end.wall_s = std::chrono::duration<double>(Clock::now() - found->second.at).count();
    end.peak_memory_mb = static_cast<double>(usage.ru_maxrss) / 1024;
    largest_mb = std::max(largest_mb, end.peak_memory_mb);
    running.erase(found);
    ended(end);
  }
}

}  // namespace brio
