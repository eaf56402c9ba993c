#pragma once
/// Logarithmic strain along the chord; the bar keeps its volume, so that the axial force is stress times
/// A L0 / L. Its one frequency is 2/L0 sqrt(E / rho).

#include "src/base/lane_math.hpp"
#include "tests/toys/spring/toy_spring.hpp"

namespace brio {

struct ToySpringKernel : ToySpring {
  using Settings = ToySpring;
  static constexpr KernelTraits kernel_traits{.uses_differences = true, .shape_rule = "has no length"};
  static constexpr int most_points = 1;
  static constexpr int points() { return 1; }
  double point_size(double volume) const { return volume / area; }

  template <class T, class Law>
  struct Header {
    T mass;
    T length;  ///< at the start
    T strain;
    T internal_energy;
  };
  template <class T, class Law>
  struct Point {
    FibreTensor<T> stress;
    [[no_unique_address]] typename Law::template History<T> history;
  };

  template <class T, class Law>
  NodalMass<T> initialize(const NodalMotion<T, 2>& motion, const Law& law, Header<T, Law>& header,
                          Point<T, Law>*) const {
    header.length = sqrt(squared_chord(motion));
    header.mass = T(law.density * area) * header.length;
    return {0.5 * header.mass, T(0.0)};
  }

  template <class T, class Law>
  BRIO_INLINE Increment<T> force(const NodalMotion<T, 2>& motion, T, const Law& law, Header<T, Law>& header,
                                 Point<T, Law>* point, NodalForces<T, 2>& forces) const {
    const T squared = squared_chord(motion);
    const T strain = 0.5 * log(squared / (header.length * header.length));
    const T change = strain - header.strain;
    header.strain = strain;
    const FibreTensor<T> before = point->stress;
    law.update_fibre(FibreTensor<T>{change, T(0.0), T(0.0)}, point->stress, point->history);

    const T volume = T(area) * header.length;
    const T per_length = volume * point->stress.xx / squared;
    for (int i = 0; i < 3; ++i) {
      forces.force[i][1] = per_length * (motion.position[i][1] - motion.position[i][0]);
      forces.force[i][0] = T(0.0) - forces.force[i][1];
    }
    const T work = 0.5 * volume * (before.xx + point->stress.xx) * change;
    header.internal_energy += work;
    const ElasticModuli<T> m = law.template moduli<T>(point->history);
    const T youngs = m.shear * (3.0 * m.first_lame + 2.0 * m.shear) / (m.first_lame + m.shear);
    const T frequency_squared = 4.0 * volume * youngs / (header.mass * squared);
    return {work, T(0.0), T(0.0), 2.0 / sqrt(frequency_squared), frequency_squared, T(0.0)};
  }

  template <class Law>
  ElementSample sample(const NodalMotion<double, 2>&, const Law&, const Header<double, Law>& header,
                       const Point<double, Law>* point) const {
    ElementSample sample{.internal_energy = header.internal_energy};
    sample.stress.xx = point->stress.xx;  // a toy: of bars along x
    return sample;
  }

 private:
  template <class T>
  static BRIO_INLINE T squared_chord(const NodalMotion<T, 2>& motion) {
    T sum(0.0);
    for (int i = 0; i < 3; ++i) {
      const T chord = motion.position[i][1] - motion.position[i][0];
      sum += chord * chord;
    }
    return sum;
  }
};

}  // namespace brio
