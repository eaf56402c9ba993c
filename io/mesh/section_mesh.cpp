#include "io/mesh/section_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "src/base/index.hpp"

namespace brio {

namespace {

/// Share of the disc's radius at which the corners of its core lie, by the share of its elements that are
/// ring: elements of about the same size inside and outside.
double core_radius_share(int across, int layers) { return 1 - 0.8 * (2.0 * layers / across); }
/// How far the sides of the core lean from the square towards the circle. With 0.4 no angle of the disc's
/// quadrilaterals is further from a right angle than a sine of 0.8, but for the coarsest disc of 2 by 2.
constexpr double core_bulge = 0.4;

/// The angle of a point (u, v) of a square's outline, equally spaced along each side.
Point2 direction_of_square(double u, double v) {
  const double quarter = std::numbers::pi / 4;
  if (std::abs(u) >= std::abs(v)) {
    const double angle = quarter * v / std::abs(u);
    return {std::copysign(std::cos(angle), u), std::sin(angle)};
  }
  const double angle = quarter * u / std::abs(v);
  return {std::sin(angle), std::copysign(std::cos(angle), v)};
}

/// Radius of a regular polygon's corners over that of the circle with the same area.
double equal_area_factor(int sides) {
  const double angle = 2 * std::numbers::pi / sides;
  return std::sqrt(angle / std::sin(angle));
}

/// A point of the core; (u, v) in [-1, 1].
Point2 core_point(double u, double v, double corner_radius, double bulge) {
  const double s = std::max(std::abs(u), std::abs(v));
  if (s == 0) return {0, 0};
  const Point2 circle = direction_of_square(u, v);
  const double lean = bulge * s;
  const double straight = (1 - lean) / std::numbers::sqrt2;
  return {corner_radius * (straight * u + lean * s * circle[0]),
          corner_radius * (straight * v + lean * s * circle[1])};
}

/// Grid places (i, j) of the outline of an m by m square, counter-clockwise from (0, 0).
std::vector<std::array<int, 2>> outline_of_square(int m) {
  std::vector<std::array<int, 2>> outline;
  outline.reserve(4 * index(m));
  for (int i = 0; i < m; ++i) outline.push_back({i, 0});
  for (int j = 0; j < m; ++j) outline.push_back({m, j});
  for (int i = m; i > 0; --i) outline.push_back({i, m});
  for (int j = m; j > 0; --j) outline.push_back({0, j});
  return outline;
}

void add_core(Section& section, int m, double corner_radius, double bulge) {
  for (int j = 0; j <= m; ++j)
    for (int i = 0; i <= m; ++i)
      section.point.push_back(core_point((2.0 * i - m) / m, (2.0 * j - m) / m, corner_radius, bulge));
  for (int j = 0; j < m; ++j)
    for (int i = 0; i < m; ++i) {
      const int corner = i + (m + 1) * j;
      section.quad.push_back({corner, corner + 1, corner + m + 2, corner + m + 1});
    }
}

std::map<std::string, std::vector<int>> node_sets_of_sides(const Mesh& mesh) {
  std::map<std::string, std::vector<int>> sets;
  for (const auto& [name, sides] : mesh.side_sets) sets[name] = nodes_of_sides(mesh, sides);
  std::vector<int>& every = sets["all"];
  every.resize(mesh.position.size());
  std::iota(every.begin(), every.end(), 0);
  return sets;
}

}  // namespace

Section rectangle_section(Point2 size, std::array<int, 2> elements) {
  const auto [nx, ny] = elements;
  Section section;
  for (int j = 0; j <= ny; ++j)
    for (int i = 0; i <= nx; ++i)  // symmetric about 0 to the last bit
      section.point.push_back({size[0] * (2.0 * i - nx) / (2.0 * nx), size[1] * (2.0 * j - ny) / (2.0 * ny)});
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < nx; ++i) {
      const int corner = i + (nx + 1) * j;
      const int quad = static_cast<int>(section.quad.size());
      section.quad.push_back({corner, corner + 1, corner + nx + 2, corner + nx + 1});
      if (j == 0) section.edges["ymin"].push_back({quad, 0});
      if (i == nx - 1) section.edges["xmax"].push_back({quad, 1});
      if (j == ny - 1) section.edges["ymax"].push_back({quad, 2});
      if (i == 0) section.edges["xmin"].push_back({quad, 3});
    }
  return section;
}

Section ring_section(double inner_radius, double outer_radius, int around, int through) {
  Section section;
  for (int j = 0; j < around; ++j) {
    const double angle = 2 * std::numbers::pi * j / around;
    for (int i = 0; i <= through; ++i) {
      const double radius = inner_radius + (outer_radius - inner_radius) * i / through;
      section.point.push_back({radius * std::cos(angle), radius * std::sin(angle)});
    }
  }
  for (int j = 0; j < around; ++j)
    for (int i = 0; i < through; ++i) {
      const int here = i + (through + 1) * j;
      const int next = i + (through + 1) * ((j + 1) % around);
      const int quad = static_cast<int>(section.quad.size());
      section.quad.push_back({here, here + 1, next + 1, next});
      if (i == 0) section.edges["inside"].push_back({quad, 3});
      if (i == through - 1) section.edges["outside"].push_back({quad, 1});
    }
  return section;
}

