#pragma once
/// Ranks that are threads of the test: each computes a model of its own.

#include <gtest/gtest.h>

#include <algorithm>
#include <barrier>
#include <cstring>
#include <functional>
#include <span>
#include <vector>

#include "src/base/index.hpp"
#include "src/base/parallel.hpp"
#include "src/domains/ranks.hpp"

namespace brio::test {

/// What the ranks of one run share.
class RankTable {
 public:
  explicit RankTable(int count)
      : meet_(count), bytes_(index(count)), message_(index(count)), values_(index(count)) {
    for (auto& from : message_) from.resize(index(count));
  }
  int count() const { return static_cast<int>(values_.size()); }

 private:
  friend class ThreadRanks;
  std::barrier<> meet_;
  std::vector<std::span<std::byte>> bytes_;
  std::vector<std::vector<std::vector<std::span<const std::byte>>>> message_;  ///< from each rank to each
  std::vector<int> values_;
};

class ThreadRanks : public Ranks {
 public:
  ThreadRanks(RankTable& table, int number) : Ranks(number, table.count()), table_(table) {}

 protected:
  void gather(std::span<std::byte> all, std::span<const std::size_t> first) override {
    table_.bytes_[index(number())] = all;
    table_.meet_.arrive_and_wait();
    for (std::size_t rank = 0; rank < index(count()); ++rank)
      if (rank != index(number()) && first[rank + 1] > first[rank])
        std::memcpy(all.data() + first[rank], table_.bytes_[rank].data() + first[rank],
                    first[rank + 1] - first[rank]);
    table_.meet_.arrive_and_wait();
  }

  void send_and_receive(std::span<const Message> messages) override {
    for (auto& to : table_.message_[index(number())]) to.clear();
    for (const Message& one : messages) table_.message_[index(number())][index(one.rank)].push_back(one.out);
    table_.meet_.arrive_and_wait();
    std::vector<std::size_t> received(index(count()), 0);
    for (const Message& one : messages) {
      const std::span<const std::byte> sent =
          table_.message_[index(one.rank)][index(number())].at(received[index(one.rank)]++);
      ASSERT_EQ(sent.size(), one.in.size());
      std::ranges::copy(sent, one.in.begin());
    }
    table_.meet_.arrive_and_wait();
  }

  void pass_on(int from, std::span<std::byte> data, bool to_all) override {
    if (number() == from) table_.bytes_[index(from)] = data;
    table_.meet_.arrive_and_wait();
    if (number() != from && (to_all || number() == 0))
      std::ranges::copy(table_.bytes_[index(from)], data.begin());
    table_.meet_.arrive_and_wait();
  }

  int largest_of_all(int value) override {
    table_.values_[index(number())] = value;
    table_.meet_.arrive_and_wait();
    const int result = *std::ranges::max_element(table_.values_);
    table_.meet_.arrive_and_wait();
    return result;
  }

 private:
  RankTable& table_;
};

/// Run `of_rank(ranks)` on each of them, side by side.
inline void run_ranks(int count, const std::function<void(Ranks&)>& of_rank) {
  RankTable table(count);
  ThreadTeam team(count);
  team.for_each(index(count), [&](std::size_t number) {
    ThreadRanks ranks(table, static_cast<int>(number));
    of_rank(ranks);
  });
}

}  // namespace brio::test
