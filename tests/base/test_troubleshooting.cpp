// Each message that docs/troubleshooting.md explains is one that the program has.

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

namespace brio {
namespace {

namespace fs = std::filesystem;

std::string text_of_file(const fs::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

// With string literals that are broken across lines put together.
std::string all_sources() {
  const std::regex broken_literal("\"\\s*\\n\\s*\"");
  std::string text;
  for (const char* folder : {"src", "elements", "materials", "contact", "io", "apps"})
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(BRIO_SOURCE_DIR) / folder))
      if (entry.path().extension() == ".cpp" || entry.path().extension() == ".hpp")
        text += std::regex_replace(text_of_file(entry.path()), broken_literal, "");
  return text;
}

/// What stands between names and numbers.
std::vector<std::string> pieces_of(std::string message) {
  std::vector<std::string> pieces;
  const std::string gap = "...";
  for (std::size_t at = 0; at != std::string::npos;) {
    at = message.find(gap);
    pieces.push_back(message.substr(0, at));
    if (at != std::string::npos) message.erase(0, at + gap.size());
  }
  return pieces;
}

TEST(Troubleshooting, EachMessageIsOneOfTheProgram) {
  const std::string sources = all_sources();
  std::ifstream page(fs::path(BRIO_SOURCE_DIR) / "docs/troubleshooting.md");
  int count = 0;
  for (std::string line; std::getline(page, line);) {
    if (!line.starts_with("| `")) continue;
    ++count;
    const std::string message = line.substr(3, line.find('`', 3) - 3);
    for (const std::string& piece : pieces_of(message))
      EXPECT_NE(sources.find(piece), std::string::npos) << message << ": no source has \"" << piece << '"';
  }
  EXPECT_GT(count, 35);
}

}  // namespace
}  // namespace brio
