#pragma once
/// Belytschko-Tsay shell (Belytschko, Lin & Tsay 1984): four nodes, co-rotational axes at the centre, one
/// integration point in the plane, velocity strains at 1 to 9 points through the thickness. A repeated fourth
/// node makes it a triangle.
///
/// * Axes, strains and what was added to the original: shell_geometry.hpp, shell_strain.hpp.
/// * Stable step and scaled rotational inertia: shell_step.hpp.
/// * Drilling: a node has one moment of inertia about all axes, and strain takes only what lies in the
///   element's plane: it does not resist spin about the normal. Elements that are tilted against each other
///   drive that spin and turn it into what bends, so a weak spring and a damper hold it (drilling_stiffness,
///   drilling_viscosity).

#include <cmath>

#include "elements/base/changing_spring.hpp"
#include "elements/shell/shell4.hpp"
#include "elements/shell/shell_step.hpp"
#include "elements/shell/shell_strain.hpp"
#include "src/base/fetch_ahead.hpp"
#include "src/base/index.hpp"

namespace brio {

struct Shell4Kernel : Shell4 {
  using Settings = Shell4;
  static constexpr KernelTraits kernel_traits{
      .fetches_points_ahead = true, .tangent = true, .completes_samples = true};
  static constexpr int most_points = most_thickness_points;
  int points() const { return thickness_points; }
  double point_size(double volume) const { return std::sqrt(volume / thickness); }

  template <class T, class Law>
  struct Header {
    T mass;
    T thickness;
    T inverse_gyration;  ///< 1 / r^2: nodal mass over nodal rotational inertia
    T internal_energy;
    T viscous_force;  ///< per length, of the last step
    ReferenceShape<T> reference;
    T hourglass[3];  ///< strains of the elastic hourglass control (changing_spring.hpp)
    T rotation[2];
    T drilling;                                 ///< angle about the normal
    HourglassStiffness<T> hourglass_stiffness;  ///< of the last step
    T drilling_stiffness;
    T viscous_drilling;  ///< moment of the last step
  };
  template <class T, class Law>
  struct Point {
    ShellTensor<T> stress;
    [[no_unique_address]] typename Law::template History<T> history;
  };

  template <class T, class Law>
  NodalMass<T> initialize(const RotatingNodalMotion<T, 4>& motion, const Law& law, Header<T, Law>& header,
                          Point<T, Law>* point) const {
    const ShellGeometry<T> g = initial_shell_geometry(motion.position);
    const auto moduli = plane_stress_moduli(law.template moduli<T>(point[0].history));
    header.thickness = T(thickness);
    header.reference = reference_shape(g);
    const T gyration = gyration_square(g, moduli, shear_factor, header.thickness, rule().second_moment());
    header.inverse_gyration = 1.0 / gyration;
    header.mass = law.density * header.thickness * g.area;
    header.hourglass_stiffness =
        brio::hourglass_stiffness(g, moduli, shear_factor, header.thickness, hourglass_stiffness);
    if (drilling_stiffness > 0)
      header.drilling_stiffness = drill_stiffness(frequency_square(g, moduli, header), header);
    // A triangle's smallest corner is zero but for round-off.
    header.mass = where((smallest_corner(g) > T(-1e-6)) & g.is_valid, header.mass, 0.0);
    const T share = 0.25 * header.mass;
    return {share, share * gyration};
  }

  /// Rotational inertia over mass.
  template <class Header>
  auto gyration_of(const Header& header) const {
    return 1.0 / header.inverse_gyration;
  }

  /// The same without damping forces.
  Shell4Kernel undamped() const {
    Shell4Kernel kernel = *this;
    kernel.linear_bulk_viscosity = 0;
    kernel.hourglass_viscosity = 0;
    kernel.drilling_viscosity = 0;
    return kernel;
  }
  /// State with the present shape and without stress. \param header out, zero before, as are the points
  template <class T, class Law, class Other>
  void start_unstressed(const Header<T, Law>& now, Header<T, Other>& header, Point<T, Other>*) const {
    header.mass = now.mass;
    header.thickness = now.thickness;
    header.inverse_gyration = now.inverse_gyration;
    header.reference = now.reference;
    header.hourglass_stiffness = now.hourglass_stiffness;
    header.drilling_stiffness = now.drilling_stiffness;
  }

