#pragma once
/// Files that a deck names: further decks, `include: [materials.yaml]`, and tables, `{file: steel.csv}` or
/// `{file: tests.csv, columns: [strain, stress]}`.

#include <memory>
#include <string>

#include "io/yaml/yaml_source.hpp"

namespace brio {

/// The tree with what it includes, of which everything knows its place: sections that are maps or lists are
/// joined, those of included files first.
/// \throws DeckError where a file cannot be read, or a key stands twice.
std::shared_ptr<const YamlNode> with_includes(const std::shared_ptr<const YamlNode>& root,
                                              const std::string& deck_file);

/// The tree with the rows of the files in place of the maps that name them: two numbers a row. Rows know
/// their place in the file. A file has columns apart by commas, semicolons or blanks, comments behind #, and
/// may begin with a row of names. A relative path begins at the file in which it stands.
/// \param deck_file where paths of overrides begin
/// \throws DeckError if a file cannot be read or has no such columns.
std::shared_ptr<const YamlNode> with_tables(const std::shared_ptr<const YamlNode>& root,
                                            const std::string& deck_file);

/// A path that stands at a place, relative to the file there.
std::string path_from(const Place& place, const std::string& deck_file, const std::string& path);

}  // namespace brio
