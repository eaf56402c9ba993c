#include "io/files/folder_lock.hpp"

#include <fcntl.h>
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <ctime>
#include <sstream>
#include <string>
#include <utility>

#include "io/files/file_error.hpp"
#include "src/base/index.hpp"

namespace brio {
namespace {

using std::string;

string host_name() {
  std::array<char, 256> name{};
  if (gethostname(name.data(), name.size() - 1) != 0 || name[0] == '\0') return "unknown";
  return name.data();
}

/// Of a lock file, in its words: `PID HOST SINCE`.
struct Owner {
  pid_t process = 0;
  string host, since;

  bool is_known() const { return process > 0; }
  /// As far as can be told from here.
  bool may_live() const {
    return is_known() && (host != host_name() || kill(process, 0) == 0 || errno == EPERM);
  }
  string text() const {
    return is_known() ? fmt::format(": process {} on {}, since {}", process, host, since)
                      : string("; it has not written its name");
  }
};

Owner read_owner(int descriptor) {
  std::array<char, 512> text{};
  const ssize_t size = pread(descriptor, text.data(), text.size(), 0);
  if (size <= 0) return {};
  for (char& c : text)
    if (static_cast<unsigned char>(c) < 0x20 || static_cast<unsigned char>(c) > 0x7E) c = ' ';
  std::istringstream words(string(text.data(), index(size)));
  Owner owner;
  if (!(words >> owner.process >> owner.host >> owner.since)) return {};
  return owner;
}

void write_owner(int descriptor) {
  const std::time_t now = std::time(nullptr);
  const string text = fmt::format("{} {} {:%Y-%m-%dT%H:%M:%SZ}\n", getpid(), host_name(), fmt::gmtime(now));
  // A disk that is full takes nothing from the lock but the name of its owner.
  if (ftruncate(descriptor, 0) != 0 || pwrite(descriptor, text.data(), text.size(), 0) < 0) return;
}

}  // namespace

FolderLock::FolderLock(std::filesystem::path folder)
    : folder_(std::move(folder)), file_(folder_ / ".brio.lock") {
  constexpr int pause_ms = 10;
  constexpr auto patience = std::chrono::seconds(5);
  const auto start = std::chrono::steady_clock::now();
  while (!try_to_lock()) {
    const Owner owner = read_owner(descriptor_);
    ::close(std::exchange(descriptor_, -1));
    if (owner.may_live() || std::chrono::steady_clock::now() - start > patience)
      throw FileError(folder_, "another process of brio writes in this folder" + owner.text());
    poll(nullptr, 0, pause_ms);
  }
  write_owner(descriptor_);
}

/// \return whether the lock is held; if not, the file is open all the same.
bool FolderLock::try_to_lock() {
  while (true) {
    descriptor_ = ::open(file_.c_str(), O_RDWR | O_CREAT | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC, 0666);
    if (descriptor_ < 0) throw FileError(folder_, string("cannot lock the folder: ") + std::strerror(errno));
    if (flock(descriptor_, LOCK_EX | LOCK_NB) != 0) {
      const int error = errno;
      if (error == EWOULDBLOCK) return false;
      if (error != EINTR) {
        ::close(std::exchange(descriptor_, -1));
        throw FileError(folder_, string("cannot lock the folder: ") + std::strerror(error));
      }
    } else if (is_at_path()) {
      return true;
    }
    ::close(std::exchange(descriptor_, -1));  // its owner removed the file as it ended
  }
}

bool FolderLock::is_at_path() const {
  struct stat held {
  }, found{};
  return fstat(descriptor_, &held) == 0 && lstat(file_.c_str(), &found) == 0 && held.st_dev == found.st_dev &&
         held.st_ino == found.st_ino;
}

void FolderLock::check() const {
  if (!is_at_path())
    throw FileError(folder_, "the folder was moved, removed or taken by another process during the run");
}

FolderLock::~FolderLock() {
  if (is_at_path()) ::unlink(file_.c_str());
  ::close(descriptor_);
}

}  // namespace brio