  template <class T, class Law>
  BRIO_INLINE Increment<T> force(const RotatingNodalMotion<T, 4>& motion, T step, const Law& law,
                                 Header<T, Law>& header, Point<T, Law>* point,
                                 RotatingNodalForces<T, 4>& nodal) const {
    const ShellGeometry<T> g = shell_geometry(motion.position, header.reference);
    const ShellRates<T> rates = shell_rates(motion, g, step, warping_projection);
    Increment<T> increment;
    ShellRates<T> result = stress_resultants(g, rates, step, law, header, point, increment);

    const auto moduli = plane_stress_moduli(law.template moduli<T>(point[0].history));
    T frequency = frequency_square(g, moduli, header);
    T drill = T(0.0);
    if (drilling_stiffness > 0) {
      drill = drill_stiffness(frequency, header);
      frequency += drilling_frequency_square(g, drill, header);
    }
    const T undamped = 2.0 / sqrt(frequency);
    T damping = T(linear_bulk_viscosity);
    if (hourglass_viscosity > 0)
      damping += hourglass_viscosity * (1.0 + 0.5 * (square(g.skew[0]) + square(g.skew[1])));
    if (drilling_stiffness > 0) damping += drilling_damping(g, header);
    increment.frequency_squared = frequency;
    increment.strain_rate_squared = strain_rate_squared(rates, header.thickness);
    increment.stable_step = where(g.is_valid, undamped * damped_share(damping), 0.0);

    // Viscosity as if the stiffness of equal stretch in both directions, E' (1 + nu) / 2, acted for b1 stable
    // steps.
    const T stretching = rates.membrane[0] + rates.membrane[1];
    const T viscous_force = (0.5 * linear_bulk_viscosity) * (header.thickness * undamped) *
                            (moduli.stretch * (1.0 + moduli.ratio)) * stretching;
    result.membrane[0] += viscous_force;
    result.membrane[1] += viscous_force;
    const T middle_area = g.area * (1.0 - 0.5 * step * stretching);
    increment.viscous_energy =
        (0.5 * middle_area * step) * ((header.viscous_force + viscous_force) * stretching);
    header.viscous_force = viscous_force;

    resist_hourglass(g, moduli, rates, step, undamped, header, result, increment);
    if (drilling_stiffness > 0) resist_drilling(drill, rates, step, header, result, increment);
    shell_forces(g, result, warping_projection, nodal);
    return increment;
  }

  template <class Law>
  BRIO_INLINE ElementSample sample(const RotatingNodalMotion<double, 4>& motion, const Law&,
                                   const Header<double, Law>& header, const Point<double, Law>* point) const {
    ElementSample out;
    const ThicknessRule& points = rule();
    ShellTensor<double> mean{};
    for (int p = 0; p < thickness_points; ++p) mean = mean + points.weight[index(p)] * point[p].stress;
    out.stress = on_global_axes(shell_geometry(motion.position, header.reference), mean);
    out.internal_energy = header.internal_energy;
    out.thickness = header.thickness;
    return out;
  }
  template <class Law>
  void complete(const RotatingNodalMotion<double, 4>& motion, const Header<double, Law>& header,
                const Point<double, Law>* point, ElementSample& sample) const {
    const ShellGeometry<double> g = shell_geometry(motion.position, header.reference);
    ShellTensor<double> first_moment{};
    for (int p = 0; p < thickness_points; ++p) {
      const auto k = index(p);
      first_moment = first_moment + (rule().weight[k] * rule().place[k]) * point[p].stress;
      if (rule().place[k] == 0) sample.middle.point = k;
    }
    // Rules go from the bottom to the top.
    sample.bottom.point = 0;
    sample.top.point = index(thickness_points - 1);
    sample.bending_moment = on_global_axes(g, header.thickness * header.thickness * first_moment);
    for (ElementSample::Layer* layer : {&sample.top, &sample.middle, &sample.bottom})
      if (layer->point != ElementSample::Layer::none)
        layer->stress = on_global_axes(g, point[layer->point].stress);
    sample.hourglass_energy = stored_hourglass_energy(header);
    sample.volume = g.area * header.thickness;
  }

