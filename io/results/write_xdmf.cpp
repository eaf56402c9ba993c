#include "io/results/write_xdmf.hpp"

#include <fmt/format.h>

#include "io/files/text_file.hpp"

namespace brio {
namespace {

constexpr const char* head =
    "<?xml version=\"1.0\" ?>\n<Xdmf Version=\"2.0\">\n<Domain>\n"
    "<Grid Name=\"scene\" GridType=\"Collection\" CollectionType=\"Temporal\">\n";
constexpr const char* tail = "</Grid>\n</Domain>\n</Xdmf>\n";

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

}  // namespace

XdmfWriter::XdmfWriter(const std::string& heavy_file) : heavy_file_(escaped(heavy_file)) {}

std::string XdmfWriter::slab(const StoredArray& array) const {
  return fmt::format(
      "<DataItem ItemType=\"HyperSlab\" Type=\"HyperSlab\" Dimensions=\"{rows} {columns}\">"
      "<DataItem Dimensions=\"3 2\" NumberType=\"Int\" Format=\"XML\">{first} 0 1 1 {rows} "
      "{columns}</DataItem>"
      "<DataItem Dimensions=\"{total} {columns}\" {type} "
      "Format=\"HDF\">{file}:{dataset}</DataItem></DataItem>",
      fmt::arg("rows", array.rows), fmt::arg("columns", array.components), fmt::arg("first", array.first_row),
      fmt::arg("total", array.rows_in_file), fmt::arg("type", number_type(array.storage)),
      fmt::arg("file", heavy_file_), fmt::arg("dataset", escaped(array.dataset)));
}

std::string XdmfWriter::attribute(const StoredArray& array, const char* center) const {
  return fmt::format("<Attribute Name=\"{}\" AttributeType=\"{}\" Center=\"{}\">{}</Attribute>\n",
                     escaped(array.name), attribute_type(array.components), center, slab(array));
}

void XdmfWriter::append(const StoredDump& dump) {
  const StoredArray& list = dump.mixed_topology;
  steps_ += fmt::format(
      "<Grid Name=\"step\" GridType=\"Uniform\"><Time Value=\"{}\"/>\n"
      "<Topology TopologyType=\"Mixed\" NumberOfElements=\"{}\">"
      "<DataItem ItemType=\"HyperSlab\" Type=\"HyperSlab\" Dimensions=\"{}\">"
      "<DataItem Dimensions=\"3 1\" NumberType=\"Int\" Format=\"XML\">{} 1 {}</DataItem>"
      "<DataItem Dimensions=\"{}\" {} Format=\"HDF\">{}:{}</DataItem></DataItem></Topology>\n"
      "<Geometry GeometryType=\"XYZ\">{}</Geometry>\n",
      dump.time, dump.cells, list.rows, list.first_row, list.rows, list.rows_in_file,
      number_type(list.storage), heavy_file_, list.dataset, slab(dump.coordinates));
  for (const StoredArray& array : dump.point_fields) steps_ += attribute(array, "Node");
  for (const StoredArray& array : dump.cell_fields) steps_ += attribute(array, "Cell");
  for (const StoredArray& array : dump.global_fields) steps_ += attribute(array, "Grid");
  steps_ += "</Grid>\n";
}

void XdmfWriter::write(const std::filesystem::path& path, bool sync) const {
  replace_text_file(path, {head, steps_, tail}, sync);
}

}  // namespace brio
