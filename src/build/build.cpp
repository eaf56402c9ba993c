#include "src/build/build.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "elements/base/bad_element.hpp"
#include "src/base/index.hpp"
#include "src/build/build_loads.hpp"
#include "src/build/build_rigid.hpp"
#include "src/build/build_ties.hpp"
#include "src/build/contact_thickness.hpp"
#include "src/build/merge.hpp"
#include "src/build/refused_motions.hpp"
#include "src/build/wall_overlap.hpp"
#include "src/deck/part_index.hpp"
#include "src/domains/node_ranges.hpp"
#include "src/initial/initial_state.hpp"
#include "src/model/part_damping.hpp"
#include "src/model/start_balances.hpp"
#include "src/sweep/particles.hpp"

namespace brio {

bool is_in_contact(const Deck& deck, const std::string& part) {
  if (!deck.contact) return false;
  const auto named = [&](const std::vector<std::string>& list) {
    return std::find(list.begin(), list.end(), part) != list.end();
  };
  return (deck.contact->surfaces.empty() || named(deck.contact->surfaces)) && !named(deck.contact->exclude);
}

namespace {

const Material& law_of(const Part& part, const Deck& deck) {
  if (const Material* material = material_of(deck, part)) return *material;
  throw BuildError("part '" + part.name + "': no material is named '" + part.material + "'", part.place);
}

// Elements in memory order, with nodes numbered in the order in which those elements first touch them.
// \return the number of nodes.
std::size_t place_parts(const Deck& deck, std::span<const Mesh> meshes, const SharedNodes& shared,
                        Model& model, std::vector<std::vector<int>>& connectivity) {
  int next = 0;
  std::size_t offset = 0;  // of the part among the nodes of all meshes
  std::vector<int> number(shared.same_as.size(), -1);
  const auto number_of = [&](std::size_t node) {
    if (shared.same_as.empty()) return next++;
    int& found = number[shared.same_as[offset + node]];
    if (found < 0) found = next++;
    return found;
  };
  for (std::size_t p = 0; p < deck.parts.size(); ++p) {
    const Mesh& mesh = meshes[p];
    const auto corners = index(mesh.nodes_per_element);
    PartInModel part;
    part.name = deck.parts[p].name;
    part.block = p;
    part.element_order = locality_order(mesh.position, mesh.connectivity, mesh.nodes_per_element);
    part.element_slot.resize(part.element_order.size());
    part.node.assign(mesh.position.size(), -1);
    part.node_id = mesh.node_id;
    part.element_id = mesh.element_id;
    std::vector<int> nodes;
    for (std::size_t slot = 0; slot < part.element_order.size(); ++slot) {
      const auto e = index(part.element_order[slot]);
      part.element_slot[e] = static_cast<int>(slot);
      for (std::size_t corner = 0; corner < corners; ++corner) {
        const auto corner_node = index(mesh.connectivity[e * corners + corner]);
        int& node = part.node[corner_node];
        if (node < 0) node = number_of(corner_node);
        nodes.push_back(node);
      }
    }
    for (int node : part.node)
      if (node < 0)
        throw BuildError("part '" + part.name + "' has a node that belongs to no element",
                         deck.parts[p].place);
    connectivity.push_back(std::move(nodes));
    model.part_number.emplace(part.name, p);
    model.parts.push_back(std::move(part));
    offset += mesh.position.size();
  }
  return index(next);
}

// Generated meshes go on after the largest numbers of mesh files, in the order of the deck.
void number_generated(std::vector<PartInModel>& parts) {
  std::int64_t next_node = 0, next_element = 0;
  for (const PartInModel& part : parts) {
    for (const std::int64_t id : part.node_id) next_node = std::max(next_node, id + 1);
    for (const std::int64_t id : part.element_id) next_element = std::max(next_element, id + 1);
  }
  for (PartInModel& part : parts) {
    if (part.node_id.empty()) {
      part.first_node = next_node;
      next_node += static_cast<std::int64_t>(part.node.size());
    }
    if (part.element_id.empty()) {
      part.first_element = next_element;
      next_element += static_cast<std::int64_t>(part.element_order.size());
    }
  }
}

void fill_nodes(const Deck& deck, std::span<const Mesh> meshes, const SharedNodes& shared, std::size_t count,
                Model& model) {
  const bool turning = std::any_of(deck.parts.begin(), deck.parts.end(),
                                   [](const Part& part) { return has_rotations(part.element); });
  model.nodes = Nodes(count, turning);
  std::size_t offset = 0;
  for (std::size_t p = 0; p < meshes.size(); ++p) {
    for (std::size_t i = 0; i < meshes[p].position.size(); ++i) {
      if (!shared.same_as.empty() && shared.same_as[offset + i] != offset + i) continue;
      for (std::size_t axis = 0; axis < 3; ++axis)
        model.nodes.record[index(model.parts[p].node[i])].position[axis] = meshes[p].position[i][axis];
    }
    offset += meshes[p].position.size();
  }
}

void make_blocks(const Deck& deck, const std::vector<std::vector<int>>& connectivity, Model& model) {
  for (std::size_t p = 0; p < deck.parts.size(); ++p) {
    const Part& part = deck.parts[p];
    if (std::holds_alternative<Rigid>(part.element)) {
      Block& nothing = model.blocks.emplace_back();
      nothing.part = part.name;
      nothing.element = part.element;
      continue;
    }
    try {
      model.blocks.push_back(make_block(part.name, part.element, law_of(part, deck), deck.numerics.precision,
                                        connectivity[p], part.deletion));
    } catch (const std::invalid_argument& fault) {
      throw BuildError("part '" + part.name + "': " + fault.what(), part.place);
    }
  }
}

// By place in the block.
std::vector<double> particle_volumes(const Mesh& mesh, const PartInModel& part) {
  std::vector<double> volume;
  for (const int e : part.element_order) volume.push_back(mesh.volume[index(e)]);
  return volume;
}

void add_point_masses(const Deck& deck, std::span<const Mesh> meshes, Model& model) {
  for (const PointMass& point : deck.point_masses)
    for (const int entry : select_nodes(point.where, deck, meshes, model)) {
      double& mass = model.nodes.mass[index(entry)];
      if (!(mass > 0))
        throw BuildError("a point mass on a node of a rigid part; accepted are nodes of parts that deform",
                         point.where.place);
      mass += point.mass;
    }
}

void start_elements(const Deck& deck, std::span<const Mesh> meshes, int threads, Model& model) {
  Nodes& nodes = model.nodes;
  const AtReference at_reference(meshes, model);
  for (std::size_t p = 0; p < model.blocks.size(); ++p) {
    if (model.parts[p].rigid >= 0) continue;
    try {
      if (!meshes[p].volume.empty()) {
        ThreadTeam team(threads);
        find_neighbours(model.blocks[p], particle_volumes(meshes[p], model.parts[p]), nodes, team);
      }
      model.blocks[p].kernel.initialize(model.blocks[p], nodes);
    } catch (const BadElement& fault) {
      const PartInModel& part = model.parts[p];
      const auto element = index(part.element_order[fault.place]);
      throw BuildError("element " + std::to_string(part.number_of_element(element)) + " of part '" +
                           part.name + "' " + fault.rule,
                       deck.parts[p].place);
    } catch (const std::invalid_argument& fault) {
      throw BuildError(fault.what(), deck.parts[p].place);
    }
  }
}

void lump_masses(const Deck& deck, std::span<const Mesh> meshes, int threads, Model& model) {
  Nodes& nodes = model.nodes;
  start_elements(deck, meshes, threads, model);
  for (PartInModel& part : model.parts) {
    const Block& block = model.blocks[part.block];
    for (std::size_t e = 0; e < block.element_count; ++e) part.mass += block.kernel.mass(block, e);
  }
  for (const RigidBody& body : model.rigid.body) model.parts[body.part].mass = body.own.mass;
  add_point_masses(deck, meshes, model);
  join_masses(model);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    nodes.record[i].inverse_mass = nodes.mass[i] > 0 ? 1 / nodes.mass[i] : 0;
    if (nodes.has_rotations())
      nodes.angular_velocity[i].component[3] =
          nodes.rotational_inertia[i] > 0 ? 1 / nodes.rotational_inertia[i] : 0;
  }
}

// Nodes of elements that are joined to rigid parts, also where those are not in contact.
void mark_joined(const Model& model, Surface& surface) {
  if (model.rigid.has_joints()) surface.rigid_of_node.resize(model.nodes.size(), -1);
  for (std::size_t b = 0; b < model.rigid.body.size(); ++b)
    for (const std::size_t i : model.rigid.body[b].joint)
      surface.rigid_of_node[index(model.rigid.body[b].node[i])] = static_cast<int>(b);
}

double debris_radius(const Part& part) {
  return part.deletion ? part.deletion->debris_radius.value_or(0) : 0;
}

void check_debris_in_contact(const Deck& deck) {
  for (const Part& part : deck.parts)
    if (debris_radius(part) > 0 && !is_in_contact(deck, part.name))
      throw BuildError(
          "part '" + part.name + "' has a debris_radius but is not in contact; accepted are parts that are",
          part.place);
}

std::vector<PairRule> pair_rules(const ContactSection& contact, std::span<const SurfacePart> parts) {
  const auto number = [&](const std::string& name, const ContactPair& pair) {
    const auto found =
        std::find_if(parts.begin(), parts.end(), [&](const SurfacePart& part) { return part.name == name; });
    if (found == parts.end())
      throw BuildError(
          "a pair of contact names part '" + name + "', which is not in contact; accepted are parts that are",
          pair.place);
    return static_cast<int>(found - parts.begin());
  };
  std::vector<PairRule> rules;
  for (const ContactPair& pair : contact.pairs)
    rules.push_back({.part = {number(pair.parts[0], pair), number(pair.parts[1], pair)},
                     .friction = pair.friction,
                     .touch = pair.touch});
  return rules;
}

// Elements start as they are after nodes were moved out of overlaps; mass and inertia of rigid bodies stay.
void follow_moved_nodes(const Deck& deck, std::span<const Mesh> meshes, int threads, Model& model) {
  Nodes& nodes = model.nodes;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    nodes.mass[i] = 0;
    if (nodes.has_rotations()) nodes.rotational_inertia[i] = 0;
  }
  for (PartInModel& part : model.parts) part.mass = 0;
  lump_masses(deck, meshes, threads, model);
  measure_arms(model);
}

