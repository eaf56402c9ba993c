#pragma once
/// What a deck may say, from the same tables that read it.

#include <string>

namespace brio {

/// JSON schema (draft 7) of the deck, for completion and checking in editors.
std::string deck_schema();

/// The printed reference, in Markdown.
std::string deck_reference();

}  // namespace brio
