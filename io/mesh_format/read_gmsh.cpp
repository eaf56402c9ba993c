#include "io/mesh_format/read_gmsh.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <optional>
#include <set>

#include "io/mesh_file/element_kinds.hpp"
#include "io/mesh_file/mesh_builder.hpp"
#include "io/mesh_format/gmsh_source.hpp"
#include "src/base/index.hpp"

namespace brio {

namespace {

constexpr const char* how_to_save = "; save it with 'gmsh -save -format msh41', or Mesh.MshFileVersion = 4.1";
constexpr std::array<const char*, 4> names_without_group{"points", "curves", "surfaces", "volumes"};
constexpr std::array<const char*, 4> names_of_dimensions{"point_", "curve_", "surface_", "volume_"};

/// An element type by its number in the format.
struct GmshType {
  int number;
  int nodes;
  ElementShape shape;
  const char* refused = "";
  int dimension = 0;
};
constexpr GmshType types[] = {
    {1, 2, ElementShape::line},
    {2, 3, ElementShape::triangle},
    {3, 4, ElementShape::quadrilateral},
    {4, 4, ElementShape::refused, "tetrahedra with 4 nodes", 3},
    {5, 8, ElementShape::hexahedron},
    {6, 6, ElementShape::wedge},
    {7, 5, ElementShape::refused, "pyramids with 5 nodes", 3},
    {8, 3, ElementShape::refused, "lines with 3 nodes", 1},
    {9, 6, ElementShape::refused, "triangles with 6 nodes", 2},
    {10, 9, ElementShape::refused, "quadrilaterals with 9 nodes", 2},
    {11, 10, ElementShape::refused, "tetrahedra with 10 nodes", 3},
    {12, 27, ElementShape::refused, "hexahedra with 27 nodes", 3},
    {13, 18, ElementShape::refused, "wedges with 18 nodes", 3},
    {14, 14, ElementShape::refused, "pyramids with 14 nodes", 3},
    {15, 1, ElementShape::point},
    {16, 8, ElementShape::refused, "quadrilaterals with 8 nodes", 2},
    {17, 20, ElementShape::refused, "hexahedra with 20 nodes", 3},
    {18, 15, ElementShape::refused, "wedges with 15 nodes", 3},
    {19, 13, ElementShape::refused, "pyramids with 13 nodes", 3},
};

RefusedKind refused_kind(const GmshType& type) {
  if (type.number == 4) return tetrahedra();
  if (type.number == 7) return pyramids();
  return {type.refused, type.dimension, instead_of_second_order};
}

class GmshReader {
 public:
  GmshReader(std::string_view text, const std::string& file) : in_(text, file), mesh_(file) {}

  FileMesh read() {
    if (in_.at_end()) in_.fail("the file is empty; a mesh of Gmsh is expected");
    bool has_nodes = false, has_elements = false;
    read_format();
    while (!in_.at_end()) {
      const std::string_view mark = in_.word("a section");
      if (mark.size() < 2 || mark.front() != '$') in_.fail("a section such as '$Nodes' is expected");
      const std::string name(mark.substr(1));
      if (name == "PhysicalNames")
        read_physical_names();
      else if (name == "Entities")
        numbers(name, [&] { read_entities(); });
      else if (name == "Nodes")
        numbers(name, [&] { read_nodes(); }), has_nodes = true;
      else if (name == "Elements")
        numbers(name, [&] { read_elements(); }), has_elements = true;
      else if (name == "PartitionedEntities")
        in_.fail("the mesh is partitioned; accepted are meshes without partitions (gmsh: unpartition)");
      else
        skip(name);
    }
    if (!has_nodes || !has_elements)
      in_.fail(std::string("the file has no section '$") + (has_nodes ? "Elements'" : "Nodes'"));
    if (!skipped_.empty()) {
      std::string list;
      for (const std::string& name : skipped_) list += (list.empty() ? "$" : ", $") + name;
      mesh_.notice("sections that are not read: " + list);
    }
    return mesh_.finish();
  }

