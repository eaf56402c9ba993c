#pragma once
/// NAME.log: what a run said, beside its results.

#include <filesystem>
#include <string>

namespace brio {

/// Keeps what is said until there is a place for it. A text that cannot be written is lost, as on a terminal:
/// no run ends for its log.
class RunLog {
 public:
  /// Begins with the program, the command, the machine and the time of day.
  RunLog(const std::string& command, const std::string& threads);
  /// \param goes_on whether a log that is there is continued
  void open(const std::filesystem::path& path, bool goes_on);
  void add(const std::string& text);

 private:
  std::filesystem::path path_;  ///< empty until it is open
  std::string kept_;
};

}  // namespace brio
