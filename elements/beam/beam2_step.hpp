#pragma once
/// State of a beam, and the motion of one step of it.

#include "elements/base/motion.hpp"
#include "elements/beam/beam_geometry.hpp"

namespace brio {

template <class T>
struct Beam2Header {
  T mass;
  T length;  ///< initial
  T internal_energy;
  Quaternion<T> triad[2];
  BeamStrain<T> strain;
  T bending_share[2];    ///< of the tilt along y, along z, while elastic
  T shear_stiffness[2];  ///< elastic, per tilt: k G A L
  T imbalance[2];        ///< tilt that shear has to take over from bending for both to bear the same
  T slack;               ///< strain by which a cable is too long to be straight, not positive
  T viscous_force;
};

template <class T>
BRIO_INLINE Vector3<T> chord_of(const RotatingNodalMotion<T, 2>& motion) {
  const T(&x)[3][2] = motion.position;
  return {x[0][1] - x[0][0], x[1][1] - x[1][0], x[2][1] - x[2][0]};
}
template <class T>
BRIO_INLINE Vector3<T> spin_of(const RotatingNodalMotion<T, 2>& motion, int node) {
  return {motion.angular_velocity[0][node], motion.angular_velocity[1][node],
          motion.angular_velocity[2][node]};
}
/// Curvature at a Gauss point is the mean and this much of the part that changes its sign in the middle.
inline constexpr double gauss_place = 0.57735026918962576;

/// What a step adds to the strains of the two cross sections.
template <class T>
struct SectionChange {
  T stretch;
  T curvature_y[2], curvature_z[2];
  T half_shear_y, half_shear_z, half_twist;
};
template <class T>
BRIO_INLINE SectionChange<T> section_change(const BeamStrain<T>& change, const Beam2Header<T>& header) {
  const T per_length = 1.0 / header.length;
  const T shear_y = (1.0 - header.bending_share[0]) * change.tilt_y + header.imbalance[0];
  const T shear_z = (1.0 - header.bending_share[1]) * change.tilt_z + header.imbalance[1];
  const Vector3<T> mean = per_length * change.bend;
  const T alternating_y = (6 * gauss_place) * per_length * (change.tilt_z - shear_z);
  const T alternating_z = (-6 * gauss_place) * per_length * (change.tilt_y - shear_y);
  return {change.stretch,
          {mean.y - alternating_y, mean.y + alternating_y},
          {mean.z - alternating_z, mean.z + alternating_z},
          0.5 * shear_y,
          0.5 * shear_z,
          0.5 * mean.x};
}

/// Sums over the fibres of both cross sections, each of which stands for half of the volume, by volume.
template <class T>
struct FibreSums {
  T axial, torque, shear_y, shear_z, work;
  T moment_y[2], moment_z[2];
};

/// The motion of a step: what follows from it whatever the material. Triads and strains of the header go on
/// to its end.
template <class T>
struct Beam2Step {
  MaskOf<T> is_valid;
  BeamGeometry<T> g;
  BeamStrain<T> change;
  SectionChange<T> sections;

  BRIO_CALLED Beam2Step(const RotatingNodalMotion<T, 2>& motion, T step, Beam2Header<T>& header)
      : is_valid(turn(motion, step, header)),
        g(beam_geometry(chord_of(motion), header.triad[0], header.triad[1])),
        change(follow(beam_strain(g, header.length), step, header)),
        sections(section_change(change, header)) {}

 private:
  static BRIO_INLINE MaskOf<T> turn(const RotatingNodalMotion<T, 2>& motion, T step, Beam2Header<T>& header) {
    auto valid = header.length > T(0.0);
    for (int node = 0; node < 2; ++node) {
      const Vector3<T> turn = step * spin_of(motion, node);
      valid = valid & (dot(turn, turn) <= T(4 * largest_half_turn_square));
      header.triad[node] = turned(turn, header.triad[node]);
    }
    return valid;
  }
  static BRIO_INLINE BeamStrain<T> follow(const BeamStrain<T>& strain, T step, Beam2Header<T>& header) {
    // Before the first step the strain is what round-off leaves of none.
    const BeamStrain<T> change = where(step > T(0.0), strain, header.strain) - header.strain;
    header.strain = strain;
    return change;
  }
};

}  // namespace brio
