#include "src/domains/ranks.hpp"

#include <algorithm>

namespace brio {

void Ranks::swap(Kind kind, std::span<const Message> messages) {
  std::size_t bytes = 0;
  for (const Message& one : messages) bytes += one.out.size();
  count_sent(kind, bytes);
  if (noted_.empty()) return send_and_receive(messages);
  collect_noted();
  const std::span<const std::byte> own = noted_of(index(number_));
  count_sent(Kind::results, own.size() * (index(count_) - 1), 0);
  joined_.assign(messages.begin(), messages.end());
  for (int rank = 0; rank < count_; ++rank)
    if (rank != number_) joined_.push_back({rank, own, noted_of(index(rank))});
  send_and_receive(joined_);
  give_noted();
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
  collect_noted();
  count_sent(kind, noted_of(index(number_)).size());
  gather(bytes_, first_);
  give_noted();
}

void Ranks::collect_noted() {
  first_.assign(index(count_) + 1, 0);
  for (const Noted& one : noted_) first_[index(one.rank) + 1] += one.bytes;
  for (std::size_t rank = 0; rank + 1 < first_.size(); ++rank) first_[rank + 1] += first_[rank];
  bytes_.resize(first_.back());
  std::byte* own = noted_of(index(number_)).data();
  for (const Noted& one : noted_)
    if (one.rank == number_) own = std::copy_n(one.data, one.bytes, own);
}

void Ranks::give_noted() {
  next_ = first_;
  for (const Noted& one : noted_) {
    std::size_t& next = next_[index(one.rank)];
    if (one.rank != number_) std::copy_n(bytes_.data() + next, one.bytes, one.data);
    next += one.bytes;
  }
  noted_.clear();
}

}  // namespace brio