// Small initial overlaps are removed by moving nodes; elements that are broken were named before.
void make_contact(const Deck& deck, std::span<const Mesh> meshes,
                  const std::vector<std::vector<int>>& connectivity, int threads, Model& model) {
  check_debris_in_contact(deck);
  if (!deck.contact) return;
  std::vector<SurfacePart> surfaces;
  std::vector<int> part_of_surface(deck.parts.size(), -1);
  if (can_erode(model.blocks))
    model.surface_numbers = {.part = std::vector<int>(deck.parts.size(), -1),
                             .element = std::vector<std::vector<int>>(deck.parts.size()),
                             .deleted = {}};
  for (std::size_t p = 0; p < deck.parts.size(); ++p) {
    const Part& part = deck.parts[p];
    if (!is_in_contact(deck, part.name)) continue;
    part_of_surface[p] = static_cast<int>(surfaces.size());
    if (model.surface_numbers) {
      model.surface_numbers->part[p] = part_of_surface[p];
      model.surface_numbers->element[p] = model.parts[p].element_slot;
    }
    surfaces.push_back({.name = part.name,
                        .nodes_per_element = meshes[p].nodes_per_element,
                        .connectivity = connectivity[p],
                        .thickness = contact_thickness(part, meshes[p]),
                        .rigid = model.parts[p].rigid,
                        .debris_radius = debris_radius(part)});
  }
  try {
    model.contacts.push_back(make_contact_scene(deck.contact->options, surfaces, model.nodes));
    mark_joined(model, model.contacts.back().surface);
    if (deck.contact->options.audit) model.contact_audits.emplace();
    const std::vector<PairRule> rules = pair_rules(*deck.contact, surfaces);
    if (!rules.empty()) model.contacts.back().surface.pairs = {rules, surfaces, model.nodes.size()};
    const Ties lasting = ties_that_last(model.ties);
    if (!lasting.empty() || !lasting.joined.empty())
      exclude_tied_pairs(model.contacts.back(), lasting, part_of_surface);
    if (model.surface_numbers) make_erodible(model.contacts.back(), surfaces, model.nodes);
    ThreadTeam team(threads);
    for (InitialOverlap& overlap : make_initial_gap(model.contacts.back(), model.nodes, team))
      model.initial_overlaps.push_back(std::move(overlap));
    if (lasting.node.size() < model.ties.node.size()) {
      tie_again(model);
      exclude_tied_pairs(model.contacts.back(), model.ties, part_of_surface);
    }
  } catch (const std::invalid_argument& fault) {
    throw BuildError(fault.what(), deck.contact->place);
  } catch (const std::length_error& fault) {
    throw BuildError(fault.what(), deck.contact->place);
  }
}

}  // namespace

