#include "io/results/dump_checksums.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>

#include "io/files/checksum.hpp"
#include "io/files/run_record.hpp"
#include "src/base/index.hpp"

namespace brio {
namespace {

using std::string;

const string checksum_group = "/checksums";
const string name_table = "/checksums/tables";
const string dump_table = "/checksums/dumps";
const string history_table = "/checksums/history";
const string time_table = "/VTKHDF/Steps/Values";

constexpr hsize_t dump_columns = 5;
constexpr hsize_t values_of_history = 3;
constexpr hsize_t chunk_rows = 256;

std::int64_t as_stored(std::uint64_t sum) { return std::bit_cast<std::int64_t>(sum); }

std::int64_t checksum_of_deck(const Hdf5File& file) {
  const string all = texts_of(read_record(file));
  return as_stored(checksum(all.data(), all.size()));
}

/// Rows of a table of checksums.
std::vector<std::int64_t> read_records(const Hdf5File& file, const string& table, hsize_t columns) {
  const std::vector<std::int64_t> size = file.dimensions(table);
  if (size.size() != 2 || size[1] != static_cast<std::int64_t>(columns))
    throw FileError(file.path(), table + " is not a table of checksums");
  return file.read_integers(table, 0, size[0]);
}

/// \return what is wrong with the rows; empty if nothing is.
string fault_of(const Hdf5File& file, const string& table, std::int64_t first, std::int64_t rows,
                std::int64_t expected) {
  try {
    if (as_stored(file.checksum_of_rows(table, first, rows)) == expected) return {};
    return table + " is not as it was written";
  } catch (const FileError& error) {
    return error.reason();
  }
}

/// Faults of the dumps that the file counts as complete.
void verify_dumps(const Hdf5File& file, std::vector<string>& faults) {
  const std::int64_t complete = file.rows_of(time_table);
  const std::int64_t begun = file.read_integer_attribute("/VTKHDF/Steps", "NSteps");
  if (begun != complete && begun != complete + 1)
    faults.push_back(fmt::format("NSteps is {}, but there are times of {} dumps", begun, complete));
  if (complete == 0 && !file.contains(dump_table)) return;
  const std::vector<string> names = file.read_texts(name_table);
  const std::vector<std::int64_t> records = read_records(file, dump_table, dump_columns);
  std::vector<bool> seen(index(complete), false);
  for (std::size_t i = 0; i < records.size(); i += dump_columns) {
    const std::int64_t dump = records[i], table = records[i + 1];
    const bool is_known = dump >= 0 && table >= 0 && table < static_cast<std::int64_t>(names.size());
    if (!is_known || dump > complete) {
      faults.push_back(
          fmt::format("row {} of {} is of no dump or table that there is", i / dump_columns, dump_table));
      continue;
    }
    if (dump == complete) continue;  // the process was killed before this dump was complete
    const string& name = names[index(table)];
    if (name == time_table) seen[index(dump)] = true;
    const string fault = fault_of(file, name, records[i + 2], records[i + 3], records[i + 4]);
    if (!fault.empty())
      faults.push_back(
          fmt::format("dump {} at time {:.6g}: {}", dump, file.read_rows(time_table, dump, 1).at(0), fault));
  }
  for (std::size_t dump = 0; dump < seen.size(); ++dump)
    if (!seen[dump]) faults.push_back(fmt::format("dump {}: it has no checksums", dump));
}

void verify_history(const Hdf5File& file, std::vector<string>& faults) {
  const std::vector<std::int64_t> records = read_records(file, history_table, values_of_history);
  const std::int64_t rows = file.rows_of("/history/values");
  std::int64_t next = 0;
  for (std::size_t i = 0; i < records.size(); i += values_of_history) {
    const bool killed_before_it = i + values_of_history == records.size() && records[i] == rows;
    if (killed_before_it) break;
    const string fault = records[i] == next
                             ? fault_of(file, "/history/values", next, records[i + 1], records[i + 2])
                             : history_table + " is not as it was written";
    if (!fault.empty()) {
      faults.push_back(fmt::format("history, from row {} on: {}", next, fault));
      return;
    }
    next += records[i + 1];
  }
  if (next != rows) faults.push_back(fmt::format("history: rows from {} on have no checksums", next));
}

}  // namespace

void create_checksums(Hdf5File& file) {
  file.create_group(checksum_group);
  file.create_table(history_table, {H5T_STD_I64LE, values_of_history, chunk_rows});
  file.write_attribute(checksum_group, "deck", checksum_of_deck(file));
}

void append_dump_checksums(Hdf5File& file, std::int64_t dump, const std::vector<AppendedRows>& rows) {
  if (dump == 0) {
    std::vector<string> names;
    for (const AppendedRows& run : rows) names.push_back(run.table);
    file.write_texts(name_table, names);
    file.create_table(dump_table, {H5T_STD_I64LE, dump_columns, chunk_rows});
  }
  const std::vector<string> names = file.read_texts(name_table);
  std::vector<std::int64_t> records;
  for (const AppendedRows& run : rows) {
    const auto table = std::find(names.begin(), names.end(), run.table) - names.begin();
    if (table == std::ssize(names)) {
      file.commit();  // what a full disk did not take reads as nothing: says so
      throw FileError(file.path(), name_table + " does not name " + run.table + ": the file is damaged");
    }
    records.insert(records.end(), {dump, table, run.first, run.rows, as_stored(run.checksum)});
  }
  file.append_rows(dump_table, rows.size(), H5T_NATIVE_INT64, records.data());
}

void append_history_checksum(Hdf5File& file, const AppendedRows& rows) {
  const std::int64_t record[] = {rows.first, rows.rows, as_stored(rows.checksum)};
  file.append_rows(history_table, 1, H5T_NATIVE_INT64, record);
}

std::vector<string> verify_checksums(const Hdf5File& file) {
  if (!file.contains(checksum_group)) throw FileError(file.path(), "the file holds no checksums");
  std::vector<string> faults;
  if (checksum_of_deck(file) != file.read_integer_attribute(checksum_group, "deck"))
    faults.emplace_back("/deck is not as it was written");
  verify_dumps(file, faults);
  verify_history(file, faults);
  return faults;
}

}  // namespace brio
