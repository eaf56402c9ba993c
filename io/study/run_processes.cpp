#include "io/study/run_processes.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <map>
#include <optional>
#include <system_error>

#include "io/files/text_file.hpp"
#include "src/forecast/memory.hpp"

namespace brio {

namespace {

using Clock = std::chrono::steady_clock;

struct Started {
  std::size_t command;
  Clock::time_point at;
};

// Between fork and exec: only calls of the system. An error number goes to the parent through `report`, which
// closes when the command starts.
[[noreturn]] void become(const Command& command, char** arguments, int faults, int report, pid_t parent) {
  const auto give_up = [report] {
    const int error = errno;
    if (write(report, &error, sizeof error) < 0) _exit(126);
    _exit(127);
  };
  if (prctl(PR_SET_PDEATHSIG, SIGKILL) != 0) give_up();
  if (getppid() != parent) _exit(127);  // it died before the line above
  const int nothing = open("/dev/null", O_RDWR | O_CLOEXEC);
  if (nothing < 0 || dup2(nothing, STDIN_FILENO) < 0 || dup2(nothing, STDOUT_FILENO) < 0 ||
      dup2(faults, STDERR_FILENO) < 0)
    give_up();
  if (command.shared_descriptor >= 0 && fcntl(command.shared_descriptor, F_SETFD, 0) != 0) give_up();
  if (!command.folder.empty() && chdir(command.folder.c_str()) != 0) give_up();
  execvp(arguments[0], arguments);
  give_up();
  _exit(127);
}

pid_t start(const Command& command) {
  std::vector<std::string> words = command.arguments;
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  const int faults = new_file(command.faults);
  std::array<int, 2> report{};
  int error = pipe2(report.data(), O_CLOEXEC) == 0 ? 0 : errno;
  if (error == 0) {
    const pid_t parent = getpid();
    const pid_t child = fork();
    if (child == 0) become(command, arguments.data(), faults, report[1], parent);
    if (child < 0) error = errno;
    close(report[1]);
    ssize_t told = 0;
    while (child > 0 && (told = read(report[0], &error, sizeof error)) < 0 && errno == EINTR) {
    }
    close(report[0]);
    close(faults);
    if (child > 0 && told == 0) return child;
    if (child > 0) waitpid(child, nullptr, 0);
  } else {
    close(faults);
  }
  throw std::system_error(error, std::generic_category(), "cannot start " + words[0]);
}

double seconds(const timeval& time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

class Processes {
 public:
  Processes(const std::vector<Command>& commands, int jobs, const std::atomic<int>* stop)
      : commands_(commands), jobs_(jobs), stop_(stop) {}
  ~Processes() {
    tell_all(SIGKILL);
    for (const auto& [process, started] : running_) waitpid(process, nullptr, 0);
  }
  Processes(const Processes&) = delete;
  Processes& operator=(const Processes&) = delete;

  void run(const std::function<void(const Ended&)>& ended) {
    constexpr int pause_ms = 5;
    while (true) {
      while (may_start()) {
        running_.emplace(start(commands_[next_]), Started{next_, Clock::now()});
        ++next_;
      }
      if (running_.empty()) return;
      if (is_stopped() && !told_) {
        told_ = true;
        tell_all(SIGTERM);
      }
      if (const std::optional<Ended> end = one_that_ended()) {
        ended(*end);
      } else {
        poll(nullptr, 0, pause_ms);
      }
    }
  }

 private:
  bool is_stopped() const { return stop_ != nullptr && *stop_ != 0; }

  bool may_start() const {
    if (next_ == commands_.size() || is_stopped()) return false;
    if (running_.empty()) return true;
    return static_cast<int>(running_.size()) < jobs_ && available_memory_mb() > 1.5 * largest_mb_;
  }

  void tell_all(int signal) const {
    for (const auto& [process, started] : running_) kill(process, signal);
  }

  std::optional<Ended> one_that_ended() {
    for (const auto& [process, started] : running_) {
      int status = 0;
      rusage usage{};
      if (wait4(process, &status, WNOHANG, &usage) != process) continue;
      Ended end;
      end.command = started.command;
      end.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
      end.processor_s = seconds(usage.ru_utime) + seconds(usage.ru_stime);
      end.wall_s = std::chrono::duration<double>(Clock::now() - started.at).count();
      end.peak_memory_mb = static_cast<double>(usage.ru_maxrss) / 1024;
      largest_mb_ = std::max(largest_mb_, end.peak_memory_mb);
      running_.erase(process);
      return end;
    }
    return {};
  }

  const std::vector<Command>& commands_;
  int jobs_;
  const std::atomic<int>* stop_;
  std::map<pid_t, Started> running_;
  std::size_t next_ = 0;
  double largest_mb_ = 0;
  bool told_ = false;
};

}  // namespace

void run_processes(const std::vector<Command>& commands, int jobs, const std::atomic<int>* stop,
                   const std::function<void(const Ended&)>& ended) {
  Processes(commands, jobs, stop).run(ended);
}

}  // namespace brio
