#include "src/output/part_energy_columns.hpp"

#include "src/base/index.hpp"

namespace brio {

namespace {

double square(const double* v) { return v[0] * v[0] + v[1] * v[1] + v[2] * v[2]; }

double kinetic_energy_of(const Model& model, const PartInModel& part) {
  if (part.rigid >= 0) {
    const auto body = index(part.rigid);
    const RigidMotion& motion = model.rigid.motion[body];
    return 0.5 * (model.rigid.body[body].mass * squared_norm(motion.velocity) +
                  dot(model.rigid.body[body].angular_momentum, motion.angular_velocity));
  }
  double sum = 0;
  for (const int entry : part.node) {
    const auto node = index(entry);
    sum += 0.5 * model.nodes.mass[node] * square(model.nodes.record[node].velocity);
    if (model.nodes.has_rotations())
      sum +=
          0.5 * model.nodes.rotational_inertia[node] * square(model.nodes.angular_velocity[node].component);
  }
  return sum;
}

}  // namespace

void add_part_energy_columns(const Model& model, std::vector<std::string>& columns) {
  for (const PartInModel& part : model.parts)
    for (const char* energy : {".kinetic", ".internal", ".hourglass"}) columns.push_back(part.name + energy);
}

void add_part_energy_values(const Model& model, std::vector<double>& row) {
  for (std::size_t p = 0; p < model.parts.size(); ++p)
    row.insert(row.end(), {kinetic_energy_of(model, model.parts[p]), model.part_energy[p].internal,
                           model.part_energy[p].hourglass});
}

}  // namespace brio
