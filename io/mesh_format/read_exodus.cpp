#include "io/mesh_format/read_exodus.hpp"

#include <algorithm>
#include <optional>
#include <span>
#include <sstream>

#include "io/files/file_error.hpp"
#include "io/files/read_apart.hpp"
#include "io/mesh_file/element_kinds.hpp"
#include "io/mesh_file/mesh_builder.hpp"
#include "io/mesh_file/mesh_file_error.hpp"
#include "io/mesh_format/netcdf_file.hpp"
#include "src/base/index.hpp"
#include "src/base/state_archive.hpp"

namespace brio {

namespace {

/// Sides in the numbering of Exodus, as corners, from 0; of shells both faces, then their edges.
std::vector<std::vector<int>> exodus_sides(ElementShape shape) {
  switch (shape) {
    case ElementShape::hexahedron:
      return {{0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}, {0, 3, 2, 1}, {4, 5, 6, 7}};
    case ElementShape::wedge:
      return {{0, 1, 4, 3}, {1, 2, 5, 4}, {2, 0, 3, 5}, {0, 2, 1}, {3, 4, 5}};
    case ElementShape::quadrilateral:
      return {{0, 1, 2, 3}, {0, 3, 2, 1}, {0, 1}, {1, 2}, {2, 3}, {3, 0}};
    case ElementShape::triangle:
      return {{0, 1, 2}, {0, 2, 1}, {0, 1}, {1, 2}, {2, 0}};
    default:
      return {};
  }
}

struct ExodusType {
  std::optional<ElementShape> shape;
  RefusedKind refused{};
};

/// \param name of the type, in upper case; what it begins with and the number of nodes tell the shape
ExodusType type_of(const std::string& name, std::size_t nodes) {
  struct Family {
    const char* beginning;
    std::size_t nodes;
    ElementShape shape;
    const char* plural;
    int dimension;
  };
  constexpr Family families[] = {{"HEX", 8, ElementShape::hexahedron, "hexahedra", 3},
                                 {"WEDGE", 6, ElementShape::wedge, "wedges", 3},
                                 {"QUAD", 4, ElementShape::quadrilateral, "quadrilaterals", 2},
                                 {"SHELL", 4, ElementShape::quadrilateral, "quadrilaterals", 2},
                                 {"SHELL", 3, ElementShape::triangle, "triangles", 2},
                                 {"TRI", 3, ElementShape::triangle, "triangles", 2},
                                 {"BAR", 2, ElementShape::line, "lines", 1},
                                 {"BEAM", 2, ElementShape::line, "lines", 1},
                                 {"TRUSS", 2, ElementShape::line, "lines", 1},
                                 {"ROD", 2, ElementShape::line, "lines", 1},
                                 {"SPHERE", 1, ElementShape::point, "points", 0},
                                 {"POINT", 1, ElementShape::point, "points", 0}};
  const std::string with_nodes = " with " + std::to_string(nodes) + " nodes";
  if (name.starts_with("TET") && nodes == 4) return {{}, tetrahedra()};
  if (name.starts_with("TET")) return {{}, {"tetrahedra" + with_nodes, 3, instead_of_second_order}};
  if (name.starts_with("PYR")) return {{}, pyramids()};
  const Family* like = nullptr;
  for (const Family& family : families) {
    if (!name.starts_with(family.beginning)) continue;
    if (family.nodes == nodes) return {family.shape, {}};
    if (like == nullptr) like = &family;
  }
  if (like != nullptr) return {{}, {like->plural + with_nodes, like->dimension, instead_of_second_order}};
  return {{}, {"elements of type '" + name + "'" + with_nodes, 3, instead_of_others}};
}

class ExodusReader {
 public:
  ExodusReader(const std::string& path, const std::string& name) : in_(path, name), mesh_(name) {}

  FileMesh read() {
    read_nodes();
    const std::size_t blocks = in_.dimension("num_el_blk");
    expect_few(blocks, "num_el_blk");
    const auto names = in_.texts("eb_names", blocks);
    const auto numbers = numbers_of("eb_prop1", blocks);
    read_element_ids();
    for (std::size_t b = 0; b < blocks; ++b) read_block(b, names[b], numbers[b]);
    if (mesh_.element_count() != element_id_.size())
      in_.fail("connect1", std::to_string(element_id_.size()) + " elements are announced, but there are " +
                               std::to_string(mesh_.element_count()));
    read_node_sets();
    read_side_sets();
    return mesh_.finish();
  }

