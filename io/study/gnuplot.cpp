#include "io/study/gnuplot.hpp"

#include <algorithm>
#include <cctype>
#include <system_error>

#include "io/files/text_file.hpp"
#include "io/study/run_processes.hpp"

namespace brio {

std::string without_control(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return std::iscntrl(c) != 0; }, ' ');
  return text;
}

std::string data_field(std::string text) {
  std::replace(text.begin(), text.end(), '"', '\'');
  std::replace(text.begin(), text.end(), '\\', '/');
  return '"' + without_control(text) + '"';
}

std::string literal(const std::string& words) {
  std::string text = "'";
  for (const char c : without_control(words)) text.append(c == '\'' ? 2 : 1, c);
  return text + '\'';
}

std::string text_literal(const std::string& words) {
  std::string text = "'";
  for (const char c : without_control(words))
    text += c == '\'' ? std::string("\xE2\x80\x99") : std::string(1, c);
  return text + '\'';
}

std::string run_gnuplot(const std::filesystem::path& folder, const std::string& script) {
  const std::filesystem::path faults = folder / "gnuplot.txt";
  int exit_code = 0;
  try {
    run_processes({{{"gnuplot", "./" + script}, faults, folder}}, 1, nullptr,
                  [&](const Ended& ended) { exit_code = ended.exit_code; });
  } catch (const std::system_error& fault) {
    if (fault.code() != std::errc::no_such_file_or_directory) throw;
    return "gnuplot is not installed; with it, `gnuplot " + script + "` in " + folder.string() +
           " draws them";
  }
  if (exit_code != 0) return "gnuplot failed; see " + faults.string();
  remove_file(faults);
  return {};
}

}  // namespace brio
