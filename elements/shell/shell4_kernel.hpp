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

#include "elements/shell/shell_resistance.hpp"
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
  using Header = Shell4State<T>;
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
    const T gyration = gyration_square(g, moduli, shear_factor, header.thickness, rule().second_moment);
    header.inverse_gyration = 1.0 / gyration;
    header.mass = law.density * header.thickness * g.area;
    header.hourglass_stiffness =
        brio::hourglass_stiffness(g, moduli, shear_factor, header.thickness, hourglass_stiffness);
    if (drilling_stiffness > 0)
      header.drilling_stiffness = drill_stiffness(*this, frequency_square(*this, g, moduli, header), header);
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
  /// State with the present shape and without stress. \param state out, zero before, as are the points
  template <class T, class Other>
  void start_unstressed(const Shell4State<T>& now, Shell4State<T>& state, Point<T, Other>*) const {
    state.mass = now.mass;
    state.thickness = now.thickness;
    state.inverse_gyration = now.inverse_gyration;
    state.reference = now.reference;
    state.hourglass_stiffness = now.hourglass_stiffness;
    state.drilling_stiffness = now.drilling_stiffness;
  }

  template <class T, class Law>
  BRIO_INLINE Increment<T> force(const RotatingNodalMotion<T, 4>& motion, T step, const Law& law,
                                 Shell4State<T>& state, Point<T, Law>* point,
                                 RotatingNodalForces<T, 4>& nodal) const {
    const ShellGeometry<T> g = shell_geometry(motion.position, state.reference);
    const ShellRates<T> rates = shell_rates(motion, g, step, warping_projection);
    Increment<T> increment;
    ShellRates<T> result;
    update_stress(g, rates, step, law, state, point, result, increment);
    resist_motion(*this, step, law.template moduli<T>(point[0].history), g, rates, state, result, increment,
                  nodal);
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
  /// That of the springs against hourglass modes and drilling.
  static double stored_hourglass_energy(const Shell4State<double>& header) {
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

  /// Update of stress at all points; membrane forces, moments and shear forces per length, new thickness,
  /// work. \param result of these alone
  template <class T, class Law>
  BRIO_INLINE void update_stress(const ShellGeometry<T>& g, const ShellRates<T>& rates, T step,
                                 const Law& law, Shell4State<T>& state, Point<T, Law>* point,
                                 ShellRates<T>& result, Increment<T>& increment) const {
    const ThicknessRule& quadrature_rule = rule();
    const T old_thickness = state.thickness;
    T strain[3], bend[3];
    for (int c = 0; c < 3; ++c) strain[c] = step * rates.membrane[c];
    for (int c = 0; c < 3; ++c) bend[c] = (step * old_thickness) * rates.curvature[c];
    const T half_shear[2] = {0.5 * step * rates.shear[0], 0.5 * step * rates.shear[1]};
    T force[3] = {T(0.0), T(0.0), T(0.0)};
    T moment[3] = {T(0.0), T(0.0), T(0.0)};
    T shear[2] = {T(0.0), T(0.0)};
    T thickness_strain = T(0.0);
    T work = T(0.0);
    const std::size_t pack_bytes = sizeof(state) + index(thickness_points) * sizeof(Point<T, Law>);
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
      state.thickness = old_thickness * (1.0 + thickness_strain + half_strain * thickness_strain);
      middle_thickness = old_thickness * (1.0 + half_strain);
    }
    const T middle_area = g.area * (1.0 - 0.5 * (strain[0] + strain[1]));
    increment.internal_energy = (middle_area * middle_thickness) * work;
    state.internal_energy += increment.internal_energy;
    for (int c = 0; c < 3; ++c) {
      result.membrane[c] = state.thickness * force[c];
      result.curvature[c] = square(state.thickness) * moment[c];
    }
    for (int c = 0; c < 2; ++c) result.shear[c] = state.thickness * shear[c];
  }
};

}  // namespace brio
