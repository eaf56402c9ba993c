#include "contact/start/overlap_report.hpp"

#include <algorithm>

#include "src/base/index.hpp"

namespace brio {

std::size_t OverlapReport::entry_of(const std::array<int, 2>& parts) {
  const auto [known, is_new] = number_.try_emplace(parts, entry_.size());
  if (is_new) {
    const auto name = [&](std::size_t k) { return surface_.part_name[index(parts[k])]; };
    entry_.push_back({.node_part = name(0), .face_part = name(1)});
    near_.emplace_back();
  }
  return known->second;
}

void OverlapReport::add(const TouchingPair& pair) {
  const std::size_t number = entry_of(pair.part);
  InitialOverlap& known = entry_[number];
  known.gap = std::max(known.gap, 2 * features_.skin);
  if (pair.depth > resolved_share * features_.smallest_edge) known.depth = std::max(known.depth, pair.depth);
  near_[number].insert(pair.slave);
  known.nodes = static_cast<int>(near_[number].size());
}

void OverlapReport::add(const SidedPair& pair) {
  const std::size_t number = entry_of(pair.part);
  InitialOverlap& known = entry_[number];
  if (overlap(pair) > resolved_share * pair.scale) known.depth = std::max(known.depth, overlap(pair));
  known.gap = std::max(known.gap, pair.skin);
  near_[number].insert(pair.contact.node.begin(), pair.contact.node.begin() + pair.contact.own);
  known.nodes = static_cast<int>(near_[number].size());
}

void OverlapReport::add_motion(const Nodes& nodes, std::span<const Vector3d> start) {
  for (std::size_t s = 0; s < start.size(); ++s) {
    const double moved = norm(position(nodes, surface_.node[s]) - start[s]);
    if (!(moved > 0)) continue;
    const std::string& part = surface_.part_name[index(part_of(static_cast<int>(s)))];
    for (InitialOverlap& known : entry_)
      if (known.node_part == part || known.face_part == part) known.moved = std::max(known.moved, moved);
  }
}

int OverlapReport::part_of(int slave) const {
  if (const auto faces = surface_.faces_of.of(slave); !faces.empty())
    return surface_.face[index(faces.front())].part;
  const int node = surface_.node[index(slave)];
  for (const RoundElement& element : surface_.round)
    if (element.alive() && (element.node[0] == node || element.node[1] == node)) return element.part;
  return 0;
}

}  // namespace brio
