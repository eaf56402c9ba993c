#pragma once
/// Co-rotational beam with two nodes and nodal triads (beam_geometry.hpp), its section integrated over fibres
/// (beam_section.hpp), or a bar with axial force only (truss, cable).
///
/// * Curvature is linear along the element, taken at two Gauss points; shear and twist are constant. Of the
///   tilt of the chord, bending takes the share 1 / (1 + Phi), Phi = 12 E I / (k G A L^2), and shear the
///   rest, as in the exact solution of a straight elastic beam under end loads: its stiffness is
///   Timoshenko's. Where fibres yield, the shear force and the slope of the moment would differ: the
///   difference moves tilt from one to the other in the next step, so that a hinge does not load the shear.
/// * Axial strain is logarithmic and the section keeps the volume: the axial force is stress times A L0 / L.
/// * A node has one moment of inertia about all axes: half of the element's polar moment. Twisting is exact;
///   turning across a beam, which has less, matters only where waves are as short as the beam is thick. The
///   stable step follows from it.

#include <algorithm>
#include <cmath>

#include "elements/beam/beam2.hpp"
#include "elements/beam/beam_geometry.hpp"
#include "elements/shell/shell_step.hpp"
#include "materials/failing.hpp"
#include "src/base/fetch_ahead.hpp"
#include "src/base/index.hpp"

namespace brio {

struct Beam2Kernel : Beam2 {
  using Settings = Beam2;
  static constexpr KernelTraits kernel_traits{
      .fetches_points_ahead = true,
      .stations = true,
      .shape_rule = "has no length, or lies along the orientation of its section"};

  static constexpr int most_points = 2 * most_fibres;
  /// Gauss points along the axis.
  int stations() const { return bends() ? 2 : 1; }
  int points() const { return bends() ? 2 * fibres->count : 1; }
  /// Length of beam that a point stands for.
  double point_size(double volume) const { return volume / (fibres->area * stations()); }

  template <class T, class Law>
  struct Header {
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
  template <class T, class Law>
  struct Point {
    FibreTensor<T> stress;
    [[no_unique_address]] typename Law::template History<T> history;
  };

  template <class T, class Law>
  NodalMass<T> initialize(const RotatingNodalMotion<T, 2>& motion, const Law& law, Header<T, Law>& header,
                          Point<T, Law>* point) const {
    const FibreSection& s = *fibres;
    const Vector3<T> chord = chord_of(motion);
    const T squared = dot(chord, chord);
    auto valid = squared > T(2 * no_length<T>);
    header.length = sqrt(where(valid, squared, 1.0));
    const Vector3<T> e1 = (1.0 / header.length) * chord;
    const Vector3<T> up = upright(e1);
    const Vector3<T> across = up - dot(up, e1) * e1;
    const T height = sqrt(max(dot(across, across), no_length<T>));
    const Vector3<T> e3 = (1.0 / height) * across;
    header.triad[0] = header.triad[1] = quaternion_of(e1, cross(e3, e1), e3);

    const auto moduli = plane_stress_moduli(law.template moduli<T>(point[0].history));
    const double second_moment[2] = {s.second_moment_z, s.second_moment_y};
    const double shear_area[2] = {s.shear_factor_y * s.area, s.shear_factor_z * s.area};
    for (int axis = 0; axis < 2; ++axis) {
      header.shear_stiffness[axis] = T(shear_area[axis]) * moduli.shear * header.length;
      const T bending = T(12 * second_moment[axis]) * moduli.youngs / header.length;
      header.bending_share[axis] = header.shear_stiffness[axis] / (header.shear_stiffness[axis] + bending);
    }

    if (bends()) valid = valid & (dot(across, across) > 1e-8 * dot(up, up));
    header.mass = where(valid, T(law.density * s.area) * header.length, 0.0);
    const T share = 0.5 * header.mass;
    return {share, bends() ? T(gyration_square()) * share : T(0.0)};
  }

  /// Rotational inertia over mass.
  template <class Header>
  double gyration_of(const Header&) const {
    return bends() ? gyration_square() : 0;
  }

