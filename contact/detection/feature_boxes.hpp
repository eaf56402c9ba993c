#pragma once
/// Boxes of features of one kind, and which of them meet given boxes. A tree holds them as they were when it
/// was built; those that have got another box since are few and are looked at beside it.

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "contact/global_search.hpp"

namespace brio {

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
  const CaptureBox& of(int feature) const { return box_[static_cast<std::size_t>(feature)]; }
  std::span<const CaptureBox> boxes() const { return box_; }

  /// Call `visit(i, feature)` for every feature whose box meets query i, by i; the same order for any number
  /// of threads.
  template <class Visit>
  void find(std::span<const CaptureBox> queries, ThreadTeam& team, SearchCounts& counts, const Visit& visit) {
    for (std::size_t begin = 0; begin < queries.size(); begin += queries_at_once) {
      const auto part = queries.subspan(begin, std::min(queries_at_once, queries.size() - begin));
      tree_.find(part, team, found_, counts);
      find_changed(part, team, counts);
      for (std::size_t i = 0; i < part.size(); ++i) {
        for (int feature : found_.of_box(i))
          if (is_changed_[static_cast<std::size_t>(feature)] == 0) visit(begin + i, feature);
        if (!changed_.empty())
          for (int k : found_changed_.of_box(i)) visit(begin + i, changed_[static_cast<std::size_t>(k)]);
      }
    }
  }

 private:
  /// What meets more queries is not held at a time: it is far more than what is paired of it.
  static constexpr std::size_t queries_at_once = 2048;

  void find_changed(std::span<const CaptureBox> queries, ThreadTeam& team, SearchCounts& counts);

  std::vector<CaptureBox> box_, changed_box_;
  std::vector<std::uint8_t> is_changed_;
  std::vector<int> changed_;
  TreeSearch tree_, tree_of_changed_;
  CandidatePairs found_, found_changed_;
};

}  // namespace brio
