#include "io/results/write_xdmf.hpp"

#include <fmt/format.h>

#include <string_view>

#include "io/files/text_file.hpp"

namespace brio {
namespace {

std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      default:
        result += c;
    }
  }
  return result;
}

const char* number_type(Storage storage) {
  switch (storage) {
    case Storage::single_precision:
      return R"(NumberType="Float" Precision="4")";
    case Storage::double_precision:
      return R"(NumberType="Float" Precision="8")";
    case Storage::integer:
      return R"(NumberType="Int" Precision="8")";
  }
  return "";
}

/// Six components as a matrix are labelled XX YY ZZ XY YZ XZ by ParaView, as they are stored; XDMF's Tensor6
/// assumes another order.
const char* attribute_type(std::int64_t components) {
  if (components == 1) return "Scalar";
  return components == 3 ? "Vector" : "Matrix";
}

/// Of a matrix the reader takes the last dimension as the number of components, from ParaView 6.1 on the
/// product of the last two.
std::string shape_of(const StoredArray& array) {
  const bool is_matrix = array.components != 1 && array.components != 3;
  return fmt::format("{}{} {}", array.rows, is_matrix ? " 1" : "", array.components);
}

/// Of a polyline or polyvertex the number of points in one must be said. Nothing: cells of several types.
const char* topology_type(std::optional<CellType> type) {
  if (!type) return R"(TopologyType="Mixed")";
  switch (*type) {
    case hexahedron_cell:
      return R"(TopologyType="Hexahedron")";
    case quadrilateral_cell:
      return R"(TopologyType="Quadrilateral")";
    case line_cell:
      return R"(TopologyType="Polyline" NodesPerElement="2")";
    case vertex_cell:
      return R"(TopologyType="Polyvertex" NodesPerElement="1")";
  }
  return "";
}

/// ParaView selects no block of this name, which it gives to the leaves of its own tree of blocks.
constexpr std::string_view reserved_name = "dataset";

StoredArray rows_of(StoredArray array, std::int64_t first, std::int64_t rows) {
  array.first_row += first;
  array.rows = rows;
  return array;
}

}  // namespace

XdmfWriter::XdmfWriter(const std::string& heavy_file) : heavy_file_(escaped(heavy_file)) {}

// No blank before the first child: the reader would take the slabs of all times for one, and read it once.
std::string XdmfWriter::slab(const StoredArray& array) const {
  return fmt::format(
      "<DataItem ItemType=\"HyperSlab\" Dimensions=\"{shape}\">"
      "<DataItem Dimensions=\"3 2\" NumberType=\"Int\" Precision=\"8\">{first} 0 1 1 {rows} "
      "{columns}</DataItem>"
      "<DataItem Dimensions=\"{total} {columns}\" {type} "
      "Format=\"HDF\">{file}:{dataset}</DataItem></DataItem>",
      fmt::arg("shape", shape_of(array)), fmt::arg("rows", array.rows), fmt::arg("columns", array.components),
      fmt::arg("first", array.first_row), fmt::arg("total", array.rows_in_file),
      fmt::arg("type", number_type(array.storage)), fmt::arg("file", heavy_file_),
      fmt::arg("dataset", escaped(array.dataset)));
}

// Of a dataset with one dimension.
std::string XdmfWriter::list(const StoredArray& array) const {
  return fmt::format(
      "<DataItem ItemType=\"HyperSlab\" Dimensions=\"{rows}\">"
      "<DataItem Dimensions=\"3\" NumberType=\"Int\" Precision=\"8\">{first} 1 {rows}</DataItem>"
      "<DataItem Dimensions=\"{total}\" {type} Format=\"HDF\">{file}:{dataset}</DataItem></DataItem>",
      fmt::arg("rows", array.rows), fmt::arg("first", array.first_row), fmt::arg("total", array.rows_in_file),
      fmt::arg("type", number_type(array.storage)), fmt::arg("file", heavy_file_),
      fmt::arg("dataset", array.dataset));
}

std::string XdmfWriter::attribute(const StoredArray& array, const char* center) const {
  return fmt::format("<Attribute Name=\"{}\" AttributeType=\"{}\" Center=\"{}\">{}</Attribute>\n",
                     escaped(array.name), attribute_type(array.components), center, slab(array));
}

std::string XdmfWriter::grid(const StoredDump& dump, const StoredPart& part) const {
  const SnapshotPart& range = part.range;
  const auto points = [&](const StoredArray& array) {
    return rows_of(array, range.first_point, range.points);
  };
  const auto cells = [&](const StoredArray& array) { return rows_of(array, range.first_cell, range.cells); };
  std::string text = fmt::format(
      "<Grid><Time Value=\"{}\"/>\n<Topology {} NumberOfElements=\"{}\" BaseOffset=\"{}\">{}</Topology>\n"
      "<Geometry GeometryType=\"XYZ\">{}</Geometry>\n",
      dump.time, topology_type(part.type), range.cells, range.first_point, list(part.connectivity),
      slab(points(dump.coordinates)));
  for (const StoredArray& array : dump.point_fields) text += attribute(points(array), "Node");
  for (const StoredArray& array : dump.cell_fields) text += attribute(cells(array), "Cell");
  for (const StoredArray& array : dump.global_fields) text += attribute(array, "Grid");
  return text += "</Grid>\n";
}

// A part without cells has no grid at this time: the reader shows its block empty, where a grid of no cells
// is an error.
void XdmfWriter::append(const StoredDump& dump) {
  blocks_.resize(dump.parts.size());
  for (std::size_t i = 0; i < blocks_.size(); ++i) {
    const StoredPart& part = dump.parts[i];
    blocks_[i].name = part.range.name == reserved_name ? part.range.name + "_" : part.range.name;
    if (part.range.cells > 0) blocks_[i].steps += grid(dump, part);
  }
  ++dumps_;
}

// A part that never had a cell has no block: the reader crashes on a collection of nothing.
void XdmfWriter::write(const std::filesystem::path& path, bool sync) {
  if (dumps_ == 0) return;
  std::vector<std::string> heads;
  heads.reserve(blocks_.size());  // pieces refer to them
  std::vector<std::string_view> pieces{"<?xml version=\"1.0\" ?>\n<Xdmf Version=\"2.0\">\n<Domain>\n"};
  for (const Block& block : blocks_) {
    if (block.steps.empty()) continue;
    heads.push_back(fmt::format("<Grid Name=\"{}\" GridType=\"Collection\" CollectionType=\"Temporal\">\n",
                                escaped(block.name)));
    pieces.insert(pieces.end(), {heads.back(), block.steps, "</Grid>\n"});
  }
  pieces.push_back("</Domain>\n</Xdmf>\n");
  replace_text_file(path, pieces, sync);
  written_ = dumps_;
}

}  // namespace brio
