#include "io/files/read_apart.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <fstream>
#include <new>
#include <system_error>

#include "io/files/file_error.hpp"
#include "src/base/index.hpp"

namespace brio {
namespace {

using std::string;

// What the child process sends: one of these, then text. Of a FileError the path, a NUL, the reason.
constexpr char result_mark = 'R';
constexpr char file_error_mark = 'F';

constexpr const char* too_much = "is broken: it claims more data than memory can hold";

struct Limits {
  rlim_t seconds;
  rlim_t bytes;
};

/// Of a file, or of the files in a folder.
double bytes_of(const std::filesystem::path& path) {
  std::error_code none;
  if (std::filesystem::is_regular_file(path, none)) {
    const std::uintmax_t bytes = std::filesystem::file_size(path, none);
    return none ? 0 : static_cast<double>(bytes);
  }
  double sum = 0;
  for (const auto& entry : std::filesystem::directory_iterator(path, none))
    if (entry.is_regular_file(none)) sum += bytes_of(entry.path());
  return sum;
}

/// Reading is far faster and takes far less, also of a small file, of one that is compressed, and on a
/// machine that is busy.
Limits limits_of(const std::filesystem::path& file) {
  constexpr double least_seconds = 10, bytes_a_second = 20e6;
  constexpr double least_bytes = 1e9, bytes_a_byte = 16;
  const double size = bytes_of(file);
  return {static_cast<rlim_t>(least_seconds + size / bytes_a_second),
          static_cast<rlim_t>(least_bytes + bytes_a_byte * size)};
}

/// Beyond what the process has taken already.
rlim_t address_space() {
  rlim_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  return pages * static_cast<rlim_t>(sysconf(_SC_PAGESIZE));
}

void lower_limit(decltype(RLIMIT_CPU) kind, rlim_t value) {
  rlimit limit{};
  getrlimit(kind, &limit);
  limit.rlim_cur = std::min(limit.rlim_max, value);
  setrlimit(kind, &limit);
}

void limit_this_process(const Limits& limits) {
  lower_limit(RLIMIT_CORE, 0);
  lower_limit(RLIMIT_CPU, limits.seconds);
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)  // they reserve terabytes
  lower_limit(RLIMIT_AS, address_space() + limits.bytes);
#endif
}

string answer_of(const std::filesystem::path& file, const std::function<string()>& work) {
  const auto fault = [](const string& path, const string& reason) {
    return file_error_mark + path + '\0' + reason;
  };
  try {
    return result_mark + work();
  } catch (const FileError& error) {
    return fault(error.path(), error.reason());
  } catch (const std::bad_alloc&) {
    return fault(file.string(), too_much);
  } catch (const std::length_error&) {
    return fault(file.string(), too_much);
  } catch (const std::exception& error) {
    return fault(file.string(), string("is broken: ") + error.what());
  }
}

[[noreturn]] void be_the_child(pid_t parent, int out, const std::filesystem::path& file,
                               const std::function<string()>& work) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(1);
  for (const int signal : {SIGSEGV, SIGBUS, SIGILL, SIGFPE, SIGABRT, SIGXCPU}) std::signal(signal, SIG_DFL);
  // The parent tells what happened; what the library or the runtime says as it dies is of no use to anybody.
  const int nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC);
  if (nowhere >= 0) dup2(nowhere, STDERR_FILENO);
  limit_this_process(limits_of(file));
  const string answer = answer_of(file, work);
  for (std::size_t sent = 0; sent < answer.size();) {
    const ssize_t count = ::write(out, answer.data() + sent, answer.size() - sent);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) _exit(1);
    sent += index(count);
  }
  _exit(0);
}

string everything_from(int in) {
  string text;
  std::array<char, 65536> piece{};
  while (true) {
    const ssize_t count = ::read(in, piece.data(), piece.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return text;
    text.append(piece.data(), index(count));
  }
}

string death_of(int status) {
  if (!WIFSIGNALED(status)) return fmt::format("reading it ended with code {}", WEXITSTATUS(status));
  if (WTERMSIG(status) == SIGXCPU) return "reading it comes to no end";
  return fmt::format("reading it crashed ({})", strsignal(WTERMSIG(status)));
}

}  // namespace

string read_apart(const std::filesystem::path& file, const std::function<string()>& work) {
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0)
    throw std::system_error(errno, std::generic_category(), "cannot make a pipe");
  const pid_t parent = getpid();
  const pid_t child = fork();
  if (child == 0) be_the_child(parent, ends[1], file, work);
  const int error = errno;
  close(ends[1]);
  const string answer = child < 0 ? string() : everything_from(ends[0]);
  close(ends[0]);
  if (child < 0) throw std::system_error(error, std::generic_category(), "cannot start a process");
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  const bool is_whole = WIFEXITED(status) && WEXITSTATUS(status) == 0 && !answer.empty();
  if (!is_whole) throw FileError(file, "is broken: " + death_of(status));
  if (answer[0] == result_mark) return answer.substr(1);
  const std::size_t end = answer.find('\0');
  throw FileError(answer.substr(1, end - 1), answer.substr(end + 1));
}

}  // namespace brio
