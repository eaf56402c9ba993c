#include "src/build/merge.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <sstream>
#include <utility>

#include "src/base/breakdown.hpp"
#include "src/deck/part_index.hpp"

namespace brio {

namespace {

using Point = Vector3d;

double squared_distance(const Point& a, const Point& b) {
  double sum = 0;
  for (std::size_t i = 0; i < 3; ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return sum;
}

/// Points by cells of the size of a tolerance; what lies within it of a place is in the 27 cells around.
class Cells {
 public:
  Cells(std::span<const Point> points, double size) : points_(points), size_(size) {
    for (std::size_t i = 0; i < points.size(); ++i) entries_.emplace_back(cell_of(points[i]), i);
    std::sort(entries_.begin(), entries_.end());
  }

  /// The closest point within the size of a cell, the first of those as close; none: the number of points.
  std::size_t closest(const Point& place, double& squared) const {
    std::size_t found = points_.size();
    squared = size_ * size_;
    const Cell centre = cell_of(place);
    for (int neighbour = 0; neighbour < 27; ++neighbour) {
      const Cell cell{centre[0] + neighbour % 3 - 1, centre[1] + neighbour / 3 % 3 - 1,
                      centre[2] + neighbour / 9 - 1};
      for (auto at = std::lower_bound(entries_.begin(), entries_.end(), std::pair(cell, std::size_t{0}));
           at != entries_.end() && at->first == cell; ++at) {
        const double candidate = squared_distance(place, points_[at->second]);
        if (candidate > squared || (candidate == squared && at->second > found)) continue;
        found = at->second;
        squared = candidate;
      }
    }
    return found;
  }

 private:
  using Cell = std::array<double, 3>;  // whole numbers, which may be too large for integers
  Cell cell_of(const Point& p) const {
    return {std::floor(p[0] / size_), std::floor(p[1] / size_), std::floor(p[2] / size_)};
  }

  std::span<const Point> points_;
  double size_;
  std::vector<std::pair<Cell, std::size_t>> entries_;
};

std::size_t root(const std::vector<std::size_t>& same_as, std::size_t node) {
  while (same_as[node] != node) node = same_as[node];
  return node;
}

MergedParts merge(const Merge& entry, const Deck& deck, std::span<const Mesh> meshes,
                  std::span<const std::size_t> offset, std::vector<std::size_t>& same_as) {
  const std::size_t first = part_index(entry.parts[0], deck);
  const std::size_t second = part_index(entry.parts[1], deck);
  const std::vector<Point>& fixed = meshes[first].position;
  const std::vector<Point>& moved = meshes[second].position;
  const Cells cells(fixed, entry.tolerance);
  MergedParts result{entry.parts[0], entry.parts[1]};
  for (std::size_t i = 0; i < moved.size(); ++i) {
    double squared = 0;
    const std::size_t found = cells.closest(moved[i], squared);
    if (found == fixed.size()) continue;
    ++result.nodes;
    result.farthest = std::max(result.farthest, std::sqrt(squared));
    same_as[root(same_as, offset[second] + i)] = root(same_as, offset[first] + found);
  }
  if (result.nodes == 0) {
    std::ostringstream fault;
    fault << "no node of '" << result.second << "' lies within " << entry.tolerance << " of a node of '"
          << result.first << "'; at least one pair of nodes is expected";
    throw BuildError(fault.str(), entry.place);
  }
  return result;
}

void check_parts(const Deck& deck, std::span<const std::size_t> offset, std::span<const std::size_t> same_as,
                 const std::string& place) {
  std::vector<std::size_t> roots;
  for (std::size_t p = 0; p < deck.parts.size(); ++p) {
    roots.assign(same_as.begin() + static_cast<std::ptrdiff_t>(offset[p]),
                 same_as.begin() + static_cast<std::ptrdiff_t>(offset[p + 1]));
    std::sort(roots.begin(), roots.end());
    if (std::adjacent_find(roots.begin(), roots.end()) != roots.end())
      throw BuildError("two nodes of part '" + deck.parts[p].name +
                           "' would become one; accepted is a tolerance below the distance of its nodes",
                       place);
  }
}

}  // namespace

SharedNodes share_nodes(const Deck& deck, std::span<const Mesh> meshes) {
  SharedNodes shared;
  const auto merges = [](const Connection& connection) { return std::holds_alternative<Merge>(connection); };
  if (std::none_of(deck.connections.begin(), deck.connections.end(), merges)) return shared;
  std::vector<std::size_t> offset{0};
  for (const Mesh& mesh : meshes) offset.push_back(offset.back() + mesh.position.size());
  shared.same_as.resize(offset.back());
  std::iota(shared.same_as.begin(), shared.same_as.end(), std::size_t{0});
  for (const Connection& connection : deck.connections) {
    const auto* entry = std::get_if<Merge>(&connection);
    if (entry == nullptr) continue;
    shared.merged.push_back(merge(*entry, deck, meshes, offset, shared.same_as));
    for (std::size_t i = 0; i < shared.same_as.size(); ++i) shared.same_as[i] = root(shared.same_as, i);
    check_parts(deck, offset, shared.same_as, entry->place);
  }
  return shared;
}

}  // namespace brio
