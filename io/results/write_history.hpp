#pragma once
/// The history as a table: `/history` of the result file and a CSV file. In the result file
/// `/history/columns` holds the names and `/history/values` one row a record, double precision; the CSV file
/// has the same numbers, written with as many digits as it takes to read the same double back.

#include <filesystem>
#include <string>
#include <vector>

#include "src/output/history.hpp"

namespace brio {

class Hdf5File;

void create_history(Hdf5File& file, const std::vector<std::string>& columns);
void append_history(Hdf5File& file, const History& history);

/// \throws FileError
void create_history_csv(const std::filesystem::path& path, const std::vector<std::string>& columns);
/// \throws FileError; the table then ends with the last row before.
void append_history_csv(const std::filesystem::path& path, const History& history, bool sync = false);

/// A field of a CSV file, quoted where it must be (RFC 4180).
std::string csv_field(const std::string& text);

}  // namespace brio
