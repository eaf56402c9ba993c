#pragma once
/// All faults of a deck that are found in one reading.

#include <functional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "io/yaml/deck_error.hpp"

namespace brio {

/// Thrown where what cannot be read has been told already, or depends on what could not be read.
struct FaultsTold {};

class FaultList {
 public:
  /// As many are told.
  static constexpr std::size_t most = 20;

  /// Reads one of several things that do not depend on each other. A fault is kept, so that the others are
  /// read all the same. \param name what other things call it by; may be empty
  /// \return whether it was read
  bool attempt(std::string_view name, const std::function<void()>& read);

  bool empty() const { return faults_.empty(); }
  /// Whether a thing of that name could not be read.
  bool concerns(std::string_view name) const { return names_.contains(name); }

  /// All faults, in the order of their places. \pre not empty
  [[noreturn]] void raise() const;

 private:
  void add(const DeckError& fault);

  std::vector<DeckError> faults_;
  std::set<std::string, std::less<>> names_;
};

}  // namespace brio