  template <class T, class Law>
  BRIO_INLINE Increment<T> force(const RotatingNodalMotion<T, 2>& motion, T step, const Law& law,
                                 Header<T, Law>& header, Point<T, Law>* point,
                                 RotatingNodalForces<T, 2>& nodal) const {
    if (!bends()) return pull(motion, step, law, header, point, nodal);
    auto valid = header.length > T(0.0);
    for (int node = 0; node < 2; ++node) {
      const Vector3<T> turn = step * spin_of(motion, node);
      valid = valid & (dot(turn, turn) <= T(4 * largest_half_turn_square));
      header.triad[node] = turned(turn, header.triad[node]);
    }
    const BeamGeometry<T> g = beam_geometry(chord_of(motion), header.triad[0], header.triad[1]);
    const BeamStrain<T> strain = beam_strain(g, header.length);
    // Before the first step the strain is what round-off leaves of none.
    const auto moves = step > T(0.0);
    const BeamStrain<T> change = where(moves, strain, header.strain) - header.strain;
    header.strain = strain;

    Increment<T> increment;
    BeamLoads<T> loads = stress_loads(g, change, law, header, point, increment);
    const auto moduli = plane_stress_moduli(law.template moduli<T>(point[0].history));
    const T axial_stiffness = T(fibres->area) * moduli.youngs * header.length * square(g.inverse_length);
    increment.strain_rate_squared = T(0.0);
    increment.frequency_squared =
        highest_frequency_square(g, moduli, axial_stiffness, abs(loads.axial_force), header);
    const T undamped = 2.0 / sqrt(increment.frequency_squared);
    increment.stable_step = where(valid & g.is_valid, undamped * damped_share(T(linear_bulk_viscosity)), 0.0);
    loads.axial_force +=
        viscous_force(axial_stiffness, undamped, g.length * change.stretch, step, header, increment);
    beam_forces(g, loads, nodal);
    return increment;
  }

  template <class Law>
  ElementSample sample(const RotatingNodalMotion<double, 2>& motion, const Law&,
                       const Header<double, Law>& header, const Point<double, Law>* point) const {
    ElementSample out;
    FibreTensor<double> mean{};
    out.section_force = out.section_moment = {};
    for (int p = 0; p < points(); ++p) {
      const BeamFibre fibre = bends() ? fibres->fibre[index(p % fibres->count)] : BeamFibre{};
      const FibreTensor<double> share = (bends() ? 0.5 * fibre.share : 1.0) * point[p].stress;
      mean = mean + share;
      out.section_force[1] += fibres->area * fibre.shear_y * share.xy;
      out.section_force[2] += fibres->area * fibre.shear_z * share.xz;
      out.section_moment[0] += fibres->area * (fibre.twist_y * share.xy + fibre.twist_z * share.xz);
      out.section_moment[1] += fibres->area * fibre.z * share.xx;
      out.section_moment[2] -= fibres->area * fibre.y * share.xx;
    }
    const Vector3d chord = chord_of(motion);
    const double length = std::sqrt(dot(chord, chord));
    out.section_force[0] = fibres->area * header.length / length * mean.xx;
    Vector3d x = (1 / length) * chord;
    Vector3d shear{};
    if (bends()) {
      const Quaternion<double> middle = middle_of(header.triad[0], header.triad[1]);
      x = rotated(middle, Vector3d{1, 0, 0});
      shear = rotated(middle, Vector3d{0, mean.xy, mean.xz});
      out.twist = header.strain.bend.x / header.length;
    }
    out.stress = {mean.xx * x.x * x.x + 2 * x.x * shear.x,
                  mean.xx * x.y * x.y + 2 * x.y * shear.y,
                  mean.xx * x.z * x.z + 2 * x.z * shear.z,
                  mean.xx * x.x * x.y + x.x * shear.y + x.y * shear.x,
                  mean.xx * x.y * x.z + x.y * shear.z + x.z * shear.y,
                  mean.xx * x.x * x.z + x.x * shear.z + x.z * shear.x};
    out.internal_energy = header.internal_energy;
    out.volume = fibres->area * header.length;
    out.radius = fibres->radius;
    return out;
  }

 private:
  template <class T>
  BRIO_INLINE static Vector3<T> chord_of(const RotatingNodalMotion<T, 2>& motion) {
    const T(&x)[3][2] = motion.position;
    return {x[0][1] - x[0][0], x[1][1] - x[1][0], x[2][1] - x[2][0]};
  }
  template <class T>
  BRIO_INLINE static Vector3<T> spin_of(const RotatingNodalMotion<T, 2>& motion, int node) {
    return {motion.angular_velocity[0][node], motion.angular_velocity[1][node],
            motion.angular_velocity[2][node]};
  }
  /// The orientation; for round sections any direction across will do.
  template <class T>
  Vector3<T> upright(const Vector3<T>& e1) const {
    if (orientation) return {T((*orientation)[0]), T((*orientation)[1]), T((*orientation)[2])};
    const auto stands = abs(e1.z) > T(0.9);
    return {where(stands, T(1.0), 0.0), T(0.0), where(stands, T(0.0), 1.0)};
  }

  /// Of the polar moment.
  double gyration_square() const {
    return (fibres->second_moment_y + fibres->second_moment_z) / fibres->area;
  }

  /// Curvature at a Gauss point is the mean and this much of the part that changes its sign in the middle.
  static constexpr double gauss_place = 0.57735026918962576;

