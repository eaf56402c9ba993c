#include "src/build/build_loads.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "src/build/build.hpp"
#include "src/build/build_rigid.hpp"
#include "src/deck/part_index.hpp"

namespace brio {

using Eigen::Vector3d;

namespace {

// One a part, of those that a set of a mesh file reaches into.
std::vector<PressureLoad> pressures_on(const Pressure& load_entry, const Deck& deck,
                                       std::span<const Mesh> meshes, const Model& model) {
  const std::string& side_set = load_entry.side_set;
  const std::size_t dot_at = side_set.find('.');
  std::vector<PressureLoad> loads;
  for (const std::size_t p : parts_called(side_set.substr(0, dot_at), deck)) {
    if (dot_at == std::string::npos) break;
    const Mesh& mesh = meshes[p];
    const auto found = mesh.side_sets.find(side_set.substr(dot_at + 1));
    if (found == mesh.side_sets.end()) continue;
    const auto corners = static_cast<std::size_t>(mesh.nodes_per_element);
    PressureLoad load{{}, load_entry.pressure, static_cast<int>(p), {}};
    for (const ElementSide& side : found->second) {
      std::array<int, 4> nodes{};
      for (std::size_t k = 0; k < 4; ++k) {
        const int corner =
            corners == 8 ? sides_of_hex[static_cast<std::size_t>(side.side)][k] : static_cast<int>(k);
        const auto entry =
            static_cast<std::size_t>(side.element) * corners + static_cast<std::size_t>(corner);
        nodes[k] = model.parts[p].node[static_cast<std::size_t>(mesh.connectivity[entry])];
      }
      load.sides.push_back(nodes);
      load.element.push_back(side.element);
    }
    loads.push_back(std::move(load));
  }
  if (loads.empty()) throw BuildError("no side set is named '" + side_set + "'", load_entry.place);
  return loads;
}

// To global components, of each node where axes differ.
void turn_to_global(NodalLoad& load, const Deck& deck, const std::string& system, const std::string& place,
                    const Model& model) {
  if (system.empty()) return;
  const Vector components = load.force;
  if (!load.bodies.empty())
    load.force =
        from_components(axes_everywhere(deck, system, "a moment on a rigid part", place), components);
  const std::vector<SystemAxes> axes = axes_at_nodes(deck, system, load.nodes, place, model);
  for (std::size_t k = 0; k < axes.size(); ++k) {
    const bool across = components[0] != 0 || components[1] != 0;
    if (across && is_zero(axes[k][0]))
      refuse_on_axis(model, static_cast<std::size_t>(load.nodes[k]), system, place);
    load.own_force.push_back(from_components(axes[k], components));
  }
  if (std::ranges::adjacent_find(load.own_force, std::not_equal_to<>()) != load.own_force.end()) return;
  if (!load.own_force.empty()) load.force = load.own_force.front();
  load.own_force.clear();
}

NodalLoad force_on(const NodalForce& entry, const Deck& deck, std::span<const Mesh> meshes,
                   const Model& model) {
  NodalLoad load{select_nodes(entry.where, deck, meshes, model), entry.force, entry.factor};
  turn_to_global(load, deck, entry.system, entry.where.place, model);
  return load;
}

GravityLoad gravity_of(const Gravity& entry, const Deck& deck) {
  if (entry.system.empty()) return {entry.acceleration, entry.factor};
  return {from_components(axes_everywhere(deck, entry.system, "gravity", entry.place), entry.acceleration),
          entry.factor};
}

NodalLoad moment_on(const NodalMoment& entry, const Deck& deck, std::span<const Mesh> meshes,
                    const Model& model) {
  NodalLoad load{.nodes = select_nodes(entry.where, deck, meshes, model),
                 .force = entry.moment,
                 .factor = entry.factor,
                 .is_moment = true};
  load.bodies = take_rigid(load.nodes, entry.where, model);
  const Nodes& nodes = model.nodes;
  const auto turns = [&](int node) {
    return nodes.has_rotations() && nodes.rotational_inertia[static_cast<std::size_t>(node)] > 0;
  };
  if (!std::ranges::all_of(load.nodes, turns))
    throw BuildError(
        "a moment on nodes that do not turn; accepted are nodes of shells and beams, and rigid parts as a "
        "whole",
        entry.where.place);
  turn_to_global(load, deck, entry.system, entry.where.place, model);
  return load;
}

/// Gathers the masses that springs are fastened to.
class Fastening {
 public:
  Fastening(const Deck& deck, Model& model) : deck_(deck), model_(model) {}

