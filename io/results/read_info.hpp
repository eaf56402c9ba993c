#pragma once
/// What is in a result: for `brio info`.

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "io/files/file_error.hpp"

namespace brio {

/// A field as of the last dump.
struct FieldInfo {
  std::string where;  ///< "point", "cell" or "global"
  std::string name;
  int components = 1;
  double min = 0, max = 0;  ///< over rows and components that are numbers; NaN without any
};

struct ResultInfo {
  std::filesystem::path file;
  std::string title, deck_path, deck_text, version;
  std::vector<std::string> overrides;
  std::int64_t threads = 0;
  std::vector<double> times;  ///< of the complete dumps
  std::int64_t points = 0;    ///< of the last dump, as are cells and fields
  std::map<std::string, std::int64_t> cells;
  std::vector<FieldInfo> fields;
  std::int64_t history_rows = 0;
  std::vector<std::string> history_columns;
  std::vector<double> history_last;  ///< empty when there is no row
  std::string status;                ///< of the summary beside the file; empty while there is none
  std::int64_t exit_code = 0;
  std::int64_t steps = 0;
  std::vector<std::pair<std::string, double>> energies;  ///< of the summary, in its order
};

/// \param path a file, which is returned, or a result folder
/// \return the only `.vtkhdf` file of that folder. \throws FileError when there is none or there are several.
std::filesystem::path result_file(const std::filesystem::path& path);

/// \param path a `.vtkhdf` file or a result folder with one of them.
/// \throws FileError when there is none or it is something else.
ResultInfo read_info(const std::filesystem::path& path);

/// Reads all of a result and compares it with its checksums.
/// \return one line that says what was compared. \throws FileError naming the dumps and tables that differ.
std::string verify_result(const std::filesystem::path& path);

/// For reading on a terminal; several lines.
std::string info_text(const ResultInfo& info);

}  // namespace brio