  /// What a step adds to the strains of the two cross sections.
  template <class T>
  struct SectionChange {
    T stretch;
    T curvature_y[2], curvature_z[2];
    T half_shear_y, half_shear_z, half_twist;
  };
  template <class T, class Law>
  BRIO_INLINE static SectionChange<T> section_change(const BeamStrain<T>& change,
                                                     const Header<T, Law>& header) {
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
  /// Update of stress in all fibres.
  template <class T, class Law>
  BRIO_INLINE FibreSums<T> sum_fibres(const SectionChange<T>& change, const Law& law,
                                      Point<T, Law>* point) const {
    const FibreSection& s = *fibres;
    const std::size_t pack_bytes = sizeof(Header<T, Law>) + index(points()) * sizeof(Point<T, Law>);
    FibreSums<T> sum{T(0.0), T(0.0), T(0.0), T(0.0), T(0.0), {T(0.0), T(0.0)}, {T(0.0), T(0.0)}};
    for (int station = 0; station < 2; ++station) {
      Point<T, Law>* const fibre_point = point + station * s.count;
      for (int f = 0; f < s.count; ++f) {
        const BeamFibre& fibre = s.fibre[index(f)];
        const FibreTensor<T> strain{
            change.stretch + T(fibre.z) * change.curvature_y[station] -
                T(fibre.y) * change.curvature_z[station],
            T(fibre.shear_y) * change.half_shear_y + T(fibre.twist_y) * change.half_twist,
            T(fibre.shear_z) * change.half_shear_z + T(fibre.twist_z) * change.half_twist};
        const FibreTensor<T> before = fibre_point[f].stress;
        FibreTensor<T> stress = before;
        law.update_fibre(strain, stress, fibre_point[f].history);
        fibre_point[f].stress = stress;
        fetch_ahead(reinterpret_cast<std::uintptr_t>(fibre_point + f) + pack_bytes, sizeof(Point<T, Law>));
        const T weight(0.5 * fibre.share);
        sum.work += weight * (0.5 * (before.xx + stress.xx) * strain.xx +
                              (before.xy + stress.xy) * strain.xy + (before.xz + stress.xz) * strain.xz);
        const T xx = weight * stress.xx, xy = weight * stress.xy, xz = weight * stress.xz;
        sum.axial += xx;
        sum.moment_y[station] += T(fibre.z) * xx;
        sum.moment_z[station] -= T(fibre.y) * xx;
        sum.shear_y += T(fibre.shear_y) * xy;
        sum.shear_z += T(fibre.shear_z) * xz;
        sum.torque += T(fibre.twist_y) * xy + T(fibre.twist_z) * xz;
      }
    }
    return sum;
  }

  /// What the stress of this step bears, and its work.
  template <class T, class Law>
  BRIO_INLINE BeamLoads<T> stress_loads(const BeamGeometry<T>& g, const BeamStrain<T>& change, const Law& law,
                                        Header<T, Law>& header, Point<T, Law>* point,
                                        Increment<T>& increment) const {
    const FibreSums<T> sum = sum_fibres(section_change(change, header), law, point);
    const T area(fibres->area);
    const T volume = area * header.length;
    BeamLoads<T> loads;
    loads.axial_force = volume * sum.axial * g.inverse_length;
    loads.moment = {area * sum.torque, area * (sum.moment_y[0] + sum.moment_y[1]),
                    area * (sum.moment_z[0] + sum.moment_z[1])};
    increment.internal_energy = volume * sum.work;
    increment.hourglass_energy = T(0.0);

    const T shear_load[2] = {volume * sum.shear_y, volume * sum.shear_z};
    const T lever = area * (6 * gauss_place);
    const T bending_load[2] = {lever * (sum.moment_z[0] - sum.moment_z[1]),
                               lever * (sum.moment_y[1] - sum.moment_y[0])};
    T tilt[2];
    for (int axis = 0; axis < 2; ++axis) {
      const T share = header.bending_share[axis];
      tilt[axis] = (1.0 - share) * shear_load[axis] + share * bending_load[axis];
      const T before = header.imbalance[axis];
      const T unit = header.shear_stiffness[axis] / share;
      header.imbalance[axis] = (bending_load[axis] - shear_load[axis]) / unit;
      // What the ends feel beyond the work in the fibres.
      increment.internal_energy += 0.5 * unit * before * (before + header.imbalance[axis]);
    }
    loads.tilt_y = tilt[0];
    loads.tilt_z = tilt[1];
    header.internal_energy += increment.internal_energy;
    return loads;
  }

  /// Largest of the element by itself: its modes are stretching, twisting, bending about two axes, and
  /// tilting along two, which moves the nodes across and turns both.
  template <class T, class Law>
  BRIO_INLINE T highest_frequency_square(const BeamGeometry<T>& g, const PlaneStressModuli<T>& moduli,
                                         T axial_stiffness, T axial_force,
                                         const Header<T, Law>& header) const {
    const FibreSection& s = *fibres;
    const T per_mass = 4.0 / header.mass;
    const T per_inertia = T(1 / gyration_square()) * per_mass;
    const T per_length = 1.0 / header.length;
    T highest = axial_stiffness * per_mass;
    highest = max(highest, T(s.torsion_constant) * moduli.shear * per_length * per_inertia);
    const T modulus = moduli.youngs * per_length;
    const T across = square(g.inverse_length) * per_mass + 0.25 * per_inertia;
    const T string = axial_force * g.inverse_length * per_mass;
    const double second_moment[2] = {s.second_moment_z, s.second_moment_y};
    for (int axis = 0; axis < 2; ++axis) {
      const T bending = T(second_moment[axis]) * modulus;
      highest = max(highest, bending * per_inertia);
      highest = max(highest, 12.0 * bending * header.bending_share[axis] * across + string);
    }
    return highest;
  }

  /// b1 times the critical damping of stretching.
  template <class T, class Law>
  BRIO_INLINE T viscous_force(T stiffness, T undamped_step, T elongation, T step, Header<T, Law>& header,
                              Increment<T>& increment) const {
    const auto moves = step > T(0.0);
    const T rate = where(moves, elongation / where(moves, step, 1.0), 0.0);
    const T before = header.viscous_force;
    header.viscous_force = linear_bulk_viscosity * undamped_step * stiffness * rate;
    increment.viscous_energy = 0.5 * (before + header.viscous_force) * elongation;
    return header.viscous_force;
  }

  /// Truss and cable: one point, axial force along the chord.
  template <class T, class Law>
  BRIO_INLINE Increment<T> pull(const RotatingNodalMotion<T, 2>& motion, T step, const Law& law,
                                Header<T, Law>& header, Point<T, Law>* point,
                                RotatingNodalForces<T, 2>& nodal) const {
    const Vector3<T> chord = chord_of(motion);
    const T squared = dot(chord, chord);
    const auto has_length = squared > T(2 * no_length<T>);
    const T length = sqrt(where(has_length, squared, 1.0));
    const T inverse_length = 1.0 / length;
    const T stretch = log(length / header.length);
    const T change = where(step > T(0.0), stretch - header.strain.stretch, 0.0);
    header.strain.stretch = stretch;

    const auto moduli = plane_stress_moduli(law.template moduli<T>(point[0].history));
    const FibreTensor<T> before = point[0].stress;
    T strain = change;
    if (formulation == BeamFormulation::cable) strain = tighten(change, moduli.youngs, law, header, point);
    law.update_fibre(FibreTensor<T>{strain, T(0.0), T(0.0)}, point[0].stress, point[0].history);

    const T volume = T(fibres->area) * header.length;
    Increment<T> increment;
    increment.internal_energy = volume * (0.5 * (before.xx + point[0].stress.xx) * strain);
    increment.hourglass_energy = T(0.0);
    header.internal_energy += increment.internal_energy;
    T force = volume * inverse_length * point[0].stress.xx;
    const T stiffness = volume * moduli.youngs * square(inverse_length);
    const T per_mass = 4.0 / header.mass;
    increment.strain_rate_squared = T(0.0);
    increment.frequency_squared = max(stiffness, abs(force) * inverse_length) * per_mass;
    const T undamped = 2.0 / sqrt(increment.frequency_squared);
    increment.stable_step = where(has_length, undamped * damped_share(T(linear_bulk_viscosity)), 0.0);
    T taut(1.0);
    if (formulation == BeamFormulation::cable) taut = where(header.slack < T(0.0), T(0.0), 1.0);
    force += viscous_force(taut * stiffness, undamped, length * change, step, header, increment);

    const Vector3<T> along = (force * inverse_length) * chord;
    const Vector3<T> none{T(0.0), T(0.0), T(0.0)};
    set_column(T(-1.0) * along, nodal.force, 0);
    set_column(along, nodal.force, 1);
    for (int node = 0; node < 2; ++node) set_column(none, nodal.moment, node);
    return increment;
  }

  /// Of a change of strain what a cable feels: it unloads to no stress and goes slack from there on.
  template <class T, class Law>
  BRIO_INLINE static T tighten(T change, T modulus, const Law& law, Header<T, Law>& header,
                               const Point<T, Law>* point) {
    T carried(1.0);
    if constexpr (can_fail<Law>) carried = max(law.carried_share(point->history), 1e-3);
    const T ahead = change + header.slack;
    const T felt = max(ahead, -(point->stress.xx / (carried * modulus)));
    header.slack = ahead - felt;
    return felt;
  }
};

}  // namespace brio
