#include "src/output/rigid_columns.hpp"

#include "src/fields/rotation.hpp"

namespace brio {

void add_rigid_columns(const Model& model, std::vector<std::string>& columns) {
  for (const RigidBody& body : model.rigid.body)
    for (const char* component :
         {".centre_x", ".centre_y", ".centre_z", ".rotation_x", ".rotation_y", ".rotation_z"})
      columns.push_back(model.parts[body.part].name + component);
}

void add_rigid_values(const Model& model, std::vector<double>& row) {
  for (const RigidBody& body : model.rigid.body)
    for (const Vector3d& vector : {body.centre, rotation_vector(body.attitude)})
      row.insert(row.end(), vector.begin(), vector.end());
}

}  // namespace brio
