#pragma once
/// A fault of a deck, and where it is.

#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>

namespace brio {

/// A place in a deck, or the override of the command line that set a value.
struct Place {
  std::shared_ptr<const std::string> source;  ///< file name, or "--set KEY.PATH=VALUE"
  int line = 0;                               ///< from 1; 0 in an override or where only the file is known
  int column = 0;                             ///< from 1
};

/// `file:line:column`, or the source alone.
std::string to_string(const Place& place);

/// A deck that cannot be run. The message is `file:line:column: what is wrong; what is accepted`, a line each
/// where several faults are told at once.
class DeckError : public std::runtime_error {
 public:
  explicit DeckError(const std::string& message) : std::runtime_error(message) {}
  DeckError(const Place& place, const std::string& fault)
      : std::runtime_error(to_string(place) + ": " + fault), place_(place) {}

  const Place& place() const { return place_; }

 private:
  Place place_{};
};

}  // namespace brio
