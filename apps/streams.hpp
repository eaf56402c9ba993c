#pragma once
/// Standard output and standard error, which may be closed, full or without a reader.

#include <fmt/format.h>

#include <atomic>
#include <string>
#include <string_view>
#include <utility>

namespace brio {

/// Takes descriptors 0 to 2 where they are closed, so that no file of results becomes one of them, and turns
/// a reader that went away or a file that may not grow into an error of the call that writes.
void prepare_streams();

/// Whether anything is written from now on: of several processes one speaks for all.
void mute(bool is_mute);

/// To standard output. What cannot be written is reported by `finish_output`.
void write_out_text(std::string_view text);
/// To standard error. A text that cannot be written is lost: nothing depends on it.
void write_error_text(std::string_view text);

template <class... Values>
void write_out(fmt::format_string<Values...> text, Values&&... values) {
  write_out_text(fmt::format(text, std::forward<Values>(values)...));
}
template <class... Values>
void write_error(fmt::format_string<Values...> text, Values&&... values) {
  write_error_text(fmt::format(text, std::forward<Values>(values)...));
}

/// Hands on what has been printed so far.
void flush_output();
/// The same at the end. \return why standard output could not be written, now or before; empty: it could.
std::string finish_output();

/// From now on SIGINT, SIGTERM and SIGHUP are only noted. A SIGHUP that the caller ignores (nohup) stays so.
void note_signals();
/// The last signal that was noted, or 0.
const std::atomic<int>& noted_signal();

}  // namespace brio
