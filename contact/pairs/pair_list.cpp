#include "contact/pairs/pair_list.hpp"

#include "src/base/index.hpp"

namespace brio {

void PairList::clear() {
  ++changes_;
  record_.clear();
  wake.clear();
  vacant_.clear();
  version_.clear();
}

void PairList::add(const PairRecord& pair) {
  std::size_t place = size();
  if (vacant_.empty()) {
    record_.emplace_back();
    wake.emplace_back();
    if (place % block_size == 0) version_.push_back(0);
  } else {
    place = index(vacant_.back());
    vacant_.pop_back();
  }
  record_[place] = pair;
  wake[place] = -1;
  change(place);
}

}  // namespace brio
