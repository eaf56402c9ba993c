#include "io/mesh_file/part_mesh.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <optional>

#include "io/mesh_file/mesh_file_error.hpp"
#include "io/mesh_file/side_table.hpp"
#include "src/base/index.hpp"
#include "src/deck/element_quality.hpp"

namespace brio {

namespace {

int dimension_of(const FileMesh& file, const FileBlock& block) {
  int dimension = 0;
  for (const int e : block.element) dimension = std::max(dimension, file.dimension(index(e)));
  return dimension;
}

constexpr std::array<int, 4> nodes_of_dimension{1, 2, 4, 8};

/// Corners of elements with fewer nodes than their kind: a repeated node takes the place of a missing one.
constexpr std::array<int, 8> wedge_as_hexahedron{0, 1, 2, 2, 3, 4, 5, 5};
constexpr std::array<int, 4> triangle_as_quadrilateral{0, 1, 2, 2};

std::size_t distinct(std::span<const int> nodes) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < nodes.size(); ++i)
    if (std::find(nodes.begin(), nodes.begin() + static_cast<std::ptrdiff_t>(i), nodes[i]) ==
        nodes.begin() + static_cast<std::ptrdiff_t>(i))
      ++count;
  return count;
}

class PartMesher {
 public:
  PartMesher(const FileMesh& file, const FileBlock& block, const MeshFromFile& source)
      : file_(file), block_(block), source_(source) {}

  Mesh make(std::vector<std::string>& notices) {
    take_elements();
    mesh_.nodes_per_element = nodes_of_dimension[index(dimension_)];
    take_nodes();
    for (const int e : elements_) take_element(index(e));
    take_volumes();
    check_elements();
    take_sets(notices);
    return std::move(mesh_);
  }

 private:
  [[noreturn]] void refuse(std::size_t e, const std::string& fault) const {
    throw MeshFileError(
        file_.file, file_.line_of(e),
        "element " + std::to_string(file_.element_id[e]) + " of block '" + block_.name + "' " + fault);
  }

  void take_elements() {
    dimension_ = dimension_of(file_, block_);
    for (const int place : block_.element) {
      const auto e = index(place);
      if (file_.dimension(e) != dimension_) continue;
      if (file_.is_refused(e)) refuse_kind(e);
      elements_.push_back(place);
    }
  }

  [[noreturn]] void refuse_kind(std::size_t e) const {
    const RefusedKind& kind = file_.refused_kind(e);
    const auto count = std::count_if(block_.element.begin(), block_.element.end(),
                                     [&](int other) { return file_.shape[index(other)] == file_.shape[e]; });
    throw MeshFileError(file_.file, file_.line_of(e),
                        "block '" + block_.name + "' has " + std::to_string(count) + " " + kind.name +
                            ", which no part can be made of; " + kind.advice);
  }

  std::span<const int> nodes_of(std::size_t e) const {
    return {file_.node.data() + file_.first[e], file_.node.data() + file_.first[e + 1]};
  }

  void take_nodes() {
    place_.assign(file_.position.size(), -1);
    for (const int e : elements_)
      for (const int node : nodes_of(index(e))) place_[index(node)] = 0;
    for (std::size_t n = 0; n < place_.size(); ++n) {
      if (place_[n] < 0) continue;
      place_[n] = static_cast<int>(mesh_.position.size());
      const auto& [x, y, z] = file_.position[n];
      mesh_.position.push_back({source_.scale * x, source_.scale * y, source_.scale * z});
      mesh_.node_id.push_back(file_.node_id[n]);
    }
  }

  void take_element(std::size_t e) {
    const auto nodes = nodes_of(e);
    const auto add = [&](int corner) { mesh_.connectivity.push_back(place_[index(nodes[index(corner)])]); };
    switch (static_cast<ElementShape>(file_.shape[e])) {
      case ElementShape::wedge:
        for (const int corner : wedge_as_hexahedron) add(corner);
        break;
      case ElementShape::triangle:
        for (const int corner : triangle_as_quadrilateral) add(corner);
        break;
      default:
        for (int corner = 0; corner < static_cast<int>(nodes.size()); ++corner) add(corner);
    }
    mesh_.element_id.push_back(file_.element_id[e]);
  }