 private:
  /// Angle, in radians, at which resistance to drilling yields.
  static constexpr double drilling_limit = 0.01;

  /// That of the springs against hourglass modes and drilling.
  template <class Law>
  static double stored_hourglass_energy(const Header<double, Law>& header) {
    const HourglassStiffness<double>& stiffness = header.hourglass_stiffness;
    double twice =
        stiffness.normal * square(header.hourglass[2]) + header.drilling_stiffness * square(header.drilling);
    for (int c = 0; c < 2; ++c)
      twice +=
          stiffness.membrane * square(header.hourglass[c]) + stiffness.rotation * square(header.rotation[c]);
    return 0.5 * twice;
  }

  static BRIO_INLINE SymmetricTensor<double> on_global_axes(const ShellGeometry<double>& g,
                                                            const ShellTensor<double>& a) {
    const Vector3d on_axis[2] = {a.xx * g.axis[0] + a.xy * g.axis[1] + a.xz * g.normal,
                                 a.xy * g.axis[0] + a.yy * g.axis[1] + a.yz * g.normal},
                   on_normal = a.xz * g.axis[0] + a.yz * g.axis[1];
    const auto entry = [&](double Vector3d::*i, double Vector3d::*j) {
      return on_axis[0].*i * g.axis[0].*j + on_axis[1].*i * g.axis[1].*j + on_normal.*i * g.normal.*j;
    };
    using V = Vector3d;
    return {entry(&V::x, &V::x), entry(&V::y, &V::y), entry(&V::z, &V::z),
            entry(&V::x, &V::y), entry(&V::y, &V::z), entry(&V::x, &V::z)};
  }

  /// Update of stress at all points; forces and moments per length, new thickness, work.
  template <class T, class Law>
  BRIO_INLINE ShellRates<T> stress_resultants(const ShellGeometry<T>& g, const ShellRates<T>& rates, T step,
                                              const Law& law, Header<T, Law>& header, Point<T, Law>* point,
                                              Increment<T>& increment) const {
    const ThicknessRule& quadrature_rule = rule();
    const T old_thickness = header.thickness;
    T strain[3], bend[3];
    for (int c = 0; c < 3; ++c) strain[c] = step * rates.membrane[c];
    for (int c = 0; c < 3; ++c) bend[c] = (step * old_thickness) * rates.curvature[c];
    const T half_shear[2] = {0.5 * step * rates.shear[0], 0.5 * step * rates.shear[1]};
    T force[3] = {T(0.0), T(0.0), T(0.0)};
    T moment[3] = {T(0.0), T(0.0), T(0.0)};
    T shear[2] = {T(0.0), T(0.0)};
    T thickness_strain = T(0.0);
    T work = T(0.0);
    const std::size_t pack_bytes = sizeof(Header<T, Law>) + index(thickness_points) * sizeof(Point<T, Law>);
    for (int p = 0; p < thickness_points; ++p) {
      const T place(quadrature_rule.place[index(p)]);
      const T weight(quadrature_rule.weight[index(p)]);
      const ShellTensor<T> strain_increment{strain[0] + place * bend[0], strain[1] + place * bend[1],
                                            strain[2] + place * bend[2], half_shear[1], half_shear[0]};
      const ShellTensor<T> before = point[p].stress;
      ShellTensor<T> stress = before;
      T through = T(0.0);
      law.update_plane_stress(strain_increment, shear_factor, stress, point[p].history, through);
      point[p].stress = stress;
      fetch_ahead(reinterpret_cast<std::uintptr_t>(point + p) + pack_bytes, sizeof(Point<T, Law>));
      thickness_strain += weight * through;
      const T normal_work =
          (before.xx + stress.xx) * strain_increment.xx + (before.yy + stress.yy) * strain_increment.yy;
      const T shear_work = (before.xy + stress.xy) * strain_increment.xy +
                           (before.yz + stress.yz) * strain_increment.yz +
                           (before.xz + stress.xz) * strain_increment.xz;
      work += weight * (0.5 * normal_work + shear_work);
      const T lever = weight * place;
      force[0] += weight * stress.xx;
      force[1] += weight * stress.yy;
      force[2] += weight * stress.xy;
      moment[0] += lever * stress.xx;
      moment[1] += lever * stress.yy;
      moment[2] += lever * stress.xy;
      shear[0] += weight * stress.xz;
      shear[1] += weight * stress.yz;
    }
    // Halves of the changes of thickness and area over the step lead to the volume in its middle.
    const T half_strain = 0.5 * thickness_strain;
    T middle_thickness = old_thickness;
    if (thickness_update) {
      header.thickness = old_thickness * (1.0 + thickness_strain + half_strain * thickness_strain);
      middle_thickness = old_thickness * (1.0 + half_strain);
    }
    const T middle_area = g.area * (1.0 - 0.5 * (strain[0] + strain[1]));
    increment.internal_energy = (middle_area * middle_thickness) * work;
    header.internal_energy += increment.internal_energy;
    const T h = header.thickness;
    const T h_squared = square(h);
    return {{h * force[0], h * force[1], h * force[2]},
            {h_squared * moment[0], h_squared * moment[1], h_squared * moment[2]},
            {h * shear[0], h * shear[1]},
            {},
            {},
            T(0.0)};
  }

