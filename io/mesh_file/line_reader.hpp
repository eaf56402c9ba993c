#pragma once
/// Text line by line, and lines as fields between commas.

#include <cstdint>
#include <string_view>
#include <vector>

#include "io/mesh_file/text_numbers.hpp"

namespace brio {

class LineReader {
 public:
  explicit LineReader(std::string_view text) : text_(text) {}

  /// The next line, without its end; false where there is none.
  bool next(std::string_view& line) {
    if (at_ >= text_.size()) return false;
    const std::size_t end = text_.find('\n', at_);
    line = text_.substr(at_, end == std::string_view::npos ? end : end - at_);
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    last_ = at_;
    at_ = end == std::string_view::npos ? text_.size() : end + 1;
    ++line_;
    return true;
  }
  /// The last line is read again.
  void put_back() {
    at_ = last_;
    --line_;
  }
  std::uint32_t line() const { return line_; }  ///< from 1
  std::size_t bytes_left() const { return text_.size() - at_; }

 private:
  std::string_view text_;
  std::size_t at_ = 0, last_ = 0;
  std::uint32_t line_ = 0;
};

/// Fields between commas, without blanks around them; an empty one after a last comma is left out.
inline void split_at_commas(std::string_view line, std::vector<std::string_view>& fields) {
  fields.clear();
  while (true) {
    const std::size_t comma = line.find(',');
    fields.push_back(trimmed(line.substr(0, comma)));
    if (comma == std::string_view::npos) break;
    line.remove_prefix(comma + 1);
  }
  if (fields.back().empty()) fields.pop_back();
}

}  // namespace brio
