#include "src/domains/ranks.hpp"

#include <cstring>

#include "src/base/index.hpp"

namespace brio {

void Ranks::share() {
  first_.assign(index(count_) + 1, 0);
  for (const Noted& one : noted_) first_[index(one.rank) + 1] += one.bytes;
  for (std::size_t rank = 0; rank + 1 < first_.size(); ++rank) first_[rank + 1] += first_[rank];
  bytes_.resize(first_.back());
  next_ = first_;
  for (const Noted& one : noted_)
    if (one.rank == number_) {
      std::memcpy(bytes_.data() + next_[index(one.rank)], one.data, one.bytes);
      next_[index(one.rank)] += one.bytes;
    }
  gather(bytes_, first_);
  next_ = first_;
  for (const Noted& one : noted_) {
    if (one.rank != number_) std::memcpy(one.data, bytes_.data() + next_[index(one.rank)], one.bytes);
    next_[index(one.rank)] += one.bytes;
  }
  noted_.clear();
}

}  // namespace brio
