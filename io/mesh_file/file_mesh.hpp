#pragma once
/// What a mesh file holds, whatever its format.

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "src/base/index.hpp"
#include "src/base/tensor.hpp"

namespace brio {

/// Shapes that are read, with their corners in VTK order. Further values are kinds that are refused
/// (`FileMesh::refused_kinds`).
enum class ElementShape : unsigned char { point, line, triangle, quadrilateral, wedge, hexahedron, refused };

inline constexpr std::array<int, 6> corners_of_shape{1, 2, 3, 4, 6, 8};
inline constexpr std::array<int, 6> dimension_of_shape{0, 1, 2, 2, 3, 3};

/// A kind of element that no part can be made of.
struct RefusedKind {
  std::string name;    ///< "tetrahedra with 4 nodes"
  int dimension = 3;   ///< of the element
  std::string advice;  ///< what is accepted in its place

  template <class Archive>
  void serialize(Archive& archive) {
    archive(name, dimension, advice);
  }
};

/// A face, by its nodes; a triangle repeats its third.
struct FileFace {
  std::array<int, 4> node{};
  int element = -1;  ///< that it is a side of; -1: the file does not say
};

/// Nodes and faces of all that bears one name in the file.
struct FileSet {
  std::vector<int> node;
  std::vector<FileFace> face;

  template <class Archive>
  void serialize(Archive& archive) {
    archive(node, face);
  }
};

/// Elements that a part can be made of.
struct FileBlock {
  std::string name;
  std::int64_t number = -1;  ///< -1: it has none
  std::vector<int> element;  ///< ascending

  template <class Archive>
  void serialize(Archive& archive) {
    archive(name, number, element);
  }
};

/// Nodes and elements by their place in the file, from 0; `..._id` are their numbers there.
struct FileMesh {
  std::string file;
  std::vector<Vector3d> position;
  std::vector<std::int64_t> node_id;
  std::vector<unsigned char> shape;     ///< ElementShape, or ElementShape::refused + a place in refused_kinds
  std::vector<std::uint32_t> first{0};  ///< element e has node[first[e]] to node[first[e + 1])
  std::vector<int> node;                ///< of the elements
  std::vector<std::int64_t> element_id;  ///< of the elements
  std::vector<std::uint32_t> line;       ///< of each element in the file; empty: it has no lines
  std::vector<double> volume;            ///< of each element that is a particle; empty: the file says none
  std::vector<RefusedKind> refused_kinds;
  std::vector<FileBlock> blocks;
  std::map<std::string, FileSet> sets;  ///< besides, each block is a set of its nodes and of its faces
  std::vector<std::string> notices;     ///< what was left out
  std::uint64_t checksum = 0;

  std::size_t element_count() const { return shape.size(); }
  bool is_refused(std::size_t e) const {
    return shape[e] >= static_cast<unsigned char>(ElementShape::refused);
  }
  const RefusedKind& refused_kind(std::size_t e) const {
    return refused_kinds[shape[e] - index(ElementShape::refused)];
  }
  int dimension(std::size_t e) const {
    return is_refused(e) ? refused_kind(e).dimension : dimension_of_shape[shape[e]];
  }
  std::uint32_t line_of(std::size_t e) const { return line.empty() ? 0 : line[e]; }
};

}  // namespace brio
