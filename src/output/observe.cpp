#include "src/output/observe.hpp"

#include <algorithm>
#include <array>
#include <set>

#include "src/output/cell_variables.hpp"

namespace brio {

namespace {

constexpr std::size_t most_parts_in_history = 100;

FieldArray field(std::string name, int components, std::size_t count,
                 Storage storage = Storage::single_precision, bool fixed = false) {
  return {std::move(name), components, std::vector<double>(static_cast<std::size_t>(components) * count),
          storage, fixed};
}

/// Whether any kind of element has that trait.
bool any_has(const Model& model, bool ElementTraits::*trait) {
  return std::any_of(model.blocks.begin(), model.blocks.end(),
                     [&](const Block& block) { return traits_of(block.element).*trait; });
}

// Mean velocity of a part: momentum over mass.
Vector mean_velocity(const PartInModel& part, const Nodes& nodes, const RigidBodies& rigid,
                     std::span<const double> moved_mass) {
  if (part.rigid >= 0) {
    const Eigen::Vector3d& v = rigid.motion[static_cast<std::size_t>(part.rigid)].velocity;
    return {v[0], v[1], v[2]};
  }
  Vector sum{};
  double mass = 0;
  for (int entry : part.node) {
    const auto node = static_cast<std::size_t>(entry);
    const double own = nodes.mass[node] + (moved_mass.empty() ? 0 : moved_mass[node]);
    mass += own;
    for (std::size_t i = 0; i < 3; ++i) sum[i] += own * nodes.record[node].velocity[i];
  }
  for (double& component : sum) component = mass > 0 ? component / mass : 0;
  return sum;
}

// Nothing is strained in a rigid part.
ElementSample sample_of(const Model& model, const PartInModel& part, std::size_t element) {
  if (part.rigid >= 0) {
    ElementSample sample{};
    sample.thickness = model.rigid.body[static_cast<std::size_t>(part.rigid)].thickness;
    return sample;
  }
  const Block& block = model.blocks[part.block];
  return block.kernel.sample(block, model.nodes, static_cast<std::size_t>(part.element_slot[element]));
}

void balance_momentum(Model& model) {
  Momentum now = momentum(model.nodes);
  add_momentum(model.rigid, now);
  model.momentum.now = now.total;
  model.momentum.linear_scale = std::max(model.momentum.linear_scale, now.linear_size);
  model.momentum.angular_scale = std::max(model.momentum.angular_scale, now.angular_size);
}

bool can_be_damaged(const Model& model) {
  return std::any_of(model.blocks.begin(), model.blocks.end(),
                     [](const Block& block) { return has_failure(block.material); });
}
std::int64_t deleted_so_far(const Model& model) { return model.erosion ? model.erosion->total_deleted() : 0; }

bool has_ids(const Model& model) {
  return std::any_of(model.parts.begin(), model.parts.end(),
                     [](const PartInModel& part) { return !part.node_id.empty(); });
}

// Of each node its number in the results, by parts; -1 of those that no part names.
std::vector<std::int64_t> points_of_nodes(const Model& model) {
  std::vector<std::int64_t> points(model.nodes.size(), -1);
  std::int64_t count = 0;
  for (const PartInModel& part : model.parts)
    for (int node : part.node)
      // One of a part before, which shares it, has its number.
      if (std::int64_t& point = points[static_cast<std::size_t>(node)]; point < 0) point = count++;
  return points;
}

}  // namespace

FieldObserver::FieldObserver(const Model& model, std::span<const std::string> variables)
    : point_of_node_(points_of_nodes(model)) {
  node_of_point_.resize(model.nodes.size() -
                        static_cast<std::size_t>(std::ranges::count(point_of_node_, std::int64_t{-1})));
  for (std::size_t node = 0; node < point_of_node_.size(); ++node)
    if (point_of_node_[node] >= 0)
      node_of_point_[static_cast<std::size_t>(point_of_node_[node])] = static_cast<int>(node);
  const std::size_t points = node_of_point_.size();
  snapshot_.points.resize(3 * points);
  snapshot_.point_fields = {field("displacement", 3, points, Storage::double_precision),
                            field("velocity", 3, points)};
  if (!model.contacts.empty()) snapshot_.point_fields.push_back(field("contact_force", 3, points));
  if (has_ids(model)) snapshot_.point_fields.push_back(field("node_id", 1, points, Storage::integer, true));
  add_cell_fields(model, variables);
  take_topology(model);
  fill_points(model);
  if (has_ids(model)) fill_node_ids(model);
  reference_ = snapshot_.points;
}

void FieldObserver::add_cell_field(std::string_view name, CellSource source) {
  const auto is_there = [&](const FieldArray& known) { return known.name == name; };
  if (std::ranges::any_of(snapshot_.cell_fields, is_there)) return;
  const bool fixed = source.kind == CellSource::Kind::part || source.kind == CellSource::Kind::element;
  snapshot_.cell_fields.push_back(field(std::string(name), source.kind == CellSource::Kind::stress ? 6 : 1, 0,
                                        fixed ? Storage::integer : Storage::single_precision, fixed));
  cell_source_.push_back(source);
}

void FieldObserver::add_cell_fields(const Model& model, std::span<const std::string> variables) {
  using Kind = CellSource::Kind;
  const auto add_default = [&] {
    add_cell_field("stress", {Kind::stress});
    add_cell_field("equivalent_plastic_strain", {Kind::history});
  };
  const auto add_default_of_kinds = [&] {
    if (any_has(model, &ElementTraits::has_thickness)) add_cell_field("thickness", {Kind::thickness});
    if (any_has(model, &ElementTraits::has_radius)) add_cell_field("radius", {Kind::radius});
    if (any_has(model, &ElementTraits::has_density)) add_cell_field("density", {Kind::density});
    if (can_be_damaged(model)) add_cell_field("damage", {Kind::history});
  };
  const bool has_default =
      variables.empty() || std::ranges::find(variables, default_group) != variables.end();
  if (has_default) add_default();
  add_cell_field("part", {Kind::part});
  add_cell_field("element_id", {Kind::element});
  if (has_default) add_default_of_kinds();
  for (const std::string& name : variables) {
    if (name == default_group) continue;
    const auto derived = std::ranges::find(derived_variables(), name, &DerivedVariable::name);
    if (derived != derived_variables().end())
      add_cell_field(name, {Kind::derived, derived->value});
    else
      add_cell_field(name, {Kind::history});
  }
}

// Cells of the elements that live, by part and element.
void FieldObserver::take_topology(const Model& model) {
  Topology& topology = snapshot_.topology;
  topology = {};
  for (const PartInModel& part : model.parts) {
    const Block& block = model.blocks[part.block];
    const RigidBody* rigid =
        part.rigid >= 0 ? &model.rigid.body[static_cast<std::size_t>(part.rigid)] : nullptr;
    const int corners = rigid != nullptr ? rigid->nodes_per_element : nodes_per_element(block.element);
    const CellType cell = rigid != nullptr ? cell_with(corners) : traits_of(block.element).cell;
    for (std::size_t e = 0; e < part.element_slot.size(); ++e) {
      if (part.element_slot[e] < 0 && rigid == nullptr) continue;
      topology.cell_type.push_back(cell);
      topology.offset.push_back(static_cast<std::int64_t>(topology.connectivity.size()));
      for (int corner = 0; corner < corners; ++corner) {
        const std::size_t entry = e * static_cast<std::size_t>(corners) + static_cast<std::size_t>(corner);
        const int node = rigid != nullptr
                             ? rigid->connectivity[entry]
                             : block.node(static_cast<std::size_t>(part.element_slot[e]), corner);
        topology.connectivity.push_back(point_of_node_[static_cast<std::size_t>(node)]);
      }
    }
  }
  topology.offset.push_back(static_cast<std::int64_t>(topology.connectivity.size()));
  for (FieldArray& cell_field : snapshot_.cell_fields)
    cell_field.values.resize(static_cast<std::size_t>(cell_field.components) * topology.cell_type.size());
  deleted_ = deleted_so_far(model);
}

void FieldObserver::follow(const Model& model) {
  const std::int64_t deleted_then = deleted_;
  take_topology(model);
  deleted_ = deleted_then;
}

void FieldObserver::fill_points(const Model& model) {
  for (std::size_t p = 0; p < node_of_point_.size(); ++p) {
    const NodeRecord& record = model.nodes.record[static_cast<std::size_t>(node_of_point_[p])];
    for (std::size_t i = 0; i < 3; ++i) snapshot_.points[3 * p + i] = record.position[i];
  }
}

// A node that parts share has its number in the first of them.
void FieldObserver::fill_node_ids(const Model& model) {
  std::vector<double>& values = snapshot_.point_fields.back().values;
  std::vector<bool> is_known(values.size());
  for (const PartInModel& part : model.parts)
    for (std::size_t i = 0; i < part.node.size(); ++i) {
      const auto point = static_cast<std::size_t>(point_of_node_[static_cast<std::size_t>(part.node[i])]);
      if (!is_known[point]) values[point] = static_cast<double>(part.number_of_node(i));
      is_known[point] = true;
    }
}

// Impulse of contact over the step, by the step: the mean force.
void FieldObserver::fill_contact_force(const Model& model) {
  std::vector<double>& values = snapshot_.point_fields[2].values;
  for (std::size_t p = 0; p < node_of_point_.size(); ++p) {
    for (std::size_t i = 0; i < 3; ++i) values[3 * p + i] = 0;
    for (const ContactScene& scene : model.contacts) {
      const int slave = scene.surface.slave(node_of_point_[p]);
      if (slave < 0) continue;
      const Eigen::Vector3d impulse = scene.normal_impulse[static_cast<std::size_t>(slave)] +
                                      scene.friction_impulse[static_cast<std::size_t>(slave)];
      for (std::size_t i = 0; i < 3; ++i)
        values[3 * p + i] += impulse[static_cast<Eigen::Index>(i)] / model.times.mean();
    }
  }
}

void FieldObserver::fill_cell(const CellSource& source, const ElementSample& sample, const Cell& at,
                              FieldArray& field) {
  using Kind = CellSource::Kind;
  const auto value = [&] {
    switch (source.kind) {
      case Kind::part:
        return static_cast<double>(at.part);
      case Kind::element:
        return static_cast<double>(at.element);
      case Kind::derived:
        return source.derived(sample);
      case Kind::thickness:
        return sample.thickness;
      case Kind::radius:
        return sample.radius;
      case Kind::density:
        return sample.density;
      default:
        return sample.named(field.name);
    }
  };
  if (source.kind != Kind::stress) {
    field.values[at.number] = value();
    return;
  }
  const SymmetricTensor<double>& s = sample.stress;
  std::ranges::copy(std::array{s.xx, s.yy, s.zz, s.xy, s.yz, s.xz}, &field.values[6 * at.number]);
}

void FieldObserver::fill_cells(const Model& model) {
  std::size_t cell = 0;
  for (std::size_t p = 0; p < model.parts.size(); ++p) {
    const PartInModel& part = model.parts[p];
    for (std::size_t e = 0; e < part.element_slot.size(); ++e) {
      if (part.element_slot[e] < 0 && part.rigid < 0) continue;
      const ElementSample sample = sample_of(model, part, e);
      for (std::size_t k = 0; k < cell_source_.size(); ++k)
        fill_cell(cell_source_[k], sample, {p, part.number_of_element(e), cell}, snapshot_.cell_fields[k]);
      ++cell;
    }
  }
}

const Snapshot& FieldObserver::observe(const Model& model) {
  snapshot_.time = model.times.time;
  snapshot_.step = model.step;
  if (deleted_so_far(model) != deleted_) {
    take_topology(model);
    ++snapshot_.topology_version;
  }
  fill_points(model);
  for (std::size_t i = 0; i < reference_.size(); ++i)
    snapshot_.point_fields[0].values[i] = snapshot_.points[i] - reference_[i];
  for (std::size_t p = 0; p < node_of_point_.size(); ++p)
    for (std::size_t i = 0; i < 3; ++i)
      snapshot_.point_fields[1].values[3 * p + i] =
          model.nodes.record[static_cast<std::size_t>(node_of_point_[p])].velocity[i];
  if (!model.contacts.empty()) fill_contact_force(model);
  fill_cells(model);
  return snapshot_;
}

std::vector<std::string> history_columns(const Model& model) {
  std::vector<std::string> columns{"time",
                                   "step",
                                   "dt",
                                   "kinetic",
                                   "internal",
                                   "hourglass",
                                   "viscous",
                                   "deleted",
                                   "contact",
                                   "friction",
                                   "external",
                                   "total",
                                   "error_relative",
                                   "contact_added_max",
                                   "momentum_x",
                                   "momentum_y",
                                   "momentum_z",
                                   "angular_momentum_x",
                                   "angular_momentum_y",
                                   "angular_momentum_z",
                                   "linear_imbalance",
                                   "angular_imbalance",
                                   "support_impulse_x",
                                   "support_impulse_y",
                                   "support_impulse_z",
                                   "wall_impulse_x",
                                   "wall_impulse_y",
                                   "wall_impulse_z",
                                   "deleted_elements"};
  for (std::size_t p = 0; p < std::min(model.parts.size(), most_parts_in_history); ++p)
    for (const char* axis : {".velocity_x", ".velocity_y", ".velocity_z"})
      columns.push_back(model.parts[p].name + axis);
  if (model.added_mass) columns.emplace_back("added_mass");
  if (model.contact_audits) columns.insert(columns.end(), {"missed_contacts", "crossings"});
  if (model.erosion)
    for (const auto cause : deletion_causes) columns.push_back("deleted_by_" + std::string(cause));
  add_columns(model.probes, columns);
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
  if (model.forces) add_values(*model.forces, row);
}

std::vector<std::string> active_features(const Model& model) {
  std::set<std::string> features;
  for (const Block& block : model.blocks) {
    features.insert(std::string(name_of(block.element)));
    if (std::holds_alternative<Rigid>(block.element)) continue;
    features.insert(std::string(name_of(block.material)));
    if (block.precision == Precision::single_precision) features.insert("float");
  }
  for (const ActiveLoad& load : model.loads)
    features.insert(std::array{"gravity", "nodal_force", "pressure"}[load.load.index()]);
  if (!model.merged.empty()) features.insert("merged_nodes");
  if (!model.ties.empty()) features.insert("ties");
  if (!model.prescribed.empty()) features.insert("prescribed_motion");
  if (!model.walls.empty()) features.insert("rigid_wall");
  if (!model.contacts.empty()) features.insert("contact");
  if (can_be_damaged(model)) features.insert("failure");
  if (model.erosion) features.insert("deletion");
  if (model.added_mass) features.insert("mass_scaling");
  return {features.begin(), features.end()};
}

namespace {

Summary::DeepestContact described(const AuditPlace& place, double time, const Model& model) {
  const std::vector<std::string>& name = model.contacts.front().surface.part_name;
  const auto part = [&](int number) { return number < 0 ? "" : name[static_cast<std::size_t>(number)]; };
  return {.depth = place.depth,
          .time = time,
          .node = points_of_nodes(model)[static_cast<std::size_t>(place.node)],
          .parts = {part(place.part[0]), part(place.part[1])}};
}

Summary::ContactAudits summary_of(const ContactAudits& audits, const Model& model) {
  const Audit& found = audits.found;
  Summary::ContactAudits summary{.audited_dumps = audits.dumps,
                                 .crossed_dumps = audits.crossed_dumps,
                                 .crossings = found.crossings,
                                 .deep_crossings = found.deep_crossings,
                                 .too_close = found.too_close,
                                 .swallowed = found.swallowed,
                                 .deepest_crossing = {},
                                 .deepest_too_close = {}};
  if (found.deepest_crossing.node >= 0)
    summary.deepest_crossing = described(found.deepest_crossing, audits.time_of_deepest_crossing, model);
  if (found.deepest_too_close.node >= 0)
    summary.deepest_too_close = described(found.deepest_too_close, audits.time_of_deepest_too_close, model);
  return summary;
}

}  // namespace

Summary observe_end(Model& model) {
  balance_momentum(model);
  Summary summary;
  summary.steps = model.step;
  summary.time = model.times.time;
  summary.dt = {model.control.least, model.control.largest, model.times.previous};
  summary.nodes = static_cast<std::int64_t>(model.nodes.size());
  double rigid_mass = 0;
  for (const PartInModel& part : model.parts) {
    summary.mass.start += part.mass;
    if (part.rigid >= 0) {
      rigid_mass += part.mass;
      continue;
    }
    const std::string_view kind = traits_of(model.blocks[part.block].element).summary_key;
    summary.elements[kind] += static_cast<std::int64_t>(part.element_slot.size());
    if (model.erosion) summary.deleted[kind] += model.erosion->deleted_count[part.block];
  }
  summary.mass.intact = summary.mass.start;
  if (model.added_mass) summary.mass.intact += model.added_mass->total();
  if (model.erosion) {
    const MassBalance balance = mass_balance(*model.erosion, model.nodes);
    summary.mass.intact = rigid_mass + balance.intact;
    summary.mass.debris = balance.debris;
    summary.mass.deleted = model.erosion->dropped_mass;
    summary.mass.of_deleted_elements = model.erosion->mass_of_deleted;
    summary.deleted_by_cause = model.erosion->deleted_by_cause;
  }
  const EnergyBalance& energy = model.energy;
  summary.energy = {.kinetic = energy.kinetic,
                    .internal = energy.internal,
                    .hourglass = energy.hourglass,
                    .viscous = energy.all_viscous(),
                    .contact = -energy.contact.at_step(),
                    .friction = -energy.friction.at_step(),
                    .external = energy.external.at_step(),
                    .deleted = energy.deleted,
                    .total_start = energy.kinetic_start,
                    .error_relative = energy.relative_error()};
  const std::size_t part = part_of_largest_ratio(model.part_energy);
  if (const double ratio = model.part_energy[part].largest_ratio; ratio > 0)
    summary.hourglass_ratio_max = {ratio, model.parts[part].name, model.part_energy[part].time_of_largest};
  summary.momentum = {model.momentum.now.linear, model.momentum.now.angular};
  for (const ContactScene& scene : model.contacts) {
    const SearchCounts& counts = scene.pairs.counts;
    const ContactTotals& totals = scene.totals;
    const std::uint64_t settled = scene.guard.certified + scene.guard.renewed;
    const std::uint64_t looks = settled + scene.guard.checked;
    const auto share = [](std::uint64_t count, std::uint64_t whole) {
      return whole > 0 ? static_cast<double>(count) / static_cast<double>(whole) : 0;
    };
    summary.contact = {.searches = static_cast<std::int64_t>(scene.pairs.searches()),
                       .comparisons = static_cast<std::int64_t>(counts.comparisons),
                       .candidate_pairs = static_cast<std::int64_t>(counts.candidate_pairs),
                       .active_max = totals.most_contacts,
                       .penetration_max = totals.deepest_overlap,
                       .missed = 0,
                       .audits = {},
                       .bodies = scene.surface.body_count,
                       .constraints_total = static_cast<std::int64_t>(totals.contacts),
                       .passes_mean = share(totals.passes, totals.steps),
                       .certified_share = share(settled, looks),
                       .last_resort_uses = static_cast<std::int64_t>(scene.zones),
                       .unresolved = static_cast<std::int64_t>(scene.unresolved.steps)};
  }
  if (model.contact_audits) {
    summary.contact.missed = model.contact_audits->found.missed();
    summary.contact.audits = summary_of(*model.contact_audits, model);
  }
  if (model.added_mass) {
    const AddedMass& mass = *model.added_mass;
    Summary::MassScaling& scaling = summary.mass_scaling.emplace(Summary::MassScaling{});
    scaling = {.added = mass.total(), .share = mass.share(), .parts = {}};
    for (std::size_t p = 0; p < model.parts.size(); ++p)
      if (mass.added[p] > 0) scaling.parts[model.parts[p].name] = mass.added[p];
  }
  if (!model.ties.found.empty()) {
    Summary::TieCounts& ties = summary.ties.emplace(Summary::TieCounts{});
    for (const TiedParts& found : model.ties.found) ties.nodes += found.count;
    ties.released = model.ties.released;
  }
  for (std::size_t stage = 0; stage < stage_names.size(); ++stage)
    if (model.stages.seconds[stage] > 0)
      summary.wall_s.by_stage[std::string(stage_names[stage])] = model.stages.seconds[stage];
  summary.active_features = active_features(model);
  return summary;
}

}  // namespace brio