  /// Upper bound of the highest frequency squared, without resistance to drilling.
  template <class T, class Law>
  BRIO_INLINE T frequency_square(const ShellGeometry<T>& g, const PlaneStressModuli<T>& moduli,
                                 const Header<T, Law>& header) const {
    return highest_frequency_square(g, moduli, shear_factor, rule().second_moment(), header.mass,
                                    header.thickness, header.inverse_gyration, hourglass_stiffness,
                                    warping_projection);
  }

  /// Moment per spin about the normal.
  template <class T, class Law>
  BRIO_INLINE T drill_stiffness(T frequency_squared, const Header<T, Law>& header) const {
    return drilling_stiffness * frequency_squared * header.mass / header.inverse_gyration;
  }

  /// What resistance to drilling adds to the largest square of a frequency: its only mode is all four nodes'
  /// spin against that of the material.
  template <class T, class Law>
  static BRIO_INLINE T drilling_frequency_square(const ShellGeometry<T>& g, T drill,
                                                 const Header<T, Law>& header) {
    return (drill / header.mass) * (header.inverse_gyration + 1.25 * gradient_square(g));
  }

  /// What damping of drilling adds to the ratio of damping. Strain meets the part of the mode that is the
  /// material's spin, a share t = s r^2 of that of the nodes. For a mode p joined with strain by the root of
  /// t p, all together is below the larger of (strain + 5/4 t p) and 5 p; 5 p is below 1 where the spring is
  /// weak.
  template <class T, class Law>
  BRIO_INLINE T drilling_damping(const ShellGeometry<T>& g, const Header<T, Law>& header) const {
    const double ratio = drilling_viscosity * std::sqrt(drilling_stiffness);
    const T share = gradient_square(g) / header.inverse_gyration;
    const bool is_weak = 5 * (drilling_stiffness + 2 * ratio) <= 1;
    return is_weak ? (1.25 * ratio) * share : ratio * (1.0 + share);
  }

