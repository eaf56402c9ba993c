#include "src/deck/element_quality.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "src/base/index.hpp"
#include "src/deck/mesh.hpp"

namespace brio {

namespace {

using FaceCorners = std::array<Corner, 4>;

FaceCorners face_of(std::span<const Corner> corners, std::size_t side) {
  FaceCorners face{};
  for (std::size_t k = 0; k < 4; ++k)
    face[k] = corners[corners.size() == 8 ? index(sides_of_hex[side][k]) : k];
  return face;
}

/// Degrees between the normals of two triangles; 0 where one has no area.
double angle_between(const Corner& a, const Corner& b) {
  const Corner product = cross(a, b);
  return std::atan2(norm(product), dot(a, b)) * 180 / std::numbers::pi;
}

double warp_of_face(const FaceCorners& face) {
  double largest = 0;
  for (std::size_t first = 0; first < 2; ++first) {
    const Corner& a = face[first];
    const Corner diagonal = face[first + 2] - a;
    const Corner right = cross(face[first + 1] - a, diagonal);
    const Corner left = cross(diagonal, face[(first + 3) % 4] - a);
    if (norm(right) > 0 && norm(left) > 0) largest = std::max(largest, angle_between(right, left));
  }
  return largest;
}

/// Edge from a corner along its ring of four, to the next corner that is not the same point.
Corner edge_along(std::span<const Corner> ring, std::size_t corner, std::size_t step) {
  for (std::size_t k = 1; k < 4; ++k) {
    const Corner edge = ring[(corner + k * step) % 4] - ring[corner];
    if (norm(edge) > 0) return edge;
  }
  return {};
}

constexpr std::size_t forward = 1, backward = 3;  // around a ring of four

double scaled(double determinant, double lengths) { return lengths > 0 ? determinant / lengths : 0; }

double jacobian_of_hexahedron(std::span<const Corner> corners) {
  double least = 1;
  for (std::size_t c = 0; c < 8; ++c) {
    const bool upper = c >= 4;
    const auto ring = corners.subspan(upper ? 4 : 0, 4);
    const Corner up = corners[upper ? c : c + 4] - corners[upper ? c - 4 : c];
    const Corner a = edge_along(ring, c % 4, forward), b = edge_along(ring, c % 4, backward);
    least = std::min(least, scaled(dot(cross(a, b), up), norm(a) * norm(b) * norm(up)));
  }
  return least;
}

double jacobian_of_shell(std::span<const Corner> corners) {
  Corner normal = cross(corners[2] - corners[0], corners[3] - corners[1]);
  const double size = norm(normal);
  if (!(size > 0)) return 0;
  double least = 1;
  for (std::size_t c = 0; c < 4; ++c) {
    const Corner a = edge_along(corners, c, forward), b = edge_along(corners, c, backward);
    least = std::min(least, scaled(dot(cross(a, b), normal) / size, norm(a) * norm(b)));
  }
  return least;
}

}  // namespace

std::vector<double> edge_lengths(std::span<const Corner> corners) {
  std::vector<double> lengths;
  const auto add = [&](std::size_t a, std::size_t b) {
    if (const double length = norm(corners[a] - corners[b]); length > 0) lengths.push_back(length);
  };
  if (corners.size() == 8)
    for (const auto& [a, b] : edges_of_hex) add(index(a), index(b));
  if (corners.size() == 4)
    for (std::size_t k = 0; k < 4; ++k) add(k, (k + 1) % 4);
  if (corners.size() == 2) add(0, 1);
  return lengths;
}

double aspect_of(std::span<const Corner> corners) {
  const std::vector<double> lengths = edge_lengths(corners);
  if (lengths.empty()) return 1;
  const auto [shortest, longest] = std::minmax_element(lengths.begin(), lengths.end());
  return *longest / *shortest;
}

double warp_of(std::span<const Corner> corners) {
  double largest = 0;
  const std::size_t faces = corners.size() == 8 ? 6 : corners.size() == 4 ? 1 : 0;
  for (std::size_t side = 0; side < faces; ++side)
    largest = std::max(largest, warp_of_face(face_of(corners, side)));
  return largest;
}

double scaled_jacobian_of(std::span<const Corner> corners) {
  if (corners.size() == 8) return jacobian_of_hexahedron(corners);
  return corners.size() == 4 ? jacobian_of_shell(corners) : 1;
}

double volume_of_hexahedron(std::span<const Corner, 8> corners) {
  double sum = 0;
  for (std::size_t side = 0; side < 6; ++side) {
    FaceCorners face = face_of(corners, side);
    for (Corner& corner : face) corner = corner - corners[0];
    const auto& [a, b, c, d] = face;
    const auto triple = [](const Corner& x, const Corner& y, const Corner& z) { return dot(x, cross(y, z)); };
    sum += triple(a, b, c) + triple(a, c, d) + triple(a, b, d) + triple(b, c, d);
  }
  return sum / 12;
}

}  // namespace brio
