#pragma once
/// What a deck, and a study, may say, from the same tables that read it; what results hold, from those that
/// write them.

#include <string>

namespace brio {

/// JSON schema (draft 7) of the deck, for completion and checking in editors.
std::string deck_schema();

std::string study_schema();

/// The printed reference, in Markdown.
std::string deck_reference();
std::string study_reference();
/// Fields, columns of the history and keys of the summary.
std::string results_reference();

}  // namespace brio
