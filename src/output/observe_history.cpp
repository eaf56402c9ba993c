#include <algorithm>
#include <array>

#include "src/base/index.hpp"
#include "src/output/observe.hpp"
#include "src/output/part_energy_columns.hpp"
#include "src/output/result_order.hpp"
#include "src/output/result_tables.hpp"
#include "src/output/rigid_columns.hpp"

namespace brio {

namespace {

constexpr std::size_t most_parts_in_history = 100;

// Mean velocity of a part: momentum over mass.
Vector mean_velocity(const PartInModel& part, const Nodes& nodes, const RigidBodies& rigid,
                     std::span<const double> moved_mass) {
  if (part.rigid >= 0) {
    const Eigen::Vector3d& v = rigid.motion[index(part.rigid)].velocity;
    return {v[0], v[1], v[2]};
  }
  constexpr std::size_t sums = 4;  // that do not wait for each other
  std::array<Row4, sums> momentum{};
  std::array<double, sums> mass{};
  for (std::size_t i = 0; i < part.node.size(); ++i) {
    const auto node = index(part.node[i]);
    const double own = nodes.mass[node] + (moved_mass.empty() ? 0 : moved_mass[node]);
    mass[i % sums] += own;
    momentum[i % sums] += own * load_row(nodes.record[node].velocity);
  }
  const double of_part = (mass[0] + mass[1]) + (mass[2] + mass[3]);
  const Row4 sum = (momentum[0] + momentum[1]) + (momentum[2] + momentum[3]);
  if (of_part <= 0) return {};
  return {sum[0] / of_part, sum[1] / of_part, sum[2] / of_part};
}

// Of a vector one for each axis.
void add_column(std::string_view name, std::vector<std::string>& columns) {
  if (!name.ends_with("_x")) {
    columns.emplace_back(name);
    return;
  }
  for (const char axis : {'x', 'y', 'z'})
    columns.push_back(std::string(name.substr(0, name.size() - 1)) + axis);
}

}  // namespace

std::vector<std::string> history_columns(const Model& model) {
  std::vector<std::string> columns;
  for (const HistoryColumn& column : common_columns()) add_column(column.name, columns);
  for (std::size_t p = 0; p < std::min(model.parts.size(), most_parts_in_history); ++p)
    for (const char* axis : {".velocity_x", ".velocity_y", ".velocity_z"})
      columns.push_back(model.parts[p].name + axis);
  if (model.added_mass) columns.emplace_back("added_mass");
  if (model.contact_audits) columns.insert(columns.end(), {"missed_contacts", "crossings"});
  if (model.erosion)
    for (const auto cause : deletion_causes) columns.push_back("deleted_by_" + std::string(cause));
  add_columns(model.probes, columns);
  if (model.tells_rigid_bodies) add_rigid_columns(model, columns);
  if (model.tells_part_energies) add_part_energy_columns(model, columns);
  add_columns(model.springs, columns);
  if (model.forces) add_columns(*model.forces, columns);
  return columns;
}

void observe_history(Model& model, std::vector<double>& row) {
  balance_momentum(model);
  const EnergyBalance& energy = model.energy;
  const MomentumBalance& balance = model.momentum;
  row.assign({model.times.time, static_cast<double>(model.step), model.times.next, energy.kinetic,
              energy.internal, energy.hourglass, energy.all_viscous(), energy.deleted,
              -energy.contact.at_step(), -energy.friction.at_step(), energy.external.at_step(), energy.sum(),
              energy.relative_error(), energy.contact_added_max});
  for (const Vector& vector : {balance.now.linear, balance.now.angular})
    row.insert(row.end(), vector.begin(), vector.end());
  row.push_back(balance.linear_imbalance());
  row.push_back(balance.angular_imbalance());
  for (const Vector& vector : {balance.supports.linear, balance.walls.linear})
    row.insert(row.end(), vector.begin(), vector.end());
  row.push_back(static_cast<double>(deleted_so_far(model)));
  for (std::size_t p = 0; p < std::min(model.parts.size(), most_parts_in_history); ++p) {
    const Vector velocity = mean_velocity(model.parts[p], model.nodes, model.rigid, model.ties.moved_mass);
    row.insert(row.end(), velocity.begin(), velocity.end());
  }
  if (model.added_mass) row.push_back(model.added_mass->total());
  if (model.contact_audits)
    for (const std::int64_t count :
         {model.contact_audits->found.missed(), model.contact_audits->found.crossings})
      row.push_back(static_cast<double>(count));
  if (model.erosion)
    for (const auto count : model.erosion->deleted_by_cause) row.push_back(static_cast<double>(count));
  add_values(model.probes, model.nodes, row);
  if (model.tells_rigid_bodies) add_rigid_values(model, row);
  if (model.tells_part_energies) add_part_energy_values(model, row);
  add_values(model.springs, row);
  if (model.forces) add_values(*model.forces, row);
}

}  // namespace brio
