#include "io/yaml/fault_list.hpp"

#include <algorithm>
#include <tuple>

namespace brio {

namespace {

// Overrides of the command line come first, then the deck and what it includes, each from its beginning.
bool is_before(const DeckError& a, const DeckError& b) {
  const auto order = [](const Place& place) { return std::tuple(place.line > 0, place.line, place.column); };
  const Place &first = a.place(), &second = b.place();
  const bool of_one_file = first.source && second.source && *first.source == *second.source;
  return of_one_file && order(first) < order(second);
}

}  // namespace

bool FaultList::attempt(std::string_view name, const std::function<void()>& read) {
  try {
    read();
    return true;
  } catch (const DeckError& fault) {
    add(fault);
  } catch (const FaultsTold&) {
  }
  if (!name.empty()) names_.emplace(name);
  return false;
}

// What several things need is told once.
void FaultList::add(const DeckError& fault) {
  const auto is_same = [&](const DeckError& other) { return std::string_view(other.what()) == fault.what(); };
  if (std::none_of(faults_.begin(), faults_.end(), is_same)) faults_.push_back(fault);
}

void FaultList::raise() const {
  std::vector<DeckError> ordered = faults_;
  // Not an order of all faults, as files are not compared: those of one file are moved past each other only.
  for (std::size_t i = 1; i < ordered.size(); ++i)
    for (std::size_t k = i; k > 0 && is_before(ordered[k], ordered[k - 1]); --k)
      std::swap(ordered[k], ordered[k - 1]);
  std::string message;
  for (std::size_t i = 0; i < std::min(most, ordered.size()); ++i)
    message += (i == 0 ? "" : "\n") + std::string(ordered[i].what());
  if (ordered.size() > most) message += "\nand " + std::to_string(ordered.size() - most) + " more faults";
  if (ordered.size() == 1) throw DeckError(ordered.front());
  throw DeckError(message);
}

}  // namespace brio
