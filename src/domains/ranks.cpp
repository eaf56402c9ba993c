#include "src/domains/ranks.hpp"

#include <cstring>

namespace brio {

void Ranks::swap(Kind kind, std::span<const Message> messages) {
  std::size_t bytes = 0;
  for (const Message& one : messages) bytes += one.out.size();
  count_sent(kind, bytes);
  send_and_receive(messages);
}

void Ranks::hand_over(Kind kind, int from, std::span<std::byte> data, bool to_all) {
  count_sent(kind, from == number_ ? data.size() : 0);
  pass_on(from, data, to_all);
}

int Ranks::largest(int value) {
  count_sent(Kind::agreement, sizeof value);
  return largest_of_all(value);
}

void Ranks::share(Kind kind) {
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
  count_sent(kind, first_[index(number_) + 1] - first_[index(number_)]);
  gather(bytes_, first_);
  next_ = first_;
  for (const Noted& one : noted_) {
    if (one.rank != number_) std::memcpy(one.data, bytes_.data() + next_[index(one.rank)], one.bytes);
    next_[index(one.rank)] += one.bytes;
  }
  noted_.clear();
}

}  // namespace brio
