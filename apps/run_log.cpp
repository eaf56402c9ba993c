#include "apps/run_log.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <ctime>

#include "io/files/file_error.hpp"
#include "io/files/text_file.hpp"

namespace brio {

namespace {

std::string time_of_day() {
  const std::time_t now = std::time(nullptr);
  std::tm utc{};
  gmtime_r(&now, &utc);
  std::array<char, 32> text{};
  std::strftime(text.data(), text.size(), "%Y-%m-%d %H:%M:%S UTC", &utc);
  return text.data();
}

std::string name_of_machine() {
  std::array<char, 256> name{};
  return gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "a machine without a name";
}

}  // namespace

RunLog::RunLog(const std::string& command, const std::string& threads)
    : kept_(fmt::format("brio {}, {}, {}, threads {}\n{}\n", BRIO_VERSION, time_of_day(), name_of_machine(),
                        threads, command)) {}

void RunLog::open(const std::filesystem::path& path, bool goes_on) {
  try {
    if (goes_on && std::filesystem::exists(path))
      append_text_file(path, "\n" + kept_);
    else
      replace_text_file(path, {kept_});
    path_ = path;
  } catch (const FileError&) {
  }
  kept_.clear();
}

void RunLog::add(const std::string& text) {
  if (path_.empty()) {
    kept_ += text;
    return;
  }
  try {
    append_text_file(path_, text);
  } catch (const FileError&) {
  }
}

}  // namespace brio
