#pragma once
/// Processes that compute one scene together. Each holds the whole model and sweeps its share of the domains.

#include <cstddef>
#include <span>
#include <type_traits>
#include <vector>

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

  /// Every rank has filled its own part of an array and gets those of all others. \param first byte of each
  /// rank's part, and the size of the array at the end
  virtual void gather(std::span<std::byte> all, std::span<const std::size_t> first) = 0;
  /// The largest value of all ranks.
  virtual int largest(int value) = 0;

  /// Note numbers that `rank` has and all others get by the next `share`; all ranks note the same.
  template <class T>
  void note(int rank, T* data, std::size_t count) {
    static_assert(std::is_trivially_copyable_v<T>);
    if (rank != everyone && count > 0)
      noted_.push_back({rank, reinterpret_cast<std::byte*>(data), count * sizeof(T)});
  }
  bool has_noted() const { return !noted_.empty(); }
  void share();

 private:
  struct Noted {
    int rank;
    std::byte* data;
    std::size_t bytes;
  };

  int number_, count_;
  std::vector<Noted> noted_;
  std::vector<std::byte> bytes_;
  std::vector<std::size_t> first_, next_;  ///< of each rank
};

}  // namespace brio
