#pragma once
/// The file system said no, or a file is not what it should be.

#include <filesystem>
#include <stdexcept>
#include <string>

namespace brio {

/// `what()` reads "PATH: REASON". What had been written to the file before stays readable.
class FileError : public std::runtime_error {
 public:
  FileError(const std::filesystem::path& path, const std::string& reason)
      : std::runtime_error(path.string() + ": " + reason), path_(path.string()), reason_(reason) {}

  const std::string& path() const { return path_; }
  const std::string& reason() const { return reason_; }

 private:
  std::string path_, reason_;
};

}  // namespace brio
