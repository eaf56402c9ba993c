#include "contact/features/motion_groups.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "src/base/index.hpp"

namespace brio {

namespace {

constexpr std::size_t nodes_a_group = 128;  // or more, so that groups are not many more than
constexpr std::size_t most_groups = 512;
constexpr std::size_t fewest_nodes = 8;  // with which a body begins a group of its own, in the same way

double distance(const Vector3d& a, const Vector3d& b) {
  const double x = a[0] - b[0], y = a[1] - b[1], z = a[2] - b[2];
  return std::sqrt(x * x + y * y + z * z) * paths_rounded_up;
}

}  // namespace

void MotionGroups::form(const Surface& surface, const SurfaceFeatures& features,
                        std::span<const Vector3d> position, ThreadTeam& team) {
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
  border_.clear();
  holds_face.clear();
  holds_edge.clear();
  for (const auto& corners : features.face_node) holds_face.push_back(add_borders(corners));
  for (const auto& ends : features.edge_node) holds_edge.push_back(add_borders(ends));
}

void MotionGroups::list_members(const Surface& surface) {
  member_.start_packed(group.size());
  for (std::size_t s = 0; s < of_node_.size(); ++s)
    if (surface.node[s] >= 0) ++member_.first[index(of_node_[s]) + 1];
  std::partial_sum(member_.first.begin(), member_.first.end(), member_.first.begin());
  member_.item.resize(index(member_.first.back()));
  std::vector<int> next(member_.first.begin(), member_.first.end() - 1);
  for (std::size_t s = 0; s < of_node_.size(); ++s)
    if (surface.node[s] >= 0) member_.item[index(next[index(of_node_[s])]++)] = static_cast<int>(s);
}

void MotionGroups::join(const Surface& surface, const SurfaceFeatures& features, const SurfaceChange& change,
                        std::span<const int> edges) {
  if (group.empty()) return;
  member_.loosen();
  for (int s : change.dead_slave) member_.erase(of_node_[index(s)], s);
  of_node_.resize(surface.slaves());
  for (int s : change.new_slave) of_node_[index(s)] = -1;
  const auto is_known = [&](int s) { return of_node_[index(s)] >= 0; };
  for (int f : change.new_face) {
    const std::array<int, 4>& corner = features.face_node[index(f)];
    const auto known = std::find_if(corner.begin(), corner.end(), is_known);
    const int own = known == corner.end() ? 0 : of_node_[index(*known)];
    for (int s : corner)
      if (!is_known(s)) of_node_[index(s)] = own;
  }
  for (int s : change.new_slave) {
    of_node_[index(s)] = std::max(of_node_[index(s)], 0);
    if (surface.node[index(s)] >= 0) member_.insert(of_node_[index(s)], s);
  }
  holds_face.resize(features.face_node.size());
  holds_edge.resize(features.edge_node.size());
  for (int f : change.new_face) at(holds_face, f) = add_borders(at(features.face_node, f));
  for (int e : edges) at(holds_edge, e) = add_borders(at(features.edge_node, e));
}

template <class Corners>
bool MotionGroups::add_borders(const Corners& corners) {
  const int own = of_node(corners[0]);
  bool none = true;
  for (int s : corners) {
    if (of_node(s) == own) continue;
    none = false;
    const std::array<int, 3> border{own, of_node(s), relate(corners[0], s)};
    const auto place = std::lower_bound(border_.begin(), border_.end(), border);
    if (place == border_.end() || *place != border) border_.insert(place, border);
  }
  return none;
}

int MotionGroups::relate(int slave_a, int slave_b) {
  const int a = of_node(slave_a), b = of_node(slave_b);
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
