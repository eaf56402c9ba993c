#include "src/output/observe.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <limits>

#include "elements/element_state.hpp"
#include "src/base/index.hpp"
#include "src/fields/strain.hpp"
#include "src/output/result_order.hpp"

namespace brio {

namespace {

constexpr std::size_t points_per_range = 2048, elements_per_range = 256;

FieldArray field(std::string name, int components, std::size_t count,
                 Storage storage = Storage::single_precision, bool fixed = false) {
  return {std::move(name), components, std::vector<double>(index(components) * count), storage, fixed};
}

/// Whether any kind of element has that trait.
bool any_has(const Model& model, bool ElementTraits::*trait) {
  return std::any_of(model.blocks.begin(), model.blocks.end(),
                     [&](const Block& block) { return traits_of(block.element).*trait; });
}

// Nothing is strained in a rigid part.
ElementSample sample_of(const Model& model, const PartInModel& part, std::size_t element, bool in_full) {
  if (part.rigid >= 0) {
    ElementSample sample{};
    const double thickness = model.rigid.body[index(part.rigid)].thickness;
    if (thickness > 0) sample.thickness = thickness;
    return sample;
  }
  const Block& block = model.blocks[part.block];
  return block.kernel.sample(block, model.nodes, index(part.element_slot[element]), in_full);
}

bool is_of_points(std::string_view name) {
  return name == rotation_variable().name ||
         std::ranges::find(contact_variables(), name, &PointVariable::name) != contact_variables().end();
}

bool has_ids(const Model& model) {
  return std::any_of(model.parts.begin(), model.parts.end(),
                     [](const PartInModel& part) { return !part.node_id.empty(); });
}

}  // namespace

FieldObserver::FieldObserver(const Model& model, std::span<const std::string> variables)
    : point_of_node_(points_of_nodes(model)) {
  node_of_point_.resize(model.nodes.size() - index(std::ranges::count(point_of_node_, std::int64_t{-1})));
  for (std::size_t node = 0; node < point_of_node_.size(); ++node)
    if (point_of_node_[node] >= 0) node_of_point_[index(point_of_node_[node])] = static_cast<int>(node);
  snapshot_->points.resize(3 * node_of_point_.size());
  add_point_fields(model, variables);
  if (std::ranges::find(variables, state_variable) != variables.end()) add_state(model);
  add_cell_fields(model, variables);
  note_parts(model);
  deleted_ = deleted_so_far(model);
  take_topology(model);
  take_positions(model, 0, node_of_point_.size(), 0);
  reference_ = snapshot_->points;
}

template <class Value>
void FieldObserver::add_point_field(FieldArray field, Value value) {
  const auto components = index(field.components);
  snapshot_->point_fields.push_back(std::move(field));
  point_values_.push_back([=](const Model& model, std::size_t begin, std::size_t end, double* values) {
    for (std::size_t point = begin; point < end; ++point) value(model, point, values + components * point);
  });
}

void FieldObserver::add_point_variable(const PointVariable& variable) {
  FieldArray added = field(std::string(variable.name), variable.components, node_of_point_.size());
  added.is_partial = variable.is_partial;
  add_point_field(std::move(added), [&variable, this](const Model& model, std::size_t point, double* out) {
    variable.values(model, node_of_point_[point], out);
  });
}

void FieldObserver::add_point_fields(const Model& model, std::span<const std::string> variables) {
  const std::size_t points = node_of_point_.size();
  add_point_field(field("displacement", 3, points, Storage::double_precision),
                  [this](const Model&, std::size_t point, double* out) {
                    for (std::size_t i = 3 * point; i < 3 * point + 3; ++i)
                      *out++ = snapshot_->points[i] - reference_[i];
                  });
  // With the state of elements, from which runs can start, of every digit.
  const bool with_state = std::ranges::find(variables, state_variable) != variables.end();
  add_point_field(
      field("velocity", 3, points, with_state ? Storage::double_precision : Storage::single_precision),
      [this](const Model& now, std::size_t point, double* out) {
        std::copy_n(now.nodes.record[index(node_of_point_[point])].velocity, 3, out);
      });
  if (with_state && model.nodes.has_rotations())
    add_point_field(field("angular_velocity", 3, points, Storage::double_precision),
                    [this](const Model& now, std::size_t point, double* out) {
                      const auto node = index(node_of_point_[point]);
                      std::copy_n(now.nodes.angular_velocity[node].component, 3, out);
                    });
  if (!model.contacts.empty()) {
    add_point_variable(contact_force_variable());
    for (const PointVariable& variable : contact_variables())
      if (std::ranges::find(variables, variable.name) != variables.end()) add_point_variable(variable);
  }
  if (!model.rotations.empty()) add_point_variable(rotation_variable());
  if (!has_ids(model)) return;
  number_points(model);
  add_point_field(field("node_id", 1, points, Storage::integer, true),
                  [this](const Model&, std::size_t point, double* out) { *out = point_number_[point]; });
}

void FieldObserver::add_cell_field(std::string_view name, CellSource source) {
  const auto is_there = [&](const FieldArray& known) { return known.name == name; };
  if (std::ranges::any_of(snapshot_->cell_fields, is_there)) return;
  const bool fixed = source.kind == CellSource::Kind::part || source.kind == CellSource::Kind::element;
  const int components = source.variable != nullptr ? source.variable->components : 1;
  snapshot_->cell_fields.push_back(
      field(std::string(name), components, 0, fixed ? Storage::integer : Storage::single_precision, fixed));
  // Without plasticity there is no plastic strain, and without failure no damage: 0. Of what other laws alone
  // know, not a number.
  snapshot_->cell_fields.back().is_partial =
      source.variable != nullptr
          ? source.variable->is_partial()
          : source.kind == CellSource::Kind::history &&
                std::ranges::find(default_fields(), name, &DefaultField::name) == default_fields().end();
  cell_source_.push_back(source);
}

void FieldObserver::add_cell_fields(const Model& model, std::span<const std::string> variables) {
  using Kind = CellSource::Kind;
  const auto add_variable = [&](std::string_view name) {
    const CellVariable& variable = cell_variable(name);
    const Kind of_nodes = name == "strain_rate" ? Kind::strain_rate : Kind::strain;
    add_cell_field(name, {variable.values == nullptr ? of_nodes : Kind::variable, &variable});
    if (name == "strain") note_thickness(model);
  };
  const bool has_default =
      variables.empty() || std::ranges::find(variables, default_group) != variables.end();
  if (has_default) add_variable("stress");
  if (has_default) add_cell_field("equivalent_plastic_strain", {Kind::history});
  add_cell_field("part", {Kind::part});
  add_cell_field("element_id", {Kind::element});
  if (has_default) {
    if (any_has(model, &ElementTraits::has_thickness)) add_variable("thickness");
    if (any_has(model, &ElementTraits::has_radius)) add_variable("radius");
    if (any_has(model, &ElementTraits::has_density)) add_variable("density");
    if (can_be_damaged(model)) add_cell_field("damage", {Kind::history});
  }
  for (const std::string& name : variables) {
    if (name == default_group || name == state_variable || is_of_points(name)) continue;
    if (std::ranges::find(chosen_variables(), name, &CellVariable::name) != chosen_variables().end()) {
      add_variable(name);
      in_full_ = true;
    } else {
      add_cell_field(name, {Kind::history});
    }
  }
}

void FieldObserver::add_state(const Model& model) {
  std::size_t components = 1;
  for (const Block& block : model.blocks) components = std::max(components, state_components(block));
  state_field_ = snapshot_->cell_fields.size();
  snapshot_->cell_fields.push_back(
      field(std::string(state_variable), static_cast<int>(components), 0, Storage::double_precision));
  snapshot_->cell_fields.back().is_partial = true;
  cell_source_.push_back({CellSource::Kind::state});
}

void FieldObserver::note_parts(const Model& model) {
  for (const PartInModel& part : model.parts) {
    std::int64_t first = part.node.empty() ? 0 : std::numeric_limits<std::int64_t>::max(), last = -1;
    for (const int node : part.node) {
      const std::int64_t point = point_of_node_[index(node)];
      first = std::min(first, point);
      last = std::max(last, point);
    }
    snapshot_->parts.push_back({.name = part.name, .first_point = first, .points = last + 1 - first});
  }
}

// Cells of the elements that live, by part and element.
void FieldObserver::take_topology(const Model& model) {
  Topology& topology = snapshot_->topology;
  topology = {};
  range_.clear();
  const auto rigid_of = [&](const PartInModel& part) {
    return part.rigid >= 0 ? &model.rigid.body[index(part.rigid)] : nullptr;
  };
  const auto corners_of = [&](const PartInModel& part) {
    const RigidBody* rigid = rigid_of(part);
    return rigid != nullptr ? rigid->nodes_per_element : nodes_per_element(model.blocks[part.block].element);
  };
  std::size_t most_cells = 0, most_corners = 0;
  for (const PartInModel& part : model.parts) {
    most_cells += part.element_slot.size();
    most_corners += part.element_slot.size() * index(corners_of(part));
  }
  topology.cell_type.reserve(most_cells);
  topology.offset.reserve(most_cells + 1);
  topology.connectivity.reserve(most_corners);
  for (std::size_t p = 0; p < model.parts.size(); ++p) {
    const PartInModel& part = model.parts[p];
    const std::size_t first_cell = topology.cell_type.size();
    const Block& block = model.blocks[part.block];
    const RigidBody* rigid = rigid_of(part);
    const int corners = corners_of(part);
    const CellType cell = rigid != nullptr ? cell_with(corners) : traits_of(block.element).cell;
    for (std::size_t e = 0; e < part.element_slot.size(); ++e) {
      if (e % elements_per_range == 0)
        range_.push_back(
            {p, e, std::min(e + elements_per_range, part.element_slot.size()), topology.cell_type.size()});
      if (part.element_slot[e] < 0 && rigid == nullptr) continue;
      topology.cell_type.push_back(cell);
      topology.offset.push_back(static_cast<std::int64_t>(topology.connectivity.size()));
      for (int corner = 0; corner < corners; ++corner) {
        const std::size_t entry = e * index(corners) + index(corner);
        const int node =
            rigid != nullptr ? rigid->connectivity[entry] : block.node(index(part.element_slot[e]), corner);
        topology.connectivity.push_back(point_of_node_[index(node)]);
      }
    }
    snapshot_->parts[p].first_cell = static_cast<std::int64_t>(first_cell);
    snapshot_->parts[p].cells = static_cast<std::int64_t>(topology.cell_type.size() - first_cell);
  }
  topology.offset.push_back(static_cast<std::int64_t>(topology.connectivity.size()));
  for (FieldArray& cell_field : snapshot_->cell_fields)
    cell_field.values.resize(index(cell_field.components) * topology.cell_type.size());
  snapshot_->topology_version = topology_version_;
  is_topology_new_ = true;
}

void FieldObserver::follow(const Model& model) { take_topology(model); }

void FieldObserver::turn() {
  assert(!is_topology_new_);
  if (!other_) other_ = std::make_unique<Snapshot>(*snapshot_);
  std::swap(snapshot_, other_);
}

void FieldObserver::take_positions(const Model& model, std::size_t begin, std::size_t end, double after) {
  for (std::size_t p = begin; p < end; ++p) {
    const NodeRecord& record = model.nodes.record[index(node_of_point_[p])];
    for (std::size_t i = 0; i < 3; ++i)
      snapshot_->points[3 * p + i] = record.position[i] + after * record.velocity[i];
  }
}

// A node that parts share has its number in the first of them.
void FieldObserver::number_points(const Model& model) {
  point_number_.resize(node_of_point_.size());
  std::vector<bool> is_known(point_number_.size());
  for (const PartInModel& part : model.parts)
    for (std::size_t i = 0; i < part.node.size(); ++i) {
      const auto point = index(point_of_node_[index(part.node[i])]);
      if (!is_known[point]) point_number_[point] = static_cast<double>(part.number_of_node(i));
      is_known[point] = true;
    }
}

void FieldObserver::fill_points(const Model& model, std::size_t begin, std::size_t end) {
  for (std::size_t f = 0; f < point_values_.size(); ++f)
    point_values_[f](model, begin, end, snapshot_->point_fields[f].values.data());
}

void FieldObserver::note_thickness(const Model& model) {
  for (const PartInModel& part : model.parts) {
    std::vector<double>& of_part = thickness_.emplace_back();
    if (part.rigid >= 0 || !traits_of(model.blocks[part.block].element).has_thickness) continue;
    for (std::size_t e = 0; e < part.element_slot.size(); ++e)
      of_part.push_back(sample_of(model, part, e, false).thickness);
  }
}

// Of hexahedra and shells that are not rigid; none of others.
std::span<const std::int64_t> FieldObserver::strained_corners(const Model& model, const Cell& at) const {
  const Topology& topology = snapshot_->topology;
  const auto first = index(topology.offset[at.number]), count = index(topology.offset[at.number + 1]) - first;
  if (count < 4 || model.parts[at.part].rigid >= 0) return {};
  return std::span(topology.connectivity).subspan(first, count);
}

SymmetricTensor<double> FieldObserver::strain_of(const Model& model, const ElementSample& sample,
                                                 const Cell& at) const {
  const std::span<const std::int64_t> corner = strained_corners(model, at);
  if (corner.empty()) return ElementSample::undefined_tensor;
  std::array<Vector3d, 8> before, now;
  for (std::size_t k = 0; k < corner.size(); ++k) {
    const auto point = index(corner[k]);
    before[k] = vector_at(&reference_[3 * point]);
    now[k] = vector_at(&snapshot_->points[3 * point]);
  }
  const std::span<const Vector3d> from(before.data(), corner.size()), to(now.data(), corner.size());
  return logarithmic_strain(
      corner.size() == 4 ? deformation_of_shell(from, to, sample.thickness / thickness_[at.part][at.place])
                         : deformation_of_hexahedron(from, to));
}

// On the shape of the half step, where a rotation by steps of any size strains nothing.
SymmetricTensor<double> FieldObserver::strain_rate_of(const Model& model, const Cell& at) const {
  const std::span<const std::int64_t> corner = strained_corners(model, at);
  if (corner.empty()) return ElementSample::undefined_tensor;
  std::array<Vector3d, 8> now, velocity;
  for (std::size_t k = 0; k < corner.size(); ++k) {
    const auto node = index(node_of_point_[index(corner[k])]);
    const NodeRecord& record = model.nodes.record[node];
    velocity[k] = vector_at(record.velocity);
    now[k] = vector_at(record.position) + 0.5 * model.times.next * velocity[k];
  }
  const std::span<const Vector3d> place(now.data(), corner.size()), rate(velocity.data(), corner.size());
  return corner.size() == 4 ? strain_rate_of_shell(place, rate) : strain_rate_of_hexahedron(place, rate);
}

void FieldObserver::fill_cell(const Model& model, const CellSource& source, const ElementSample& sample,
                              const Cell& at, FieldArray& field) const {
  double* values = &field.values[index(field.components) * at.number];
  switch (source.kind) {
    case CellSource::Kind::part:
      *values = static_cast<double>(at.part);
      return;
    case CellSource::Kind::element:
      *values = static_cast<double>(at.element);
      return;
    case CellSource::Kind::variable:
      source.variable->values(sample, values);
      return;
    case CellSource::Kind::strain:
      write_components(strain_of(model, sample, at), values);
      return;
    case CellSource::Kind::strain_rate:
      write_components(strain_rate_of(model, at), values);
      return;
    case CellSource::Kind::history:
      *values = sample.named(field.name, field.is_partial ? ElementSample::undefined : 0);
      return;
    case CellSource::Kind::state:
      return;  // no sample tells it
  }
}

// Of particles a row is not all: they remember their neighbours.
void FieldObserver::fill_state(const Model& model, const PartInModel& part, std::size_t element,
                               std::size_t cell) {
  FieldArray& field = snapshot_->cell_fields[state_field_];
  const auto components = index(field.components);
  double* row = field.values.data() + cell * components;
  std::fill_n(row, components, ElementSample::undefined);
  const Block& block = model.blocks[part.block];
  if (part.rigid < 0 && !block.cloud) read_state(block, index(part.element_slot[element]), row);
}

void FieldObserver::fill_cells(const Model& model, const ElementRange& range) {
  const PartInModel& part = model.parts[range.part];
  std::size_t cell = range.first_cell;
  for (std::size_t e = range.begin; e < range.end; ++e) {
    if (part.element_slot[e] < 0 && part.rigid < 0) continue;
    const ElementSample sample = sample_of(model, part, e, in_full_);
    for (std::size_t k = 0; k < cell_source_.size(); ++k) {
      FieldArray& field = snapshot_->cell_fields[k];
      if (is_topology_new_ || !field.fixed_by_topology)
        fill_cell(model, cell_source_[k], sample, {range.part, e, part.number_of_element(e), cell}, field);
    }
    if (state_field_ != none) fill_state(model, part, e, cell);
    ++cell;
  }
}

const Snapshot& FieldObserver::observe(const Model& model, double time, ThreadTeam& team) {
  snapshot_->time = state_field_ == none ? time : model.times.time;
  snapshot_->step = model.step;
  if (const std::int64_t deleted = deleted_so_far(model); deleted != deleted_) {
    deleted_ = deleted;
    ++topology_version_;
  }
  if (snapshot_->topology_version != topology_version_) take_topology(model);
  const double after = snapshot_->time - model.times.time;
  team.for_ranges(node_of_point_.size(), points_per_range, [&](std::size_t begin, std::size_t end) {
    take_positions(model, begin, end, after);
    fill_points(model, begin, end);
  });
  team.for_each(range_.size(), [&](std::size_t i) { fill_cells(model, range_[i]); });
  is_topology_new_ = false;
  return *snapshot_;
}

}  // namespace brio
