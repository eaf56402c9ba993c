#pragma once
/// Small files that are complete at every moment. Nothing is written through a symbolic link.

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace brio {

/// Write the pieces to a temporary name in the same folder, then rename: the old file or the new one is
/// there. \param sync whether the file is on the disk when this returns. \throws FileError; the old file is
/// then untouched and nothing is left beside it.
void replace_text_file(const std::filesystem::path& path, const std::vector<std::string_view>& pieces,
                       bool sync = false);

/// Append to a file that exists. \throws FileError; the file is then as long as before.
void append_text_file(const std::filesystem::path& path, std::string_view text, bool sync = false);

/// A file that was not there before: what stood under its name is removed, not followed.
/// \return its descriptor, open for reading and writing. \throws FileError
int new_file(const std::filesystem::path& path);

/// With those above it, where they are not there. \throws FileError
void make_folder(const std::filesystem::path& folder);

/// Replaces a file that is there. \throws FileError
void rename_file(const std::filesystem::path& from, const std::filesystem::path& to);

/// A file that is not there is no fault. \throws FileError
void remove_file(const std::filesystem::path& path);

/// The whole of a regular file. \throws FileError where it is none, cannot be read or is longer than a file
/// of its kind can be.
std::string read_small_file(const std::filesystem::path& path);

/// Have the system bring a file, or the names in a folder, to the disk. \throws FileError
void sync_to_disk(const std::filesystem::path& path);

}  // namespace brio
