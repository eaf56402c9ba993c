#pragma once
/// One list of pairs of features. What is taken out leaves a vacant place, which the next new pair takes: a
/// search changes few blocks of the list.

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "src/base/floating_point.hpp"
#include "src/base/parallel.hpp"

namespace brio {

/// What is kept between a pair: two skins; its radii; its radii once it has been apart by them, two skins
/// until then. None: the place is vacant.
enum class Spacing : std::uint8_t { skins, radii, waiting, none };

/// What a look at a pair reads, side by side.
struct alignas(32) PairRecord {
  int first = 0, second = 0;         ///< a node or an edge; a face or an edge
  std::array<float, 3> direction{};  ///< from the second to the first; zero: not known
  int relation = 0;                  ///< of their groups, in MotionGroups
  Spacing spacing = Spacing::none;

  bool operator==(const PairRecord&) const = default;
};

class PairList {
 public:
  static constexpr std::size_t block_size = 32;
  /// Motion bound: sum of the paths at which each pair has to be examined; of vacant places infinite.
  std::vector<double> wake;

  /// Places, vacant ones too.
  std::size_t size() const { return record_.size(); }
  std::size_t vacant() const { return vacant_.size(); }
  const std::vector<PairRecord>& records() const { return record_; }
  const PairRecord& operator[](std::size_t pair) const { return record_[pair]; }
  int first(std::size_t pair) const { return record_[pair].first; }
  int second(std::size_t pair) const { return record_[pair].second; }
  Spacing spacing(std::size_t pair) const { return record_[pair].spacing; }
  bool has_radii(std::size_t pair) const { return spacing(pair) == Spacing::radii; }
  void set_direction(std::size_t pair, double x, double y, double z) {
    record_[pair].direction = {static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)};
  }
  /// A pair that waited has been apart.
  void end_wait(std::size_t pair) { record_[pair].spacing = Spacing::radii; }

  void clear();
  void add(int first, int second, Spacing spacing, int relation);
  /// Take out those for which `leaves(first, second)`; `removed(first, second, spacing)` is then called for
  /// each, in the same order for any number of threads.
  template <class Leaves, class Removed>
  void remove_if(const Leaves& leaves, ThreadTeam& team, const Removed& removed);
  /// Close up where more than a quarter of the places are vacant.
  void close_up();

  /// Differs from what it was when a pair of the block came or went since.
  std::uint64_t version(std::size_t block) const { return version_[block]; }

  /// Saved and restored (src/base/state_archive.hpp).
  template <class Archive>
  void serialize(Archive& archive) {
    archive(wake, record_, vacant_, version_, changes_);
  }

 private:
  static constexpr std::size_t blocks_a_task = 256;
  /// Of a block, by bit.
  struct Leaving {
    std::uint32_t vacant = 0, leaving = 0;
  };

  void change(std::size_t pair) { version_[pair / block_size] = changes_; }

  std::vector<PairRecord> record_;
  std::vector<int> vacant_;  ///< descending
  std::vector<Leaving> leaving_;
  std::vector<std::uint64_t> version_;
  std::uint64_t changes_ = 0;
};

template <class Leaves, class Removed>
void PairList::remove_if(const Leaves& leaves, ThreadTeam& team, const Removed& removed) {
  ++changes_;
  leaving_.resize((size() + block_size - 1) / block_size);
  team.for_ranges(leaving_.size(), blocks_a_task, [&](std::size_t begin, std::size_t end) {
    for (std::size_t block = begin; block < end; ++block) {
      leaving_[block] = {};
      for (std::size_t i = block * block_size; i < std::min((block + 1) * block_size, size()); ++i) {
        const PairRecord& pair = record_[i];
        const std::uint32_t bit = 1U << (i % block_size);
        if (pair.spacing == Spacing::none)
          leaving_[block].vacant |= bit;
        else if (leaves(pair.first, pair.second))
          leaving_[block].leaving |= bit;
      }
    }
  });
  vacant_.clear();
  for (std::size_t block = leaving_.size(); block-- > 0;) {
    const Leaving& own = leaving_[block];
    if (own.leaving != 0) version_[block] = changes_;
    for (std::uint32_t bits = own.vacant | own.leaving; bits != 0;) {
      const int place = 31 - __builtin_clz(bits);
      bits ^= 1U << place;
      const std::size_t i = block * block_size + static_cast<std::size_t>(place);
      vacant_.push_back(static_cast<int>(i));
      if ((own.leaving >> place & 1U) == 0) continue;
      removed(record_[i].first, record_[i].second, record_[i].spacing);
      record_[i] = {};
      wake[i] = infinity;
    }
  }
}

}  // namespace brio
