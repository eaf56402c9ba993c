#pragma once
/// Text in UTF-8 (RFC 3629).

#include <cstddef>
#include <string>
#include <string_view>

namespace brio {

/// Bytes of the sequence that starts at `text[i]`; 0 if it is none: cut short, longer than need be, or of a
/// number that is no character.
std::size_t utf8_length(std::string_view text, std::size_t i);

/// Whether the sequence at `text[i]`, which is one, is a control character: below U+0020, U+007F to U+009F,
/// or one that XML does not accept. Tab, line feed, carriage return and next line are not.
bool is_control(std::string_view text, std::size_t i);

/// Whether all of it is UTF-8 without control characters or ends of lines: fit for a name.
bool is_printable(std::string_view text);

/// The text with U+FFFD in place of every byte that is not UTF-8.
std::string as_utf8(std::string_view text);

}  // namespace brio
