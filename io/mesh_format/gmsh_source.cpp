#include "io/mesh_format/gmsh_source.hpp"

#include <algorithm>
#include <cstring>

#include "io/mesh_file/mesh_file_error.hpp"
#include "io/mesh_file/text_numbers.hpp"

namespace brio {

std::uint32_t GmshSource::line() { return has_lines_ ? line_ : 0; }

void GmshSource::fail(const std::string& fault) { throw MeshFileError(file_, line(), fault); }

void GmshSource::skip_blanks() {
  for (; at_ < text_.size(); ++at_) {
    const char c = text_[at_];
    if (c == '\n')
      ++line_;
    else if (!is_blank(c))
      return;
  }
}

bool GmshSource::at_end() {
  skip_blanks();
  return at_ >= text_.size();
}

std::string_view GmshSource::token(const char* what) {
  skip_blanks();
  const std::size_t begin = at_;
  while (at_ < text_.size() && !is_blank(text_[at_]) && text_[at_] != '\n') ++at_;
  if (at_ == begin) fail("the file ends where " + std::string(what) + " is expected");
  return text_.substr(begin, at_ - begin);
}

std::string_view GmshSource::word(const char* what) { return token(what); }

template <class Number>
Number GmshSource::binary(const char* what) {
  if (text_.size() - at_ < sizeof(Number)) fail("the file ends where " + std::string(what) + " is expected");
  Number number;
  std::memcpy(&number, text_.data() + at_, sizeof number);
  at_ += sizeof number;
  return number;
}

int GmshSource::integer(const char* what) {
  if (is_binary_) return binary<std::int32_t>(what);
  const std::string_view text = token(what);
  const auto number = number_in<int>(text);
  if (!number) fail(in_quotes(text) + " is not " + what + "; an integer is expected");
  return *number;
}

std::int64_t GmshSource::count(const char* what) {
  if (is_binary_) return binary<std::int64_t>(what);
  const std::string_view text = token(what);
  const auto number = number_in<std::int64_t>(text);
  if (!number) fail(in_quotes(text) + " is not " + what + "; an integer is expected");
  return *number;
}

double GmshSource::real(const char* what) {
  if (is_binary_) return binary<double>(what);
  const std::string_view text = token(what);
  const auto number = number_in<double>(text);
  if (!number) fail(in_quotes(text) + " is not " + what + "; a number is expected");
  return *number;
}

std::string GmshSource::quoted_name() {
  skip_blanks();
  const std::size_t line_end = std::min(text_.find('\n', at_), text_.size());
  const std::size_t begin = text_.find('"', at_);
  const std::size_t end = begin < line_end ? text_.find('"', begin + 1) : begin;
  if (begin >= line_end || end >= line_end) fail("a name of a physical group is expected, in double quotes");
  at_ = end + 1;
  return std::string(text_.substr(begin + 1, end - begin - 1));
}

void GmshSource::skip_line() {
  const std::size_t end = text_.find('\n', at_);
  if (end == std::string_view::npos) {
    at_ = text_.size();
    return;
  }
  at_ = end + 1;
  ++line_;
}

void GmshSource::end_section(const std::string& name) {
  const std::string_view mark = token("the end of a section");
  if (mark != "$End" + name)
    fail(in_quotes(mark) + " stands where '$End" + name +
         "' is expected: the counts of the section are wrong");
}

void GmshSource::skip_section(const std::string& name) {
  const std::string mark = "$End" + name;
  const std::size_t found = text_.find("\n" + mark, at_ > 0 ? at_ - 1 : 0);
  if (found == std::string_view::npos) fail("the section '$" + name + "' has no '" + mark + "'");
  line_ +=
      static_cast<std::uint32_t>(std::count(text_.begin() + static_cast<std::ptrdiff_t>(at_),
                                            text_.begin() + static_cast<std::ptrdiff_t>(found) + 1, '\n'));
  at_ = found + 1 + mark.size();
}

void GmshSource::expect_room(std::int64_t items, std::int64_t integers, std::int64_t counts,
                             std::int64_t reals, const char* what) {
  const std::int64_t bytes = is_binary_ ? 4 * integers + 8 * (counts + reals)
                                        : 2 * (integers + counts + reals);  // a digit and a blank
  const auto left = static_cast<std::int64_t>(text_.size() - at_) + 1;
  if (items < 0 || (bytes > 0 && items > left / bytes))
    fail(std::to_string(items) + " " + what + " are announced, more than the file can hold");
}

}  // namespace brio
