#pragma once
/// A set of slave nodes, visited in ascending order: what a step does for the few nodes in contact, in the
/// order in which it would do it for all.

#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "src/base/index.hpp"
#include "src/base/parallel.hpp"

namespace brio {

class SlaveSet {
 public:
  explicit SlaveSet(std::size_t slaves = 0) : word_((slaves + bits - 1) / bits, 0) {}

  void resize(std::size_t slaves) { word_.resize((slaves + bits - 1) / bits, 0); }
  void insert(int slave) {
    const auto s = index(slave);
    word_[s / bits] |= std::uint64_t{1} << s % bits;
  }

  bool contains(int slave) const {
    const auto s = index(slave);
    return (word_[s / bits] >> s % bits & 1) != 0;
  }

  template <class Visit>
  void for_each(Visit&& visit) const {
    for (std::size_t w = 0; w < word_.size(); ++w) visit_word(w, visit);
  }

  /// By threads, `visit(range, slave)`, in ascending order within each of `ranges()`, which are the same for
  /// any number of threads.
  template <class Visit>
  void for_each(ThreadTeam& team, Visit&& visit) const {
    team.for_ranges(word_.size(), words_a_range, [&](std::size_t begin, std::size_t end) {
      for (std::size_t w = begin; w < end; ++w)
        visit_word(w, [&](std::size_t slave) { visit(begin / words_a_range, slave); });
    });
  }
  std::size_t ranges() const { return (word_.size() + words_a_range - 1) / words_a_range; }

  void clear() { word_.assign(word_.size(), 0); }

  /// Saved and restored (src/base/state_archive.hpp).
  template <class Archive>
  void serialize(Archive& archive) {
    archive(word_);
  }

 private:
  static constexpr std::size_t bits = 64, words_a_range = 16;

  template <class Visit>
  void visit_word(std::size_t w, Visit&& visit) const {
    for (std::uint64_t left = word_[w]; left != 0; left &= left - 1)
      visit(w * bits + index(std::countr_zero(left)));
  }

  std::vector<std::uint64_t> word_;
};

}  // namespace brio
