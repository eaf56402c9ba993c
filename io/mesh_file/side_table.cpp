#include "io/mesh_file/side_table.hpp"

#include <algorithm>

#include "src/base/index.hpp"

namespace brio {

namespace {

/// Ascending, without repeated nodes, filled up by the last; false where the side has collapsed.
bool make_key(std::array<int, 4>& nodes) {
  std::sort(nodes.begin(), nodes.end());
  const auto end = std::unique(nodes.begin(), nodes.end());
  if (end - nodes.begin() < 3) return false;
  std::fill(end, nodes.end(), *(end - 1));
  return true;
}

}  // namespace

SideTable::SideTable(const Mesh& mesh) : mesh_(mesh), sides_(mesh.nodes_per_element == 8 ? 6 : 1) {
  const int count = static_cast<int>(mesh.element_count()) * sides_;
  first_.assign(mesh.position.size() + 1, 0);
  const auto each = [&](const auto& take) {
    for (int side = 0; side < count; ++side) {
      std::array<int, 4> key = nodes_of({side / sides_, side % sides_});
      if (make_key(key)) take(key, side);
    }
  };
  each([&](const std::array<int, 4>& key, int) { ++first_[index(key[0]) + 1]; });
  for (std::size_t n = 1; n < first_.size(); ++n) first_[n] += first_[n - 1];
  entries_.resize(first_.back());
  std::vector<std::size_t> next = first_;
  each([&](const std::array<int, 4>& key, int side) {
    entries_[next[index(key[0])]++] = {{key[1], key[2], key[3]}, side};
  });
}

std::array<int, 4> SideTable::nodes_of(const ElementSide& side) const {
  const auto corners = index(mesh_.nodes_per_element);
  const auto first = index(side.element) * corners;
  std::array<int, 4> nodes{};
  for (std::size_t k = 0; k < 4; ++k) {
    const int corner = corners == 8 ? sides_of_hex[index(side.side)][k] : static_cast<int>(k);
    nodes[k] = mesh_.connectivity[first + index(corner)];
  }
  return nodes;
}

std::vector<ElementSide> SideTable::exterior() const {
  std::vector<ElementSide> found;
  for (std::size_t n = 0; n + 1 < first_.size(); ++n)
    for (std::size_t i = first_[n]; i < first_[n + 1]; ++i) {
      const auto is_same = [&](const Entry& other) {
        return other.side != entries_[i].side && other.further == entries_[i].further;
      };
      const auto begin = entries_.begin() + static_cast<std::ptrdiff_t>(first_[n]),
                 end = entries_.begin() + static_cast<std::ptrdiff_t>(first_[n + 1]);
      if (std::none_of(begin, end, is_same)) found.push_back(side_of(entries_[i]));
    }
  std::sort(found.begin(), found.end(), [](const ElementSide& a, const ElementSide& b) {
    return std::pair(a.element, a.side) < std::pair(b.element, b.side);
  });
  return found;
}

bool SideTable::has_same_turn(const ElementSide& side, const std::array<int, 4>& nodes) const {
  std::array<int, 4> own = nodes_of(side), asked = nodes;
  const auto own_end = std::unique(own.begin(), own.end()),
             asked_end = std::unique(asked.begin(), asked.end());
  const auto at = std::find(own.begin(), own_end, asked[0]);
  if (at == own_end || asked_end - asked.begin() < 2) return false;
  return *(at + 1 == own_end ? own.begin() : at + 1) == asked[1];
}

std::optional<ElementSide> SideTable::find(const std::array<int, 4>& nodes, int element) const {
  std::array<int, 4> key = nodes;
  if (!make_key(key)) return {};
  const auto least = index(key[0]);
  std::optional<ElementSide> found;
  for (std::size_t i = first_[least]; i < first_[least + 1]; ++i) {
    if (entries_[i].further != std::array{key[1], key[2], key[3]}) continue;
    const ElementSide side = side_of(entries_[i]);
    if (element >= 0 && side.element != element) continue;
    if (!found || has_same_turn(side, nodes)) found = side;
  }
  return found;
}

}  // namespace brio
