#pragma once
/// Processes that compute one scene together. Each holds the whole model and sweeps its share of the domains.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <type_traits>
#include <vector>

#include "src/base/index.hpp"

namespace brio {

class Ranks {
 public:
  Ranks(int number, int count) : number_(number), count_(count) {}
  virtual ~Ranks() = default;
  Ranks(const Ranks&) = delete;
  Ranks& operator=(const Ranks&) = delete;

  static constexpr int everyone = -1;  ///< in place of one rank

  /// Of this process, from 0 on.
  int number() const { return number_; }
  int count() const { return count_; }
  bool is_own(int rank) const { return rank == number_ || rank == everyone; }

  /// What ranks tell each other: rows of nodes, results of chunks, sums over nodes, state that is written,
  /// whether the run goes on.
  enum class Kind { rows, results, sums, state, agreement };
  static constexpr std::array<std::string_view, 5> kinds{"rows", "results", "sums", "state", "agreement"};
  /// What this rank has sent.
  struct Traffic {
    std::int64_t exchanges = 0, bytes = 0;
  };
  /// How often domains went to other ranks.
  int moves() const { return moves_; }
  void count_move() { ++moves_; }
  const Traffic& traffic(Kind kind) const { return traffic_[index(kind)]; }

  /// Messages between pairs of ranks, all at once. What is noted rides along, to all ranks.
  struct Message {
    int rank;  ///< the other one
    std::span<const std::byte> out;
    std::span<std::byte> in;
  };
  void swap(Kind kind, std::span<const Message> messages);
  /// Numbers that rank `from` has, to the first rank or to all.
  void hand_over(Kind kind, int from, std::span<std::byte> data, bool to_all);
  /// The largest value of all ranks.
  int largest(int value);

  /// Note numbers that `rank` has, as they will be at the next `swap` or `share`, by which all others get
  /// them; all ranks note the same.
  template <class T>
  void note(int rank, T* data, std::size_t count) {
    static_assert(std::is_trivially_copyable_v<T>);
    if (rank != everyone && count > 0)
      noted_.push_back({rank, reinterpret_cast<std::byte*>(data), count * sizeof(T)});
  }
  bool has_noted() const { return !noted_.empty(); }
  void share(Kind kind);

 protected:
  /// Every rank has filled its own part of an array and gets those of all others. \param first byte of each
  /// rank's part, and the size of the array at the end
  virtual void gather(std::span<std::byte> all, std::span<const std::size_t> first) = 0;
  /// Of several messages between two ranks the first is received first.
  virtual void send_and_receive(std::span<const Message> messages) = 0;
  virtual void pass_on(int from, std::span<std::byte> data, bool to_all) = 0;
  virtual int largest_of_all(int value) = 0;

 private:
  struct Noted {
    int rank;
    std::byte* data;
    std::size_t bytes;
  };

  void count_sent(Kind kind, std::size_t bytes, int exchanges = 1) {
    traffic_[index(kind)].exchanges += exchanges;
    traffic_[index(kind)].bytes += static_cast<std::int64_t>(bytes);
  }
  /// Of a rank, in the order in which they were noted.
  std::span<std::byte> noted_of(std::size_t rank) {
    return std::span(bytes_).subspan(first_[rank], first_[rank + 1] - first_[rank]);
  }
  void collect_noted();
  void give_noted();

  int number_, count_, moves_ = 0;
  std::array<Traffic, kinds.size()> traffic_{};
  std::vector<Noted> noted_;
  std::vector<std::byte> bytes_;
  std::vector<std::size_t> first_, next_;  ///< of each rank
  std::vector<Message> joined_;            ///< with what rides along
};

}  // namespace brio