 private:
  void read_format() {
    if (in_.word("a section") != "$MeshFormat")
      in_.fail("'$MeshFormat' is expected at the beginning of a mesh of Gmsh");
    const std::string version(in_.word("the version"));
    const int type = in_.integer("the type of the file"), size = in_.integer("the size of numbers");
    if (version != "4.1") in_.fail("format " + version + "; accepted is 4.1" + how_to_save);
    if (type != 0 && type != 1) in_.fail("the type of the file is neither 0 (ASCII) nor 1 (binary)");
    if (size != 8) in_.fail("numbers of " + std::to_string(size) + " bytes; accepted are 8");
    is_binary_ = type == 1;
    in_.skip_line();
    if (is_binary_) {
      in_.set_binary(true);
      const int one = in_.integer("the number 1, which tells the order of bytes");
      if (one != 1)
        in_.fail("the bytes of numbers stand in another order than on this machine; save it in ASCII");
      in_.set_binary(false);
    }
    in_.end_section("MeshFormat");
  }

  template <class Read>
  void numbers(const std::string& name, const Read& read) {
    in_.skip_line();
    in_.set_binary(is_binary_);
    read();
    in_.set_binary(false);
    in_.end_section(name);
  }

  void skip(const std::string& name) {
    if (name != "Comments") skipped_.insert(name);
    in_.skip_section(name);
  }

  void read_physical_names() {
    const std::int64_t count = in_.count("the number of physical names");
    in_.expect_room(count, 0, 2, 1, "physical names");
    for (std::int64_t i = 0; i < count; ++i) {
      const int dimension = in_.integer("a dimension");
      expect_dimension(dimension);
      const int tag = in_.integer("the tag of a physical group");
      name_of_group_[{dimension, tag}] = in_.quoted_name();
    }
    in_.end_section("PhysicalNames");
  }

  void expect_dimension(int dimension) {
    if (dimension < 0 || dimension > 3)
      in_.fail("a dimension is " + std::to_string(dimension) + "; accepted are 0 to 3");
  }

  void read_entities() {
    std::array<std::int64_t, 4> count{};
    for (std::int64_t& number : count) number = in_.count("the number of entities");
    for (int dimension = 0; dimension < 4; ++dimension) {
      const std::int64_t entities = count[index(dimension)];
      in_.expect_room(entities, 1, 1, dimension == 0 ? 3 : 6, "entities");
      for (std::int64_t i = 0; i < entities; ++i) read_entity(dimension);
    }
  }

  void read_entity(int dimension) {
    const int tag = in_.integer("the tag of an entity");
    for (int k = 0; k < (dimension == 0 ? 3 : 6); ++k) in_.real("a coordinate of an entity");
    const std::int64_t groups = in_.count("the number of physical groups");
    in_.expect_room(groups, 1, 0, 0, "physical groups");
    std::vector<int>& list = groups_of_entity_[{dimension, tag}];
    for (std::int64_t k = 0; k < groups; ++k) list.push_back(std::abs(in_.integer("a physical group")));
    if (dimension == 0) return;
    const std::int64_t bounds = in_.count("the number of bounding entities");
    in_.expect_room(bounds, 1, 0, 0, "bounding entities");
    for (std::int64_t k = 0; k < bounds; ++k) in_.integer("a bounding entity");
  }

  void read_nodes() {
    const std::int64_t blocks = in_.count("the number of blocks of nodes");
    const std::int64_t nodes = in_.count("the number of nodes");
    in_.count("the least tag");
    in_.count("the largest tag");
    in_.expect_room(blocks, 3, 1, 0, "blocks of nodes");
    in_.expect_room(nodes, 0, 1, 3, "nodes");
    mesh_.reserve(index(nodes), 0, 0);
    for (std::int64_t b = 0; b < blocks; ++b) read_node_block();
    if (static_cast<std::int64_t>(mesh_.node_count()) != nodes)
      in_.fail(std::to_string(nodes) + " nodes are announced, but there are " +
               std::to_string(mesh_.node_count()));
  }

