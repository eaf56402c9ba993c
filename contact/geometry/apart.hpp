#pragma once
/// Fast rejection of many pairs at once: nodes that are certainly disjoint from their faces over the whole
/// time step. The others are examined by `velocity_check`.

#include <array>
#include <limits>

#include "src/base/lanes.hpp"
#include "src/base/tensor.hpp"

namespace brio {

/// A node (point 0) and the four vertices of a face (points 1 to 4) over one step, as positions at its
/// beginning and displacements until its end. With T = Lanes<double> these are eight pairs side by side; a
/// loop over an array of them reads memory in order.
template <class T>
struct MovingPair {
  std::array<Vector3<T>, 5> start;
  std::array<Vector3<T>, 5> displacement;
};

/// The least and greatest height of the face over the node along a direction during the step, by its vertices
/// at the beginning and at the end: they move linearly.
template <class T>
struct Heights {
  T least;
  T greatest;

  BRIO_INLINE void include(T height) {
    least = min(least, height);
    greatest = max(greatest, height);
  }
};

/// True only where the node stays farther than `reach` from the face (its four triangles about the centroid,
/// at any time of the step): where a plane through the node, across an axis or along the face at half the
/// step, has the face beyond `reach` on one side all the while. The rounding of differences, ends and
/// heights, below 16 units of the largest distance plus displacement, is allowed for twice over.
template <class T>
BRIO_INLINE MaskOf<T> surely_apart(const MovingPair<T>& pair, T reach) {
  constexpr double roundoff = std::numeric_limits<RealOf<T>>::epsilon() / 2.0;
  std::array<Vector3<T>, 4> first;
  std::array<Vector3<T>, 4> last;
  T scale = reach;
  Heights<T> along_x;
  Heights<T> along_y;
  Heights<T> along_z;
  for (std::size_t k = 0; k < 4; ++k) {
    const Vector3<T> motion = pair.displacement[k + 1] - pair.displacement[0];
    first[k] = pair.start[k + 1] - pair.start[0];
    last[k] = first[k] + motion;
    scale = max(scale, max(max(abs(first[k].x) + abs(motion.x), abs(first[k].y) + abs(motion.y)),
                           abs(first[k].z) + abs(motion.z)));
    if (k == 0) {
      along_x = {first[0].x, first[0].x};
      along_y = {first[0].y, first[0].y};
      along_z = {first[0].z, first[0].z};
    }
    along_x.include(first[k].x);
    along_x.include(last[k].x);
    along_y.include(first[k].y);
    along_y.include(last[k].y);
    along_z.include(first[k].z);
    along_z.include(last[k].z);
  }
  const T beyond = reach + T(32 * roundoff) * scale;
  const Vector3<T> normal =
      cross((first[2] + last[2]) - (first[0] + last[0]), (first[3] + last[3]) - (first[1] + last[1]));
  Heights<T> along_normal{dot(normal, first[0]), dot(normal, first[0])};
  for (std::size_t k = 0; k < 4; ++k) {
    along_normal.include(dot(normal, first[k]));
    along_normal.include(dot(normal, last[k]));
  }
  const T length = sqrt(dot(normal, normal));
  const T beyond_normal = (reach + T(64 * roundoff) * scale) * length;
  return (along_x.least > beyond) | (along_x.greatest < -beyond) | (along_y.least > beyond) |
         (along_y.greatest < -beyond) | (along_z.least > beyond) | (along_z.greatest < -beyond) |
         (along_normal.least > beyond_normal) | (along_normal.greatest < -beyond_normal);
}

}  // namespace brio
