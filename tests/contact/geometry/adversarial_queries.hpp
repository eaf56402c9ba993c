#pragma once
/// Moving nodes and faces chosen to be difficult for the velocity check.

#include <cstdint>
#include <random>
#include <string_view>

#include "contact/geometry/velocity_check.hpp"

namespace brio {

struct Query {
  MovingNode node;
  MovingFace face;
};

/// Numbers that are the same with every standard library.
inline Vector3d rounded_to(const Vector3d& a, double multiple) {
  return {std::round(a.x / multiple) * multiple, std::round(a.y / multiple) * multiple,
          std::round(a.z / multiple) * multiple};
}

class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}
  double uniform(double low, double high) {
    return low + (high - low) * (static_cast<double>(engine_() >> 11) * 0x1p-53);
  }
  int integer(int low, int high) {  // both included
    return low + static_cast<int>(engine_() % static_cast<std::uint64_t>(high - low + 1));
  }
  bool coin() { return (engine_() >> 63) != 0; }
  Vector3d vector(double size) {
    const double x = uniform(-size, size);
    const double y = uniform(-size, size);
    return {x, y, uniform(-size, size)};
  }
  double power_of_ten(double low, double high) { return std::pow(10.0, uniform(low, high)); }

 private:
  std::mt19937_64 engine_;
};

enum class Family {
  random,           // all of a size, nothing aimed
  outer_edge,       // aimed at an edge of the face
  corner,           // aimed at a vertex
  seam,             // aimed at a seam between sub-triangles or at the centroid
  near_edge,        // aimed beside an edge by 1e-17 to 1e-2 of the size
  lattice,          // small integers: exact hits on edges, corners, seams and at time 0 and 1
  grazing,          // the cubic has a double root, exactly or but for an ulp
  far_from_origin,  // 1e6 sizes away
  moving_frame,     // everything moves by 1e3 sizes besides
  sliver,           // height 1e-1 to 1e-15 of the length, or none
  fast,             // relative displacement 1e1 to 1e4 sizes
  coplanar,         // node and face stay in one plane
  still,            // nothing moves, or everything alike
  triangle,         // triangular faces, aimed at edges and corners
};
inline constexpr int family_count = 14;

std::string_view name_of(Family family);

Query adversarial_query(Family family, Random& random);

}  // namespace brio
