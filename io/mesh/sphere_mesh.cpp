#include "io/mesh/sphere_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>

#include "io/mesh/section_mesh.hpp"
#include "src/base/index.hpp"

namespace brio {

namespace {

using Point3 = Vector3d;
using Place3 = std::array<int, 3>;  // of the grid on a cube with m elements an edge

/// Share of the radius at which the corners of the core lie, by the share of the elements that are layers.
double ball_core_radius_share(int across, int layers) { return 1 - 0.8 * (2.0 * layers / across); }
/// How far the sides of the core lean from the cube towards the sphere: with 0.45 the corners of the core and
/// those of the layers around them are about equally far from right angles.
constexpr double ball_core_bulge = 0.45;

/// Unit vector towards a point of the surface of the cube [-1, 1]^3, equally spaced in angle along each side.
Point3 direction_of_cube(const Point3& p) {
  Point3 t{};
  double square = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    t[i] = std::abs(p[i]) == 1 ? p[i] : std::tan(std::numbers::pi / 4 * p[i]);
    square += t[i] * t[i];
  }
  for (double& component : t) component /= std::sqrt(square);
  return t;
}

Point3 core_point(const Point3& p, double corner_radius, double bulge) {
  const double s = std::max({std::abs(p[0]), std::abs(p[1]), std::abs(p[2])});
  if (s == 0) return {0, 0, 0};
  const Point3 sphere = direction_of_cube({p[0] / s, p[1] / s, p[2] / s});
  const double lean = bulge * s;
  Point3 point{};
  for (std::size_t i = 0; i < 3; ++i)
    point[i] = corner_radius * ((1 - lean) / std::numbers::sqrt3 * p[i] + lean * s * sphere[i]);
  return point;
}

Point3 on_cube(const Place3& place, int m) {
  return {(2.0 * place[0] - m) / m, (2.0 * place[1] - m) / m, (2.0 * place[2] - m) / m};
}

/// Grid places of the quadrilaterals on the six sides of the cube, counter-clockwise from outside.
std::vector<std::array<Place3, 4>> sides_of_cube(int m) {
  std::vector<std::array<Place3, 4>> quads;
  constexpr std::array<std::array<int, 2>, 4> around{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (const int side : {0, m})
      for (int j = 0; j < m; ++j)
        for (int i = 0; i < m; ++i) {
          std::array<Place3, 4> quad{};
          for (std::size_t k = 0; k < 4; ++k) {
            const auto& [a, b] = around[side == 0 ? 3 - k : k];
            quad[k][axis] = side;
            quad[k][(axis + 1) % 3] = i + a;
            quad[k][(axis + 2) % 3] = j + b;
          }
          quads.push_back(quad);
        }
  return quads;
}

double volume_of_tetrahedron(const Point3& a, const Point3& b, const Point3& c) {
  return (a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
          a[2] * (b[0] * c[1] - b[1] * c[0])) /
         6;
}

/// Within the bilinear sides of the surface: each is the mean of its two ways to be cut into triangles.
double enclosed_volume(const Mesh& mesh) {
  double volume = 0;
  for (const auto& [element, side] : mesh.side_sets.at("outside")) {
    std::array<Point3, 4> x;
    for (std::size_t k = 0; k < 4; ++k) {
      const int corner = sides_of_hex[index(side)][k];
      x[k] = mesh.position[index(mesh.connectivity[8 * index(element) + index(corner)])];
    }
    volume += 0.5 * (volume_of_tetrahedron(x[0], x[1], x[2]) + volume_of_tetrahedron(x[0], x[2], x[3]) +
                     volume_of_tetrahedron(x[0], x[1], x[3]) + volume_of_tetrahedron(x[1], x[2], x[3]));
  }
  return volume;
}

void add_sets(Mesh& mesh) {
  mesh.side_sets["all"] = mesh.side_sets["outside"];
  mesh.node_sets["outside"] = nodes_of_sides(mesh, mesh.side_sets["outside"]);
  std::vector<int>& every = mesh.node_sets["all"];
  every.resize(mesh.position.size());
  std::iota(every.begin(), every.end(), 0);
}

// m by m by m elements; with `outside` their outer sides are the surface.
void add_core(Mesh& mesh, int m, double corner_radius, double bulge, bool outside) {
  const auto node = [m](int i, int j, int k) { return i + (m + 1) * (j + (m + 1) * k); };
  for (int k = 0; k <= m; ++k)
    for (int j = 0; j <= m; ++j)
      for (int i = 0; i <= m; ++i)
        mesh.position.push_back(core_point(on_cube({i, j, k}, m), corner_radius, bulge));
  for (int k = 0; k < m; ++k)
    for (int j = 0; j < m; ++j)
      for (int i = 0; i < m; ++i) {
        const int element = static_cast<int>(mesh.element_count());
        for (const int up : {k, k + 1})
          for (const int corner :
               {node(i, j, up), node(i + 1, j, up), node(i + 1, j + 1, up), node(i, j + 1, up)})
            mesh.connectivity.push_back(corner);
        if (!outside) continue;
        std::vector<ElementSide>& sides = mesh.side_sets["outside"];
        if (k == 0) sides.push_back({element, 0});
        if (k == m - 1) sides.push_back({element, 1});
        if (j == 0) sides.push_back({element, 2});
        if (i == m - 1) sides.push_back({element, 3});
        if (j == m - 1) sides.push_back({element, 4});
        if (i == 0) sides.push_back({element, 5});
      }
}

void add_layers(Mesh& mesh, int m, int layers, double radius) {
  // First node of each ray from the core's surface outwards; the further ones follow one another.
  std::map<Place3, int> ray;
  const auto node = [&](const Place3& place, int layer) {
    const int on_core = place[0] + (m + 1) * (place[1] + (m + 1) * place[2]);
    if (layer == 0) return on_core;
    const auto [entry, is_new] = ray.try_emplace(place, static_cast<int>(mesh.position.size()));
    if (is_new) {
      const Point3 inner = mesh.position[index(on_core)];
      const Point3 direction = direction_of_cube(on_cube(place, m));
      for (int k = 1; k <= layers; ++k) {
        const double share = static_cast<double>(k) / layers;
        Point3 point{};
        for (std::size_t i = 0; i < 3; ++i) point[i] = inner[i] + share * (radius * direction[i] - inner[i]);
        mesh.position.push_back(point);
      }
    }
    return entry->second + layer - 1;
  };
  for (const auto& quad : sides_of_cube(m))
    for (int layer = 0; layer < layers; ++layer) {
      if (layer == layers - 1)
        mesh.side_sets["outside"].push_back({static_cast<int>(mesh.element_count()), 1});
      for (const int up : {layer, layer + 1})
        for (const Place3& place : quad) mesh.connectivity.push_back(node(place, up));
    }
}

}  // namespace

Mesh sphere_mesh(double radius, int across, bool keep_volume) {
  const int layers = across / 4;
  const int m = across - 2 * layers;
  Mesh mesh;
  mesh.nodes_per_element = 8;
  if (layers == 0) {
    add_core(mesh, m, radius, 1, true);
  } else {
    add_core(mesh, m, ball_core_radius_share(across, layers) * radius, ball_core_bulge, false);
    add_layers(mesh, m, layers, radius);
  }
  add_sets(mesh);
  if (!keep_volume) return mesh;
  const double volume = 4 * std::numbers::pi / 3 * radius * radius * radius;
  const double factor = std::cbrt(volume / enclosed_volume(mesh));
  for (Point3& x : mesh.position)
    for (double& component : x) component *= factor;
  return mesh;
}

Mesh hollow_sphere_mesh(double radius, int around) {
  Mesh mesh;
  mesh.nodes_per_element = 4;
  std::map<Place3, int> node_at;
  for (const auto& quad : sides_of_cube(around)) {
    mesh.side_sets["all"].push_back({static_cast<int>(mesh.element_count()), 0});
    for (const Place3& place : quad) {
      const auto [entry, is_new] = node_at.try_emplace(place, static_cast<int>(mesh.position.size()));
      if (is_new) {
        Point3 point = direction_of_cube(on_cube(place, around));
        for (double& component : point) component *= radius;
        mesh.position.push_back(point);
      }
      mesh.connectivity.push_back(entry->second);
    }
  }
  std::vector<int>& every = mesh.node_sets["all"];
  every.resize(mesh.position.size());
  std::iota(every.begin(), every.end(), 0);
  return mesh;
}

}  // namespace brio
