#include "contact/pairs/pair_list.hpp"

namespace brio {

void PairList::clear() {
  ++changes_;
  record_.clear();
  wake.clear();
  vacant_.clear();
  version_.clear();
}

void PairList::add(int first, int second, Spacing spacing, int relation) {
  std::size_t place = size();
  if (vacant_.empty()) {
    record_.emplace_back();
    wake.emplace_back();
    if (place % block_size == 0) version_.push_back(0);
  } else {
    place = static_cast<std::size_t>(vacant_.back());
    vacant_.pop_back();
  }
  record_[place] = {first, second, {}, relation, spacing};
  wake[place] = -1;
  change(place);
}

void PairList::close_up() {
  if (4 * vacant() <= size()) return;
  ++changes_;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < size(); ++i) {
    if (record_[i].spacing == Spacing::none) continue;
    record_[kept] = record_[i];
    wake[kept++] = wake[i];
  }
  record_.resize(kept);
  wake.resize(kept);
  vacant_.clear();
  version_.assign((kept + block_size - 1) / block_size, changes_);
}

}  // namespace brio
