#include "tests/io/mesh_format/mesh_writers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <map>
#include <numeric>
#include <stdexcept>
#include <vector>

#include "io/mesh_file/part_mesh.hpp"
#include "src/base/index.hpp"
#include "tests/io/mesh_format/netcdf_writer.hpp"

namespace brio::test {

namespace {

/// Elements of one shape, with the corners that they have in files.
struct FileElement {
  int shape_nodes = 0;  ///< 8, 6, 4, 3, 2, 1
  std::int64_t id = 0;
  std::vector<std::int64_t> node;  ///< numbers
};

std::int64_t id_of_node(const Mesh& mesh, int node) {
  return mesh.node_id.empty() ? node + 1 : mesh.node_id[index(node)];
}
std::int64_t id_of_element(const Mesh& mesh, std::size_t element) {
  return mesh.element_id.empty() ? static_cast<std::int64_t>(element) + 1 : mesh.element_id[element];
}

FileElement element_of(const Mesh& mesh, std::size_t e) {
  const auto corners = index(mesh.nodes_per_element);
  const int* node = mesh.connectivity.data() + corners * e;
  std::vector<int> taken(corners);
  std::iota(taken.begin(), taken.end(), 0);
  if (corners == 8 && node[2] == node[3] && node[6] == node[7]) taken = {0, 1, 2, 4, 5, 6};
  if (corners == 4 && node[2] == node[3]) taken = {0, 1, 2};
  FileElement element{static_cast<int>(taken.size()), id_of_element(mesh, e), {}};
  for (const int k : taken) element.node.push_back(id_of_node(mesh, node[k]));
  return element;
}

std::vector<FileElement> elements_of(const Mesh& mesh) {
  std::vector<FileElement> elements;
  for (std::size_t e = 0; e < mesh.element_count(); ++e) elements.push_back(element_of(mesh, e));
  return elements;
}

/// Runs of elements of one shape: first and one after the last.
std::vector<std::pair<std::size_t, std::size_t>> runs_of(const std::vector<FileElement>& elements) {
  std::vector<std::pair<std::size_t, std::size_t>> runs;
  for (std::size_t e = 0; e < elements.size(); ++e)
    if (runs.empty() || elements[runs.back().first].shape_nodes != elements[e].shape_nodes)
      runs.emplace_back(e, e + 1);
    else
      runs.back().second = e + 1;
  return runs;
}

std::vector<std::int64_t> face_of(const Mesh& mesh, const ElementSide& side) {
  const auto corners = index(mesh.nodes_per_element);
  std::vector<std::int64_t> nodes;
  for (std::size_t k = 0; k < 4; ++k) {
    const int corner = corners == 8 ? sides_of_hex[index(side.side)][k] : static_cast<int>(k);
    const std::int64_t id =
        id_of_node(mesh, mesh.connectivity[index(side.element) * corners + index(corner)]);
    if (std::find(nodes.begin(), nodes.end(), id) == nodes.end()) nodes.push_back(id);
  }
  return nodes;
}

bool has_faces(const Mesh& mesh, const std::string& name) { return mesh.side_sets.contains(name); }

int gmsh_type(int nodes) {
  return std::map<int, int>{{8, 5}, {6, 6}, {4, 3}, {3, 2}, {2, 1}, {1, 15}}.at(nodes);
}
int gmsh_dimension(int nodes) { return nodes >= 6 ? 3 : nodes >= 3 ? 2 : nodes - 1; }

/// Numbers of a Gmsh file.
class GmshText {
 public:
  explicit GmshText(bool binary) : binary_(binary) {}
  GmshText& integers(std::initializer_list<int> values) {
    for (const int value : values) put(value);
    return *this;
  }
  GmshText& counts(const std::vector<std::int64_t>& values) {
    for (const std::int64_t value : values) put(value);
    return *this;
  }
  GmshText& reals(const Vector3d& values) {
    for (const double value : values) put(value);
    return *this;
  }
  void end_line() {
    if (!binary_) text += '\n';
  }
  void begin(const char* section) { text += fmt::format("${}\n", section); }
  void end(const char* section) { text += fmt::format("{}$End{}\n", binary_ ? "\n" : "", section); }
  std::string text;

