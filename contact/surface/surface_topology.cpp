#include "contact/surface/surface_topology.hpp"

#include <algorithm>
#include <cassert>
#include <limits>
#include <numeric>
#include <stdexcept>

#include "src/base/disjoint_sets.hpp"
#include "src/base/index.hpp"
#include "src/base/lists.hpp"

namespace brio {

namespace {

void number_elements(std::span<const SurfacePart> parts, SurfaceTopology& topology) {
  std::int64_t elements = 0;
  std::int64_t sides = 0;
  int rounds = 0;
  for (const SurfacePart& given : parts) {
    TopologyPart& part = topology.part.emplace_back();
    part.nodes_per_element = given.nodes_per_element;
    part.first_round = rounds;
    part.connectivity.assign(given.connectivity.begin(), given.connectivity.end());
    part.first_element = static_cast<int>(elements);
    part.first_side = static_cast<int>(sides);
    const std::int64_t count = std::ssize(part.connectivity) / part.corners();
    elements += count;
    sides += count * part.sides();
    if (part.round()) rounds += static_cast<int>(count);
    if (sides > std::numeric_limits<int>::max())
      throw std::length_error("contact: more element sides than an int can number");
  }
  topology.side.assign(index(sides), side_state::none);
  topology.body.assign(index(elements), 0);
}

template <class Visit>
void for_sides_of_hexahedra(const SurfaceTopology& topology, const Visit& visit) {
  for (const TopologyPart& part : topology.part) {
    if (!part.solid()) continue;
    const int sides = static_cast<int>(part.connectivity.size()) / 8 * sides_of_hexahedron;
    std::array<int, 4> nodes{};
    for (int side = part.first_side; side < part.first_side + sides; ++side)
      if (nodes_of_side(part, side, nodes)) visit(side, side_key(nodes));
  }
}

// Close a ring of the sides with equal keys, one after the other in a bucket.
void close_rings(std::span<const int> bucket, std::span<const std::array<int, 4>> key,
                 std::vector<int>& side) {
  for (std::size_t i = 0; i < bucket.size(); ++i) {
    std::size_t next = i;
    do next = (next + 1) % bucket.size();
    while (key[next] != key[i]);
    side[index(bucket[i])] = next == i ? side_state::alone : bucket[next];
  }
}

void link_sides(std::size_t node_count, SurfaceTopology& topology) {
  std::vector<int> first(node_count + 1, 0);
  for_sides_of_hexahedra(topology, [&](int, const std::array<int, 4>& key) { ++first[index(key[0]) + 1]; });
  std::partial_sum(first.begin(), first.end(), first.begin());
  std::vector<int> bucket(index(first.back()));
  std::vector<std::array<int, 4>> keys(bucket.size());
  std::vector<int> fill(first.begin(), first.end() - 1);
  for_sides_of_hexahedra(topology, [&](int side, const std::array<int, 4>& key) {
    const auto place = index(fill[index(key[0])]++);
    bucket[place] = side;
    keys[place] = key;
  });
  for (std::size_t n = 0; n < node_count; ++n) {
    const auto begin = index(first[n]);
    const auto count = index(first[n + 1]) - begin;
    close_rings(std::span(bucket).subspan(begin, count), std::span(keys).subspan(begin, count),
                topology.side);
  }
}

void give_faces(const Surface& surface, SurfaceTopology& topology) {
  for (std::size_t f = 0; f < surface.face.size(); ++f) {
    const Face& face = surface.face[f];
    const TopologyPart& part = topology.part[index(face.part)];
    int& state = topology.side[index(part.first_side + part.sides() * face.element + face.side)];
    assert(part.shell() || state == side_state::alone);
    state = side_state::of_face(static_cast<int>(f));
  }
}

void number_bodies(Surface& surface, SurfaceTopology& topology) {
  DisjointSets sets(surface.slave_of.size());
  const int elements = static_cast<int>(topology.body.size());
  for (int e = 0; e < elements; ++e)
    for (int node : nodes_of(topology, e)) sets.join(nodes_of(topology, e)[0], node);
  std::vector<int> number(surface.slave_of.size(), -1);
  for (const Face& face : surface.face) number[index(sets.root(face.node[0]))] = face.body;
  for (const RoundElement& element : surface.round) number[index(sets.root(element.node[0]))] = element.body;
  for (int e = 0; e < elements; ++e) {
    int& own = number[index(sets.root(nodes_of(topology, e)[0]))];
    if (own < 0) own = surface.body_count++;
    topology.body[index(e)] = own;
  }
}

void find_hexahedra_under_shells(std::size_t node_count, SurfaceTopology& topology) {
  std::vector<char> of_shell(node_count, 0);
  for (const TopologyPart& part : topology.part)
    if (part.shell())
      for (int node : part.connectivity) of_shell[index(node)] = 1;
  for (const TopologyPart& part : topology.part) {
    if (!part.solid()) continue;
    for (std::size_t i = 0; i < part.connectivity.size(); ++i)
      if (of_shell[index(part.connectivity[i])] != 0)
        topology.under_shells.emplace_back(part.connectivity[i],
                                           part.first_element + static_cast<int>(i / 8));
  }
  std::sort(topology.under_shells.begin(), topology.under_shells.end());
}

void prepare_debris(std::span<const SurfacePart> parts, std::size_t node_count, SurfaceTopology& topology) {
  if (std::none_of(parts.begin(), parts.end(), [](const SurfacePart& p) { return p.debris_radius > 0; }))
    return;
  topology.debris.resize(node_count);
  for (const SurfacePart& part : parts)
    for (int node : part.connectivity) {
      DebrisNode& debris = topology.debris[index(node)];
      debris.radius = std::max(debris.radius, part.debris_radius);
      ++debris.elements;
    }
}

}  // namespace

SurfaceTopology make_topology(Surface& surface, std::span<const SurfacePart> parts) {
  SurfaceTopology topology;
  number_elements(parts, topology);
  link_sides(surface.slave_of.size(), topology);
  give_faces(surface, topology);
  number_bodies(surface, topology);
  find_hexahedra_under_shells(surface.slave_of.size(), topology);
  prepare_debris(parts, surface.slave_of.size(), topology);
  topology.mark.assign(topology.body.size(), 0);
  return topology;
}

}  // namespace brio
