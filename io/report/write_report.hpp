#pragma once
/// One page (HTML) that shows a result in a browser, by itself: the scene as it moves, histories, summary,
/// deck. It needs neither a server nor a network.

#include <filesystem>
#include <string>
#include <vector>

namespace brio {

struct ReportOptions {
  std::filesystem::path result{};     ///< folder or .vtkhdf file
  std::filesystem::path output{};     ///< .html; empty: the name of the result with .html, beside it
  std::size_t frames = 100;           ///< at most; the first and the last dump are among them
  std::vector<std::string> fields{};  ///< to colour by; empty: all that are not zero
};

/// Rows of the history in a page at most.
inline constexpr std::size_t most_history_rows = 4000;

/// Where the page goes: `can.html` for `can.results` and for `can.vtkhdf`.
std::filesystem::path page_of(const ReportOptions& options);

/// The page. Everything of the result stands in it as data, nothing as a part of its program.
/// \throws FileError where the result cannot be read, or naming the fields that there are
std::string report_page(const ReportOptions& options);

}  // namespace brio
