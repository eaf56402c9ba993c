#pragma once
/// A mesh as a reader finds it, by the numbers of the file, and the checks that all formats share.

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "io/mesh_file/file_mesh.hpp"
#include "io/mesh_file/mesh_file_error.hpp"
#include "src/base/tensor.hpp"

namespace brio {

class IdMap;

class MeshBuilder {
 public:
  explicit MeshBuilder(std::string file);

  /// \param line of the file; 0: it has none. \throws MeshFileError for a coordinate that is not finite
  void add_node(std::int64_t id, const Vector3d& position, std::uint32_t line);
  /// \return its place
  int add_element(ElementShape shape, std::int64_t id, std::span<const std::int64_t> nodes,
                  std::uint32_t line);
  int add_refused(const RefusedKind& kind, std::int64_t id, std::span<const std::int64_t> nodes,
                  std::uint32_t line);
  /// Of an element, if it is a particle.
  void set_volume(int element, double volume);
  void reserve(std::size_t nodes, std::size_t elements, std::size_t element_nodes);

  /// The block of that name; it is made where there is none. \return its place
  std::size_t block(const std::string& name, std::int64_t number = -1);
  void add_to_block(std::size_t block, int element) { mesh_.blocks[block].element.push_back(element); }
  const std::vector<FileBlock>& blocks() const { return mesh_.blocks; }

  void add_to_set(const std::string& set, std::int64_t node, std::uint32_t line);
  /// All nodes of the file whose numbers are in a range.
  void add_range_to_set(const std::string& set, std::int64_t first, std::int64_t last);
  /// \param nodes of a face: 3 or 4
  void add_face(const std::string& set, std::span<const std::int64_t> nodes, std::uint32_t line);
  /// \param sides of each shape, the numbers of its corners, in the numbering of the format
  using SideTable = std::vector<std::vector<int>> (*)(ElementShape);
  void add_side(const std::string& set, std::int64_t element, int side, SideTable sides, std::uint32_t line);
  /// The same of each element of a block.
  void add_sides_of_block(const std::string& set, const std::string& block, int side, SideTable sides,
                          std::uint32_t line);
  void add_nodes_of_block(const std::string& set, const std::string& block, std::uint32_t line);
  void add_elements_to_block(const std::string& name, std::vector<std::int64_t> elements, std::uint32_t line);
  /// Elements of different dimensions may bear the same number.
  void number_by_dimension() { is_numbered_by_dimension_ = true; }

  void notice(const std::string& text) { mesh_.notices.push_back(text); }
  [[noreturn]] void fail(std::uint32_t line, const std::string& fault) const {
    throw MeshFileError(mesh_.file, line, fault);
  }
  const std::string& file() const { return mesh_.file; }
  std::size_t node_count() const { return mesh_.position.size(); }
  std::size_t element_count() const { return mesh_.shape.size(); }

  /// Everything resolved. \throws MeshFileError for numbers that stand twice or that nothing bears
  FileMesh finish();

 private:
  struct RawNodes {
    std::vector<std::int64_t> node;
    std::vector<std::uint32_t> line;
  };
  struct RawFace {
    std::array<std::int64_t, 4> node;
    std::uint32_t line;
  };
  struct RawSide {
    std::string block;  ///< empty: of one element
    std::int64_t element;
    int side;
    SideTable sides;
    std::uint32_t line;
  };
  struct RawBlock {
    std::string block;
    std::uint32_t line;
  };
  struct RawElements {
    std::vector<std::int64_t> element;
    std::uint32_t line;
  };

  int add(unsigned char shape, std::int64_t id, std::span<const std::int64_t> nodes, std::uint32_t line);
  void resolve_elements(const IdMap& nodes);
  void resolve_sets(const IdMap& nodes);
  void add_resolved_side(const std::string& name, FileSet& set, const RawSide& side, std::size_t element);
  void resolve_sides(const IdMap& elements);
  void resolve_nodes_of_blocks();
  void resolve_blocks(const IdMap& elements);
  const FileBlock& block_named(const std::string& name, std::uint32_t line) const;
  void expect_unique_elements() const;
  void note_unused_nodes();

  FileMesh mesh_;
  std::vector<std::uint32_t> node_line_;
  std::vector<std::int64_t> element_node_;  ///< by number
  std::map<std::string, RawNodes> nodes_;
  std::map<std::string, std::vector<std::array<std::int64_t, 2>>> ranges_;
  std::map<std::string, std::vector<RawFace>> faces_;
  std::map<std::string, std::vector<RawSide>> sides_;
  std::map<std::string, std::vector<RawBlock>> nodes_of_blocks_;
  std::map<std::string, std::vector<RawElements>> elements_;
  bool is_numbered_by_dimension_ = false;
  std::map<std::string, std::size_t, std::less<>> block_of_name_;
};

}  // namespace brio
