#include "contact/local_candidates.hpp"

#include <algorithm>
#include <limits>

#include "contact/exclusion.hpp"
#include "contact/face_geometry.hpp"

namespace brio {

namespace {

/// Boxes added that are compared one by one.
constexpr std::size_t most_unsorted = 64;

CaptureBox at_point(const Vector3<double>& p) { return {{p.x, p.y, p.z}, {p.x, p.y, p.z}}; }

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
constexpr Vector3<double> nowhere{not_a_number, not_a_number, not_a_number};

bool is_placed(const Candidates& candidates, int slave) {
  return candidates.point[static_cast<std::size_t>(slave)].x ==
         candidates.point[static_cast<std::size_t>(slave)].x;
}

Eigen::Vector3d displacement_of(const Candidates& candidates, const Surface& surface, const Nodes& nodes,
                                int slave) {
  const Vector3<double>& start = candidates.point[static_cast<std::size_t>(slave)];
  return position(nodes, surface.node[static_cast<std::size_t>(slave)]) -
         Eigen::Vector3d(start.x, start.y, start.z);
}

// Of a node beside a newcomer if one has a starting point, else of any; any is right, one like its own makes
// the buffer last.
Eigen::Vector3d displacement_near(const Candidates& candidates, const Surface& surface, const Nodes& nodes,
                                  int slave) {
  for (int f : surface.faces_of.of(slave))
    for (int node : surface.face[static_cast<std::size_t>(f)].node)
      if (is_placed(candidates, surface.slave(node)))
        return displacement_of(candidates, surface, nodes, surface.slave(node));
  for (int other = 0; other < static_cast<int>(surface.slaves()); ++other)
    if (is_placed(candidates, other)) return displacement_of(candidates, surface, nodes, other);
  return Eigen::Vector3d::Zero();
}

}  // namespace

void GrowingTree::build(const SearchNodes& boxes, ThreadTeam& team) {
  all_.build(boxes, team);
  number_.clear();
  box_.clear();
  later_.clear();
}

void GrowingTree::sort_in(ThreadTeam& team) {
  std::size_t begin = sorted_in();
  if (box_.size() - begin <= most_unsorted) return;
  while (!later_.empty() && later_.back().size() <= 2 * (box_.size() - begin)) {
    begin = later_.back().begin;
    later_.pop_back();
  }
  Later& added = later_.emplace_back(Later{.tree = {}, .begin = begin, .end = box_.size()});
  added.tree.build(std::span<const CaptureBox>(box_).subspan(begin), team);
}

template <class Visit>
void GrowingTree::for_overlapping(const CaptureBox& box, std::uint64_t& comparisons, const Visit& visit) {
  constexpr std::size_t all = std::numeric_limits<std::size_t>::max();
  std::size_t count = all_.collect(box, all, found_, places_, comparisons);
  for (std::size_t i = 0; i < count; ++i) visit(found_[i]);
  for (const Later& later : later_) {
    count = later.tree.collect(box, all, found_, places_, comparisons);
    for (std::size_t i = 0; i < count; ++i) visit(number_[later.begin + static_cast<std::size_t>(found_[i])]);
  }
  comparisons += 6 * (box_.size() - sorted_in());
  for (std::size_t i = sorted_in(); i < box_.size(); ++i)
    if (box_[i].overlaps(box)) visit(number_[i]);
}

void LocalCandidates::follow_search(const Candidates& candidates, ThreadTeam& team) {
  if (search_ == candidates.counts.searches) return;
  search_ = candidates.counts.searches;
  slaves_.build(candidates.point, team);
  faces_.build(candidates.box, team);
  is_candidate_.assign(candidates.box.size(), 0);
  for (int f : candidates.face) is_candidate_[static_cast<std::size_t>(f)] = 1;
}

void LocalCandidates::place_newcomers(Candidates& candidates, const Surface& surface,
                                      const ContactOptions& options, const Nodes& nodes,
                                      const SurfaceChange& change) {
  const std::size_t faces = surface.face.size();
  candidates.point.resize(surface.slaves());
  candidates.edge.resize(faces);
  candidates.box.resize(faces);
  is_candidate_.resize(faces, 0);
  candidates.faces_of.loosen();
  while (candidates.faces_of.first.size() < surface.slaves()) candidates.faces_of.add_list();
  for (const auto* slaves : {&change.dead_slave, &change.new_slave})
    for (int slave : *slaves) {
      candidates.faces_of.clear(slave);
      candidates.renewed.push_back(slave);
      candidates.point[static_cast<std::size_t>(slave)] = nowhere;
    }
  for (int slave : change.changed_slave) candidates.renewed.push_back(slave);
  for (int slave : change.new_slave) {
    const auto s = static_cast<std::size_t>(slave);
    const Eigen::Vector3d x =
        position(nodes, surface.node[s]) - displacement_near(candidates, surface, nodes, slave);
    candidates.point[s] = {x[0], x[1], x[2]};
    slaves_.add(slave, at_point(candidates.point[s]));
  }
  for (int face : change.new_face) {
    const auto f = static_cast<std::size_t>(face);
    is_candidate_[f] = 0;
    candidates.edge[f] = shortest_edge(nodes, surface.face[f]);
    candidates.smallest_edge = std::min(candidates.smallest_edge, candidates.edge[f]);
    candidates.box[f] = capture_box(candidates, surface, options, face);
  }
}

void LocalCandidates::add_pair(Candidates& candidates, int slave, int face, ThreadTeam& team) {
  follow_search(candidates, team);
  candidates.faces_of.loosen();
  include(candidates, slave, face);
}

void LocalCandidates::include(Candidates& candidates, int slave, int face) {
  if (!candidates.faces_of.insert(slave, face)) return;
  candidates.renewed.push_back(slave);
  char& known = is_candidate_[static_cast<std::size_t>(face)];
  if (known == 0) candidates.face.push_back(face);
  known = 1;
}

void LocalCandidates::add(Candidates& candidates, const Surface& surface, const Lists& excluded,
                          const ContactOptions& options, const Nodes& nodes, const SurfaceChange& change,
                          ThreadTeam& team) {
  if (candidates.growth[0] < 0) return;
  follow_search(candidates, team);
  place_newcomers(candidates, surface, options, nodes, change);
  const auto add_unless_excluded = [&](int slave, int face) {
    if (surface.node[static_cast<std::size_t>(slave)] < 0) return;
    if (!surface.face[static_cast<std::size_t>(face)].alive()) return;
    if (!surface.never_touch(slave, surface.face[static_cast<std::size_t>(face)]) &&
        !is_excluded(excluded, slave, face))
      include(candidates, slave, face);
  };
  for (int face : change.new_face)
    slaves_.for_overlapping(candidates.box[static_cast<std::size_t>(face)], comparisons,
                            [&](int slave) { add_unless_excluded(slave, face); });
  for (int slave : change.new_slave)
    faces_.for_overlapping(at_point(candidates.point[static_cast<std::size_t>(slave)]), comparisons,
                           [&](int face) { add_unless_excluded(slave, face); });
  for (int face : change.new_face) faces_.add(face, candidates.box[static_cast<std::size_t>(face)]);
  slaves_.sort_in(team);
  faces_.sort_in(team);
}

}  // namespace brio
