#pragma once
/// Numbers of a Gmsh file, ASCII or binary.

#include <cstdint>
#include <string>
#include <string_view>

namespace brio {

class GmshSource {
 public:
  GmshSource(std::string_view text, const std::string& file) : text_(text), file_(file) {}

  /// In a file with binary sections no line is counted.
  void set_binary(bool is_binary) {
    is_binary_ = is_binary;
    has_lines_ = has_lines_ && !is_binary;
  }
  bool is_binary() const { return is_binary_; }

  /// \throws MeshFileError where the file ends, or holds something else.
  int integer(const char* what);
  std::int64_t count(const char* what);  ///< tags and counts: 64 bits
  double real(const char* what);

  /// A word of a line of text, also in binary files.
  std::string_view word(const char* what);
  std::string quoted_name();
  void skip_line();
  bool at_end();
  /// After the numbers of a section: its end mark.
  void end_section(const std::string& name);
  /// Over what is in a section that is not read.
  void skip_section(const std::string& name);

  /// \throws MeshFileError where the rest of the file cannot hold so many items of so many numbers
  void expect_room(std::int64_t items, std::int64_t integers, std::int64_t counts, std::int64_t reals,
                   const char* what);
  /// Of the present place; 0 in a binary file.
  std::uint32_t line();
  [[noreturn]] void fail(const std::string& fault);

 private:
  void skip_blanks();
  std::string_view token(const char* what);
  template <class Number>
  Number binary(const char* what);

  std::string_view text_;
  const std::string& file_;
  std::size_t at_ = 0;
  std::uint32_t line_ = 1;
  bool is_binary_ = false, has_lines_ = true;
};

}  // namespace brio