Section disc_section(double radius, int across, bool keep_area) {
  const int layers = across / 4;
  const int m = across - 2 * layers;
  if (keep_area) radius *= equal_area_factor(4 * m);
  Section section;
  if (layers == 0) {  // the outline of the core is the circle itself
    add_core(section, m, radius, 1);
    for (int i = 0; i < m; ++i) {
      section.edges["outside"].push_back({i, 0});
      section.edges["outside"].push_back({i * m + m - 1, 1});
      section.edges["outside"].push_back({(m - 1) * m + i, 2});
      section.edges["outside"].push_back({i * m, 3});
    }
    return section;
  }
  add_core(section, m, core_radius_share(across, layers) * radius, core_bulge);
  const auto outline = outline_of_square(m);
  const int around = static_cast<int>(outline.size());
  // First node of each ray outwards, from the core's outline; the further ones follow one another.
  std::vector<int> on_core;
  const int first_on_ray = static_cast<int>(section.point.size());
  for (const auto& [i, j] : outline) {
    on_core.push_back(i + (m + 1) * j);
    const Point2 inner = section.point[index(on_core.back())];
    const Point2 direction = direction_of_square((2.0 * i - m) / m, (2.0 * j - m) / m);
    for (int k = 1; k <= layers; ++k) {
      const double share = static_cast<double>(k) / layers;
      section.point.push_back({inner[0] + share * (radius * direction[0] - inner[0]),
                               inner[1] + share * (radius * direction[1] - inner[1])});
    }
  }
  const auto node = [&](int ray, int k) {
    const int r = ray % around;
    return k == 0 ? on_core[index(r)] : first_on_ray + r * layers + k - 1;
  };
  for (int ray = 0; ray < around; ++ray)
    for (int k = 0; k < layers; ++k) {
      if (k == layers - 1) section.edges["outside"].push_back({static_cast<int>(section.quad.size()), 1});
      section.quad.push_back({node(ray, k), node(ray, k + 1), node(ray + 1, k + 1), node(ray + 1, k)});
    }
  return section;
}

Section blade_section(const BladeSize& size, int across, int up) {
  // Rows on the flanks and above them; a row of nodes lies on the shoulders.
  const bool straight = size.shoulder < size.height;
  const int on_flanks =
      straight ? std::clamp(static_cast<int>(std::lround(up * size.shoulder / size.height)), 1, up - 1) : up;
  const bool sharp = size.tip_width == 0;
  Section section;
  const auto node = [&](int i, int k) {
    if (!sharp) return i + (across + 1) * k;
    return k == 0 ? 0 : 1 + i + (across + 1) * (k - 1);
  };
  for (int k = 0; k <= up; ++k) {
    const double share = std::min(1.0, static_cast<double>(k) / on_flanks);
    const double width = size.tip_width + share * (size.thickness - size.tip_width);
    const double z = k <= on_flanks
                         ? size.shoulder * share
                         : size.shoulder + (size.height - size.shoulder) * (k - on_flanks) / (up - on_flanks);
    if (sharp && k == 0) {
      section.point.push_back({0, 0});
      continue;
    }
    for (int i = 0; i <= across; ++i)
      section.point.push_back({width * (2.0 * i - across) / (2.0 * across), z});
  }
  for (int k = 0; k < up; ++k)
    for (int i = 0; i < across; ++i) {
      const int quad = static_cast<int>(section.quad.size());
      section.quad.push_back({node(i, k), node(i + 1, k), node(i + 1, k + 1), node(i, k + 1)});
      if (k == 0 && !sharp) section.edges["zmin"].push_back({quad, 0});
      if (i == across - 1) section.edges["xmax"].push_back({quad, 1});
      if (k == up - 1) section.edges["zmax"].push_back({quad, 2});
      if (i == 0) section.edges["xmin"].push_back({quad, 3});
    }
  return section;
}

Mesh pull_along_z(const Section& section, double start, double length, int layers) {
  Mesh mesh;
  mesh.nodes_per_element = 8;
  const int level = static_cast<int>(section.point.size());
  const int quads = static_cast<int>(section.quad.size());
  mesh.position.reserve(section.point.size() * index(layers + 1));
  mesh.connectivity.reserve(8 * section.quad.size() * index(layers));
  for (int k = 0; k <= layers; ++k)
    for (const Point2& p : section.point) mesh.position.push_back({p[0], p[1], start + length * k / layers});
  for (int k = 0; k < layers; ++k)
    for (const auto& quad : section.quad)
      for (int up = 0; up < 2; ++up)
        for (const int corner : quad) mesh.connectivity.push_back(corner + level * (k + up));

  std::vector<ElementSide>& whole = mesh.side_sets["all"];
  const auto add = [&](const std::string& name, ElementSide side) {
    mesh.side_sets[name].push_back(side);
    whole.push_back(side);
  };
  for (int q = 0; q < quads; ++q) {
    add("bottom", {q, 0});
    add("top", {q + quads * (layers - 1), 1});
  }
  for (const auto& [name, edges] : section.edges)
    for (int k = 0; k < layers; ++k)
      for (const auto& [quad, edge] : edges)
        add(name,
            {quad + quads * k, 2 + edge});  // sides 2 to 5 of a hexahedron stand on the edges of its base
  mesh.node_sets = node_sets_of_sides(mesh);
  return mesh;
}

std::vector<int> nodes_of_sides(const Mesh& mesh, const std::vector<ElementSide>& sides) {
  const auto corners = index(mesh.nodes_per_element);
  std::vector<int> nodes;
  nodes.reserve(4 * sides.size());
  for (const auto& [element, side] : sides)
    for (int corner = 0; corner < 4; ++corner) {
      const int local = mesh.nodes_per_element == 4 ? corner : sides_of_hex[index(side)][index(corner)];
      nodes.push_back(mesh.connectivity[index(element) * corners + index(local)]);
    }
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

}  // namespace brio
