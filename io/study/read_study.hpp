#pragma once
/// The door for studies.

#include <string>
#include <vector>

#include "io/yaml/deck_error.hpp"
#include "src/forecast/study.hpp"

namespace brio {

/// A study from a YAML file, its deck read with the settings of every run.
struct CheckedStudy {
  Study study;
  std::string deck;  ///< path of the deck
  std::vector<StudyRun> runs;
  std::vector<std::string> texts;     ///< of the deck of each run, with its overrides
  std::vector<std::string> meshes{};  ///< of each run: names and checksums of its mesh files
  std::vector<std::string> parts;     ///< names, in the order of the deck
};

/// \throws DeckError naming the place, what is wrong and what is accepted: of the study, of its deck, or of
/// an override.
CheckedStudy read_study(const std::string& path);

}  // namespace brio