 private:
  std::string numbered(const char* name, std::size_t place) const { return name + std::to_string(place + 1); }
  void expect_few(std::size_t count, const char* dimension) const {
    constexpr std::size_t most = 100000;
    if (count > most)
      mesh_.fail(0, "dimension '" + std::string(dimension) + "' is " + std::to_string(count) + "; at most " +
                        std::to_string(most) + " are accepted");
  }
  std::vector<std::int64_t> numbers_of(const char* variable, std::size_t count) const {
    if (in_.has(variable)) return in_.integers(variable, count);
    std::vector<std::int64_t> numbers(count);
    for (std::size_t i = 0; i < count; ++i) numbers[i] = static_cast<std::int64_t>(i) + 1;
    return numbers;
  }

  void read_nodes() {
    const std::size_t count = in_.dimension("num_nodes"), dimensions = in_.dimension("num_dim");
    if (count == 0) mesh_.fail(0, "the file has no nodes (dimension 'num_nodes')");
    if (dimensions < 2 || dimensions > 3)
      mesh_.fail(0, "dimension 'num_dim' is " + std::to_string(dimensions) + "; accepted are 2 and 3");
    std::vector<double> x[3];
    if (in_.has("coord")) {
      const std::vector<double> all = in_.reals("coord", count * dimensions);
      for (std::size_t i = 0; i < dimensions; ++i)
        x[i].assign(all.begin() + static_cast<std::ptrdiff_t>(i * count),
                    all.begin() + static_cast<std::ptrdiff_t>((i + 1) * count));
    } else {
      constexpr const char* names[] = {"coordx", "coordy", "coordz"};
      for (std::size_t i = 0; i < dimensions; ++i) x[i] = in_.reals(names[i], count);
    }
    if (dimensions == 2) x[2].assign(count, 0);
    node_id_ = numbers_of("node_num_map", count);
    mesh_.reserve(count, 0, 0);
    for (std::size_t i = 0; i < count; ++i) mesh_.add_node(node_id_[i], {x[0][i], x[1][i], x[2][i]}, 0);
  }

  void read_element_ids() {
    const std::size_t count = in_.dimension("num_elem");
    if (count == 0) mesh_.fail(0, "the file has no elements (dimension 'num_elem')");
    if (!in_.has("elem_num_map") && count / 8 > node_id_.size())  // of no element more than of its nodes
      mesh_.fail(0, "dimension 'num_elem' is " + std::to_string(count) + ", more than the file can hold");
    element_id_ = numbers_of("elem_num_map", count);
    mesh_.reserve(node_id_.size(), count, 0);
  }

  std::int64_t node_at(std::int64_t place, const std::string& variable) const {
    if (place < 1 || place > static_cast<std::int64_t>(node_id_.size()))
      in_.fail(variable,
               "names node " + std::to_string(place) + "; there are " + std::to_string(node_id_.size()));
    return node_id_[index(place) - 1];
  }

  void read_block(std::size_t b, const std::string& name, std::int64_t number) {
    const std::size_t elements = in_.dimension(numbered("num_el_in_blk", b));
    const std::size_t each = in_.dimension(numbered("num_nod_per_el", b));
    if (elements == 0) return;
    const std::string variable = numbered("connect", b);
    if (each == 0 || each > 27) in_.fail(variable, "has " + std::to_string(each) + " nodes an element");
    const std::vector<std::int64_t> connectivity = in_.integers(variable, elements * each);
    std::string type = in_.text_attribute(variable, "elem_type");
    for (char& c : type) {
      if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
      if (static_cast<unsigned char>(c) < 0x20 || static_cast<unsigned char>(c) >= 0x7f) c = '?';
    }
    const ExodusType kind = type_of(type.substr(0, 32), each);
    const std::size_t block = mesh_.block(name.empty() ? std::to_string(number) : name, number);
    std::vector<std::int64_t> nodes(each);
    if (mesh_.element_count() + elements > element_id_.size())
      in_.fail(variable, "holds more elements than dimension 'num_elem' announces");
    const std::vector<double> volume = volumes(b, elements);
    for (std::size_t e = 0; e < elements; ++e) {
      for (std::size_t k = 0; k < each; ++k) nodes[k] = node_at(connectivity[e * each + k], variable);
      const std::int64_t id = element_id_[mesh_.element_count()];
      const int element = kind.shape ? mesh_.add_element(*kind.shape, id, nodes, 0)
                                     : mesh_.add_refused(kind.refused, id, nodes, 0);
      if (!volume.empty() && kind.shape == ElementShape::point) mesh_.set_volume(element, volume[e]);
      mesh_.add_to_block(block, element);
    }
  }

