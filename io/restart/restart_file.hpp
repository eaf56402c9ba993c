#pragma once
/// Restart files: the state of a run between two steps, from which it goes on with the bits of a run that
/// was not interrupted.
///   NAME.restart.h5            the last state saved
///   NAME.restart.previous.h5   the one before
/// with the groups `/deck` (as in results) and `/state` (`bytes`, and `blocks`: size and checksum of each
/// run of them). A file is written under its `.partial` name, forced to the disk and renamed: whenever the
/// process or the machine dies, one of both is whole. A state is read by the program that wrote it, and by
/// no other.

#include <cstdint>
#include <filesystem>
#include <functional>
#include <istream>
#include <ostream>
#include <string>

#include "io/files/file_error.hpp"
#include "io/files/run_record.hpp"

namespace brio {

/// What a restart file says of itself.
struct RestartHeader {
  RunRecord record;
  double time = 0;
  std::int64_t step = 0;
};

inline constexpr const char* restart_ending = ".restart.h5";
inline constexpr const char* previous_restart_ending = ".restart.previous.h5";

/// Write the next restart file of a run; the last becomes the one before. \param save writes the state
/// \throws FileError; both files are then as they were.
void write_restart(const std::filesystem::path& folder, const std::string& name, const RestartHeader& header,
                   const std::function<void(std::ostream&)>& save);

/// A restart file that was read whole and compared with its checksums.
struct RestartFile {
  std::filesystem::path path;
  RestartHeader header;
  std::string instead_of;  ///< why the file that was asked for is not the one; empty: it is
};

/// The file, or where it is missing or damaged the one before. \throws FileError where there is none that
/// this program can read.
RestartFile find_restart(const std::filesystem::path& path);

/// \param restore reads the state, from a stream that holds so many bytes
void read_restart(const RestartFile& file, const std::function<void(std::istream&, std::uint64_t)>& restore);

/// Whether a file is one, by its name.
bool is_restart_file(const std::filesystem::path& path);

/// Header of a file that is whole. \throws FileError
RestartHeader verify_restart(const std::filesystem::path& path);

/// The same for reading on a terminal; several lines.
std::string restart_text(const std::filesystem::path& path);

}  // namespace brio
