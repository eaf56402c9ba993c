#include "io/text_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string>

#include "io/file_error.hpp"

namespace brio {
namespace {

/// \return 0 or the error number.
int write_all(int descriptor, std::string_view text) {
  while (!text.empty()) {
    const ssize_t written = ::write(descriptor, text.data(), text.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return written < 0 ? errno : ENOSPC;
    text.remove_prefix(static_cast<std::size_t>(written));
  }
  return 0;
}

int opened(const std::filesystem::path& path, int mode) {
  const int descriptor = ::open(path.c_str(), mode | O_CLOEXEC, 0666);
  if (descriptor < 0) throw FileError(path, std::string("cannot open the file: ") + std::strerror(errno));
  return descriptor;
}

}  // namespace

void replace_text_file(const std::filesystem::path& path, std::initializer_list<std::string_view> pieces) {
  std::filesystem::path temporary = path;
  temporary += ".partial";
  const int descriptor = opened(temporary, O_WRONLY | O_CREAT | O_TRUNC);
  int error = 0;
  for (const std::string_view piece : pieces) {
    if (error == 0) error = write_all(descriptor, piece);
  }
  if (::close(descriptor) != 0 && error == 0) error = errno;
  if (error == 0 && std::rename(temporary.c_str(), path.c_str()) != 0) error = errno;
  if (error == 0) return;
  ::unlink(temporary.c_str());
  throw FileError(path, std::string("cannot write: ") + std::strerror(error));
}

void append_text_file(const std::filesystem::path& path, std::string_view text) {
  const int descriptor = opened(path, O_WRONLY | O_APPEND);
  const off_t before = ::lseek(descriptor, 0, SEEK_END);
  int error = before < 0 ? errno : write_all(descriptor, text);
  if (error != 0 && before >= 0 && ::ftruncate(descriptor, before) != 0) error = errno;
  if (::close(descriptor) != 0 && error == 0) error = errno;
  if (error != 0) throw FileError(path, std::string("cannot write: ") + std::strerror(error));
}

}  // namespace brio
