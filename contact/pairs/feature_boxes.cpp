#include "contact/pairs/feature_boxes.hpp"

#include "src/base/index.hpp"

namespace brio {

void FeatureBoxes::start(std::size_t count) {
  box_.assign(count, empty_box);
  is_changed_.assign(count, 0);
  changed_.clear();
}

void FeatureBoxes::grow(std::size_t count) {
  box_.resize(count, empty_box);
  is_changed_.resize(count, 0);
}

void FeatureBoxes::build(ThreadTeam& team) {
  tree_.build(SearchNodes(box_), team);
  for (int feature : changed_) is_changed_[index(feature)] = 0;
  changed_.clear();
}

void FeatureBoxes::change(int feature, const CaptureBox& box) {
  const auto f = index(feature);
  box_[f] = box;
  if (is_changed_[f] != 0) return;
  is_changed_[f] = 1;
  changed_.push_back(feature);
}

void FeatureBoxes::find_changed(std::span<const CaptureBox> queries, ThreadTeam& team, SearchCounts& counts) {
  if (changed_.empty()) return;
  changed_box_.clear();
  for (int feature : changed_) changed_box_.push_back(of(feature));
  tree_of_changed_.find(SearchNodes(changed_box_), queries, team, found_changed_, counts);
}

}  // namespace brio
