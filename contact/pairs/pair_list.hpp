#pragma once
/// One list of pairs of features. What is taken out leaves a vacant place, which the next new pair takes: a
/// search changes few blocks of the list.

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "src/base/floating_point.hpp"
#include "src/base/index.hpp"
#include "src/base/parallel.hpp"
#include "src/base/tensor.hpp"

namespace brio {

/// What is kept between a pair: two skins; its radii; its radii once it has been apart by them, two skins
/// until then. None: the place is vacant.
enum class Spacing : std::uint8_t { skins, radii, waiting, none };

/// Of features, the pair of faces, or of a beam or particle and a face, that was opened for them.
enum class Parents : std::uint8_t { faces, rounds };
inline constexpr int no_parent = -1;
constexpr int parent_number(Parents of, std::size_t pair) {
  return of == Parents::faces ? static_cast<int>(pair) : -2 - static_cast<int>(pair);
}
constexpr Parents parents_of(int parent) { return parent >= 0 ? Parents::faces : Parents::rounds; }
constexpr std::size_t place_of_parent(int parent) { return index(parent >= 0 ? parent : -2 - parent); }

/// By which a height along a direction is lowered, as directions are kept in single precision.
inline constexpr double rounding_of_direction = 1e-6;

/// What a look at a pair reads, side by side.
struct alignas(32) PairRecord {
  int first = 0, second = 0;         ///< a node or an edge; a face or an edge
  std::array<float, 3> direction{};  ///< from the second to the first; zero: not known
  int relation = 0;                  ///< of their groups, in MotionGroups
  Spacing spacing = Spacing::none;
  /// Of faces: bit k: corner k of the first is of one piece with the second, and from bit 4 on the reverse.
  std::uint8_t one_piece = 0;
  int parent = no_parent;  ///< parent_number

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
  /// Before pairs are added or reset: blocks of them differ from what they were.
  void begin_changes() { ++changes_; }
  void add(const PairRecord& pair);
  /// Another motion bound for a pair, which may be less than what it was.
  void reset_wake(std::size_t pair, double bound) {
    wake[pair] = bound;
    change(pair);
  }
  /// Take out those for which `leaves(pair)`, any thread asks; `removed(record)` is then called for each, in
  /// the same order for any number of threads.
  template <class Leaves, class Removed>
  void remove_if(const Leaves& leaves, ThreadTeam& team, const Removed& removed);
  /// Close up where more than a quarter of the places are vacant; `moved(from, to)` is called for each pair.
  template <class Moved>
  void close_up(const Moved& moved);
  void close_up() {
    close_up([](std::size_t, std::size_t) {});
  }
  /// Of features: their parents have got other numbers.
  template <class Number>
  void renumber_parents(const Number& number) {
    for (PairRecord& pair : record_) pair.parent = number(pair.parent);
  }

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
        else if (leaves(i))
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
      const std::size_t i = block * block_size + index(place);
      vacant_.push_back(static_cast<int>(i));
      if ((own.leaving >> place & 1U) == 0) continue;
      removed(record_[i]);
      record_[i] = {};
      wake[i] = infinity;
    }
  }
}

template <class Moved>
void PairList::close_up(const Moved& moved) {
  if (4 * vacant() <= size()) return;
  ++changes_;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < size(); ++i) {
    if (record_[i].spacing == Spacing::none) continue;
    moved(i, kept);
    record_[kept] = record_[i];
    wake[kept++] = wake[i];
  }
  record_.resize(kept);
  wake.resize(kept);
  vacant_.clear();
  version_.assign((kept + block_size - 1) / block_size, changes_);
}

}  // namespace brio