  /// Attribute 'volume' of a block of particles; empty where it has none.
  std::vector<double> volumes(std::size_t b, std::size_t elements) const {
    const std::string values = numbered("attrib", b), names = numbered("attrib_name", b);
    const std::size_t count = in_.dimension(numbered("num_att_in_blk", b));
    if (count == 0 || !in_.has(values)) return {};
    expect_few(count, "num_att_in_blk");
    const auto name = in_.texts(names, count);
    const auto found = std::find_if(name.begin(), name.end(), [](const std::string& text) {
      return text == "volume" || text == "VOLUME" || text == "Volume";
    });
    if (found == name.end()) return {};
    const std::vector<double> all = in_.reals(values, elements * count);
    std::vector<double> volume(elements);
    for (std::size_t e = 0; e < elements; ++e) volume[e] = all[e * count + index(found - name.begin())];
    return volume;
  }

  /// Node sets and side sets are numbered apart.
  std::string name_of_set(const std::string& name, const char* kind, std::int64_t number) const {
    return name.empty() ? kind + std::to_string(number) : name;
  }

  void read_node_sets() {
    const std::size_t sets = in_.dimension("num_node_sets");
    expect_few(sets, "num_node_sets");
    const auto names = in_.texts("ns_names", sets);
    const auto numbers = numbers_of("ns_prop1", sets);
    for (std::size_t s = 0; s < sets; ++s) {
      const std::string variable = numbered("node_ns", s);
      const std::size_t count = in_.dimension(numbered("num_nod_ns", s));
      if (count == 0) continue;
      for (const std::int64_t place : in_.integers(variable, count))
        mesh_.add_to_set(name_of_set(names[s], "node_set_", numbers[s]), node_at(place, variable), 0);
    }
  }

  void read_side_sets() {
    const std::size_t sets = in_.dimension("num_side_sets");
    expect_few(sets, "num_side_sets");
    const auto names = in_.texts("ss_names", sets);
    const auto numbers = numbers_of("ss_prop1", sets);
    for (std::size_t s = 0; s < sets; ++s) {
      const std::string variable = numbered("elem_ss", s);
      const std::size_t count = in_.dimension(numbered("num_side_ss", s));
      if (count == 0) continue;
      const auto elements = in_.integers(variable, count);
      const auto sides = in_.integers(numbered("side_ss", s), count);
      for (std::size_t i = 0; i < count; ++i) {
        if (elements[i] < 1 || elements[i] > static_cast<std::int64_t>(element_id_.size()))
          in_.fail(variable, "names element " + std::to_string(elements[i]) + "; there are " +
                                 std::to_string(element_id_.size()));
        constexpr std::int64_t most_sides = 100;
        mesh_.add_side(name_of_set(names[s], "side_set_", numbers[s]), element_id_[index(elements[i]) - 1],
                       static_cast<int>(std::clamp<std::int64_t>(sides[i], 0, most_sides)), exodus_sides, 0);
      }
    }
  }

  NetcdfFile in_;
  MeshBuilder mesh_;
  std::vector<std::int64_t> node_id_, element_id_;
};

}  // namespace

namespace {

template <class Archive>
void exchange(Archive& archive, FileMesh& mesh, std::vector<std::pair<std::string, FileSet>>& sets) {
  archive(mesh.file, mesh.position, mesh.node_id, mesh.shape, mesh.first, mesh.node, mesh.element_id,
          mesh.line, mesh.volume, mesh.refused_kinds, mesh.blocks, mesh.notices, sets);
}

constexpr char mesh_mark = 'M', fault_mark = 'F';

std::string packed(FileMesh mesh) {
  std::vector<std::pair<std::string, FileSet>> sets(mesh.sets.begin(), mesh.sets.end());
  std::ostringstream out;
  StateWriter writer(out);
  exchange(writer, mesh, sets);
  return mesh_mark + std::move(out).str();
}

FileMesh unpacked(std::string bytes) {
  const std::uint64_t size = bytes.size();
  std::istringstream in(std::move(bytes));
  StateReader reader(in, size);
  FileMesh mesh;
  std::vector<std::pair<std::string, FileSet>> sets;
  exchange(reader, mesh, sets);
  mesh.sets = {sets.begin(), sets.end()};
  return mesh;
}

}  // namespace

FileMesh read_exodus(const std::string& path, const std::string& name) {
  std::string answer;
  try {
    answer = read_apart(path, [&] {
      try {
        return packed(ExodusReader(path, name).read());
      } catch (const MeshFileError& fault) {
        return fault_mark + std::string(fault.what());
      }
    });
  } catch (const FileError& fault) {
    throw MeshFileError(name, 0, fault.reason());
  }
  if (answer[0] == fault_mark) throw MeshFileError(answer.substr(1));
  return unpacked(std::move(answer.erase(0, 1)));
}

}  // namespace brio
