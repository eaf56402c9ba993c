#include "io/mesh/generate_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "io/mesh/particle_mesh.hpp"
#include "io/mesh/section_mesh.hpp"
#include "io/mesh/sphere_mesh.hpp"
#include "src/base/index.hpp"

namespace brio {

namespace {

std::vector<ElementSide> every_shell(const Mesh& mesh) {
  std::vector<ElementSide> sides;
  sides.reserve(mesh.element_count());
  for (int e = 0; e < static_cast<int>(mesh.element_count()); ++e) sides.push_back({e, 0});
  return sides;
}

std::vector<int> every_node(const Mesh& mesh) {
  std::vector<int> nodes(mesh.position.size());
  std::iota(nodes.begin(), nodes.end(), 0);
  return nodes;
}

Mesh mesh_of(const BoxMesh& box) {
  const auto& [nx, ny, nz] = box.elements;
  Mesh mesh = pull_along_z(rectangle_section({box.size[0], box.size[1]}, {nx, ny}), -box.size[2] / 2,
                           box.size[2], nz);
  // Above and below by the same number, whatever the rounding of the steps between.
  const std::size_t level = mesh.position.size() / index(nz + 1);
  for (std::size_t n = 0; n < mesh.position.size(); ++n) {
    const int k = static_cast<int>(n / level);
    mesh.position[n][2] = box.size[2] * (2.0 * k - nz) / (2.0 * nz);
  }
  mesh.side_sets["zmin"] = mesh.side_sets["bottom"];
  mesh.side_sets["zmax"] = mesh.side_sets["top"];
  mesh.node_sets["zmin"] = mesh.node_sets["bottom"];
  mesh.node_sets["zmax"] = mesh.node_sets["top"];
  return mesh;
}

Mesh mesh_of(const PlateMesh& plate) {
  const Section section = rectangle_section(plate.size, plate.elements);
  Mesh mesh;
  mesh.nodes_per_element = 4;
  for (const Point2& p : section.point) mesh.position.push_back({p[0], p[1], 0});
  for (const auto& quad : section.quad)
    mesh.connectivity.insert(mesh.connectivity.end(), quad.begin(), quad.end());
  mesh.side_sets["all"] = every_shell(mesh);
  std::vector<int>& boundary = mesh.node_sets["boundary"];
  for (const auto& [name, edges] : section.edges) {
    std::vector<int>& set = mesh.node_sets[name];
    for (const auto& [quad, edge] : edges)
      for (const int corner : {edge, (edge + 1) % 4}) set.push_back(section.quad[index(quad)][index(corner)]);
    boundary.insert(boundary.end(), set.begin(), set.end());
  }
  for (auto& [name, set] : mesh.node_sets) {
    std::sort(set.begin(), set.end());
    set.erase(std::unique(set.begin(), set.end()), set.end());
  }
  mesh.node_sets["all"] = every_node(mesh);
  return mesh;
}

Mesh mesh_of(const CylinderMesh& cylinder) {
  const auto [around, along] = cylinder.elements;
  const int row = cylinder.arc ? around + 1 : around;  // of nodes
  const double turn = cylinder.arc ? *cylinder.arc / 180 * std::numbers::pi : 2 * std::numbers::pi;
  Mesh mesh;
  mesh.nodes_per_element = 4;
  for (int k = 0; k <= along; ++k)
    for (int j = 0; j < row; ++j) {
      const double angle = turn * j / around;
      mesh.position.push_back({cylinder.radius * std::cos(angle), cylinder.radius * std::sin(angle),
                               cylinder.height * k / along});
    }
  for (int k = 0; k < along; ++k)
    for (int j = 0; j < around; ++j) {
      const int next = (j + 1) % row;
      for (const int node : {j + row * k, next + row * k, next + row * (k + 1), j + row * (k + 1)})
        mesh.connectivity.push_back(node);
    }
  for (int j = 0; j < row; ++j) {
    mesh.node_sets["bottom"].push_back(j);
    mesh.node_sets["top"].push_back(j + row * along);
  }
  for (int k = 0; cylinder.arc && k <= along; ++k) {
    mesh.node_sets["start"].push_back(row * k);
    mesh.node_sets["end"].push_back(row * k + around);
  }
  mesh.node_sets["all"] = every_node(mesh);
  mesh.side_sets["all"] = every_shell(mesh);
  return mesh;
}

Mesh mesh_of(const TubeMesh& tube) {
  const auto [around, along, through] = tube.elements;
  return pull_along_z(ring_section(tube.inner_radius, tube.outer_radius, around, through), 0, tube.height,
                      along);
}

Mesh mesh_of(const RodMesh& rod) {
  const auto [across, along] = rod.elements;
  return pull_along_z(disc_section(rod.radius, across, rod.keep_volume), 0, rod.length, along);
}

template <class Set>
void rename(std::map<std::string, Set>& sets, const std::string& from, const std::string& to) {
  auto entry = sets.extract(from);
  entry.key() = to;
  sets.insert(std::move(entry));
}

// The section stands up: what was pulled along z is turned to lie along -y.
Mesh mesh_of(const WedgeMesh& wedge) {
  const auto [across, up, along] = wedge.elements;
  Mesh mesh = pull_along_z(
      blade_section({wedge.thickness, wedge.height, wedge.tip_width, wedge.shoulder()}, across, up),
      -wedge.length / 2, wedge.length, along);
  for (auto& [x, y, z] : mesh.position) {
    const double pulled = z;
    z = y;
    y = -pulled;
  }
  for (const auto& [from, to] : {std::pair{"bottom", "ymax"}, std::pair{"top", "ymin"}}) {
    rename(mesh.side_sets, from, to);
    rename(mesh.node_sets, from, to);
  }
  return mesh;
}

Mesh mesh_of(const SphereMesh& ball) { return sphere_mesh(ball.radius, ball.elements, ball.keep_volume); }
Mesh mesh_of(const HollowSphereMesh& sphere) { return hollow_sphere_mesh(sphere.radius, sphere.elements); }

Mesh mesh_of(const LineMesh& line) {
  Mesh mesh;
  mesh.nodes_per_element = 2;
  for (int k = 0; k <= line.elements; ++k) {
    const double share = static_cast<double>(k) / line.elements;
    Vector3d& point = mesh.position.emplace_back();
    for (std::size_t i = 0; i < 3; ++i) point[i] = line.start[i] * (1 - share) + line.end[i] * share;
    if (k < line.elements) mesh.connectivity.insert(mesh.connectivity.end(), {k, k + 1});
  }
  mesh.node_sets["start"] = {0};
  mesh.node_sets["end"] = {line.elements};
  mesh.node_sets["all"] = every_node(mesh);
  return mesh;
}

Mesh mesh_of(const ParticleMesh& fill) { return particle_mesh(fill); }
Mesh mesh_of(const MeshFromFile& source) { return *source.mesh; }

/// Cosine and sine of an angle in degrees; exact for quarter turns.
std::array<double, 2> cosine_and_sine(double degrees) {
  const double turn = std::remainder(degrees, 360);
  if (turn == 0) return {1, 0};
  if (std::abs(turn) == 180) return {-1, 0};
  if (std::abs(turn) == 90) return {0, std::copysign(1, turn)};
  const double radians = turn * std::numbers::pi / 180;
  return {std::cos(radians), std::sin(radians)};
}

/// Rodrigues' formula.
Vector3d rotate(const Rotation& rotation, const Vector3d& p) {
  const double length = std::hypot(rotation.axis[0], rotation.axis[1], rotation.axis[2]);
  const Vector3d k{rotation.axis[0] / length, rotation.axis[1] / length, rotation.axis[2] / length};
  const auto [c, s] = cosine_and_sine(rotation.degrees);
  const double along = (k[0] * p[0] + k[1] * p[1] + k[2] * p[2]) * (1 - c);
  return {c * p[0] + s * (k[1] * p[2] - k[2] * p[1]) + along * k[0],
          c * p[1] + s * (k[2] * p[0] - k[0] * p[2]) + along * k[1],
          c * p[2] + s * (k[0] * p[1] - k[1] * p[0]) + along * k[2]};
}

// Names of the sets, without making the mesh.
using Names = std::vector<std::string_view>;
Names node_names(const BoxMesh&) {
  return {"all", "bottom", "top", "xmax", "xmin", "ymax", "ymin", "zmax", "zmin"};
}
Names node_names(const PlateMesh&) { return {"all", "boundary", "xmax", "xmin", "ymax", "ymin"}; }
Names node_names(const CylinderMesh& cylinder) {
  if (cylinder.arc) return {"all", "bottom", "end", "start", "top"};
  return {"all", "bottom", "top"};
}
Names node_names(const TubeMesh&) { return {"all", "bottom", "inside", "outside", "top"}; }
Names node_names(const RodMesh&) { return {"all", "bottom", "outside", "top"}; }
Names node_names(const WedgeMesh& wedge) {
  Names names{"all", "xmax", "xmin", "ymax", "ymin", "zmax"};
  if (wedge.tip_width > 0) names.push_back("zmin");
  return names;
}
Names node_names(const SphereMesh&) { return {"all", "outside"}; }
Names node_names(const HollowSphereMesh&) { return {"all"}; }
Names node_names(const LineMesh&) { return {"all", "end", "start"}; }
Names node_names(const ParticleMesh& fill) { return particle_set_names(fill); }
template <class Set>
Names names_of(const std::map<std::string, Set>& sets) {
  Names names;
  for (const auto& [name, set] : sets) names.push_back(name);
  return names;
}
Names node_names(const MeshFromFile& source) {
  return source.mesh ? names_of(source.mesh->node_sets) : Names{};
}

}  // namespace

Vector3d place(const Placement& placement, const Vector3d& point) {
  Vector3d p = placement.rotate ? rotate(*placement.rotate, point) : point;
  for (std::size_t i = 0; i < 3; ++i) p[i] += placement.translate[i];
  return p;
}

Mesh generate_mesh(const MeshSource& source, const Placement& placement) {
  Mesh mesh = std::visit([](const auto& shape) { return mesh_of(shape); }, source);
  for (auto& position : mesh.position) position = place(placement, position);
  return mesh;
}

int nodes_per_element(const MeshSource& source) {
  if (const auto* file = std::get_if<MeshFromFile>(&source)) return file->mesh->nodes_per_element;
  if (std::holds_alternative<LineMesh>(source)) return 2;
  if (std::holds_alternative<ParticleMesh>(source)) return 1;
  const bool shell = std::holds_alternative<PlateMesh>(source) ||
                     std::holds_alternative<CylinderMesh>(source) ||
                     std::holds_alternative<HollowSphereMesh>(source);
  return shell ? 4 : 8;
}

std::vector<std::string_view> node_set_names(const MeshSource& source) {
  return std::visit([](const auto& shape) { return node_names(shape); }, source);
}

std::vector<std::string_view> side_set_names(const MeshSource& source) {
  if (const auto* file = std::get_if<MeshFromFile>(&source)) return names_of(file->mesh->side_sets);
  if (nodes_per_element(source) <= 2) return {};  // lines and particles have no sides
  if (nodes_per_element(source) == 4) return {"all"};
  return node_set_names(source);
}

}  // namespace brio
