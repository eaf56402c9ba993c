#pragma once
/// Uniform-gradient hexahedron: eight nodes, one integration point (Flanagan & Belytschko 1981), for one
/// objective rate.
///
/// The gradient is taken once, on the configuration at the end of the step: L_end. The velocity gradient of
/// the middle follows exactly for affine motion, so that a rigid rotation of any size gives no strain, and so
/// does the volume at the middle, V_mid = V det(I - dt/2 L_end). Forces are V sigma B at the end; the work
/// accounted for is V_mid (sigma_old + sigma_new)/2 : D dt, which differs from the work of the forces by
/// third order in the step.

#include <cmath>

#include "elements/solid/hex8_step.hpp"
#include "materials/hardening.hpp"

namespace brio {

template <ObjectiveRate rate>
struct Hex8Kernel : Hex8 {
  using Settings = Hex8;
  static constexpr KernelTraits kernel_traits{
      .uses_differences = true, .tangent = true, .completes_samples = true};
  static constexpr int most_points = 1;
  static constexpr int points() { return 1; }
  static double point_size(double volume) { return std::cbrt(volume); }
  static constexpr bool is_unrotated = rate == ObjectiveRate::green_naghdi;
  template <class Law>
  static constexpr bool accepts = RateLaw<Law> || (is_unrotated && StretchLaw<Law>);

  template <class T, class Law>
  using Header = Hex8State<T>;
  template <class T, class Law>
  using Point = SolidPoint<T, Law, rate>;

  template <class T, class Law>
  NodalMass<T> initialize(const NodalMotion<T, 8>& motion, const Law& law, Header<T, Law>& header,
                          Point<T, Law>* point) const {
    const HexahedronModes<T> x = modes(motion.position);
    const MeanGradient<T> b = mean_gradient(x);
    header.mass = T(law.density) * b.volume;
    start(*point);
    const T volume = where(b.volume > T(0.0), b.volume, T(1.0));
    const T distortion =
        hourglass_distortion(hourglass_sums(x), gradient_product(b, gradient_scale / volume));
    header.hourglass.scale = hourglass_scale(brio::hourglass_stiffness(
        hourglass_stiffness, law.template moduli<T>(point->history), volume, distortion));
    return {header.mass * 0.125, T(0.0)};
  }

  /// The same without damping forces.
  Hex8Kernel undamped() const {
    Hex8Kernel kernel = *this;
    kernel.linear_bulk_viscosity = 0;
    kernel.quadratic_bulk_viscosity = 0;
    kernel.hourglass_viscosity = 0;
    return kernel;
  }
  /// State with the present shape and without stress. \param state, point out, zero before
  template <class T, class Other>
  void start_unstressed(const Hex8State<T>& now, Hex8State<T>& state, Point<T, Other>* point) const {
    state.mass = now.mass;
    state.hourglass.scale = now.hourglass.scale;
    start(*point);
  }

  template <class T, class Law>
  BRIO_INLINE Increment<T> force(const NodalMotion<T, 8>& motion, T step, const Law& law, Hex8State<T>& state,
                                 Point<T, Law>* point, NodalForces<T, 8>& forces) const {
    Hex8Step<T> s;
    Increment<T> increment;
    follow_motion(motion, step, point->stress, point->rotation, s, increment);
    const PointStep<T> point_step = update(law, s.axes, *point);
    const ElasticModuli<T> moduli = law.moduli(point->history);
    resist_motion(*this, step, moduli, point_step.has_yielded, state, s, increment);
    T most = T(HUGE_VAL);
    if constexpr (has_yield_stress<Law>) most = most_hourglass_energy(law, point->history, s);
    resist_with_forces<rate>(*this, step, point_step, point->stress, moduli.shear, most, state, s, increment,
                             forces);
    return increment;
  }

  template <class Law>
  ElementSample sample(const NodalMotion<double, 8>&, const Law&, const Header<double, Law>& header,
                       const Point<double, Law>* point) const {
    return {.stress = fixed_stress(*point), .internal_energy = header.internal_energy};
  }
  template <class Law>
  void complete(const NodalMotion<double, 8>& motion, const Header<double, Law>& header,
                const Point<double, Law>*, ElementSample& sample) const {
    sample.hourglass_energy = stored_energy(header.hourglass);
    sample.volume = mean_gradient(modes(motion.position)).volume;
  }

 private:
  /// That hourglass stress can store at yield. The present yield stress is asked for where that of the
  /// beginning is exceeded.
  template <class T, class Law>
  static BRIO_INLINE T most_hourglass_energy(const Law& law, const typename Law::template History<T>& history,
                                             const Hex8Step<T>& s) {
    const auto hardening = law.hardening();
    const HourglassTrial<T>& trial = s.hourglass;
    const T at_first_yield =
        hourglass_energy_at_yield(T(hardening.initial_yield_stress()), s.volume.end, trial.bending);
    if (!any(trial.energy > at_first_yield)) return at_first_yield;
    return hourglass_energy_at_yield(point_of(hardening, history).stress, s.volume.end, trial.bending);
  }
};

}  // namespace brio
