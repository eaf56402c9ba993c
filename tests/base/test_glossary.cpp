// Each term of docs/glossary.md stands in the file that the glossary names.

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

namespace brio {
namespace {

const std::filesystem::path project = BRIO_SOURCE_DIR;

struct GlossaryRow {
  std::string term, file;
};

std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream text(line.substr(1));
  for (std::string cell; std::getline(text, cell, '|');) {
    const std::size_t first = cell.find_first_not_of(" `");
    const std::size_t last = cell.find_last_not_of(" `");
    cells.push_back(first == std::string::npos ? "" : cell.substr(first, last - first + 1));
  }
  return cells;
}

std::vector<GlossaryRow> rows_of_glossary() {
  std::vector<GlossaryRow> rows;
  std::ifstream glossary(project / "docs/glossary.md");
  for (std::string line; std::getline(glossary, line);) {
    if (!line.starts_with("| ") || line.starts_with("| term ") || line.starts_with("| ---")) continue;
    const std::vector<std::string> cells = cells_of(line);
    EXPECT_GE(cells.size(), 4u) << line;
    if (cells.size() >= 4) rows.push_back({cells[0], cells[2]});
  }
  return rows;
}

// In small letters; comment signs and line ends count as one space, so that a term may be broken across
// lines.
std::string words_of(const std::string& text) {
  std::string words;
  for (const char letter : text) {
    const bool separates = std::isspace(static_cast<unsigned char>(letter)) != 0 || letter == '/';
    if (!separates)
      words += static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
    else if (!words.empty() && words.back() != ' ')
      words += ' ';
  }
  return words;
}

TEST(Glossary, EachTermStandsInItsFile) {
  const std::vector<GlossaryRow> rows = rows_of_glossary();
  EXPECT_GT(rows.size(), 60u);
  for (const GlossaryRow& row : rows) {
    std::ifstream file(project / row.file);
    if (!file) {
      ADD_FAILURE() << row.term << ": no file " << row.file;
      continue;
    }
    std::ostringstream text;
    text << file.rdbuf();
    EXPECT_NE(words_of(text.str()).find(words_of(row.term)), std::string::npos)
        << "'" << row.term << "' does not stand in " << row.file;
  }
}

TEST(Glossary, NoTermStandsTwice) {
  std::vector<std::string> terms;
  for (const GlossaryRow& row : rows_of_glossary()) terms.push_back(words_of(row.term));
  std::sort(terms.begin(), terms.end());
  EXPECT_EQ(std::adjacent_find(terms.begin(), terms.end()), terms.end());
}

}  // namespace
}  // namespace brio
