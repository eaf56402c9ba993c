#include "src/build/build_loads.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <utility>

#include "src/base/index.hpp"
#include "src/build/build.hpp"
#include "src/build/build_rigid.hpp"
#include "src/deck/part_index.hpp"
#include "src/initial/initial_state.hpp"

namespace brio {

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
    const auto corners = index(mesh.nodes_per_element);
    PressureLoad load{{}, load_entry.pressure, static_cast<int>(p), {}};
    for (const ElementSide& side : found->second) {
      std::array<int, 4> nodes{};
      for (std::size_t k = 0; k < 4; ++k) {
        const int corner = corners == 8 ? sides_of_hex[index(side.side)][k] : static_cast<int>(k);
        const auto entry = index(side.element) * corners + index(corner);
        nodes[k] = model.parts[p].node[index(mesh.connectivity[entry])];
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
  const Vector3d components = load.force;
  if (!load.bodies.empty())
    load.force =
        from_components(axes_everywhere(deck, system, "a moment on a rigid part", place), components);
  const std::vector<SystemAxes> axes = axes_at_nodes(deck, system, load.nodes, place, model);
  for (std::size_t k = 0; k < axes.size(); ++k) {
    const bool across = components[0] != 0 || components[1] != 0;
    if (across && is_zero(axes[k][0])) refuse_on_axis(model, index(load.nodes[k]), system, place);
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

bool turns(int node, const Nodes& nodes) {
  return nodes.has_rotations() && nodes.rotational_inertia[index(node)] > 0;
}

NodalLoad moment_on(const NodalMoment& entry, const Deck& deck, std::span<const Mesh> meshes,
                    const Model& model) {
  NodalLoad load{.nodes = select_nodes(entry.where, deck, meshes, model),
                 .force = entry.moment,
                 .factor = entry.factor,
                 .is_moment = true};
  load.bodies = take_rigid(load.nodes, entry.where, model);
  if (!std::ranges::all_of(load.nodes, [&](int node) { return turns(node, model.nodes); }))
    throw BuildError(
        "a moment on nodes that do not turn; accepted are nodes of shells and beams, and rigid parts as a "
        "whole",
        entry.where.place);
  turn_to_global(load, deck, entry.system, entry.where.place, model);
  return load;
}

Vector3d radial_velocity(const RadialVelocity& radial, const NodeRecord& record, const std::string& place) {
  Vector3d arm = vector_at(record.position) - radial.point;
  const double along = dot(arm, radial.axis) / dot(radial.axis, radial.axis);
  arm -= along * radial.axis;
  const double distance = norm(arm);
  if (!(distance > 0))
    throw BuildError("a node on the axis of 'radial' in initial_conditions has no radial direction", place);
  for (double& component : arm) component *= radial.speed / distance;
  return arm;
}

/// Nodes of a selection in the order of the parts and of their numbers in the mesh.
std::vector<int> in_order_of_numbers(std::vector<int> nodes, const Model& model) {
  std::vector<std::array<std::int64_t, 2>> key(model.nodes.size());
  std::vector<std::uint8_t> is_known(model.nodes.size(), 0);
  for (std::size_t p = 0; p < model.parts.size(); ++p)
    for (std::size_t i = 0; i < model.parts[p].node.size(); ++i) {
      const auto node = index(model.parts[p].node[i]);
      if (is_known[node] == 0) key[node] = {static_cast<std::int64_t>(p), model.parts[p].number_of_node(i)};
      is_known[node] = 1;
    }
  std::ranges::sort(nodes, {}, [&](int node) { return key[index(node)]; });
  return nodes;
}

/// Sorted along the longest extent: a search goes outwards from a point while something nearer can come.
class NearestPlace {
 public:
  explicit NearestPlace(std::span<const Vector3d> places) : places_(places) {
    Vector3d lower = places.front(), upper = lower;
    for (const Vector3d& place : places) {
      lower = minimum(lower, place);
      upper = maximum(upper, place);
    }
    const Vector3d extent = upper - lower;
    axis_ = std::max_element(extent.begin(), extent.end()) - extent.begin();
    for (std::size_t i = 0; i < places.size(); ++i) order_.emplace_back(places[i][axis_], i);
    std::ranges::sort(order_);
  }
  /// The first of those as near.
  std::size_t to(const Vector3d& point) const {
    const auto middle = std::ranges::lower_bound(order_, std::pair(point[axis_], std::size_t{0}));
    std::pair best(std::numeric_limits<double>::infinity(), std::size_t{0});
    const auto look = [&](const std::pair<double, std::size_t>& entry) {
      const double along = entry.first - point[axis_];
      if (along * along > best.first) return false;
      best = std::min(best, std::pair(squared_norm(places_[entry.second] - point), entry.second));
      return true;
    };
    for (auto at = middle; at != order_.end() && look(*at);) ++at;
    for (auto at = middle; at != order_.begin() && look(*std::prev(at));) --at;
    return best.second;
  }

 private:
  std::span<const Vector3d> places_;
  std::ptrdiff_t axis_ = 0;
  std::vector<std::pair<double, std::size_t>> order_;
};

/// Gathers the masses that springs are fastened to.
class Fastening {
 public:
  Fastening(const Deck& deck, std::span<const Mesh> meshes, Model& model)
      : deck_(deck), meshes_(meshes), model_(model) {}

  void add(const Spring& wanted) {
    SpringSet set{.name = wanted.name,
                  .first = model_.springs.spring.size(),
                  .is_torsional = wanted.is_torsional(),
                  .joins_sets = wanted.joins_sets()};
    const std::vector<Ends> ends = ends_of(wanted);
    set.count = ends.size();
    const double share = wanted.values == SpringValues::total ? 1 / static_cast<double>(ends.size()) : 1;
    set.shortest = std::numeric_limits<double>::infinity();
    for (const Ends& one : ends) {
      std::string name = wanted.name;
      if (set.joins_sets) name.append(".").append(std::to_string(1 + (&one - ends.data())));
      const double distance = add(std::move(name), one, share, wanted);
      set.shortest = std::min(set.shortest, distance);
      set.longest = std::max(set.longest, distance);
    }
    model_.springs.set.push_back(std::move(set));
  }

 private:
  using Ends = std::array<SpringAnchor, 2>;

  Vector3d place_of(const SpringAnchor& anchor) const {
    if (anchor.node < 0) return anchor.point;
    return vector_at(model_.nodes.record[index(anchor.node)].position);
  }

  /// \return the distance of its ends
  double add(std::string name, const Ends& ends, double share, const Spring& wanted) {
    SpringInRun spring{.name = std::move(name),
                       .end = ends,
                       .is_torsional = wanted.is_torsional(),
                       .stiffness = share * wanted.stiffness,
                       .table = wanted.table(),
                       .damping = share * wanted.damping};
    expect_motion(spring, wanted);
    for (auto& point : spring.table) point[1] *= share;
    for (std::size_t i = 1; i < spring.table.size(); ++i) {
      const auto& [point, next] = std::pair(spring.table[i - 1], spring.table[i]);
      spring.stiffness = std::max(spring.stiffness, (next[1] - point[1]) / (next[0] - point[0]));
    }
    const double distance = norm(place_of(ends[1]) - place_of(ends[0]));
    spring.length = wanted.length.value_or(distance);
    if (wanted.strength) spring.strength = share * *wanted.strength;
    if (spring.is_torsional) {
      spring.elongation = wanted.angle.value_or(0);
      spring.direction = normalized(*wanted.axis);
    }
    model_.springs.spring.push_back(std::move(spring));
    return distance;
  }

  void expect_motion(const SpringInRun& spring, const Spring& wanted) const {
    const auto& [from, to] = spring.end;
    const bool on_one_mass = from.node >= 0 && to.node >= 0 && from.mass == to.mass;
    if (on_one_mass || (from.node < 0 && to.node < 0))
      throw BuildError("both ends of spring '" + spring.name + "' are " +
                           (on_one_mass ? "at one node or rigid part" : "fixed") +
                           "; accepted are two that move against each other",
                       wanted.place);
    if (!spring.is_torsional) return;
    for (const SpringAnchor& anchor : spring.end)
      if (anchor.node >= 0 && anchor.body < 0 && !turns(anchor.node, model_.nodes))
        throw BuildError("an end of the torsional spring '" + spring.name +
                             "' is a node that does not turn; accepted are nodes of shells and beams, rigid "
                             "parts and fixed points",
                         wanted.place);
  }

  std::vector<Ends> ends_of(const Spring& wanted) {
    const std::vector<SpringAnchor> from = anchors_at(wanted.from, wanted);
    const std::vector<SpringAnchor> to = anchors_at(wanted.to, wanted);
    std::vector<Ends> ends;
    if (wanted.pairing == SpringPairing::order) {
      if (from.size() != to.size())
        throw BuildError("the sets of springs '" + wanted.name + "' have " + std::to_string(from.size()) +
                             " and " + std::to_string(to.size()) +
                             " nodes; pairing: order is accepted with sets of equal size",
                         wanted.place);
      for (std::size_t i = 0; i < from.size(); ++i) ends.push_back({from[i], to[i]});
      return ends;
    }
    if (!wanted.from.set) {
      for (const SpringAnchor& other : to) ends.push_back({from.front(), other});
      return ends;
    }
    std::vector<Vector3d> places;
    for (const SpringAnchor& other : to) places.push_back(place_of(other));
    const NearestPlace nearest(places);
    for (const SpringAnchor& one : from) ends.push_back({one, to[nearest.to(place_of(one))]});
    return ends;
  }

  std::vector<SpringAnchor> anchors_at(const SpringEnd& end, const Spring& spring) {
    if (end.fixed) {
      SpringAnchor anchor;
      anchor.point = *end.point;
      return {anchor};
    }
    if (end.point)
      return {anchor_at(
          static_cast<int>(nearest_node(*end.point, end.part, deck_, model_.parts, model_.nodes)), spring)};
    std::vector<SpringAnchor> anchors;
    for (const int node : in_order_of_numbers(select_nodes(*end.set, deck_, meshes_, model_), model_))
      anchors.push_back(anchor_at(node, spring));
    return anchors;
  }

  SpringAnchor anchor_at(int node, const Spring& spring) {
    SpringAnchor anchor;
    anchor.node = node;
    if (model_.ties.is_tied(anchor.node))
      throw BuildError(
          "spring '" + spring.name +
              "' would be fastened to a tied node, which has no mass of its own; accepted is a point "
              "near another node, such as one of the face",
          spring.place);
    for (std::size_t b = 0; b < model_.rigid.body.size(); ++b)
      if (std::ranges::binary_search(model_.rigid.body[b].node, anchor.node))
        anchor.body = static_cast<int>(b);
    anchor.mass = mass_of(anchor, spring.is_torsional());
    return anchor;
  }

  std::size_t mass_of(const SpringAnchor& anchor, bool is_torsional) {
    std::vector<AnchoredMass>& masses = model_.springs.mass;
    const auto key = anchor.body >= 0 ? std::pair(true, anchor.body) : std::pair(false, anchor.node);
    const auto [found, is_new] = index_of_mass_.try_emplace(key, masses.size());
    if (is_new) masses.push_back({.node = anchor.node, .body = anchor.body});
    AnchoredMass& mass = masses[found->second];
    if (anchor.body >= 0 && !is_torsional) {  // a moment has no arm
      const Vector3d centre = model_.rigid.body[index(anchor.body)].centre;
      mass.arm = std::max(mass.arm, norm(place_of(anchor) - centre));
    }
    return found->second;
  }

  const Deck& deck_;
  std::span<const Mesh> meshes_;
  Model& model_;
  std::map<std::pair<bool, int>, std::size_t> index_of_mass_;  ///< of a body or a node
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

void make_springs(const Deck& deck, std::span<const Mesh> meshes, Model& model) {
  if (deck.springs.empty()) return;
  Fastening fastening(deck, meshes, model);
  for (const Spring& spring : deck.springs) fastening.add(spring);
  const double stored = start(model.springs, model.nodes);
  model.energy.internal += stored;
  model.energy.kinetic_start += stored;
}

void set_initial_velocities(const Deck& deck, std::span<const Mesh> meshes, std::span<const PartState> states,
                            Model& model) {
  std::size_t number = 0;
  for (const InitialCondition& condition : deck.initial_conditions) {
    for (const PartState& state : states)
      if (state.condition == number) set_velocities(state, model);
    ++number;
    if (condition.from) continue;
    std::vector<int> nodes = select_nodes(condition.where, deck, meshes, model);
    take_rigid(nodes, condition.where, model);
    for (int entry : nodes) {
      const auto node = index(entry);
      NodeRecord& record = model.nodes.record[node];
      Vector3d velocity = condition.velocity;
      if (condition.spin) {
        const Vector3d arm = vector_at(record.position) - condition.spin->point;
        velocity += cross(condition.spin->angular_velocity, arm);
        if (model.nodes.has_rotations() && model.nodes.rotational_inertia[node] > 0)
          for (std::size_t i = 0; i < 3; ++i)
            model.nodes.angular_velocity[node].component[i] = condition.spin->angular_velocity[i];
      }
      if (condition.radial) velocity += radial_velocity(*condition.radial, record, condition.where.place);
      for (std::size_t i = 0; i < 3; ++i) record.velocity[i] = velocity[i];
    }
  }
}

}  // namespace brio
