#pragma once
/// A slave node that touches, or may touch within the step, one place of the surface: one constraint.

#include <Eigen/Dense>
#include <array>

namespace brio {

struct Contact {
  int slave = 0;  ///< index among the slave nodes
  int face = 0;
  int body = 0;                     ///< of the face
  std::array<int, 5> node{};        ///< slave indices: the node, then the corners of the face
  std::array<double, 5> weight{};   ///< 1, then minus the weights of the corners; their sum is 0
  Eigen::Vector3d normal;           ///< unit vector from the face to the node: the way the node is pushed
  double gap = 0;                   ///< at the beginning of the step; negative: old overlap
  double friction_coefficient = 0;  ///< Coulomb's
  double impulse = 0;               ///< along the normal, on the node; never negative
  Eigen::Vector3d friction = Eigen::Vector3d::Zero();  ///< tangential impulse on the node
};

}  // namespace brio
