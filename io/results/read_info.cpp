#include "io/results/read_info.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <new>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "io/files/hdf5_file.hpp"
#include "io/files/text_file.hpp"
#include "io/results/dump_checksums.hpp"
#include "src/base/index.hpp"
#include "src/output/snapshot.hpp"

namespace brio {
namespace {

using std::string;

void must_be_result(const Hdf5File& file) {
  for (const char* part : {"/VTKHDF/Steps/Values", "/deck/title", "/history/values"}) {
    if (!file.contains("/VTKHDF") && file.contains("/deck"))
      throw FileError(file.path(), "the result holds no dump: the run failed before its first");
    if (!file.contains(part)) throw FileError(file.path(), string("not a result of brio: it has no ") + part);
  }
}

std::int64_t number_at(const Hdf5File& file, const string& table, std::int64_t row) {
  const std::vector<std::int64_t> values = file.read_integers(table, row, 1);
  if (values.empty()) throw FileError(file.path(), table + " has no columns");
  return values[0];
}

string cell_name(std::int64_t type) {
  switch (type) {
    case hexahedron_cell:
      return "hexahedra";
    case quadrilateral_cell:
      return "quadrilaterals";
    case line_cell:
      return "lines";
    case vertex_cell:
      return "vertices";
    default:
      return "cells of VTK type " + std::to_string(type);
  }
}

FieldInfo field_info(const Hdf5File& file, const string& where, const string& group, const string& name,
                     std::int64_t dump, std::int64_t rows) {
  const string table = "/VTKHDF/" + group + "/" + name;
  const std::int64_t first = number_at(file, "/VTKHDF/Steps/" + group + "Offsets/" + name, dump);
  const std::vector<double> values = file.read_rows(table, first, rows);
  FieldInfo info{where, name, rows > 0 ? static_cast<int>(values.size() / index(rows)) : 0,
                 std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  for (const double value : values) {
    if (std::isnan(value)) continue;  // what does not have the field
    info.min = std::min(info.min, value);
    info.max = std::max(info.max, value);
  }
  if (info.min > info.max) info.min = info.max = std::nan("");
  return info;
}

void read_dumps(const Hdf5File& file, ResultInfo& info) {
  const std::int64_t dumps =
      std::min(file.read_integer_attribute("/VTKHDF/Steps", "NSteps"), file.rows_of("/VTKHDF/Steps/Values"));
  info.times = file.read_rows("/VTKHDF/Steps/Values", 0, dumps);
  if (dumps == 0) return;
  const std::int64_t last = dumps - 1;
  const std::int64_t part = number_at(file, "/VTKHDF/Steps/PartOffsets", last);
  info.points = number_at(file, "/VTKHDF/NumberOfPoints", part);
  const std::int64_t cells = number_at(file, "/VTKHDF/NumberOfCells", part);
  const std::int64_t first_cell = number_at(file, "/VTKHDF/Steps/CellOffsets", last);
  for (const std::int64_t type : file.read_integers("/VTKHDF/Types", first_cell, cells)) {
    ++info.cells[cell_name(type)];
  }
  const auto add = [&](const char* where, const string& group, std::int64_t rows) {
    for (const string& name : file.members("/VTKHDF/" + group)) {
      info.fields.push_back(field_info(file, where, group, name, last, rows));
    }
  };
  add("point", "PointData", info.points);
  add("cell", "CellData", cells);
  add("global", "FieldData", 1);
}

void read_history(const Hdf5File& file, ResultInfo& info) {
  info.history_columns = file.read_texts("/history/columns");
  info.history_rows = file.rows_of("/history/values");
  if (info.history_rows > 0) info.history_last = file.read_rows("/history/values", info.history_rows - 1, 1);
  if (!info.history_last.empty() && info.history_last.size() != info.history_columns.size()) {
    throw FileError(file.path(), "/history/values and /history/columns do not belong together");
  }
}

void read_summary(ResultInfo& info) {
  std::filesystem::path path = info.file;
  path.replace_extension(".summary.json");
  if (!std::filesystem::exists(path)) return;
  try {
    const auto json = nlohmann::ordered_json::parse(read_small_file(path));
    info.status = json.at("status").get<string>();
    info.exit_code = json.at("exit_code").get<std::int64_t>();
    info.steps = json.at("steps").get<std::int64_t>();
    for (const auto& [name, value] : json.at("energy").items()) {
      info.energies.emplace_back(name, value.is_null() ? std::nan("") : value.get<double>());
    }
  } catch (const nlohmann::json::exception& error) {
    throw FileError(path, string("not a summary of brio: ") + error.what());
  }
}

ResultInfo read_file(const std::filesystem::path& path) {
  ResultInfo info;
  info.file = result_file(path);
  const Hdf5File file = Hdf5File::open_to_read(info.file);
  must_be_result(file);
  info.title = file.read_text("/deck/title");
  info.deck_path = file.read_text("/deck/path");
  info.deck_text = file.read_text("/deck/text");
  info.version = file.read_text("/deck/version");
  info.overrides = file.read_texts("/deck/overrides");
  info.threads = file.read_integer_attribute("/deck", "threads");
  read_dumps(file, info);
  read_history(file, info);
  read_summary(info);
  return info;
}

/// What a file can do to its reader becomes a FileError.
template <class Work>
auto guarded(const std::filesystem::path& path, const Work& work) {
  try {
    return work();
  } catch (const std::bad_alloc&) {  // a damaged file may claim any size
    throw FileError(path, "the file claims more data than memory can hold");
  } catch (const std::length_error&) {
    throw FileError(path, "the file claims more data than memory can hold");
  } catch (const std::filesystem::filesystem_error& error) {
    throw FileError(path, error.code().message());
  }
}

string verify_file(const std::filesystem::path& path) {
  const Hdf5File file = Hdf5File::open_to_read(result_file(path));
  must_be_result(file);
  const std::vector<string> faults = verify_checksums(file);
  if (faults.empty())
    return fmt::format("  checksums  {} dumps and {} rows of history are as they were written\n",
                       file.rows_of("/VTKHDF/Steps/Values"), file.rows_of("/history/values"));
  constexpr std::size_t most = 10;
  string told = "is damaged";
  for (std::size_t i = 0; i < std::min(most, faults.size()); ++i) told += "\n  " + faults[i];
  if (faults.size() > most) told += fmt::format("\n  and {} more", faults.size() - most);
  throw FileError(file.path(), told);
}

}  // namespace

std::filesystem::path result_file(const std::filesystem::path& path) {
  if (!std::filesystem::is_directory(path)) return path;
  std::vector<std::filesystem::path> found;
  bool begun = false;
  for (const auto& entry : std::filesystem::directory_iterator(path)) {
    if (entry.path().extension() == ".vtkhdf") found.push_back(entry.path());
    begun = begun || entry.path().filename().string().ends_with(".vtkhdf.partial");
  }
  if (found.size() == 1) return found[0];
  if (found.empty()) {
    throw FileError(path, begun ? "the run in this folder has not completed its first dump"
                                : "no .vtkhdf file in this folder");
  }
  std::sort(found.begin(), found.end());
  string names;
  for (const auto& file : found) names.append(" ").append(file.filename().string());
  throw FileError(path, "several results in this folder, name one of:" + names);
}

ResultInfo read_info(const std::filesystem::path& path) {
  return guarded(path, [&] { return read_file(path); });
}

string verify_result(const std::filesystem::path& path) {
  return guarded(path, [&] { return verify_file(path); });
}

}  // namespace brio
