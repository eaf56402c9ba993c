#pragma once
/// Eight-node hexahedron with 2x2x2 integration points and the dilatation of the whole element at each of
/// them (B-bar: selective reduced integration in the form of Hughes 1980): no hourglass modes, no volumetric
/// locking.

#include "elements/solid/hex8_full_step.hpp"
#include "src/base/fetch_ahead.hpp"

namespace brio {

template <ObjectiveRate rate>
struct Hex8FullKernel : Hex8Full {
  using Settings = Hex8Full;
  static constexpr KernelTraits kernel_traits{
      .uses_differences = true, .fetches_points_ahead = true, .tangent = true, .completes_samples = true};
  static constexpr int most_points = hexahedron_points;
  static constexpr int points() { return hexahedron_points; }
  static double point_size(double volume) { return std::cbrt(volume / hexahedron_points); }
  template <class Law>
  static constexpr bool accepts = RateLaw<Law> || (rate == ObjectiveRate::green_naghdi && StretchLaw<Law>);

  template <class T, class Law>
  using Header = Hex8FullState<T>;
  template <class T, class Law>
  using Point = SolidPoint<T, Law, rate>;

  template <class T, class Law>
  NodalMass<T> initialize(const NodalMotion<T, 8>& motion, const Law& law, Header<T, Law>& header,
                          Point<T, Law>* point) const {
    const HexahedronModes<T> x = modes(motion.position);
    header.mass = T(law.density) * mean_gradient(x).volume;
    T mass = header.mass * 0.125;
    for (int p = 0; p < hexahedron_points; ++p) {
      start(point[p]);
      mass = where(point_geometry(x, point_position[p]).determinant > T(0.0), mass, T(0.0));
    }
    return {mass, T(0.0)};
  }

  /// The same without damping forces.
  Hex8FullKernel undamped() const {
    Hex8FullKernel kernel = *this;
    kernel.linear_bulk_viscosity = 0;
    kernel.quadratic_bulk_viscosity = 0;
    return kernel;
  }
  /// State with the present shape and without stress. \param state, point out, zero before
  template <class T, class Other>
  void start_unstressed(const Hex8FullState<T>& now, Hex8FullState<T>& state, Point<T, Other>* point) const {
    state.mass = now.mass;
    for (int p = 0; p < hexahedron_points; ++p) start(point[p]);
  }

  template <class T, class Law>
  BRIO_INLINE Increment<T> force(const NodalMotion<T, 8>& motion, T step, const Law& law,
                                 Hex8FullState<T>& state, Point<T, Law>* point,
                                 NodalForces<T, 8>& forces) const {
    constexpr std::size_t pack_bytes = sizeof(state) + hexahedron_points * sizeof(Point<T, Law>);
    Hex8FullStep<T> s;
    Increment<T> increment;
    begin_step(motion, step, s, increment);
#pragma GCC unroll 1
    for (int p = 0; p < hexahedron_points; ++p) {
      Hex8FullPoint<T> here;
      follow_motion(point_position[p], step, point[p].stress, point[p].rotation, s, here);
      const T work = update(law, here.axes, point[p]).work;
      fetch_ahead(reinterpret_cast<std::uintptr_t>(point + p) + pack_bytes, sizeof(Point<T, Law>));
      add_point<rate>(point_position[p], work, point[p].stress, law.moduli(point[p].history), here, s);
    }
    finish_step(*this, state, s, increment, forces);
    return increment;
  }

  template <class Law>
  ElementSample sample(const NodalMotion<double, 8>&, const Law&, const Header<double, Law>& header,
                       const Point<double, Law>* point) const {
    ElementSample result{.internal_energy = header.internal_energy};
    result.stress = isotropic(0.0);
    for (int p = 0; p < hexahedron_points; ++p)
      result.stress = result.stress + (1.0 / hexahedron_points) * fixed_stress(point[p]);
    return result;
  }
  template <class Law>
  void complete(const NodalMotion<double, 8>& motion, const Header<double, Law>&, const Point<double, Law>*,
                ElementSample& sample) const {
    sample.volume = mean_gradient(modes(motion.position)).volume;
  }
};

}  // namespace brio
