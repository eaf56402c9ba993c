#pragma once
/// Boxes of features of one kind, and which of them overlap given boxes. A tree holds them as they were when
/// it was built; those that have got another box since are few and are looked at beside it.

#include <algorithm>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <vector>

#include "contact/search/global_search.hpp"
#include "src/base/index.hpp"

namespace brio {

/// So many boxes overlap that their pairs cannot be examined.
struct TooManyNear : std::runtime_error {
  TooManyNear() : std::runtime_error("contact search: everything is near everything") {}
};

/// A box that is larger on all sides.
inline CaptureBox grown(CaptureBox box, double by) {
  for (int axis = 0; axis < 3; ++axis) {
    box.lower[axis] -= by;
    box.upper[axis] += by;
  }
  return box;
}

class FeatureBoxes {
 public:
  /// As many features, none of which has a box.
  void start(std::size_t count);
  /// More features, none of the new ones has a box.
  void grow(std::size_t count);
  void set(std::size_t feature, const CaptureBox& box) { box_[feature] = box; }
  /// The tree of all boxes as they are.
  void build(ThreadTeam& team);
  /// Another box for a feature, once the tree is built.
  void change(int feature, const CaptureBox& box);

  std::size_t size() const { return box_.size(); }
  /// How many have changed since the tree was built.
  std::size_t changed() const { return changed_.size(); }
  const CaptureBox& operator[](std::size_t feature) const { return box_[feature]; }
  const CaptureBox& of(int feature) const { return box_[index(feature)]; }
  std::span<const CaptureBox> boxes() const { return box_; }

  /// Of every feature whose box meets query i, `judge(i, feature)` is called by any thread, in any order;
  /// where it gives anything but `none`, then `visit(i, feature, judgement)`, by i, in the same order for any
  /// number of threads.
  template <class Judgement, class Judge, class Visit>
  void find(std::span<const CaptureBox> queries, ThreadTeam& team, SearchCounts& counts,
            std::uint64_t most_pairs, Judgement none, const Judge& judge, const Visit& visit) {
    static_assert(sizeof(Judgement) == 1);
    for (std::size_t begin = 0; begin < queries.size(); begin += queries_at_once) {
      const auto part = queries.subspan(begin, std::min(queries_at_once, queries.size() - begin));
      tree_.find(part, team, found_, counts);
      find_changed(part, team, counts);
      if (counts.candidate_pairs > most_pairs) throw TooManyNear();
      const auto each_found = [&](std::size_t i, auto&& call) {
        const auto first = index(found_.first[i]);
        const auto found = found_.of_box(i);
        for (std::size_t k = 0; k < found.size(); ++k)
          if (is_changed_[index(found[k])] == 0) call(found[k], judgement_[first + k]);
        if (changed_.empty()) return;
        const std::size_t first_changed = found_.size() + index(found_changed_.first[i]);
        const auto among_changed = found_changed_.of_box(i);
        for (std::size_t k = 0; k < among_changed.size(); ++k)
          call(changed_[index(among_changed[k])], judgement_[first_changed + k]);
      };
      judgement_.resize(found_.size() + (changed_.empty() ? 0 : found_changed_.size()));
      team.for_ranges(part.size(), queries_a_task, [&](std::size_t from, std::size_t to) {
        for (std::size_t i = from; i < to; ++i)
          each_found(i, [&](int feature, std::uint8_t& judgement) {
            judgement = static_cast<std::uint8_t>(judge(begin + i, feature));
          });
      });
      for (std::size_t i = 0; i < part.size(); ++i)
        each_found(i, [&](int feature, std::uint8_t judgement) {
          if (judgement != static_cast<std::uint8_t>(none))
            visit(begin + i, feature, static_cast<Judgement>(judgement));
        });
    }
  }

  /// Saved and restored (src/base/state_archive.hpp).
  template <class Archive>
  void serialize(Archive& archive) {
    archive(box_, is_changed_, changed_, tree_);
  }

 private:
  /// What meets more queries is not held at a time: it is far more than what is paired of it.
  static constexpr std::size_t queries_at_once = 2048;
  static constexpr std::size_t queries_a_task = 64;

  void find_changed(std::span<const CaptureBox> queries, ThreadTeam& team, SearchCounts& counts);

  std::vector<CaptureBox> box_, changed_box_;
  std::vector<std::uint8_t> is_changed_;
  std::vector<int> changed_;
  TreeSearch tree_, tree_of_changed_;
  CandidatePairs found_, found_changed_;
  std::vector<std::uint8_t> judgement_;  ///< of what was found, then of what was found among the changed
};

}  // namespace brio
