#pragma once
/// Strains of a two-node beam, and the nodal forces of their conjugates: co-rotational after
/// Belytschko, Schwer & Klein (1977), with nodal triads, so that nothing is integrated over rotations.
///
/// Nodal triads R_a, R_b follow the nodes; their mean R_m lies halfway on the turn from one to the other.
/// With the chord from node a to node b, of length L:
///
///     stretch   ln(L / L_0)
///     bend      the vector of the turn from R_a to R_b, on R_m: twist, and bending about y and z
///     tilt      R_m^T chord / L, less its part along x: the angle by which the chord leaves the normal of
///     the
///               mean cross section; transverse shear and bending that changes its sign in the middle
///
/// They do not change in rigid motion, however large, and `beam_forces` is their exact transpose: what it
/// gives has neither resultant nor moment.
///
/// Variations, with spins a and b of the ends on R_m and the turn between them 2 eta n, t = n tan(eta/2),
/// k = eta / sin(eta):
///
///     d(bend) = (k I + (1 - k) n n^T) (b - a)
///     spin of R_m = (a + b) / 2 - t x (b - a) / 2

#include "elements/base/motion.hpp"
#include "elements/beam/beam_rotation.hpp"
#include "src/base/lane_math.hpp"

namespace brio {

template <class T>
struct BeamStrain {
  T stretch;
  Vector3<T> bend;
  T tilt_y, tilt_z;

  friend BRIO_INLINE BeamStrain operator-(const BeamStrain& a, const BeamStrain& b) {
    return {a.stretch - b.stretch, a.bend - b.bend, a.tilt_y - b.tilt_y, a.tilt_z - b.tilt_z};
  }
};

template <class T, class Mask>
BRIO_INLINE BeamStrain<T> where(Mask condition, const BeamStrain<T>& a, const BeamStrain<T>& b) {
  return {where(condition, a.stretch, b.stretch),
          {where(condition, a.bend.x, b.bend.x), where(condition, a.bend.y, b.bend.y),
           where(condition, a.bend.z, b.bend.z)},
          where(condition, a.tilt_y, b.tilt_y),
          where(condition, a.tilt_z, b.tilt_z)};
}

/// Derivatives of the energy by the strains, but by the length in place of the stretch.
template <class T>
struct BeamLoads {
  T axial_force;
  Vector3<T> moment;
  T tilt_y, tilt_z;
};

template <class T>
struct BeamGeometry {
  T length, inverse_length;
  Quaternion<T> middle;   ///< R_m
  Vector3<T> chord;       ///< unit vector along the chord, on R_m
  Quaternion<T> between;  ///< half of the turn from one end to the other, on R_m: cos(eta), n sin(eta)
  T bend_ratio;           ///< k
  MaskOf<T> is_valid;     ///< neither collapsed nor folded onto itself
};

/// Square of a length that counts as none.
template <class T>
inline constexpr double no_length = sizeof(RealOf<T>) == 8 ? 1e-200 : 1e-30;

template <class T>
BRIO_INLINE BeamGeometry<T> beam_geometry(const Vector3<T>& chord, const Quaternion<T>& first,
                                          const Quaternion<T>& second) {
  BeamGeometry<T> g;
  const T squared = dot(chord, chord);
  const MaskOf<T> has_length = squared > T(2 * no_length<T>);
  g.length = sqrt(where(has_length, squared, 1.0));
  g.inverse_length = 1.0 / g.length;
  g.middle = middle_of(first, second);
  g.chord = g.inverse_length * rotated(conjugate(g.middle), chord);
  g.between = conjugate(first) * second;
  g.bend_ratio = angle_over_sine(max(g.between.w, 0.0));
  g.is_valid = has_length & (g.between.w > T(0.0)) & (g.chord.x > T(0.0));
  return g;
}

template <class T>
BRIO_INLINE BeamStrain<T> beam_strain(const BeamGeometry<T>& g, const T& initial_length) {
  return {log(g.length / initial_length), 2.0 * g.bend_ratio * vector_part(g.between), g.chord.y, g.chord.z};
}

template <class T>
BRIO_INLINE void set_column(const Vector3<T>& value, T (&field)[3][2], int node) {
  field[0][node] = value.x;
  field[1][node] = value.y;
  field[2][node] = value.z;
}

template <class T>
BRIO_INLINE void beam_forces(const BeamGeometry<T>& g, const BeamLoads<T>& loads,
                             RotatingNodalForces<T, 2>& nodal) {
  const Vector3<T> tilt{T(0.0), loads.tilt_y, loads.tilt_z};
  const Vector3<T>& u = g.chord;
  const Vector3<T> pull = (loads.axial_force - dot(tilt, u) * g.inverse_length) * u + g.inverse_length * tilt;
  const Vector3<T> about_middle = cross(tilt, u);

  const Vector3<T> sine = vector_part(g.between);                                // n sin(eta)
  const Vector3<T> half_tangent = (1.0 / (1.0 + max(g.between.w, 0.0))) * sine;  // t
  const T along_turn = (1.0 - g.bend_ratio) * dot(sine, loads.moment) / max(dot(sine, sine), no_length<T>);
  const Vector3<T> apart =
      g.bend_ratio * loads.moment + along_turn * sine - T(0.5) * cross(about_middle, half_tangent);

  const Vector3<T> force = rotated(g.middle, pull);
  set_column(T(-1.0) * force, nodal.force, 0);
  set_column(force, nodal.force, 1);
  set_column(rotated(g.middle, T(0.5) * about_middle - apart), nodal.moment, 0);
  set_column(rotated(g.middle, T(0.5) * about_middle + apart), nodal.moment, 1);
}

}  // namespace brio
