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

std::size_t parts_in_history(const Model& model) {
  return std::min(model.parts.size(), most_parts_in_history);
}

void make_room(HistorySums& sums, const Model& model) {
  if (!sums.of_nodes.empty()) return;
  sums.of_nodes.resize((model.nodes.size() + nodes_per_range - 1) / nodes_per_range);
  for (std::size_t p = 0; p < parts_in_history(model); ++p) {
    const PartInModel& part = model.parts[p];
    if (part.rigid >= 0) continue;
    for (std::size_t begin = 0; begin < part.node.size(); begin += nodes_per_range)
      sums.of_parts.push_back({p, begin, std::min(begin + nodes_per_range, part.node.size())});
  }
}

void sum_up(HistorySums::PartRange& range, const PartInModel& part, const Nodes& nodes,
            std::span<const double> moved_mass) {
  constexpr std::size_t sums = 4;  // that do not wait for each other
  std::array<Row4, sums> momentum{};
  std::array<double, sums> mass{};
  for (std::size_t i = range.begin; i < range.end; ++i) {
    const auto node = index(part.node[i]);
    const double own = nodes.mass[node] + (moved_mass.empty() ? 0 : moved_mass[node]);
    mass[i % sums] += own;
    momentum[i % sums] += own * load_row(nodes.record[node].velocity);
  }
  range.mass = (mass[0] + mass[1]) + (mass[2] + mass[3]);
  range.momentum = (momentum[0] + momentum[1]) + (momentum[2] + momentum[3]);
}

void sum_up(HistorySums& sums, const Model& model, ThreadTeam& team) {
  const std::size_t ranges = sums.of_nodes.size();
  team.for_each(ranges + sums.of_parts.size(), [&](std::size_t task) {
    if (task < ranges) {
      const std::size_t begin = task * nodes_per_range;
      sums.of_nodes[task] =
          momentum(model.nodes, begin, std::min(begin + nodes_per_range, model.nodes.size()));
      return;
    }
    HistorySums::PartRange& range = sums.of_parts[task - ranges];
    sum_up(range, model.parts[range.part], model.nodes, model.ties.moved_mass);
  });
}

Momentum total(const std::vector<Momentum>& ranges) {
  Momentum sum;
  for (const Momentum& range : ranges) sum += range;
  return sum;
}

// Momentum over mass. \param range the first of the part's; moves on to that of the next part
Vector3d mean_velocity(std::size_t part, const HistorySums& sums, std::size_t& range) {
  Row4 momentum{};
  double mass = 0;
  for (; range < sums.of_parts.size() && sums.of_parts[range].part == part; ++range) {
    momentum += sums.of_parts[range].momentum;
    mass += sums.of_parts[range].mass;
  }
  if (mass <= 0) return {};
  return {momentum[0] / mass, momentum[1] / mass, momentum[2] / mass};
}

void add_mean_velocities(const Model& model, const HistorySums& sums, std::vector<double>& row) {
  std::size_t range = 0;
  for (std::size_t p = 0; p < parts_in_history(model); ++p) {
    if (const int body = model.parts[p].rigid; body >= 0) {
      const Vector3d& v = model.rigid.motion[index(body)].velocity;
      row.insert(row.end(), v.data(), v.data() + 3);
      continue;
    }
    const Vector3d velocity = mean_velocity(p, sums, range);
    row.insert(row.end(), velocity.begin(), velocity.end());
  }
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
  for (std::size_t p = 0; p < parts_in_history(model); ++p)
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

void observe_history(Model& model, HistorySums& sums, std::vector<double>& row, ThreadTeam& team) {
  make_room(sums, model);
  sum_up(sums, model, team);
  balance_momentum(model, total(sums.of_nodes));
  const EnergyBalance& energy = model.energy;
  const MomentumBalance& balance = model.momentum;
  row.assign({model.times.time, static_cast<double>(model.step), model.times.next, energy.kinetic,
              energy.internal, energy.hourglass, energy.all_viscous(), energy.deleted,
              -energy.contact.at_step(), -energy.friction.at_step(), energy.external.at_step(), energy.sum(),
              energy.relative_error(), energy.contact_added_max});
  for (const Vector3d& vector : {balance.now.linear, balance.now.angular})
    row.insert(row.end(), vector.begin(), vector.end());
  row.push_back(balance.linear_imbalance());
  row.push_back(balance.angular_imbalance());
  for (const Vector3d& vector : {balance.supports.linear, balance.walls.linear})
    row.insert(row.end(), vector.begin(), vector.end());
  row.push_back(static_cast<double>(deleted_so_far(model)));
  add_mean_velocities(model, sums, row);
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
