#pragma once
/// What a study leaves: NAME.csv and NAME.md with the table, NAME.gp that gnuplot draws from.

#include <filesystem>
#include <string>

#include "io/study/run_study.hpp"

namespace brio {

/// The table in Markdown, with what follows from it.
std::string study_text(const StudyTable& table);

/// \throws FileError
void write_study_table(const StudyTable& table, const std::filesystem::path& folder, const std::string& name);

/// Writes NAME.gp and has gnuplot draw NAME.front.svg, NAME.knobs.svg and the same as PNG.
/// \return why there are no pictures; empty if there are.
std::string draw_study(const StudyTable& table, const std::filesystem::path& folder, const std::string& name);

}  // namespace brio