  /// Of particles: that of the file, or the one that the deck gives to each.
  void take_volumes() {
    if (dimension_ != 0) return;
    for (const int place : elements_) {
      const auto e = index(place);
      const double own = file_.volume.empty() ? 0 : file_.volume[e];
      const double cube = source_.scale * source_.scale * source_.scale;
      if (source_.particle_volume)
        mesh_.volume.push_back(*source_.particle_volume);
      else if (own > 0)
        mesh_.volume.push_back(own * cube);
      else
        refuse(e, "is a particle without volume; accepted is a particle_volume in the deck, beside the file");
    }
  }

  void check_elements() const {
    const auto corners = index(mesh_.nodes_per_element);
    constexpr std::array<std::size_t, 4> fewest_nodes{1, 2, 3, 6};
    std::size_t inverted = 0, first = 0;
    std::array<Corner, 8> corner{};
    for (std::size_t i = 0; i < elements_.size(); ++i) {
      const std::span<const int> nodes(mesh_.connectivity.data() + corners * i, corners);
      const auto e = index(elements_[i]);
      if (const std::size_t count = distinct(nodes); count < fewest_nodes[index(dimension_)])
        refuse(e, "has " + std::to_string(count) + " different nodes; expected are at least " +
                      std::to_string(fewest_nodes[index(dimension_)]));
      for (std::size_t k = 0; k < corners; ++k) corner[k] = mesh_.position[index(nodes[k])];
      if (!is_inverted({corner.data(), corners})) continue;
      if (inverted++ == 0) first = e;
    }
    if (inverted == 0) return;
    const std::string others = inverted > 1 ? " (and " + std::to_string(inverted - 1) + " others)" : "";
    refuse(first, others.empty() ? inverted_rule() : others.substr(1) + " " + inverted_rule());
  }

  std::string inverted_rule() const {
    if (dimension_ == 3)
      return "is inverted or has no volume; accepted are nodes that go around one side, seen "
             "counter-clockwise "
             "from inside, then around the opposite side likewise";
    if (dimension_ == 2) return "is not convex; accepted are nodes that go around a convex quadrilateral";
    return "has no length";
  }

  /// What is nearly flat is left to the element, which has a rule of its own.
  bool is_inverted(std::span<const Corner> corner) const {
    constexpr double rounding = 1e-6;
    if (dimension_ == 3) return !(volume_of_hexahedron(corner.first<8>()) > 0);
    if (dimension_ == 2) return scaled_jacobian_of(corner) < -rounding;
    return dimension_ == 1 && corner[0] == corner[1];
  }

  void take_sets(std::vector<std::string>& notices) {
    std::vector<int>& all = mesh_.node_sets["all"];
    all.resize(mesh_.position.size());
    std::iota(all.begin(), all.end(), 0);
    if (dimension_ >= 2) table_.emplace(mesh_);
    element_place_.assign(dimension_ >= 2 ? file_.element_count() : 0, -1);
    for (std::size_t i = 0; i < elements_.size() && dimension_ >= 2; ++i)
      element_place_[index(elements_[i])] = static_cast<int>(i);
    if (dimension_ >= 2) mesh_.side_sets["all"] = table_->exterior();
    for (const auto& [name, set] : file_.sets) {
      if (name == "all") {
        notices.push_back(file_.file + ": its set 'all' is not taken; `all` is the whole of a part");
        continue;
      }
      add_nodes(name, set.node);
      for (const FileFace& face : set.face) add_face(name, face, notices);
    }
    for (const FileBlock& block : file_.blocks)
      if (block.name != "all") take_block_as_set(block);
    sort_sets();
  }

