#include "io/mesh_file/mesh_builder.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "io/mesh_file/id_map.hpp"
#include "src/base/index.hpp"

namespace brio {

namespace {

/// Nodes and elements are counted by int, nodes of elements by 32 bits.
constexpr std::size_t most_items = std::size_t{1} << 27;

std::string counted(std::size_t count, const std::string& noun) {
  return std::to_string(count) + " " + noun + (count == 1 ? "" : "s");
}

}  // namespace

MeshBuilder::MeshBuilder(std::string file) { mesh_.file = std::move(file); }

void MeshBuilder::reserve(std::size_t nodes, std::size_t elements, std::size_t element_nodes) {
  mesh_.position.reserve(nodes);
  mesh_.node_id.reserve(nodes);
  mesh_.shape.reserve(elements);
  mesh_.first.reserve(elements + 1);
  mesh_.element_id.reserve(elements);
  element_node_.reserve(element_nodes);
}

void MeshBuilder::add_node(std::int64_t id, const Vector3d& position, std::uint32_t line) {
  for (const double x : position)
    if (!std::isfinite(x))
      fail(line, "a coordinate of node " + std::to_string(id) + " is not a finite number");
  if (mesh_.position.size() >= most_items)
    fail(line, "the mesh is too fine; at most " + std::to_string(most_items) + " nodes are accepted");
  mesh_.position.push_back(position);
  mesh_.node_id.push_back(id);
  if (line > 0) node_line_.push_back(line);
}

int MeshBuilder::add(unsigned char shape, std::int64_t id, std::span<const std::int64_t> nodes,
                     std::uint32_t line) {
  if (mesh_.shape.size() >= most_items)
    fail(line, "the mesh is too fine; at most " + std::to_string(most_items) + " elements are accepted");
  mesh_.shape.push_back(shape);
  mesh_.element_id.push_back(id);
  element_node_.insert(element_node_.end(), nodes.begin(), nodes.end());
  mesh_.first.push_back(static_cast<std::uint32_t>(element_node_.size()));
  if (line > 0) mesh_.line.push_back(line);
  return static_cast<int>(mesh_.shape.size()) - 1;
}

int MeshBuilder::add_element(ElementShape shape, std::int64_t id, std::span<const std::int64_t> nodes,
                             std::uint32_t line) {
  return add(static_cast<unsigned char>(shape), id, nodes, line);
}

int MeshBuilder::add_refused(const RefusedKind& kind, std::int64_t id, std::span<const std::int64_t> nodes,
                             std::uint32_t line) {
  std::size_t place = 0;
  while (place < mesh_.refused_kinds.size() && mesh_.refused_kinds[place].name != kind.name) ++place;
  if (place == mesh_.refused_kinds.size()) {
    constexpr std::size_t most_kinds = 200;
    if (place == most_kinds) fail(line, "the file holds too many kinds of elements that are not accepted");
    mesh_.refused_kinds.push_back(kind);
  }
  return add(static_cast<unsigned char>(index(ElementShape::refused) + place), id, nodes, line);
}

void MeshBuilder::set_volume(int element, double volume) {
  mesh_.volume.resize(mesh_.shape.size());
  mesh_.volume[index(element)] = volume;
}

std::size_t MeshBuilder::block(const std::string& name, std::int64_t number) {
  const auto [entry, is_new] = block_of_name_.try_emplace(name, mesh_.blocks.size());
  if (is_new) mesh_.blocks.push_back({name, number, {}});
  return entry->second;
}

void MeshBuilder::add_to_set(const std::string& set, std::int64_t node, std::uint32_t line) {
  RawNodes& nodes = nodes_[set];
  nodes.node.push_back(node);
  nodes.line.push_back(line);
}

void MeshBuilder::add_range_to_set(const std::string& set, std::int64_t first, std::int64_t last) {
  ranges_[set].push_back({first, last});
}

void MeshBuilder::add_face(const std::string& set, std::span<const std::int64_t> nodes, std::uint32_t line) {
  faces_[set].push_back({{nodes[0], nodes[1], nodes[2], nodes.size() > 3 ? nodes[3] : nodes[2]}, line});
}

void MeshBuilder::add_side(const std::string& set, std::int64_t element, int side, SideTable sides,
                           std::uint32_t line) {
  sides_[set].push_back({{}, element, side, sides, line});
}

void MeshBuilder::add_sides_of_block(const std::string& set, const std::string& block, int side,
                                     SideTable sides, std::uint32_t line) {
  sides_[set].push_back({block, 0, side, sides, line});
}

void MeshBuilder::add_nodes_of_block(const std::string& set, const std::string& block, std::uint32_t line) {
  nodes_of_blocks_[set].push_back({block, line});
}

void MeshBuilder::add_elements_to_block(const std::string& name, std::vector<std::int64_t> elements,
                                        std::uint32_t line) {
  elements_[name].push_back({std::move(elements), line});
}

void MeshBuilder::resolve_elements(const IdMap& nodes) {
  mesh_.node.resize(element_node_.size());
  for (std::size_t e = 0; e < mesh_.element_count(); ++e)
    for (std::size_t k = mesh_.first[e]; k < mesh_.first[e + 1]; ++k) {
      mesh_.node[k] = nodes.find(element_node_[k]);
      if (mesh_.node[k] < 0)
        fail(mesh_.line_of(e), "element " + std::to_string(mesh_.element_id[e]) + " names node " +
                                   std::to_string(element_node_[k]) + ", which the file does not have");
    }
  element_node_ = {};
}

void MeshBuilder::resolve_sets(const IdMap& nodes) {
  const auto found = [&](const std::string& set, std::int64_t id, std::uint32_t line) {
    const int node = nodes.find(id);
    if (node < 0)
      fail(line, "set '" + set + "' names node " + std::to_string(id) + ", which the file does not have");
    return node;
  };
  for (const auto& [name, raw] : nodes_) {
    std::vector<int>& node = mesh_.sets[name].node;
    for (std::size_t i = 0; i < raw.node.size(); ++i) node.push_back(found(name, raw.node[i], raw.line[i]));
  }
  for (const auto& [name, raw] : ranges_)
    for (const auto& [first, last] : raw)
      for (std::size_t i = 0; i < mesh_.node_id.size(); ++i)
        if (mesh_.node_id[i] >= first && mesh_.node_id[i] <= last)
          mesh_.sets[name].node.push_back(static_cast<int>(i));
  for (const auto& [name, raw] : faces_) {
    FileSet& set = mesh_.sets[name];
    for (const auto& [ids, line] : raw) {
      FileFace& face = set.face.emplace_back();
      for (std::size_t k = 0; k < 4; ++k) face.node[k] = found(name, ids[k], line);
      set.node.insert(set.node.end(), face.node.begin(), face.node.end());
    }
  }
}

// An edge of a shell is no face: its nodes alone belong to the set.
void MeshBuilder::add_resolved_side(const std::string& name, FileSet& set, const RawSide& raw,
                                    std::size_t e) {
  if (mesh_.is_refused(e)) return;
  const auto table = raw.sides(static_cast<ElementShape>(mesh_.shape[e]));
  if (raw.side < 1 || raw.side > static_cast<int>(table.size()))
    fail(raw.line, "set '" + name + "' names side " + std::to_string(raw.side) + " of element " +
                       std::to_string(mesh_.element_id[e]) + ", which has no such side");
  const std::vector<int>& corners = table[index(raw.side) - 1];
  const auto node = [&](std::size_t k) { return mesh_.node[mesh_.first[e] + index(corners[k])]; };
  for (std::size_t k = 0; k < corners.size(); ++k) set.node.push_back(node(k));
  if (corners.size() < 3) return;
  FileFace& face = set.face.emplace_back();
  face.element = static_cast<int>(e);
  for (std::size_t k = 0; k < 4; ++k) face.node[k] = node(std::min(k, corners.size() - 1));
}

const FileBlock& MeshBuilder::block_named(const std::string& name, std::uint32_t line) const {
  const auto found = std::find_if(mesh_.blocks.begin(), mesh_.blocks.end(),
                                  [&](const FileBlock& block) { return block.name == name; });
  if (found == mesh_.blocks.end()) fail(line, "no set of elements is named '" + name + "'");
  return *found;
}

void MeshBuilder::resolve_sides(const IdMap& elements) {
  for (const auto& [name, raw] : sides_) {
    FileSet& set = mesh_.sets[name];
    for (const RawSide& side : raw) {
      if (!side.block.empty()) {
        for (const int e : block_named(side.block, side.line).element)
          add_resolved_side(name, set, side, index(e));
        continue;
      }
      const int element = elements.find(side.element);
      if (element < 0)
        fail(side.line, "set '" + name + "' names element " + std::to_string(side.element) +
                            ", which the file does not have");
      add_resolved_side(name, set, side, index(element));
    }
  }
}

void MeshBuilder::resolve_nodes_of_blocks() {
  for (const auto& [name, raw] : nodes_of_blocks_) {
    std::vector<int>& node = mesh_.sets[name].node;
    for (const auto& [block, line] : raw)
      for (const int element : block_named(block, line).element) {
        const auto e = index(element);
        node.insert(node.end(), mesh_.node.begin() + mesh_.first[e], mesh_.node.begin() + mesh_.first[e + 1]);
      }
  }
}

void MeshBuilder::resolve_blocks(const IdMap& elements) {
  for (const auto& [name, lists] : elements_)
    for (const auto& [ids, line] : lists) {
      const std::size_t place = block(name);
      for (const std::int64_t id : ids) {
        const int element = elements.find(id);
        if (element < 0)
          fail(line,
               "set '" + name + "' names element " + std::to_string(id) + ", which the file does not have");
        add_to_block(place, element);
      }
    }
  for (FileBlock& block : mesh_.blocks) {
    if (std::adjacent_find(block.element.begin(), block.element.end(), std::greater_equal<>()) ==
        block.element.end())
      continue;
    std::sort(block.element.begin(), block.element.end());
    block.element.erase(std::unique(block.element.begin(), block.element.end()), block.element.end());
  }
  std::erase_if(mesh_.blocks, [](const FileBlock& block) { return block.element.empty(); });
}

void MeshBuilder::note_unused_nodes() {
  std::vector<bool> is_used(mesh_.position.size());
  for (const int node : mesh_.node) is_used[index(node)] = true;
  const auto unused = index(std::count(is_used.begin(), is_used.end(), false));
  if (unused > 0) notice(counted(unused, "node") + " of no element: dropped");
}

void MeshBuilder::expect_unique_elements() const {
  for (int dimension = is_numbered_by_dimension_ ? 0 : 3; dimension < 4; ++dimension) {
    std::vector<std::int64_t> ids;
    std::vector<std::size_t> place;
    for (std::size_t e = 0; is_numbered_by_dimension_ && e < mesh_.element_count(); ++e)
      if (mesh_.dimension(e) == dimension) ids.push_back(mesh_.element_id[e]), place.push_back(e);
    const int twice = IdMap(is_numbered_by_dimension_ ? ids : mesh_.element_id).repeated();
    if (twice < 0) continue;
    const auto found = index(twice);
    const std::size_t e = is_numbered_by_dimension_ ? place[found] : found;
    fail(mesh_.line_of(e),
         "element " + std::to_string(mesh_.element_id[e]) + " stands twice; numbers are unique");
  }
}

FileMesh MeshBuilder::finish() {
  if (mesh_.position.empty()) fail(0, "the file has no nodes");
  if (mesh_.shape.empty()) fail(0, "the file has no elements");
  if (!mesh_.volume.empty()) mesh_.volume.resize(mesh_.shape.size());
  {
    const IdMap nodes(mesh_.node_id);
    if (const int twice = nodes.repeated(); twice >= 0) {
      const auto node = index(twice);
      fail(node_line_.empty() ? 0 : node_line_[node],
           "node " + std::to_string(mesh_.node_id[node]) + " stands twice; numbers are unique");
    }
    resolve_elements(nodes);
    resolve_sets(nodes);
  }
  expect_unique_elements();
  {
    const IdMap elements(mesh_.element_id);
    resolve_blocks(elements);
    resolve_sides(elements);
  }
  resolve_nodes_of_blocks();
  for (auto& [name, set] : mesh_.sets) {
    std::sort(set.node.begin(), set.node.end());
    set.node.erase(std::unique(set.node.begin(), set.node.end()), set.node.end());
  }
  note_unused_nodes();
  return std::move(mesh_);
}

}  // namespace brio
