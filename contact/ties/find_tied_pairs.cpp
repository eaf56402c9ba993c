#include "contact/ties/find_tied_pairs.hpp"

#include "src/base/disjoint_sets.hpp"
#include "src/base/index.hpp"

namespace brio {

namespace {

// Parts that a node of the surface belongs to.
std::vector<int> parts_of(const Surface& surface, int slave) {
  std::vector<int> parts;
  for (int f : surface.faces_of.of(slave)) parts.push_back(surface.face[index(f)].part);
  const int node = surface.node[index(slave)];
  if (surface.radius_of_rounds(slave) > 0)
    for (const RoundElement& element : surface.round)
      if (element.node[0] == node || element.node[1] == node) parts.push_back(element.part);
  std::sort(parts.begin(), parts.end());
  parts.erase(std::unique(parts.begin(), parts.end()), parts.end());
  return parts;
}

}  // namespace

TiedPairs find_tied_pairs(const Surface& surface, const Ties& ties, const std::vector<int>& part_of_surface) {
  TiedPairs tied;
  if (ties.empty() && ties.joined.empty()) return tied;
  tied.part_of_surface = part_of_surface;
  renew(tied, surface, ties);
  DisjointSets bodies(index(surface.body_count));
  const auto body_of = [&](int node) { return surface.body[index(surface.slave(node))]; };
  for (const std::vector<TiedNode>* entries : {&ties.node, &ties.joined})
    for (const TiedNode& entry : *entries)
      if (tied.main_part[index(entry.tie.node)] >= 0)
        bodies.join(body_of(entry.tie.node), body_of(entry.tie.corner[0]));
  for (int body = 0; body < surface.body_count; ++body) tied.piece.push_back(bodies.root(body));
  return tied;
}

void renew(TiedPairs& tied, const Surface& surface, const Ties& ties) {
  tied.main_part.assign(surface.slave_of.size(), -1);
  tied.pairs.clear();
  for (const std::vector<TiedNode>* entries : {&ties.node, &ties.joined})
    for (const TiedNode& entry : *entries) {
      const int main_part = tied.part_of_surface[index(entry.face_part)];
      const int slave = surface.slave(entry.tie.node);
      if (main_part < 0 || slave < 0) continue;
      tied.main_part[index(entry.tie.node)] = main_part;
      tied.pairs.emplace_back(entry.tie.node, main_part);
      for (int part : parts_of(surface, slave))
        for (int corner : entry.tie.corner) tied.pairs.emplace_back(corner, part);
    }
  std::sort(tied.pairs.begin(), tied.pairs.end());
  tied.pairs.erase(std::unique(tied.pairs.begin(), tied.pairs.end()), tied.pairs.end());
}

}  // namespace brio