  void add_nodes(const std::string& name, std::span<const int> nodes) {
    std::vector<int> found;
    for (const int node : nodes)
      if (const int place = place_[index(node)]; place >= 0) found.push_back(place);
    if (found.empty()) return;
    std::vector<int>& set = mesh_.node_sets[name];
    set.insert(set.end(), found.begin(), found.end());
  }

  void add_face(const std::string& name, const FileFace& face, std::vector<std::string>& notices) {
    if (!table_) return;
    std::array<int, 4> nodes{};
    for (std::size_t k = 0; k < 4; ++k) nodes[k] = place_[index(face.node[k])];
    if (std::find(nodes.begin(), nodes.end(), -1) != nodes.end()) return;
    const int element = face.element < 0 ? -1 : element_place_[index(face.element)];
    if (face.element >= 0 && element < 0) return;
    const auto side = table_->find(nodes, element);
    if (!side) return;
    if (dimension_ == 2 && element >= 0 && !table_->has_same_turn(*side, nodes)) {
      const std::string notice =
          file_.file + ": set '" + name + "' has backs of shells, which are no faces of it";
      if (std::find(notices.begin(), notices.end(), notice) == notices.end()) notices.push_back(notice);
      return;
    }
    mesh_.side_sets[name].push_back(*side);
  }

  // Of the block of the part those elements that are of a lower dimension than its own.
  void take_block_as_set(const FileBlock& block) {
    std::vector<std::string> none;
    for (const int place : block.element) {
      const auto e = index(place);
      if (&block == &block_ && file_.dimension(e) == dimension_) continue;
      const auto nodes = nodes_of(e);
      add_nodes(block.name, nodes);
      if (file_.is_refused(e) || file_.dimension(e) != 2) continue;
      add_face(block.name, {{nodes[0], nodes[1], nodes[2], nodes[nodes.size() == 4 ? 3 : 2]}, -1}, none);
    }
  }

  void sort_sets() {
    for (auto& [name, set] : mesh_.node_sets) {
      std::sort(set.begin(), set.end());
      set.erase(std::unique(set.begin(), set.end()), set.end());
    }
    const auto key = [](const ElementSide& side) { return std::pair(side.element, side.side); };
    for (auto& [name, set] : mesh_.side_sets) {
      std::sort(set.begin(), set.end(), [&](const auto& a, const auto& b) { return key(a) < key(b); });
      set.erase(
          std::unique(set.begin(), set.end(), [&](const auto& a, const auto& b) { return key(a) == key(b); }),
          set.end());
    }
  }

  const FileMesh& file_;
  const FileBlock& block_;
  const MeshFromFile& source_;
  Mesh mesh_;
  int dimension_ = 0;
  std::vector<int> elements_;       ///< of the part, by their places in the file
  std::vector<int> place_;          ///< of each node of the file in the part; -1: not in it
  std::vector<int> element_place_;  ///< likewise of its elements
  std::optional<SideTable> table_;
};

}  // namespace

const FileBlock* block_called(const FileMesh& file, std::string_view name) {
  for (const FileBlock& block : file.blocks)
    if (block.name == name) return &block;
  for (const FileBlock& block : file.blocks)
    if (block.number >= 0 && std::to_string(block.number) == name) return &block;
  return nullptr;
}

std::vector<const FileBlock*> main_blocks(const FileMesh& file) {
  int highest = 0;
  for (std::size_t e = 0; e < file.element_count(); ++e) highest = std::max(highest, file.dimension(e));
  std::vector<const FileBlock*> blocks;
  for (const FileBlock& block : file.blocks)
    if (dimension_of(file, block) == highest) blocks.push_back(&block);
  return blocks;
}

Mesh part_mesh(const FileMesh& file, const FileBlock& block, const MeshFromFile& source,
               std::vector<std::string>& notices) {
  return PartMesher(file, block, source).make(notices);
}

}  // namespace brio
