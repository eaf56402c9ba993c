#include "contact/detection/motion_groups.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace brio {

namespace {

constexpr std::size_t nodes_a_group = 128;  // or more, so that groups are not many more than
constexpr std::size_t most_groups = 512;
constexpr std::size_t fewest_nodes = 8;  // with which a body begins a group of its own, in the same way

std::size_t index(int i) { return static_cast<std::size_t>(i); }

double distance(const std::array<double, 3>& a, const std::array<double, 3>& b) {
  const double x = a[0] - b[0], y = a[1] - b[1], z = a[2] - b[2];
  return std::sqrt(x * x + y * y + z * z) * paths_rounded_up;
}

}  // namespace

void MotionGroups::form(const Surface& surface, const SurfaceFeatures& features,
                        std::span<const Vector3<double>> position, ThreadTeam& team) {
  order_.sort(position, team);
  std::vector<int> slaves;
  of_node_.assign(surface.slaves(), -1);
  for (std::size_t i = 0; i < order_.size(); ++i) {
    slaves.push_back(order_[i]);
    of_node_[index(order_[i])] = 0;
  }
  for (std::size_t s = 0; s < of_node_.size(); ++s)  // positions that are no numbers
    if (surface.node[s] >= 0 && of_node_[s] < 0) slaves.push_back(static_cast<int>(s));
  std::stable_sort(slaves.begin(), slaves.end(),
                   [&](int a, int b) { return surface.body[index(a)] < surface.body[index(b)]; });

  const std::size_t nodes = std::max(nodes_a_group, slaves.size() / most_groups),
                    fewest = std::max(fewest_nodes, slaves.size() / most_groups);
  int groups = 0, body = -1;
  std::size_t in_group = nodes;
  for (int s : slaves) {
    const bool new_body = surface.body[index(s)] != body;
    body = surface.body[index(s)];
    if (in_group >= nodes || (new_body && in_group >= fewest)) {
      ++groups;
      in_group = 0;
    }
    of_node_[index(s)] = groups - 1;
    ++in_group;
  }
  for (int& g : of_node_) g = std::max(g, 0);
  group.assign(index(std::max(groups, 1)), {});
  relation_of_.assign(group.size() * group.size(), -1);
  related_.clear();
  apart.clear();
  for (PathAndAhead* sums : {&relation, &total}) {
    sums->path.clear();
    sums->ahead.clear();
  }
  list_members(surface);
  find_borders(features);
}

void MotionGroups::join(const Surface& surface, const SurfaceFeatures& features,
                        std::span<const int> new_slave) {
  if (group.empty()) return;
  of_node_.resize(surface.slaves(), 0);
  for (int s : new_slave) of_node_[index(s)] = -1;
  for (const std::array<int, 4>& corner : features.face_node) {
    const auto known =
        std::find_if(corner.begin(), corner.end(), [&](int s) { return of_node_[index(s)] >= 0; });
    if (known == corner.end()) continue;
    for (int s : corner)
      if (of_node_[index(s)] < 0) of_node_[index(s)] = of_node_[index(*known)];
  }
  for (int s : new_slave) of_node_[index(s)] = std::max(of_node_[index(s)], 0);
  list_members(surface);
  find_borders(features);
}

void MotionGroups::list_members(const Surface& surface) {
  first_.assign(group.size() + 1, 0);
  for (std::size_t s = 0; s < of_node_.size(); ++s)
    if (surface.node[s] >= 0) ++first_[index(of_node_[s]) + 1];
  std::partial_sum(first_.begin(), first_.end(), first_.begin());
  member_.resize(first_.back());
  std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
  for (std::size_t s = 0; s < of_node_.size(); ++s)
    if (surface.node[s] >= 0) member_[next[index(of_node_[s])]++] = static_cast<int>(s);
}

void MotionGroups::find_borders(const SurfaceFeatures& features) {
  border_.clear();
  const auto add = [&](const auto& corners) {
    const int own = of_node(corners[0]);
    for (int s : corners)
      if (of_node(s) != own) border_.push_back({own, of_node(s), relate(own, of_node(s))});
  };
  for (const auto& corners : features.face_node) add(corners);
  for (const auto& ends : features.edge_node) add(ends);
  std::sort(border_.begin(), border_.end());
  border_.erase(std::unique(border_.begin(), border_.end()), border_.end());
}

int MotionGroups::relate(int a, int b) {
  int& known = relation_of_[cell(a, b)];
  if (known >= 0) return known;
  known = static_cast<int>(related_.size());
  related_.push_back({a, b});
  const Group &first = group[index(a)], &second = group[index(b)];
  apart.push_back({distance(first.last, second.last), distance(first.step, second.step)});
  const double ahead = approach_factor * apart.back()[1];
  relation.path.push_back(0);
  relation.ahead.push_back(ahead);
  total.path.push_back(first.longest_path + second.longest_path);
  total.ahead.push_back(first.longest_ahead + second.longest_ahead + ahead);
  return known;
}

void MotionGroups::advance(bool with_paths) {
  for (std::size_t r = 0; r < related_.size(); ++r) {
    const Group &a = group[index(related_[r][0])], &b = group[index(related_[r][1])];
    apart[r] = {distance(a.last, b.last), distance(a.step, b.step)};
  }
  longest_.clear();
  for (const Group& g : group) longest_.push_back({g.moved, g.ahead});
  for (auto [own, other, between] : border_) {  // a corner in another group moves with that
    const Group& of_corner = group[index(other)];
    auto& [moved, ahead] = longest_[index(own)];
    moved = std::max(moved, of_corner.moved + apart[index(between)][0]);
    ahead = std::max(ahead, of_corner.ahead + apart[index(between)][1]);
  }
  for (std::size_t g = 0; g < group.size(); ++g) {
    if (with_paths) group[g].longest_path += longest_[g][0];
    group[g].longest_ahead = group[g].longest_path + approach_factor * longest_[g][1];
  }
  for (std::size_t r = 0; r < related_.size(); ++r) {
    const Group &a = group[index(related_[r][0])], &b = group[index(related_[r][1])];
    if (with_paths) relation.path[r] += apart[r][0];
    relation.ahead[r] = relation.path[r] + approach_factor * apart[r][1];
    total.path[r] = a.longest_path + b.longest_path + relation.path[r];
    total.ahead[r] = a.longest_ahead + b.longest_ahead + relation.ahead[r];
  }
}

}  // namespace brio
