#pragma once
/// Checksums of what a result file holds:
///   /checksums/tables   names of the tables of a dump
///   /checksums/dumps    one row for each run of rows that a dump appended: dump, table, first row, rows,
///   checksum /checksums/history  the same of the history: first row, rows, checksum /checksums attribute
///   `deck`: of the texts of `/deck`
/// A checksum is xxHash64 of the bytes as stored. A row stands in the file no later than what it is about.

#include <cstdint>
#include <string>
#include <vector>

#include "io/files/hdf5_file.hpp"

namespace brio {

/// After the texts of `/deck` were written. \throws FileError
void create_checksums(Hdf5File& file);

/// \param rows all that the dump appends; in the first dump to all tables that there will be. \throws
/// FileError
void append_dump_checksums(Hdf5File& file, std::int64_t dump, const std::vector<AppendedRows>& rows);

/// \throws FileError
void append_history_checksum(Hdf5File& file, const AppendedRows& rows);

/// Reads everything that has a checksum.
/// \return what differs, one line each, which names dump and table; empty where all is as it was written.
/// \throws FileError where the file holds no checksums, or cannot be read at all.
std::vector<std::string> verify_checksums(const Hdf5File& file);

}  // namespace brio