  void read_node_block() {
    const int dimension = in_.integer("a dimension");
    expect_dimension(dimension);
    in_.integer("the tag of an entity");
    const int parametric = in_.integer("whether there are parametric coordinates");
    if (parametric != 0 && parametric != 1) in_.fail("0 or 1 is expected: are there parametric coordinates?");
    const std::int64_t count = in_.count("the number of nodes of a block");
    const int further = parametric == 1 ? dimension : 0;
    in_.expect_room(count, 0, 1, 3 + further, "nodes of a block");
    tags_.clear();
    for (std::int64_t i = 0; i < count; ++i) tags_.push_back(in_.count("the tag of a node"));
    for (const std::int64_t tag : tags_) {
      Vector3d position{};
      for (double& x : position) x = in_.real("a coordinate");
      for (int k = 0; k < further; ++k) in_.real("a parametric coordinate");
      mesh_.add_node(tag, position, in_.line());
    }
  }

  void read_elements() {
    const std::int64_t blocks = in_.count("the number of blocks of elements");
    const std::int64_t elements = in_.count("the number of elements");
    in_.count("the least tag");
    in_.count("the largest tag");
    in_.expect_room(blocks, 3, 1, 0, "blocks of elements");
    in_.expect_room(elements, 0, 2, 0, "elements");
    mesh_.reserve(mesh_.node_count(), index(elements), 0);
    for (std::int64_t b = 0; b < blocks; ++b) read_element_block();
    if (static_cast<std::int64_t>(mesh_.element_count()) != elements)
      in_.fail(std::to_string(elements) + " elements are announced, but there are " +
               std::to_string(mesh_.element_count()));
  }

  void read_element_block() {
    const int dimension = in_.integer("a dimension");
    expect_dimension(dimension);
    const int entity = in_.integer("the tag of an entity");
    const int number = in_.integer("the type of elements");
    const auto* type = std::find_if(std::begin(types), std::end(types),
                                    [&](const GmshType& each) { return each.number == number; });
    if (type == std::end(types))
      in_.fail("elements of type " + std::to_string(number) + " are not known; " + instead_of_others);
    const std::int64_t count = in_.count("the number of elements of a block");
    in_.expect_room(count, 0, 1 + type->nodes, 0, "elements of a block");
    const std::vector<std::size_t> blocks = blocks_of(dimension, entity);
    const std::optional<RefusedKind> refused =
        type->shape == ElementShape::refused ? std::optional(refused_kind(*type)) : std::nullopt;
    std::array<std::int64_t, 27> nodes{};
    const std::span<std::int64_t> corners(nodes.data(), index(type->nodes));
    for (std::int64_t i = 0; i < count; ++i) {
      const std::int64_t tag = in_.count("the tag of an element");
      const std::uint32_t line = in_.line();
      for (std::int64_t& node : corners) node = in_.count("a node of an element");
      const int element = refused ? mesh_.add_refused(*refused, tag, corners, line)
                                  : mesh_.add_element(type->shape, tag, corners, line);
      for (const std::size_t block : blocks) mesh_.add_to_block(block, element);
    }
  }

  /// Groups without a name are called by dimension and tag, since each dimension has tags of its own.
  std::vector<std::size_t> blocks_of(int dimension, int entity) {
    const auto place = index(dimension);
    const auto found = groups_of_entity_.find({dimension, entity});
    if (found == groups_of_entity_.end() || found->second.empty())
      return {mesh_.block(names_without_group[place])};
    std::vector<std::size_t> blocks;
    for (const int group : found->second) {
      const auto named = name_of_group_.find({dimension, group});
      const std::string name =
          named == name_of_group_.end() ? names_of_dimensions[place] + std::to_string(group) : named->second;
      blocks.push_back(mesh_.block(name, group));
    }
    return blocks;
  }

  GmshSource in_;
  MeshBuilder mesh_;
  bool is_binary_ = false;
  std::map<std::pair<int, int>, std::string> name_of_group_;          ///< by dimension and tag
  std::map<std::pair<int, int>, std::vector<int>> groups_of_entity_;  ///< by dimension and tag
  std::vector<std::int64_t> tags_;
  std::set<std::string> skipped_;
};

}  // namespace

FileMesh read_gmsh(std::string_view text, const std::string& file) { return GmshReader(text, file).read(); }

}  // namespace brio
