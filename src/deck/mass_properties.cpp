#include "src/deck/mass_properties.hpp"

#include <cmath>
#include <stdexcept>
#include <string>

#include "src/base/index.hpp"

namespace brio {

namespace {

// Three points a direction: exact for the volume's second moments, whose integrand is of the fourth degree.
const std::array<double, 3> gauss_point{-std::sqrt(0.6), 0, std::sqrt(0.6)};
constexpr std::array<double, 3> gauss_weight{5.0 / 9, 8.0 / 9, 5.0 / 9};
// Signs of the corners of the parent cube in VTK order; the first four are those of a quadrilateral.
constexpr std::array<Vector3d, 8> corner_sign{
    {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1}, {-1, -1, 1}, {1, -1, 1}, {1, 1, 1}, {-1, 1, 1}}};

// Volume, first and second moments about the origin of the corners given.
struct Moments {
  double volume = 0;
  Vector3d first{};
  Tensor<double> second{};
  void add(double share, const Vector3d& x) {
    volume += share;
    first += share * x;
    second += share * outer_product(x, x);
  }
};

double product(const Vector3d& a) { return a.x * a.y * a.z; }

// Point and its derivatives to the coordinates of the parent cube (or square, with two dimensions).
struct Place {
  Vector3d point{};
  Tensor<double> gradient{};  // column d: derivative to coordinate d
};
Place place_of(const std::array<Vector3d, 8>& corner, std::size_t corners, const Vector3d& parent) {
  const int dimensions = corners == 8 ? 3 : 2;
  Place place;
  for (std::size_t k = 0; k < corners; ++k) {
    Vector3d factor{1, 1, 1};
    for (int d = 0; d < dimensions; ++d) factor[d] = 0.5 * (1 + corner_sign[k][index(d)] * parent[d]);
    place.point += product(factor) * corner[k];
    for (int d = 0; d < dimensions; ++d) {
      Vector3d others = factor;
      others[d] = 0.5 * corner_sign[k][index(d)];
      place.gradient.set_column(d, place.gradient.column(d) + product(others) * corner[k]);
    }
  }
  return place;
}

bool add_hexahedron(const std::array<Vector3d, 8>& corner, Moments& moments) {
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      for (std::size_t k = 0; k < 3; ++k) {
        const Place place = place_of(corner, 8, {gauss_point[i], gauss_point[j], gauss_point[k]});
        const double volume = determinant(place.gradient);
        if (!(volume > 0)) return false;
        moments.add(gauss_weight[i] * gauss_weight[j] * gauss_weight[k] * volume, place.point);
      }
  return true;
}

bool add_shell(const std::array<Vector3d, 8>& corner, double thickness, Moments& moments) {
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) {
      const Place place = place_of(corner, 4, {gauss_point[i], gauss_point[j], 0});
      const Vector3d normal = cross(place.gradient.column(0), place.gradient.column(1));
      const double area = norm(normal);
      if (!(area > 0)) return false;
      const double share = gauss_weight[i] * gauss_weight[j] * thickness;
      moments.add(share * area, place.point);
      moments.second += share * thickness * thickness / 12 / area * outer_product(normal, normal);
    }
  return true;
}

}  // namespace

MassProperties mass_properties(const Mesh& mesh, double density, double thickness) {
  const auto corners = index(mesh.nodes_per_element);
  const auto point = [&](std::size_t node) { return mesh.position[node]; };
  const Vector3d origin = point(0);  // near the mesh, so that moments do not cancel
  Moments moments;
  for (std::size_t e = 0; e < mesh.element_count(); ++e) {
    std::array<Vector3d, 8> corner;
    for (std::size_t k = 0; k < corners; ++k)
      corner[k] = point(index(mesh.connectivity[e * corners + k])) - origin;
    if (!(corners == 8 ? add_hexahedron(corner, moments) : add_shell(corner, thickness, moments)))
      throw std::invalid_argument("element " + std::to_string(mesh.number_of_element(e)) +
                                  " is inverted or has no volume");
  }
  const Vector3d centre = moments.first / moments.volume;
  const Tensor<double> about_centre = moments.second - moments.volume * outer_product(centre, centre);
  MassProperties result;
  result.mass = density * moments.volume;
  result.centre = origin + centre;
  result.inertia = density * (trace(about_centre) * identity<double>() - about_centre);
  return result;
}

}  // namespace brio
