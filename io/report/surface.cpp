#include "io/report/surface.hpp"

#include <algorithm>
#include <cmath>

#include "src/base/index.hpp"

namespace brio {

namespace {

// Outward, in VTK order.
constexpr std::array<std::array<std::size_t, 4>, 6> sides_of_hexahedron{
    {{0, 4, 7, 3}, {1, 2, 6, 5}, {0, 1, 5, 4}, {3, 7, 6, 2}, {0, 3, 2, 1}, {4, 5, 6, 7}}};

struct Side {
  std::array<std::int64_t, 4> key{};  ///< its different nodes, ascending; -1 in place of the missing
  std::int64_t part = 0;
  Facet facet;

  bool is_same_place(const Side& other) const { return part == other.part && key == other.key; }
  bool operator<(const Side& other) const { return part != other.part ? part < other.part : key < other.key; }
};

// Whether at least three of its nodes differ.
bool set_key(Side& side) {
  std::array<std::int64_t, 4> sorted = side.facet.node;
  std::sort(sorted.begin(), sorted.end());
  const auto end = std::unique(sorted.begin(), sorted.end());
  side.key.fill(-1);
  std::copy(sorted.begin(), end, side.key.begin());
  return end - sorted.begin() >= 3;
}

Facet facet_of(const SceneCells& cells, std::size_t cell) {
  Facet facet{.cell = cell, .until = cells.until[cell]};
  const int corners = cells.corners(cell);
  facet.kind = corners == 4 ? Facet::Kind::shell : corners == 2 ? Facet::Kind::line : Facet::Kind::vertex;
  for (int k = 0; k < 4; ++k)
    facet.node[index(k)] = cells.connectivity[index(cells.offset[cell] + std::min(k, corners - 1))];
  return facet;
}

void add_sides(const SceneCells& cells, std::size_t cell, std::vector<Side>& sides) {
  for (const auto& corners : sides_of_hexahedron) {
    Side side;
    side.part = cells.part[cell];
    side.facet = {.cell = cell, .until = cells.until[cell]};
    for (std::size_t k = 0; k < 4; ++k)
      side.facet.node[k] = cells.connectivity[index(cells.offset[cell]) + corners[k]];
    if (set_key(side)) sides.push_back(side);
  }
}

// Of sides in one place each is seen when the other cells are gone.
void add_seen(std::vector<Side>::const_iterator begin, std::vector<Side>::const_iterator end,
              std::vector<Facet>& facets) {
  for (auto side = begin; side != end; ++side) {
    Facet facet = side->facet;
    for (auto other = begin; other != end; ++other)
      if (other != side) facet.from = std::max(facet.from, other->facet.until);
    if (facet.from < facet.until) facets.push_back(facet);
  }
}

}  // namespace

std::vector<std::size_t> SceneCells::alive(int frame) const {
  std::vector<std::size_t> cells;
  for (std::size_t c = 0; c < size(); ++c)
    if (frame < until[c]) cells.push_back(c);
  return cells;
}

bool SceneCells::keep(int frame, const std::vector<std::int64_t>& parts,
                      const std::vector<std::int64_t>& ids) {
  std::size_t row = 0;
  for (std::size_t c = 0; c < size(); ++c) {
    if (until[c] <= frame) continue;
    if (row < ids.size() && parts[row] == part[c] && ids[row] == id[c])
      ++row;
    else
      until[c] = frame;
  }
  return row == ids.size();
}

std::vector<Facet> facets_of(const SceneCells& cells) {
  std::vector<Side> sides;
  std::vector<Facet> facets;
  for (std::size_t c = 0; c < cells.size(); ++c) {
    const int corners = cells.corners(c);
    if (corners == 8)
      add_sides(cells, c, sides);
    else if (corners == 4 || corners == 2 || corners == 1)
      facets.push_back(facet_of(cells, c));
  }
  std::stable_sort(sides.begin(), sides.end());
  for (auto begin = sides.cbegin(); begin != sides.cend();) {
    const auto end =
        std::find_if(begin, sides.cend(), [&](const Side& s) { return !s.is_same_place(*begin); });
    add_seen(begin, end, facets);
    begin = end;
  }
  return facets;
}

std::vector<std::size_t> thinned(std::size_t dumps, std::size_t limit) {
  if (limit <= 1) return {dumps - 1};
  const std::size_t count = std::min(dumps, limit);
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < count; ++i)
    kept.push_back(count == 1 ? dumps - 1
                              : index(std::lround(static_cast<double>(i * (dumps - 1)) /
                                                  static_cast<double>(count - 1))));
  return kept;
}

}  // namespace brio
