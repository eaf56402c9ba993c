#include "io/results/read_result.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "io/files/hdf5_file.hpp"
#include "io/files/text_file.hpp"
#include "src/base/index.hpp"

namespace brio {

namespace {

const std::string root_group = "/VTKHDF/";
const std::string steps_group = "/VTKHDF/Steps/";

std::int64_t number(const Hdf5File& file, const std::string& table, std::size_t row) {
  const std::vector<std::int64_t> values = file.read_integers(table, static_cast<std::int64_t>(row), 1);
  if (values.empty()) throw FileError(file.path(), table + " is empty");
  return values[0];
}

// Numbers of points, cells and corners stand by part of the file, of which a new topology makes a new one.
std::int64_t count(const Hdf5File& file, const std::string& what, std::size_t dump) {
  return number(file, root_group + what, index(number(file, steps_group + "PartOffsets", dump)));
}

std::string listed(const std::vector<std::string>& names) {
  return fmt::format("{}", fmt::join(names, ", "));
}

}  // namespace

std::vector<double> ReadHistory::column(const std::string& name, const std::filesystem::path& file) const {
  const auto found = std::find(columns.begin(), columns.end(), name);
  if (found == columns.end())
    throw FileError(file, "the history has no column '" + name + "'; it has " + listed(columns));
  std::vector<double> result;
  for (auto i = index(found - columns.begin()); i < values.size(); i += columns.size())
    result.push_back(values[i]);
  return result;
}

ResultReader::ResultReader(std::filesystem::path file_name) : file_(std::move(file_name)) {
  const Hdf5File file = Hdf5File::open_to_read(file_);
  // The process may have been killed before the time of the last dump, which then is not complete.
  const std::int64_t dumps =
      std::min(file.read_integer_attribute("/VTKHDF/Steps", "NSteps"), file.rows_of(steps_group + "Values"));
  times_ = file.read_rows(steps_group + "Values", 0, dumps);
  if (times_.empty()) throw FileError(file_, "the result holds no dump");
}

std::vector<std::string> ResultReader::history_columns() const {
  return Hdf5File::open_to_read(file_).read_texts("/history/columns");
}

std::size_t ResultReader::dump_at(double time) const {
  const auto farther = [&](double a, double b) { return std::abs(a - time) < std::abs(b - time); };
  return index(std::min_element(times_.begin(), times_.end(), farther) - times_.begin());
}

ReadField ResultReader::field(const std::string& name, std::size_t dump) const {
  const Hdf5File file = Hdf5File::open_to_read(file_);
  const std::int64_t points = count(file, "NumberOfPoints", dump);
  const std::int64_t cells = count(file, "NumberOfCells", dump);
  ReadField result;
  std::int64_t rows = points;
  if (name == "position") {
    result.values =
        file.read_rows(root_group + "Points", number(file, steps_group + "PointOffsets", dump), points);
  } else {
    std::string group = "PointData";
    if (!file.contains(root_group + group + "/" + name)) {
      group = "CellData";
      result.of_points = false;
      rows = cells;
    }
    if (!file.contains(root_group + group + "/" + name))
      throw FileError(file_, "there is no field '" + name + "'; of points there are position, " +
                                 listed(file.members(root_group + "PointData")) + "; of cells " +
                                 listed(file.members(root_group + "CellData")));
    result.values = file.read_rows(root_group + group + "/" + name,
                                   number(file, steps_group + group + "Offsets/" + name, dump), rows);
  }
  result.rows = index(rows);
  result.components = rows > 0 ? result.values.size() / result.rows : 1;
  return result;
}

ReadCells ResultReader::cells(std::size_t dump) const {
  const Hdf5File file = Hdf5File::open_to_read(file_);
  const std::int64_t cells = count(file, "NumberOfCells", dump);
  ReadCells result;
  result.connectivity = file.read_integers(root_group + "Connectivity",
                                           number(file, steps_group + "ConnectivityIdOffsets", dump),
                                           count(file, "NumberOfConnectivityIds", dump));
  // Each part of the file has one offset more than cells.
  const std::int64_t before = number(file, steps_group + "PartOffsets", dump);
  result.offset = file.read_integers(root_group + "Offsets",
                                     number(file, steps_group + "CellOffsets", dump) + before, cells + 1);
  result.part = file.read_integers(root_group + "CellData/part",
                                   number(file, steps_group + "CellDataOffsets/part", dump), cells);
  return result;
}

ReadHistory ResultReader::history() const {
  const Hdf5File file = Hdf5File::open_to_read(file_);
  ReadHistory result;
  result.columns = file.read_texts("/history/columns");
  result.values = file.read_rows("/history/values", 0, file.dimensions("/history/values").at(0));
  return result;
}

nlohmann::json read_summary(const std::filesystem::path& file) {
  std::filesystem::path path = file;
  path.replace_extension(".summary.json");
  if (!std::filesystem::exists(path)) throw FileError(path, "there is no summary");
  try {
    return nlohmann::json::parse(read_small_file(path));
  } catch (const nlohmann::json::exception& error) {
    throw FileError(path, std::string("not a summary of brio: ") + error.what());
  }
}

}  // namespace brio
