#pragma once
/// Pictures by gnuplot. It runs what stands in backquotes, in text between double quotes as well: texts of
/// decks and studies stand between single quotes, where nothing is expanded, or in data. Names of files begin
/// with `./`: one that begins with `|` is a command.

#include <filesystem>
#include <string>

namespace brio {

/// A text in one line.
std::string without_control(std::string text);
/// A field of a block of data.
std::string data_field(std::string text);
/// The name of a file in a command; it begins with `./`, since a quote in front would be misread.
std::string literal(const std::string& words);
/// A text in a command, with apostrophes as they are printed.
std::string text_literal(const std::string& words);

/// Runs a script, which stays where it is, to be drawn anew by hand. \param script its name in the folder
/// \return why nothing was drawn; empty if it was
std::string run_gnuplot(const std::filesystem::path& folder, const std::string& script);

}  // namespace brio