  void add(const Spring& wanted) {
    SpringInRun spring{.name = wanted.name,
                       .end = {anchor_at(wanted.from, wanted), anchor_at(wanted.to, wanted)},
                       .stiffness = wanted.stiffness,
                       .table = wanted.force,
                       .damping = wanted.damping};
    const auto& [from, to] = spring.end;
    const bool on_one_mass = from.node >= 0 && to.node >= 0 && from.mass == to.mass;
    if (on_one_mass || (from.node < 0 && to.node < 0))
      throw BuildError("both ends of spring '" + wanted.name + "' are " +
                           (on_one_mass ? "at one node or rigid part" : "fixed") +
                           "; accepted are two that move against each other",
                       wanted.place);
    for (std::size_t i = 1; i < spring.table.size(); ++i) {
      const auto& [point, next] = std::pair(spring.table[i - 1], spring.table[i]);
      spring.stiffness = std::max(spring.stiffness, (next[1] - point[1]) / (next[0] - point[0]));
    }
    spring.length = wanted.length.value_or((place_of(to) - place_of(from)).norm());
    if (wanted.strength) spring.strength = *wanted.strength;
    model_.springs.spring.push_back(std::move(spring));
  }

 private:
  Vector3d place_of(const SpringAnchor& anchor) const {
    if (anchor.node < 0) return anchor.point;
    return Vector3d(model_.nodes.record[static_cast<std::size_t>(anchor.node)].position);
  }

  SpringAnchor anchor_at(const SpringEnd& end, const Spring& spring) {
    SpringAnchor anchor;
    if (end.fixed) {
      anchor.point = Vector3d(end.point.data());
      return anchor;
    }
    anchor.node = static_cast<int>(nearest_node(end.point, end.part, deck_, model_.parts, model_.nodes));
    if (model_.ties.is_tied(anchor.node))
      throw BuildError(
          "spring '" + spring.name +
              "' would be fastened to a tied node, which has no mass of its own; accepted is a point "
              "near another node, such as one of the face",
          spring.place);
    for (std::size_t b = 0; b < model_.rigid.body.size(); ++b)
      if (std::ranges::binary_search(model_.rigid.body[b].node, anchor.node))
        anchor.body = static_cast<int>(b);
    anchor.mass = mass_of(anchor);
    return anchor;
  }

  std::size_t mass_of(const SpringAnchor& anchor) {
    std::vector<AnchoredMass>& masses = model_.springs.mass;
    const auto is_it = [&](const AnchoredMass& mass) {
      return anchor.body >= 0 ? mass.body == anchor.body : mass.node == anchor.node;
    };
    auto found = std::ranges::find_if(masses, is_it);
    if (found == masses.end())
      found = masses.insert(masses.end(), {.node = anchor.node, .body = anchor.body});
    if (anchor.body >= 0) {
      const Vector3d centre = model_.rigid.body[static_cast<std::size_t>(anchor.body)].centre;
      found->arm = std::max(found->arm, (place_of(anchor) - centre).norm());
    }
    return static_cast<std::size_t>(found - masses.begin());
  }

  const Deck& deck_;
  Model& model_;
};

}  // namespace

void make_loads(const Deck& deck, std::span<const Mesh> meshes, Model& model) {
  for (const Load& entry : deck.loads) {
    if (const auto* gravity = std::get_if<Gravity>(&entry))
      model.loads.push_back({gravity_of(*gravity, deck), {}});
    if (const auto* force = std::get_if<NodalForce>(&entry))
      model.loads.push_back({force_on(*force, deck, meshes, model), {}});
    if (const auto* moment = std::get_if<NodalMoment>(&entry))
      model.loads.push_back({moment_on(*moment, deck, meshes, model), {}});
    if (const auto* pressure = std::get_if<Pressure>(&entry))
      for (PressureLoad& load : pressures_on(*pressure, deck, meshes, model))
        model.loads.push_back({std::move(load), {}});
  }
}

void make_springs(const Deck& deck, Model& model) {
  if (deck.springs.empty()) return;
  Fastening fastening(deck, model);
  for (const Spring& spring : deck.springs) fastening.add(spring);
  const double stored = start(model.springs, model.nodes);
  model.energy.internal += stored;
  model.energy.kinetic_start += stored;
}

}  // namespace brio
