#include "io/files/utf8.hpp"

namespace brio {
namespace {

unsigned byte_at(std::string_view text, std::size_t i) { return static_cast<unsigned char>(text[i]); }

std::size_t length_by_lead(unsigned lead) {
  if (lead < 0x80) return 1;
  if (lead >> 5 == 6) return 2;
  if (lead >> 4 == 14) return 3;
  return lead >> 3 == 30 ? 4 : 0;
}

unsigned number_of(std::string_view text, std::size_t i, std::size_t length) {
  unsigned number = length == 1 ? byte_at(text, i) : byte_at(text, i) & (0x7Fu >> length);
  for (std::size_t k = 1; k < length; ++k) number = number << 6 | (byte_at(text, i + k) & 0x3F);
  return number;
}

}  // namespace

std::size_t utf8_length(std::string_view text, std::size_t i) {
  constexpr unsigned least[] = {0, 0, 0x80, 0x800, 0x10000};
  const std::size_t length = length_by_lead(byte_at(text, i));
  if (length == 0 || i + length > text.size()) return 0;
  for (std::size_t k = 1; k < length; ++k)
    if ((byte_at(text, i + k) & 0xC0) != 0x80) return 0;
  const unsigned number = number_of(text, i, length);
  const bool is_surrogate = number >= 0xD800 && number <= 0xDFFF;
  return number < least[length] || is_surrogate || number > 0x10FFFF ? 0 : length;
}

bool is_control(std::string_view text, std::size_t i) {
  const unsigned number = number_of(text, i, utf8_length(text, i));
  if (number == '\t' || number == '\n' || number == '\r' || number == 0x85) return false;
  return number < 0x20 || (number >= 0x7F && number <= 0x9F) || number == 0xFFFE || number == 0xFFFF;
}

bool is_printable(std::string_view text) {
  if (text.find_first_of("\t\n\r") != std::string_view::npos) return false;
  for (std::size_t i = 0; i < text.size(); i += utf8_length(text, i))
    if (utf8_length(text, i) == 0 || is_control(text, i)) return false;
  return text.find("\xC2\x85") == std::string_view::npos;
}

std::string as_utf8(std::string_view text) {
  std::string result;
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t length = utf8_length(text, i);
    result += length > 0 ? text.substr(i, length) : std::string_view("\xEF\xBF\xBD");
    i += length > 0 ? length : 1;
  }
  return result;
}

}  // namespace brio
