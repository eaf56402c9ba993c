#include "src/model/part_shape.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "src/base/index.hpp"
#include "src/deck/element_quality.hpp"
#include "src/deck/mesh.hpp"

namespace brio {

namespace {

// Sides of sides_of_hex at both ends of each direction.
constexpr std::array<std::array<int, 2>, 3> ends_of_direction{{{5, 3}, {2, 4}, {0, 1}}};

std::vector<double> edges_of(const Model& model, const std::vector<int>& nodes) {
  std::vector<Vector3d> corners;
  for (const int node : nodes) corners.push_back(position(model.nodes, node));
  return edge_lengths(corners);
}

std::array<int, 4> sorted_side(const std::vector<int>& nodes, int side) {
  std::array<int, 4> found{};
  for (std::size_t k = 0; k < 4; ++k) found[k] = nodes[index(sides_of_hex[index(side)][k])];
  std::sort(found.begin(), found.end());
  return found;
}

double length_along(const Model& model, const std::vector<int>& nodes, std::size_t direction) {
  double sum = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    const auto& [a, b] = edges_of_hex[4 * direction + k];
    sum += 0.25 * norm(position(model.nodes, nodes[index(a)]) - position(model.nodes, nodes[index(b)]));
  }
  return sum;
}

void find_alone(const Model& model, const std::vector<std::vector<int>>& elements, PartShape& shape) {
  std::map<std::array<int, 4>, int> count;
  for (const std::vector<int>& nodes : elements)
    for (int side = 0; side < 6; ++side) ++count[sorted_side(nodes, side)];
  shape.alone_thickness = HUGE_VAL;
  for (std::size_t direction = 0; direction < 3; ++direction) {
    std::size_t alone = 0;
    double thickness = 0;
    for (const std::vector<int>& nodes : elements) {
      const auto& [first, last] = ends_of_direction[direction];
      if (count[sorted_side(nodes, first)] > 1 || count[sorted_side(nodes, last)] > 1) continue;
      ++alone;
      thickness += length_along(model, nodes, direction);
    }
    if (5 * alone < 4 * elements.size() || alone == 0) continue;
    ++shape.alone_directions;
    shape.alone_thickness = std::min(shape.alone_thickness, thickness / static_cast<double>(alone));
  }
}

void take_nodes(const Model& model, const PartInModel& part, PartShape& shape) {
  shape.lower = {HUGE_VAL, HUGE_VAL, HUGE_VAL};
  shape.upper = {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
  for (const int node : part.node) {
    const NodeRecord& record = model.nodes.record[index(node)];
    for (std::size_t i = 0; i < 3; ++i) {
      shape.lower[i] = std::min(shape.lower[i], record.position[i]);
      shape.upper[i] = std::max(shape.upper[i], record.position[i]);
      shape.velocity[i] += record.velocity[i] / static_cast<double>(part.node.size());
    }
  }
}

}  // namespace

double PartShape::extent() const {
  return std::max({upper[0] - lower[0], upper[1] - lower[1], upper[2] - lower[2]});
}

std::vector<int> nodes_of_element(const Model& model, const PartInModel& part, std::size_t element) {
  std::vector<int> nodes;
  if (part.rigid >= 0) {
    const RigidBody& body = model.rigid.body[index(part.rigid)];
    const auto corners = index(body.nodes_per_element);
    nodes.assign(body.connectivity.begin() + static_cast<std::ptrdiff_t>(corners * element),
                 body.connectivity.begin() + static_cast<std::ptrdiff_t>(corners * (element + 1)));
    return nodes;
  }
  const Block& block = model.blocks[part.block];
  const int slot = part.element_slot[element];
  for (int corner = 0; slot >= 0 && corner < nodes_per_element(block.element); ++corner)
    nodes.push_back(block.node(index(slot), corner));
  return nodes;
}

PartShape shape_of(const Model& model, const PartInModel& part) {
  PartShape shape;
  take_nodes(model, part, shape);
  const Block& block = model.blocks[part.block];
  if (block.cloud) {
    shape.length.assign(block.cloud->spacing.begin(), block.cloud->spacing.end());
    shape.edge = shape.length.front();
    return shape;
  }
  std::vector<double> all;
  std::vector<std::vector<int>> elements;
  for (std::size_t e = 0; e < part.element_slot.size(); ++e) {
    if (nodes_of_element(model, part, e).empty()) continue;  // deleted
    elements.push_back(nodes_of_element(model, part, e));
    const std::vector<double> edges = edges_of(model, elements.back());
    if (edges.empty()) continue;
    const auto [shortest, longest] = std::minmax_element(edges.begin(), edges.end());
    shape.length.push_back(*shortest);
    shape.largest_aspect = std::max(shape.largest_aspect, *longest / *shortest);
    if (*longest > aspect_limit * *shortest) ++shape.long_elements;
    all.insert(all.end(), edges.begin(), edges.end());
  }
  if (!all.empty()) {
    std::nth_element(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(all.size() / 2), all.end());
    shape.edge = all[all.size() / 2];
  }
  if (!elements.empty() && elements.front().size() == 8) find_alone(model, elements, shape);
  return shape;
}

}  // namespace brio
