#pragma once
/// Product of the assembled elastic stiffness and nodal displacements, element by element: forces of the
/// kernel on an element with its present shape, without stress and viscosity.

#include "elements/elastic_tangent.hpp"
#include "elements/node_exchange.hpp"

namespace brio {

/// Displacements over the size of an element, and rotations, at which forces are linear to rounding in single
/// precision.
inline constexpr double small_displacement = 1e-6;

/// Displacements and rotations relative to those of the first node, made small. \returns by which factor
template <class Kind, class T>
BRIO_INLINE T shrink(NodalMotionOf<Kind, T>& motion) {
  T size(0.0), moved(0.0), turned(0.0);
  for (int corner = 0; corner < Kind::nodes; ++corner)
    for (int i = 0; i < 3; ++i) {
      size = max(size, abs(motion.position[i][corner] - motion.position[i][0]));
      moved = max(moved, abs(motion.velocity[i][corner] - motion.velocity[i][0]));
      if constexpr (Kind::rotations) turned = max(turned, abs(motion.angular_velocity[i][corner]));
    }
  moved = max(moved, size * turned);
  const auto moves = moved > T(0.0);
  const T factor = where(moves, (small_displacement * size) / where(moves, moved, T(1.0)), T(1.0));
  for (int corner = 0; corner < Kind::nodes; ++corner)
    for (int i = 0; i < 3; ++i) {
      motion.velocity[i][corner] = factor * motion.velocity[i][corner];
      if constexpr (Kind::rotations)
        motion.angular_velocity[i][corner] = factor * motion.angular_velocity[i][corner];
    }
  return factor;
}

/// Of a pack; the same code for all laws. \param motion with displacements in place of velocities
template <class Kind, Floating Real>
BRIO_CALLED void elastic_forces(const Kind& undamped, NodalMotionOf<Kind, Lanes<Real>>& motion,
                                typename Kind::template Header<Lanes<Real>, ElasticTangent>& header,
                                typename Kind::template Point<Lanes<Real>, ElasticTangent>* point,
                                ForcesOf<Kind, Lanes<Real>>& forces) {
  using T = Lanes<Real>;
  const T factor = shrink<Kind, T>(motion);
  undamped.force(motion, T(1.0), ElasticTangent{}, header, point, forces);
  const T back = 1.0 / factor;
  for (int corner = 0; corner < Kind::nodes; ++corner)
    for (int i = 0; i < 3; ++i) {
      forces.force[i][corner] = back * forces.force[i][corner];
      if constexpr (Kind::rotations) forces.moment[i][corner] = back * forces.moment[i][corner];
    }
  forces.stiffness = T(0.0);
  if constexpr (Kind::rotations) forces.rotational_stiffness = T(0.0);
}

/// \param kind with the settings of the block \param product out: minus the forces are added
template <class Kind, class Law, Floating Real, class Layout>
void multiply_stiffness(const Kind& kind, const Law& law, Block& block, Chunk chunk, const Nodes& nodes,
                        const NodalRows& displacement, const NodalRows& product) {
  using T = Lanes<Real>;
  constexpr std::size_t width = lane_count<Real>;
  const Kind undamped = kind.undamped();
  for (std::size_t done = 0; done < chunk.element_count; done += width) {
    const std::size_t pack = chunk.first_pack + done / width;
    const int* connectivity = block.connectivity.data() + pack * Kind::nodes * width;
    NodalMotionOf<Kind, T> motion;
    gather_motion<Kind, Real>(nodes, displacement, connectivity, motion);
    typename Kind::template Header<T, ElasticTangent> header{};
    typename Kind::template Point<T, ElasticTangent> point[Kind::most_points] = {};
    kind.start_unstressed(Layout::header(block, pack), header, point);
    for (int p = 0; p < kind.points(); ++p)
      point[p].history = law.template moduli<T>(Layout::points(block, pack)[p].history);
    ForcesOf<Kind, T> forces;
    elastic_forces<Kind, Real>(undamped, motion, header, point, forces);
    scatter_pack<Kind, Real>(product, connectivity,
                             static_cast<int>(std::min(width, chunk.element_count - done)), forces);
  }
}

}  // namespace brio