void cut_domains(Model& model, std::size_t least_elements) {
  model.schedule = make_schedule(model.blocks, model.nodes.size(), least_elements);
  model.nodes.ranges = cut_ranges(model.nodes.size(), nodes_of_domains(model.schedule.pieces, model.blocks));
  model.sweep_results.resize(model.schedule.tasks.size());
}

Model build(const Deck& deck, std::span<const Mesh> meshes, int threads, std::span<const PartState> states) {
  Model model;
  std::vector<std::vector<int>> connectivity;
  SharedNodes shared = share_nodes(deck, meshes);
  const std::size_t node_count = place_parts(deck, meshes, shared, model, connectivity);
  number_generated(model.parts);
  fill_nodes(deck, meshes, shared, node_count, model);
  model.merged = std::move(shared.merged);
  make_blocks(deck, connectivity, model);
  make_rigid_bodies(deck, meshes, model);
  join_nodes(model);
  constrain(deck, meshes, model);
  model.initial_overlaps = remove_overlap_with_walls(
      meshes, (deck.contact ? deck.contact->options : ContactOptions{}).initial_overlap_limit, model);
  make_ties(deck, meshes, connectivity, model);
  if (!model.ties.joined.empty()) join_nodes(model);
  release_joined(model);
  lump_masses(deck, meshes, threads, model);
  const std::size_t of_walls = model.initial_overlaps.size();
  make_contact(deck, meshes, connectivity, threads, model);
  if (model.initial_overlaps.size() > of_walls) follow_moved_nodes(deck, meshes, threads, model);
  model.damping = damping_of_parts(deck, model);
  if (!model.ties.empty()) condense(model.ties, model.nodes);
  set_states(states, model);
  expect_nothing_behind_walls(meshes, model);
  for (std::size_t b = 0; b < model.blocks.size(); ++b)
    if (model.blocks[b].cloud && model.blocks[b].cloud->is_eulerian())
      model.particle_searches.push_back({.block = b});
  cut_domains(model);
  if (can_erode(model.blocks)) model.erosion = make_erosion(model.blocks, model.nodes.size());
  model.part_energy.resize(model.blocks.size());
  model.hourglass_warning = deck.numerics.hourglass_warning;
  model.control.settings = deck.time;
  if (deck.time.mass_scaling)
    model.added_mass = make_mass_scaling(deck.time, deck, model.blocks, model.parts);
  set_initial_velocities(deck, meshes, states, model);
  start_ties(model);
  start_rigid_bodies(deck, meshes, model);
  refuse_contradictory_motions(model);
  refuse_motions_through_walls(model);
  make_loads(deck, meshes, model);
  model.extent = scene_extent(model.nodes);
  model.assembled_step = make_assembled_step(deck.time, bounds_assembled_step(model), model.blocks,
                                             model.nodes, model.extent.width);
  start_balances(model);
  add_energies(states, model);
  make_springs(deck, meshes, model);
  prepare_output(deck, model);
  return model;
}

}  // namespace brio
