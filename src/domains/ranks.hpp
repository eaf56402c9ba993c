#pragma once
/// Processes that compute one scene together. Each holds the whole model and sweeps its share of the domains.

#include <cstddef>
#include <span>

namespace brio {

class Ranks {
 public:
  Ranks(int number, int count) : number_(number), count_(count) {}
  virtual ~Ranks() = default;
  Ranks(const Ranks&) = delete;
  Ranks& operator=(const Ranks&) = delete;

  /// Of this process, from 0 on.
  int number() const { return number_; }
  int count() const { return count_; }

  /// Every rank has filled its own part of an array and gets those of all others. \param first byte of each
  /// rank's part, and the size of the array at the end
  virtual void gather(std::span<std::byte> all, std::span<const std::size_t> first) = 0;
  /// The largest value of all ranks.
  virtual int largest(int value) = 0;

 private:
  int number_, count_;
};

}  // namespace brio
