#pragma once
/// The end state of a run as JSON.

#include <filesystem>
#include <string>

#include "src/output/summary.hpp"

namespace brio {

/// Keys in the order of the structure; a number that is not finite becomes null.
std::string summary_json(const Summary& summary);

/// \throws FileError; a summary that was there is then untouched.
void write_summary(const std::filesystem::path& path, const Summary& summary, bool sync = false);

}  // namespace brio
