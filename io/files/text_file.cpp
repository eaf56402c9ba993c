#include "io/files/text_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <system_error>

#include "io/files/file_error.hpp"
#include "src/base/index.hpp"

namespace brio {
namespace {

/// Keeps a wrong file from filling the memory.
constexpr std::size_t largest_small_file = std::size_t{64} << 20;

/// \return 0 or the error number.
int write_all(int descriptor, std::string_view text) {
  while (!text.empty()) {
    const ssize_t written = ::write(descriptor, text.data(), text.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return written < 0 ? errno : ENOSPC;
    text.remove_prefix(index(written));
  }
  return 0;
}

int opened(const std::filesystem::path& path, int mode) {
  const int descriptor = ::open(path.c_str(), mode | O_CLOEXEC, 0666);
  if (descriptor < 0) throw FileError(path, std::string("cannot open the file: ") + std::strerror(errno));
  return descriptor;
}

std::filesystem::path folder_of(const std::filesystem::path& path) {
  return path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
}

/// Closes what it is given.
class Descriptor {
 public:
  explicit Descriptor(int descriptor) : descriptor_(descriptor) {}
  ~Descriptor() { ::close(descriptor_); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int get() const { return descriptor_; }

 private:
  int descriptor_;
};

}  // namespace

void rename_file(const std::filesystem::path& from, const std::filesystem::path& to) {
  std::error_code error;
  std::filesystem::rename(from, to, error);
  if (error) throw FileError(to, "cannot rename " + from.filename().string() + ": " + error.message());
}

void remove_file(const std::filesystem::path& path) {
  if (::unlink(path.c_str()) != 0 && errno != ENOENT)
    throw FileError(path, std::string("cannot remove the file: ") + std::strerror(errno));
}

int new_file(const std::filesystem::path& path) {
  remove_file(path);
  return opened(path, O_RDWR | O_CREAT | O_EXCL | O_NOFOLLOW);
}

void replace_text_file(const std::filesystem::path& path, const std::vector<std::string_view>& pieces,
                       bool sync) {
  std::filesystem::path temporary = path;
  temporary += ".partial";
  const int descriptor = new_file(temporary);
  int error = 0;
  for (const std::string_view piece : pieces) {
    if (error == 0) error = write_all(descriptor, piece);
  }
  if (error == 0 && sync && ::fsync(descriptor) != 0) error = errno;
  if (::close(descriptor) != 0 && error == 0) error = errno;
  if (error == 0 && std::rename(temporary.c_str(), path.c_str()) != 0) error = errno;
  if (error != 0) {
    ::unlink(temporary.c_str());
    throw FileError(path, std::string("cannot write: ") + std::strerror(error));
  }
  if (sync) sync_to_disk(folder_of(path));
}

void append_text_file(const std::filesystem::path& path, std::string_view text, bool sync) {
  const int descriptor = opened(path, O_WRONLY | O_APPEND | O_NOFOLLOW);
  const off_t before = ::lseek(descriptor, 0, SEEK_END);
  int error = before < 0 ? errno : write_all(descriptor, text);
  if (error != 0 && before >= 0 && ::ftruncate(descriptor, before) != 0) error = errno;
  if (error == 0 && sync && ::fsync(descriptor) != 0) error = errno;
  if (::close(descriptor) != 0 && error == 0) error = errno;
  if (error != 0) throw FileError(path, std::string("cannot write: ") + std::strerror(error));
}

void make_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw FileError(folder, "cannot make the folder: " + error.message());
}

std::string read_small_file(const std::filesystem::path& path) {
  const Descriptor file(opened(path, O_RDONLY | O_NONBLOCK));  // a pipe would wait for its other end
  struct stat status {};
  if (::fstat(file.get(), &status) != 0 || !S_ISREG(status.st_mode))
    throw FileError(path, "not a regular file");
  std::string text;
  std::string piece(std::size_t{1} << 16, '\0');
  while (true) {
    const ssize_t count = ::read(file.get(), piece.data(), piece.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) throw FileError(path, std::string("cannot read: ") + std::strerror(errno));
    if (count == 0) return text;
    text.append(piece, 0, index(count));
    if (text.size() > largest_small_file) throw FileError(path, "is longer than such a file can be");
  }
}

void sync_to_disk(const std::filesystem::path& path) {
  const Descriptor file(opened(path, O_RDONLY | O_NONBLOCK));
  // A file system that cannot do it for folders says EINVAL: there is nothing more to be had.
  if (::fsync(file.get()) != 0 && errno != EINVAL)
    throw FileError(path, std::string("cannot write: ") + std::strerror(errno));
}

}  // namespace brio
