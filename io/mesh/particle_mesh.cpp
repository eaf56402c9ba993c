#include "io/mesh/particle_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "src/base/index.hpp"

namespace brio {

namespace {

/// Centres of equal cells from `start` to `start` + `length`; about 0 symmetric to the last bit.
std::vector<double> layers(double start, double length, double spacing) {
  const int count = static_cast<int>(std::max(1L, std::lround(length / spacing)));
  std::vector<double> centre;
  for (int i = 0; i < count; ++i) {
    const double from_middle = length * (2.0 * i + 1 - count) / (2.0 * count);
    centre.push_back(start + 0.5 * length + from_middle);
  }
  return centre;
}

/// Points at odd multiples of half the spacing, up to the reach on both sides of 0.
std::vector<double> lattice(double reach, double spacing) {
  const int half = static_cast<int>(std::ceil(reach / spacing));
  std::vector<double> centre;
  for (int i = -half; i < half; ++i) centre.push_back(spacing * (i + 0.5));
  return centre;
}

template <class Inside>
void fill(const std::vector<double>& x, const std::vector<double>& y, const std::vector<double>& z,
          double volume, const Inside& is_inside, Mesh& mesh) {
  for (const double c : z)
    for (const double b : y)
      for (const double a : x)
        if (is_inside(a, b, c)) mesh.position.push_back({a, b, c});
  mesh.volume.assign(mesh.position.size(), volume / static_cast<double>(mesh.position.size()));
}

/// The particles of the outermost layers.
void add_layers(const char* lower_name, const char* upper_name, std::size_t axis,
                const std::vector<double>& centre, Mesh& mesh) {
  std::vector<int>& lower = mesh.node_sets[lower_name];
  std::vector<int>& upper = mesh.node_sets[upper_name];
  for (int i = 0; i < static_cast<int>(mesh.position.size()); ++i) {
    const double at = mesh.position[index(i)][axis];
    if (at == centre.front()) lower.push_back(i);
    if (at == centre.back()) upper.push_back(i);
  }
}

void fill(const ParticleBox& box, Mesh& mesh) {
  std::vector<double> centre[3];
  for (std::size_t i = 0; i < 3; ++i) centre[i] = layers(-0.5 * box.size[i], box.size[i], box.spacing);
  fill(
      centre[0], centre[1], centre[2], box.size[0] * box.size[1] * box.size[2],
      [](double, double, double) { return true; }, mesh);
  add_layers("xmin", "xmax", 0, centre[0], mesh);
  add_layers("ymin", "ymax", 1, centre[1], mesh);
  add_layers("zmin", "zmax", 2, centre[2], mesh);
  mesh.node_sets["bottom"] = mesh.node_sets["zmin"];
  mesh.node_sets["top"] = mesh.node_sets["zmax"];
}

void fill(const ParticleCylinder& cylinder, Mesh& mesh) {
  const double inner = cylinder.inner_radius, outer = cylinder.radius;
  const std::vector<double> across = lattice(outer, cylinder.spacing);
  const std::vector<double> along = layers(0, cylinder.height, cylinder.spacing);
  fill(
      across, across, along, std::numbers::pi * (outer * outer - inner * inner) * cylinder.height,
      [&](double x, double y, double) {
        const double squared = x * x + y * y;
        return squared <= outer * outer && squared >= inner * inner;
      },
      mesh);
  add_layers("bottom", "top", 2, along, mesh);
}

void fill(const ParticleSphere& sphere, Mesh& mesh) {
  const double r = sphere.radius;
  const std::vector<double> across = lattice(r, sphere.spacing);
  fill(
      across, across, across, 4 * std::numbers::pi / 3 * r * r * r,
      [&](double x, double y, double z) { return x * x + y * y + z * z <= r * r; }, mesh);
}

}  // namespace

Mesh particle_mesh(const ParticleMesh& shape) {
  Mesh mesh;
  mesh.nodes_per_element = 1;
  if (shape.box) fill(*shape.box, mesh);
  if (shape.cylinder) fill(*shape.cylinder, mesh);
  if (shape.sphere) fill(*shape.sphere, mesh);
  mesh.connectivity.resize(mesh.position.size());
  std::iota(mesh.connectivity.begin(), mesh.connectivity.end(), 0);
  mesh.node_sets["all"] = mesh.connectivity;
  return mesh;
}

std::vector<std::string_view> particle_set_names(const ParticleMesh& shape) {
  if (shape.box) return {"all", "bottom", "top", "xmax", "xmin", "ymax", "ymin", "zmax", "zmin"};
  if (shape.cylinder) return {"all", "bottom", "top"};
  return {"all"};
}

}  // namespace brio
