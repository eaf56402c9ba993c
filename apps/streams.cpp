#include "apps/streams.hpp"

#include <fcntl.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>

namespace brio {

namespace {

std::atomic<int> last_signal{0};

void note_signal(int signal) { last_signal = signal; }

bool is_muted = false;
int output_fault = 0;  // errno of the first text that could not be written

void remember_fault() {
  if (output_fault == 0) output_fault = errno != 0 ? errno : EIO;
}

}  // namespace

// Opened for the other direction: a text for a closed stream fails as before.
void prepare_streams() {
  for (const int stream : {0, 1, 2})
    if (fcntl(stream, F_GETFD) < 0 && errno == EBADF) open("/dev/null", stream == 0 ? O_WRONLY : O_RDONLY);
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
}

void mute(bool is_mute) { is_muted = is_mute; }

void write_out_text(std::string_view text) {
  if (is_muted) return;
  errno = 0;
  if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size()) remember_fault();
}

void write_error_text(std::string_view text) {
  if (is_muted) return;
  std::fwrite(text.data(), 1, text.size(), stderr);
  std::fflush(stderr);
}

void flush_output() {
  errno = 0;
  if (std::fflush(stdout) != 0) remember_fault();
}

std::string finish_output() {
  flush_output();
  return output_fault == 0
             ? ""
             : std::string("standard output: cannot be written: ") + std::strerror(output_fault);
}

void note_signals() {
  std::signal(SIGINT, note_signal);
  std::signal(SIGTERM, note_signal);
  if (std::signal(SIGHUP, note_signal) == SIG_IGN) std::signal(SIGHUP, SIG_IGN);
}

const std::atomic<int>& noted_signal() { return last_signal; }

}  // namespace brio
