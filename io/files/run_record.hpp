#pragma once
/// What was run, in files that a run writes.

#include <cstdint>
#include <string>
#include <vector>

namespace brio {

class Hdf5File;

/// What was run, kept in `/deck`: anybody can run it again from the result file.
struct RunRecord {
  std::string title;
  std::string deck_path;
  std::string deck_text;               ///< as read
  std::vector<std::string> overrides;  ///< KEY.PATH=VALUE, in order
  std::string version;
  int threads = 1;
  /// Of each file besides the deck that the scene is made of: its name and checksum.
  std::vector<std::string> mesh_checksums{};
  std::string program{};  ///< checksum of the program, where states of elements are written; else empty
};

/// Of the program that runs: a state is laid out as its structs are.
std::int64_t program_checksum();
/// The same as text.
std::string program_checksum_text();

/// Its texts, each followed by a NUL: what checksums of a record are of.
std::string texts_of(const RunRecord& record);

/// As the group `/deck`. \throws FileError
void write_record(Hdf5File& file, const RunRecord& record);
/// \throws FileError
RunRecord read_record(const Hdf5File& file);

}  // namespace brio
