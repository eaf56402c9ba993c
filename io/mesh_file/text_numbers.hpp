#pragma once
/// Numbers in text, independent of the locale.

#include <charconv>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace brio {

constexpr bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r'; }

constexpr std::string_view trimmed(std::string_view text) {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

/// The whole of a text as a number; nothing where it is none. A leading + is accepted.
template <class Number>
std::optional<Number> number_in(std::string_view text) {
  if (text.size() > 1 && text.front() == '+' && text[1] != '-') text.remove_prefix(1);
  Number number{};
  const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (fault != std::errc() || end != text.data() + text.size()) return {};
  return number;
}

/// The same, where Fortran's exponents (1.5D+3) are as good as others.
inline std::optional<double> fortran_number_in(std::string_view text) {
  if (const std::optional<double> number = number_in<double>(text)) return number;
  std::string copy(text);
  for (char& c : copy)
    if (c == 'D' || c == 'd') c = 'e';
  return number_in<double>(copy);
}

/// A piece of a file in a message: short, and without control characters.
inline std::string in_quotes(std::string_view text) {
  constexpr std::size_t longest = 40;
  std::string shown = "'";
  for (const char c : text.substr(0, longest))
    shown += static_cast<unsigned char>(c) < 0x20 || static_cast<unsigned char>(c) >= 0x7f ? '?' : c;
  return shown + (text.size() > longest ? "...'" : "'");
}

}  // namespace brio