 private:
  template <class Number>
  void put(Number value) {
    if (binary_)
      text.append(reinterpret_cast<const char*>(&value), sizeof value);
    else
      text += fmt::format("{} ", value);
  }
  bool binary_;
};

}  // namespace

std::string as_gmsh(const Mesh& mesh, bool binary) {
  // Physical groups: 1 is the body, then one a set; one entity each, of the group's number.
  struct Group {
    std::string name;
    int dimension;
    std::vector<FileElement> elements;
  };
  std::vector<Group> groups{{"body", gmsh_dimension(mesh.nodes_per_element), elements_of(mesh)}};
  std::int64_t next = 1;
  for (const FileElement& element : groups[0].elements) next = std::max(next, element.id + 1);
  for (const auto& [name, nodes] : mesh.node_sets) {
    if (name == "all") continue;
    Group& group = groups.emplace_back(Group{name, has_faces(mesh, name) ? 2 : 0, {}});
    if (has_faces(mesh, name))
      for (const ElementSide& side : mesh.side_sets.at(name)) {
        const auto face = face_of(mesh, side);
        group.elements.push_back({static_cast<int>(face.size()), next++, face});
      }
    else
      for (const int node : nodes) group.elements.push_back({1, next++, {id_of_node(mesh, node)}});
  }
  GmshText out(binary);
  out.begin("MeshFormat");
  out.text += fmt::format("4.1 {} 8\n", binary ? 1 : 0);
  if (binary) out.integers({1}).text += "\n";
  out.text += "$EndMeshFormat\n$PhysicalNames\n" + fmt::format("{}\n", groups.size());
  for (std::size_t g = 0; g < groups.size(); ++g)
    out.text += fmt::format("{} {} \"{}\"\n", groups[g].dimension, g + 1, groups[g].name);
  out.text += "$EndPhysicalNames\n";
  out.begin("Entities");
  std::vector<std::int64_t> count(4);
  for (const Group& group : groups) ++count[index(group.dimension)];
  out.counts(count).end_line();
  for (int dimension = 0; dimension < 4; ++dimension)
    for (std::size_t g = 0; g < groups.size(); ++g) {
      if (groups[g].dimension != dimension) continue;
      const int tag = static_cast<int>(g) + 1;
      out.integers({tag}).reals({});
      if (dimension > 0) out.reals({});
      out.counts({1}).integers({tag});
      if (dimension > 0) out.counts({0});
      out.end_line();
    }
  out.end("Entities");
  out.begin("Nodes");
  const auto nodes = static_cast<std::int64_t>(mesh.position.size());
  out.counts({1, nodes, 1, nodes}).end_line();
  out.integers({groups[0].dimension, 1, 0}).counts({nodes}).end_line();
  for (int n = 0; n < static_cast<int>(nodes); ++n) out.counts({id_of_node(mesh, n)}).end_line();
  for (const auto& position : mesh.position) out.reals(position).end_line();
  out.end("Nodes");
  out.begin("Elements");
  std::int64_t runs = 0, elements = 0;
  for (const Group& group : groups) {
    runs += static_cast<std::int64_t>(runs_of(group.elements).size());
    elements += static_cast<std::int64_t>(group.elements.size());
  }
  out.counts({runs, elements, 1, next}).end_line();
  for (std::size_t g = 0; g < groups.size(); ++g)
    for (const auto& [first, end] : runs_of(groups[g].elements)) {
      out.integers(
          {groups[g].dimension, static_cast<int>(g) + 1, gmsh_type(groups[g].elements[first].shape_nodes)});
      out.counts({static_cast<std::int64_t>(end - first)}).end_line();
      for (std::size_t e = first; e < end; ++e)
        out.counts({groups[g].elements[e].id}).counts(groups[g].elements[e].node).end_line();
    }
  out.end("Elements");
  return out.text;
}

std::string as_abaqus(const Mesh& mesh) {
  const std::map<int, const char*> type{{8, "C3D8R"}, {6, "C3D6"}, {4, "S4R"},
                                        {3, "S3R"},   {2, "B31"},  {1, "MASS"}};
  std::string out = "*HEADING\nA mesh of a test\n** nodes\n*NODE\n";
  for (int n = 0; n < static_cast<int>(mesh.position.size()); ++n) {
    const auto& [x, y, z] = mesh.position[index(n)];
    out += fmt::format("{}, {}, {}, {}\n", id_of_node(mesh, n), x, y, z);
  }
  const std::vector<FileElement> elements = elements_of(mesh);
  for (const auto& [first, end] : runs_of(elements)) {
    out += fmt::format("*Element, type={}, elset=body\n", type.at(elements[first].shape_nodes));
    for (std::size_t e = first; e < end; ++e) {
      out += fmt::format("{}", elements[e].id);
      for (std::size_t k = 0; k < elements[e].node.size(); ++k)
        out += fmt::format(",{} {}", k == 5 ? "\n" : "", elements[e].node[k]);
      out += '\n';
    }
  }
  constexpr std::array<int, 6> side_of_hexahedron{1, 2, 3, 4, 5, 6}, side_of_wedge{1, 2, 3, 4, 0, 5};
  for (const auto& [name, nodes] : mesh.node_sets) {
    if (name == "all") continue;
    if (!has_faces(mesh, name)) {
      out += fmt::format("*NSET, NSET={}\n", name);
      for (const int node : nodes) out += fmt::format("{},\n", id_of_node(mesh, node));
      continue;
    }
    out += fmt::format("*SURFACE, NAME={}\n", name);
    for (const auto& [element, side] : mesh.side_sets.at(name)) {
      const FileElement& of = elements[index(element)];
      const int number = (of.shape_nodes == 6 ? side_of_wedge : side_of_hexahedron)[index(side)];
      out += of.shape_nodes >= 6 ? fmt::format("{}, S{}\n", of.id, number) : fmt::format("{}, SPOS\n", of.id);
    }
  }
  return out + "*MATERIAL, NAME=STEEL\n*ELASTIC\n210e3, 0.3\n";
}

std::string as_ls_dyna(const Mesh& mesh) {
  std::string out =
      "*KEYWORD\n*TITLE\nA mesh of a test\n*PART\nbody\n         1         1         1\n*NODE\n$ nid, x, y, "
      "z\n";
  for (int n = 0; n < static_cast<int>(mesh.position.size()); ++n) {
    const auto& [x, y, z] = mesh.position[index(n)];
    out += fmt::format("{}, {}, {}, {}\n", id_of_node(mesh, n), x, y, z);
  }
  const std::map<int, const char*> keyword{
      {8, "SOLID"}, {6, "SOLID"}, {4, "SHELL"}, {3, "SHELL"}, {2, "BEAM"}};
  const std::vector<FileElement> elements = elements_of(mesh);
  for (const auto& [first, end] : runs_of(elements)) {
    out += fmt::format("*ELEMENT_{}\n", keyword.at(elements[first].shape_nodes));
    for (std::size_t e = first; e < end; ++e) {
      std::vector<std::int64_t> n = elements[e].node;
      if (n.size() == 6) n = {n[0], n[2], n[5], n[3], n[1], n[1], n[4], n[4]};
      if (n.size() == 3) n.push_back(n[2]);
      out += fmt::format("{:8}{:8}", elements[e].id, 1);
      for (const std::int64_t node : n) out += fmt::format("{:8}", node);
      out += '\n';
    }
  }
  int number = 0;
  for (const auto& [name, nodes] : mesh.node_sets) {
    if (name == "all") continue;
    ++number;
    if (!has_faces(mesh, name)) {
      out += fmt::format("*SET_NODE_LIST_TITLE\n{}\n{:10}\n", name, number);
      for (std::size_t k = 0; k < nodes.size(); ++k)
        out += fmt::format("{:10}{}", id_of_node(mesh, nodes[k]),
                           k % 8 == 7 || k + 1 == nodes.size() ? "\n" : "");
      continue;
    }
    out += fmt::format("*SET_SEGMENT_TITLE\n{}\n{:10}\n", name, number);
    for (const ElementSide& side : mesh.side_sets.at(name)) {
      auto face = face_of(mesh, side);
      if (face.size() == 3) face.push_back(face[2]);
      for (const std::int64_t node : face) out += fmt::format("{:10}", node);
      out += '\n';
    }
  }
  return out + "*MAT_ELASTIC\n         1  7.8e-9    210000       0.3\n*END\n";
}

namespace {

void write_exodus_as(int mode, const Mesh& mesh, const std::string& path) {
  constexpr std::array<int, 6> side_of_hexahedron{5, 6, 1, 2, 3, 4}, side_of_wedge{4, 5, 1, 2, 0, 3};
  const std::map<int, const char*> type{{8, "HEX8"}, {6, "WEDGE"}, {4, "SHELL4"},
                                        {3, "TRI3"}, {2, "BEAM"},  {1, "SPHERE"}};
  const std::vector<FileElement> elements = elements_of(mesh);
  const auto runs = runs_of(elements);
  std::vector<std::string> faces, points;
  for (const auto& [name, nodes] : mesh.node_sets)
    if (name != "all") (has_faces(mesh, name) ? faces : points).push_back(name);
  NetcdfWriter out(path, mode);
  out.dimension("num_dim", 3);
  out.dimension("num_nodes", mesh.position.size());
  out.dimension("num_elem", elements.size());
  out.dimension("num_el_blk", runs.size());
  out.dimension("len_name", name_length);
  for (const char* name : {"coordx", "coordy", "coordz"}) out.variable(name, NC_DOUBLE, {"num_nodes"});
  out.variable("node_num_map", NC_INT, {"num_nodes"});
  out.variable("elem_num_map", NC_INT, {"num_elem"});
  out.variable("eb_names", NC_CHAR, {"num_el_blk", "len_name"});
  for (std::size_t b = 0; b < runs.size(); ++b) {
    const std::string k = std::to_string(b + 1);
    const auto nodes = index(elements[runs[b].first].shape_nodes);
    out.dimension("num_el_in_blk" + k, runs[b].second - runs[b].first);
    out.dimension("num_nod_per_el" + k, nodes);
    out.variable("connect" + k, NC_INT, {"num_el_in_blk" + k, "num_nod_per_el" + k});
    out.attribute("connect" + k, "elem_type", type.at(static_cast<int>(nodes)));
  }
  if (!points.empty()) {
    out.dimension("num_node_sets", points.size());
    out.variable("ns_names", NC_CHAR, {"num_node_sets", "len_name"});
  }
  if (!faces.empty()) {
    out.dimension("num_side_sets", faces.size());
    out.variable("ss_names", NC_CHAR, {"num_side_sets", "len_name"});
  }
  for (std::size_t s = 0; s < points.size(); ++s) {
    const std::string k = std::to_string(s + 1);
    out.dimension("num_nod_ns" + k, mesh.node_sets.at(points[s]).size());
    out.variable("node_ns" + k, NC_INT, {"num_nod_ns" + k});
  }
  for (std::size_t s = 0; s < faces.size(); ++s) {
    const std::string k = std::to_string(s + 1);
    out.dimension("num_side_ss" + k, mesh.side_sets.at(faces[s]).size());
    out.variable("elem_ss" + k, NC_INT, {"num_side_ss" + k});
    out.variable("side_ss" + k, NC_INT, {"num_side_ss" + k});
  }
  out.end_definitions();
  for (std::size_t i = 0; i < 3; ++i) {
    std::vector<double> x;
    for (const auto& position : mesh.position) x.push_back(position[i]);
    out.put(std::array{"coordx", "coordy", "coordz"}[i], x);
  }
  std::map<std::int64_t, int> place;
  std::vector<int> node_ids, element_ids;
  for (int n = 0; n < static_cast<int>(mesh.position.size()); ++n) {
    node_ids.push_back(static_cast<int>(id_of_node(mesh, n)));
    place[node_ids.back()] = n + 1;
  }
  for (const FileElement& element : elements) element_ids.push_back(static_cast<int>(element.id));
  out.put("node_num_map", node_ids);
  out.put("elem_num_map", element_ids);
  // Blocks of the same name are one.
  out.put("eb_names", padded(std::vector<std::string>(runs.size(), "body")));
  for (std::size_t b = 0; b < runs.size(); ++b) {
    std::vector<int> connectivity;
    for (std::size_t e = runs[b].first; e < runs[b].second; ++e)
      for (const std::int64_t node : elements[e].node) connectivity.push_back(place.at(node));
    out.put("connect" + std::to_string(b + 1), connectivity);
  }
  if (!points.empty()) out.put("ns_names", padded(points));
  if (!faces.empty()) out.put("ss_names", padded(faces));
  for (std::size_t s = 0; s < points.size(); ++s) {
    std::vector<int> nodes;
    for (const int node : mesh.node_sets.at(points[s])) nodes.push_back(node + 1);
    out.put("node_ns" + std::to_string(s + 1), nodes);
  }
  for (std::size_t s = 0; s < faces.size(); ++s) {
    std::vector<int> of, sides;
    for (const auto& [element, side] : mesh.side_sets.at(faces[s])) {
      const int nodes = elements[index(element)].shape_nodes;
      of.push_back(element + 1);
      sides.push_back(nodes < 6 ? 1 : (nodes == 6 ? side_of_wedge : side_of_hexahedron)[index(side)]);
    }
    out.put("elem_ss" + std::to_string(s + 1), of);
    out.put("side_ss" + std::to_string(s + 1), sides);
  }
  out.close();
}

}  // namespace

void write_exodus(const Mesh& mesh, const std::string& path) {
  write_exodus_as(NC_CLOBBER | NC_NETCDF4, mesh, path);
}
void write_classic_exodus(const Mesh& mesh, const std::string& path) {
  write_exodus_as(NC_CLOBBER | NC_64BIT_OFFSET, mesh, path);
}

std::string write_mesh(const Mesh& mesh, MeshFormat format, const std::string& folder,
                       const std::string& stem) {
  const char* suffix = std::array{".msh", ".inp", ".k", ".exo"}[index(format)];
  const std::string name = stem + suffix, path = folder + "/" + name;
  if (format == MeshFormat::exodus) {
    write_exodus(mesh, path);
    return name;
  }
  std::ofstream(path, std::ios::binary) << (format == MeshFormat::gmsh     ? as_gmsh(mesh, false)
                                            : format == MeshFormat::abaqus ? as_abaqus(mesh)
                                                                           : as_ls_dyna(mesh));
  return name;
}

Mesh mesh_of(const FileMesh& file, const std::string& block, double scale) {
  const FileBlock* found = block.empty() ? main_blocks(file).front() : block_called(file, block);
  if (found == nullptr) throw std::runtime_error("no block " + block);
  MeshFromFile source;
  source.scale = scale;
  std::vector<std::string> notices;
  return part_mesh(file, *found, source, notices);
}

}  // namespace brio::test
