#pragma once
/// Text files that are complete at every moment.

#include <filesystem>
#include <initializer_list>
#include <string_view>

namespace brio {

/// Write the pieces to a temporary name in the same folder, then rename: the old file or the new one is
/// there. \throws FileError; the old file is then untouched and nothing is left beside it.
void replace_text_file(const std::filesystem::path& path, std::initializer_list<std::string_view> pieces);

/// Append to a file that exists. \throws FileError; the file is then as long as before.
void append_text_file(const std::filesystem::path& path, std::string_view text);

}  // namespace brio
