#include "src/output/rigid_columns.hpp"

#include <cmath>

namespace brio {

namespace {

// A quaternion and its opposite are one rotation: the one of the smaller angle is taken.
Eigen::Vector3d rotation_vector(const Eigen::Quaterniond& attitude) {
  const double sign = attitude.w() < 0 ? -1 : 1;
  const Eigen::Vector3d axis = sign * attitude.vec();
  const double sine = axis.norm();
  const double half_angle = std::atan2(sine, sign * attitude.w());
  return sine > 0 ? Eigen::Vector3d((2 * half_angle / sine) * axis) : Eigen::Vector3d(2 * axis);
}

}  // namespace

void add_rigid_columns(const Model& model, std::vector<std::string>& columns) {
  for (const RigidBody& body : model.rigid.body)
    for (const char* component :
         {".centre_x", ".centre_y", ".centre_z", ".rotation_x", ".rotation_y", ".rotation_z"})
      columns.push_back(model.parts[body.part].name + component);
}

void add_rigid_values(const Model& model, std::vector<double>& row) {
  for (const RigidBody& body : model.rigid.body)
    for (const Eigen::Vector3d& vector : {body.centre, rotation_vector(body.attitude)})
      row.insert(row.end(), vector.begin(), vector.end());
}

}  // namespace brio