  /// Nodal spin about the normal bends no element that is flat, and nothing else would resist it; but moments
  /// of elements that are tilted against each other drive it, and turn it into what bends. (After Hughes &
  /// Brezzi 1989: a weak spring between the spin of the nodes and that of the material. One for the mean of
  /// the nodes, as one point of integration gives: nodes spin unequally where a warped surface bends, and one
  /// for each would lock it. It yields at a hundredth of a radian, so that it does not resist where the
  /// corners of folds shear in their plane. Moments are not those of a potential in that spin: it swings up
  /// in strips of short elements that are bent strongly, unless damped.)
  template <class T, class Law>
  BRIO_INLINE void resist_drilling(T drill, const ShellRates<T>& rates, T step, Header<T, Law>& header,
                                   ShellRates<T>& result, Increment<T>& increment) const {
    const SpringChange<T> change = spring_change(header.drilling_stiffness, drill);
    header.drilling_stiffness = drill;
    const T before = change.carried * header.drilling;
    const T growth = (step * change.growth) * rates.drilling;
    header.drilling = min(max(before + growth, -drilling_limit), drilling_limit);
    increment.hourglass_energy += (0.5 * drill) * growth * (before + header.drilling);
    const T elastic = drill * header.drilling;
    const T damper = (2 * drilling_viscosity) * sqrt(drill * header.mass / header.inverse_gyration);
    const T most = drilling_limit * drill;
    result.drilling = min(max(elastic + damper * rates.drilling, -most), most);
    const T viscous = result.drilling - elastic;
    increment.viscous_energy += (0.5 * step) * rates.drilling * (header.viscous_drilling + viscous);
    header.viscous_drilling = viscous;
  }

  /// Elastic and viscous hourglass forces (Belytschko, Ong, Liu & Kennedy 1984).
  /// They stay elastic where the material flows: shrunk with its stress, as those of bricks are, they let the
  /// elements of a can's folds collapse into slivers.
  template <class T, class Law>
  BRIO_INLINE void resist_hourglass(const ShellGeometry<T>& g, const PlaneStressModuli<T>& moduli,
                                    const ShellRates<T>& rates, T step, T undamped_step,
                                    Header<T, Law>& header, ShellRates<T>& result,
                                    Increment<T>& increment) const {
    const HourglassStiffness<T> stiffness =
        brio::hourglass_stiffness(g, moduli, shear_factor, header.thickness, hourglass_stiffness);
    const HourglassStiffness<T> old = header.hourglass_stiffness;
    header.hourglass_stiffness = stiffness;
    const SpringChange<T> in_plane = spring_change(old.membrane, stiffness.membrane);
    const SpringChange<T> bow = spring_change(old.normal, stiffness.normal);
    const SpringChange<T> turning = spring_change(old.rotation, stiffness.rotation);
    T work = T(0.0);
    const auto force = [step, &work](T& strain, const SpringChange<T>& change, T rate, T end_stiffness) {
      const T before = change.carried * strain;
      const T growth = (step * change.growth) * rate;
      strain = before + growth;
      work += end_stiffness * ((before + strain) * growth);
      return end_stiffness * strain;
    };
    for (int c = 0; c < 2; ++c) {
      result.hourglass[c] = force(header.hourglass[c], in_plane, rates.hourglass[c], stiffness.membrane);
      result.rotation[c] = force(header.rotation[c], turning, rates.rotation[c], stiffness.rotation);
    }
    result.hourglass[2] = force(header.hourglass[2], bow, rates.hourglass[2], stiffness.normal);
    increment.hourglass_energy = 0.5 * work;
    if (hourglass_viscosity > 0) {
      const T damper = hourglass_viscosity * header.mass / (4.0 * undamped_step);
      const T rotation_damper = damper / header.inverse_gyration;
      T power = T(0.0);
      for (int c = 0; c < 3; ++c) {
        result.hourglass[c] += damper * rates.hourglass[c];
        power += damper * square(rates.hourglass[c]);
      }
      for (int c = 0; c < 2; ++c) {
        result.rotation[c] += rotation_damper * rates.rotation[c];
        power += rotation_damper * square(rates.rotation[c]);
      }
      increment.viscous_energy += step * power;
    }
  }
};

}  // namespace brio
