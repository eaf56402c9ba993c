#include "src/build/contact_thickness.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "src/base/breakdown.hpp"
#include "src/base/index.hpp"
#include "src/sweep/particles.hpp"

namespace brio {

namespace {

/// Pairs of contact grow with the square of thickness over edge; shells are thinner than one.
constexpr double largest_thickness = 20;  // mean edges

double mean_edge(const Mesh& mesh) {
  const auto corners = index(mesh.nodes_per_element);
  double sum = 0;
  for (std::size_t i = 0; i < mesh.connectivity.size(); ++i) {
    const std::size_t next = i % corners + 1 == corners ? i + 1 - corners : i + 1;
    const auto& a = mesh.position[index(mesh.connectivity[i])];
    const auto& b = mesh.position[index(mesh.connectivity[next])];
    sum += std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
  }
  return sum / static_cast<double>(mesh.connectivity.size());
}

}  // namespace

std::vector<double> contact_thickness(const Part& part, const Mesh& mesh) {
  if (cell_with(mesh.nodes_per_element) == hexahedron_cell) return {};
  if (!mesh.volume.empty()) {
    std::vector<double> edges;
    for (const double volume : mesh.volume) edges.push_back(edge_of_cube(volume));
    return edges;
  }
  const auto thickness_of = [](const auto& element) { return element.contact_thickness(); };
  const double thickness = std::visit(thickness_of, part.element), edge = mean_edge(mesh);
  if (thickness > largest_thickness * edge) {
    std::ostringstream fault;
    fault << "contact: part '" << part.name << "' is " << thickness << " thick, " << thickness / edge
          << " times as much as the mean edge of its mesh; accepted are up to " << largest_thickness;
    throw BuildError(fault.str(), part.place);
  }
  return std::vector<double>(mesh.element_count(), thickness);
}

}  // namespace brio
