#pragma once
/// A fault of a mesh file, and where it is.

#include <cstdint>
#include <stdexcept>
#include <string>

namespace brio {

/// The message is `file:line: what is wrong; what is accepted`; of a binary file it is `file: ...` and names
/// the thing.
class MeshFileError : public std::runtime_error {
 public:
  explicit MeshFileError(const std::string& message) : std::runtime_error(message) {}
  MeshFileError(const std::string& file, std::uint32_t line, const std::string& fault)
      : std::runtime_error(file + (line > 0 ? ":" + std::to_string(line) : "") + ": " + fault) {}
};

}  // namespace brio
