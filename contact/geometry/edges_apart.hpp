#pragma once
/// A cheap test over many pairs of edges at once: which surely stay apart for the whole step? What it does
/// not dismiss goes to `edge_check`.

#include <array>
#include <limits>

#include "contact/geometry/apart.hpp"

namespace brio {

/// Edges a and b over one step, as positions of their two ends at its beginning and displacements until its
/// end. With T = Lanes<double> these are eight pairs side by side.
template <class T>
struct MovingEdgePair {
  std::array<Vector3<T>, 2> start_a;
  std::array<Vector3<T>, 2> displacement_a;
  std::array<Vector3<T>, 2> start_b;
  std::array<Vector3<T>, 2> displacement_b;
};

/// True only where the edges stay farther apart than `reach` at any time of the step: where along an axis,
/// the common perpendicular at half the step, or the direction between the middles at half the step across
/// one of the edges, every end of one edge stays beyond every end of the other. The rounding of differences,
/// ends and heights, below 16 units of the largest distance plus displacement, is allowed for twice over.
template <class T>
BRIO_INLINE MaskOf<T> surely_apart(const MovingEdgePair<T>& pair, T reach) {
  constexpr double roundoff = std::numeric_limits<RealOf<T>>::epsilon() / 2.0;
  std::array<Vector3<T>, 8> between;  // ends of a minus ends of b: four at the beginning, four at the end
  T scale = reach;
  for (std::size_t i = 0; i < 2; ++i) {
    for (std::size_t j = 0; j < 2; ++j) {
      const Vector3<T> motion = pair.displacement_a[i] - pair.displacement_b[j];
      const Vector3<T> first = pair.start_a[i] - pair.start_b[j];
      between[2 * i + j] = first;
      between[2 * i + j + 4] = first + motion;
      scale = max(scale, max(max(abs(first.x) + abs(motion.x), abs(first.y) + abs(motion.y)),
                             abs(first.z) + abs(motion.z)));
    }
  }
  Heights<T> along_x{between[0].x, between[0].x};
  Heights<T> along_y{between[0].y, between[0].y};
  Heights<T> along_z{between[0].z, between[0].z};
  for (std::size_t k = 1; k < 8; ++k) {
    along_x.include(between[k].x);
    along_y.include(between[k].y);
    along_z.include(between[k].z);
  }
  const T beyond = reach + T(32 * roundoff) * scale;
  MaskOf<T> apart = (along_x.least > beyond) | (along_x.greatest < -beyond) | (along_y.least > beyond) |
                    (along_y.greatest < -beyond) | (along_z.least > beyond) | (along_z.greatest < -beyond);
  const T beyond_direction = reach + T(64 * roundoff) * scale;
  const auto apart_along = [&](const Vector3<T>& direction) {
    Heights<T> heights{dot(direction, between[0]), dot(direction, between[0])};
    for (std::size_t k = 1; k < 8; ++k) heights.include(dot(direction, between[k]));
    const T limit = beyond_direction * sqrt(dot(direction, direction));
    return (heights.least > limit) | (heights.greatest < -limit);
  };
  const auto apart_across = [&](const Vector3<T>& along, const Vector3<T>& offset) {
    const T length_squared = max(dot(along, along), T(double{std::numeric_limits<RealOf<T>>::min()}));
    return apart_along(offset - (dot(along, offset) / length_squared) * along);
  };
  // Twice the edges, and four times the offset of their middles, at half the step.
  const Vector3<T> along_a = (pair.start_a[1] - pair.start_a[0]) + (pair.start_a[1] - pair.start_a[0]) +
                             (pair.displacement_a[1] - pair.displacement_a[0]);
  const Vector3<T> along_b = (pair.start_b[1] - pair.start_b[0]) + (pair.start_b[1] - pair.start_b[0]) +
                             (pair.displacement_b[1] - pair.displacement_b[0]);
  const Vector3<T> offset = (between[0] + between[3]) + (between[4] + between[7]);
  apart = apart | apart_along(cross(along_a, along_b)) | apart_across(along_a, offset) |
          apart_across(along_b, offset);
  return apart;
}

}  // namespace brio
