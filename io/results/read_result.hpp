#pragma once
/// Reads figures back out of a result: dumps, history, summary.

#include <array>
#include <cstdint>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace brio {

/// One field of one dump.
struct ReadField {
  bool of_points = true;  ///< of points, or of cells
  std::size_t rows = 0, components = 0;
  std::vector<double> values;  ///< row after row
};

struct ReadCells {
  std::vector<std::int64_t> connectivity, offset;  ///< as in a snapshot
  std::vector<std::int64_t> part;                  ///< number of the part, one a cell
};

struct ReadHistory {
  std::vector<std::string> columns;
  std::vector<double> values;  ///< row after row
  /// One column. \throws FileError naming the columns that there are.
  std::vector<double> column(const std::string& name, const std::filesystem::path& file) const;
};

/// All functions throw FileError where the file does not hold what is asked for.
class ResultReader {
 public:
  /// \param file a `.vtkhdf` file
  explicit ResultReader(std::filesystem::path file);

  const std::vector<double>& times() const { return times_; }  ///< of the dumps
  /// The dump nearest to a time.
  std::size_t dump_at(double time) const;
  /// \param name of a field of points or of cells, or `position`
  ReadField field(const std::string& name, std::size_t dump) const;
  ReadCells cells(std::size_t dump) const;
  ReadHistory history() const;
  std::vector<std::string> history_columns() const;

 private:
  std::filesystem::path file_;
  std::vector<double> times_;
};

/// The summary beside a result. \throws FileError if there is none.
nlohmann::json read_summary(const std::filesystem::path& file);

}  // namespace brio
