#pragma once
/// Eight-node hexahedron with one integration point (Flanagan & Belytschko 1981).

#include <array>
#include <string_view>
#include <tuple>

#include "elements/motion.hpp"
#include "src/base/fields.hpp"

namespace brio {

struct Hex8 {
  static constexpr std::string_view name = "hex8";
  static constexpr int nodes = 8;
  static constexpr bool rotations = false;
  template <class Law>
  static constexpr bool accepts = true;
  static constexpr int points() { return 1; }
  static constexpr auto fields() { return std::tuple{}; }

  template <class T, class Law>
  struct Header {
    T mass;
  };
  template <class T, class Law>
  struct Point {
    SymmetricTensor<T> stress;
    [[no_unique_address]] typename Law::template History<T> history;
  };

  template <class T, class Law>
  NodalMass<T> initialize(const NodalMotion<T, 8>& motion, const Law& law, Header<T, Law>& header,
                          Point<T, Law>*) const {
    header.mass = T(law.density) * motion.position[0][6] * motion.position[1][6] * motion.position[2][6];
    return {header.mass * 0.125, T(0.0)};
  }
  template <class T, class Law>
  Increment<T> force(const NodalMotion<T, 8>& motion, T step, const Law& law, Header<T, Law>& header,
                     Point<T, Law>* point, NodalForces<T, 8>& forces) const {
    const SymmetricTensor<T> d = isotropic(step * motion.velocity[0][1]);
    law.update(d, point->stress, point->history);
    for (int i = 0; i < 3; ++i)
      for (int n = 0; n < 8; ++n) forces.force[i][n] = point->stress.xx;
    return {T(0.0), T(0.0), T(0.0), header.mass};
  }
  template <class Law>
  ElementSample sample(const NodalMotion<double, 8>&, const Law&, const Header<double, Law>&,
                       const Point<double, Law>* point) const {
    return {.stress = point->stress};
  }
};

}  // namespace brio
