#include "src/forecast/built_features.hpp"

#include <algorithm>
#include <set>

#include "src/base/index.hpp"
#include "src/deck/part_index.hpp"
#include "src/forecast/memory.hpp"
#include "src/output/observe.hpp"

namespace brio {

namespace {

using Features = std::vector<BuiltFeature>;

std::string counted(std::size_t count, const std::string& word) {
  return std::to_string(count) + " " + word + (count == 1 ? "" : "s");
}

std::string listed(const std::vector<std::string>& words) {
  constexpr std::size_t most = 4;
  std::string text;
  for (std::size_t i = 0; i < std::min(most, words.size()); ++i) text += (i == 0 ? "" : ", ") + words[i];
  if (words.size() > most) text += " and " + std::to_string(words.size() - most) + " more";
  return text;
}

// Deck keys of the parts for which something holds.
template <class Holds>
std::vector<std::string> keys_of_parts(const Deck& deck, const std::string& key, const Holds& holds) {
  std::vector<std::string> keys;
  for (const Part& part : deck.parts)
    if (holds(part)) keys.push_back("parts." + part.name + "." + key);
  return keys;
}

template <class Key>
void add_per_kind(const Deck& deck, const Model& model, const Key& kind_of, const std::string& key,
                  bool with_memory, Features& features) {
  std::set<std::string> kinds;
  for (const Part& part : deck.parts) kinds.insert(kind_of(part));
  kinds.erase("");
  kinds.erase(std::string(Rigid::name));
  for (const std::string& kind : kinds) {
    BuiltFeature feature{.name = kind, .because = "", .detail = "", .bytes = 0};
    feature.because =
        listed(keys_of_parts(deck, key, [&](const Part& part) { return kind_of(part) == kind; }));
    std::size_t elements = 0;
    for (std::size_t p = 0; p < deck.parts.size(); ++p) {
      if (kind_of(deck.parts[p]) != kind) continue;
      elements += model.parts[p].element_slot.size();
      if (with_memory) feature.bytes += bytes_held(model.blocks[p]);
    }
    feature.detail = counted(elements, "element");
    features.push_back(std::move(feature));
  }
}

void add_elements(const Deck& deck, const Model& model, Features& features) {
  add_per_kind(
      deck, model, [](const Part& part) { return std::string(name_of(part.element)); }, "element", true,
      features);
  add_per_kind(
      deck, model,
      [&](const Part& part) {
        const Material* material = material_of(deck, part);
        const bool used = material != nullptr && !std::holds_alternative<Rigid>(part.element);
        return used ? std::string(name_of(*material)) : "";
      },
      "material", false, features);
  const auto follows = [](const Part& part) {
    const auto* shell = std::get_if<Shell4>(&part.element);
    return shell != nullptr && shell->thickness_update;
  };
  if (const auto keys = keys_of_parts(deck, "element.thickness_update", follows); !keys.empty())
    features.push_back({"thickness update", listed(keys), "", 0});
  if (!model.particle_searches.empty())
    features.push_back({"search of particles",
                        listed(keys_of_parts(deck, "element.kernel",
                                             [](const Part& part) {
                                               const auto* particle = std::get_if<Particle>(&part.element);
                                               return particle != nullptr && particle->is_eulerian();
                                             })),
                        "", bytes_held(model.particle_searches)});
  if (deck.numerics.precision == Precision::single_precision)
    features.push_back({"float", "numerics.precision", "", 0});
  if (model.added_mass)
    features.push_back({"mass scaling", "time.mass_scaling", "", bytes_held(*model.added_mass)});
}

void add_rigid_bodies(const Deck& deck, const Model& model, Features& features) {
  if (model.rigid.empty()) return;
  std::size_t elements = 0;
  for (const PartInModel& part : model.parts)
    if (part.rigid >= 0) elements += part.element_slot.size();
  const auto keys = keys_of_parts(
      deck, "element", [](const Part& part) { return std::holds_alternative<Rigid>(part.element); });
  features.push_back({"rigid bodies", listed(keys),
                      std::to_string(keys.size()) + ", drawn by " + counted(elements, "element"),
                      bytes_held(model.rigid)});
}

void add_failure(const Deck& deck, const Model& model, Features& features) {
  std::vector<std::string> keys;
  for (const auto& [name, material] : deck.materials)
    if (has_failure(material)) keys.push_back("materials." + name + ".failure");
  if (!keys.empty()) features.push_back({"failure", listed(keys), "", 0});
  if (!model.erosion) return;
  const auto named =
      keys_of_parts(deck, "deletion", [](const Part& part) { return part.deletion.has_value(); });
  keys.insert(keys.end(), named.begin(), named.end());
  features.push_back(
      {"deletion", listed(keys), "", bytes_held(*model.erosion) + bytes_held(model.surface_numbers)});
}

void add_joints(const Deck& deck, const Model& model, Features& features) {
  std::size_t merged = 0, held = 0;
  for (const MergedParts& entry : model.merged) merged += index(entry.nodes);
  for (const TiedParts& entry : model.ties.found) held += index(entry.count);
  std::vector<std::string> merges, ties;
  for (std::size_t i = 0; i < deck.connections.size(); ++i) {
    const bool tie = std::holds_alternative<TieToSurface>(deck.connections[i]);
    (tie ? ties : merges).push_back("connections[" + std::to_string(i) + (tie ? "].tie" : "].merge"));
  }
  if (!merges.empty()) features.push_back({"merged nodes", listed(merges), counted(merged, "node"), 0});
  if (!ties.empty())
    features.push_back({"ties", listed(ties), counted(held, "node"), bytes_held(model.ties)});
}

std::size_t bodies_with_given_motion(const RigidBodies& rigid) {
  return index(std::count_if(rigid.body.begin(), rigid.body.end(),
                             [](const RigidBody& body) { return !body.given.empty(); }));
}

void add_conditions(const Deck& deck, const Model& model, Features& features) {
  std::vector<std::string> motions, walls;
  for (std::size_t i = 0; i < deck.boundary_conditions.size(); ++i) {
    const bool wall = std::holds_alternative<RigidWall>(deck.boundary_conditions[i]);
    (wall ? walls : motions).push_back("boundary_conditions[" + std::to_string(i) + "]");
  }
  if (!motions.empty()) {
    std::set<int> nodes;
    for (const PrescribedNodes& given : model.prescribed)
      nodes.insert(given.nodes.begin(), given.nodes.end());
    std::string detail;
    if (!nodes.empty()) detail = counted(nodes.size(), "node");
    if (const std::size_t bodies = bodies_with_given_motion(model.rigid); bodies > 0)
      detail += (detail.empty() ? "" : ", ") + std::to_string(bodies) + " rigid";
    if (const std::size_t own = model.nodes.support_axes.size(); own > 0)
      detail += ", " + std::to_string(own) + " along axes of their own";
    features.push_back({"prescribed motion", listed(motions), detail,
                        bytes_held(model.prescribed) + bytes_held(model.nodes.support_axes) +
                            bytes_held(model.nodes.axes_of)});
  }
  if (!walls.empty()) features.push_back({"rigid wall", listed(walls), counted(walls.size(), "wall"), 0});
  for (std::size_t i = 0; i < model.loads.size(); ++i) {
    const ActiveLoad& load = model.loads[i];
    BuiltFeature feature{
        .name = "", .because = "loads[" + std::to_string(i) + "]", .detail = "", .bytes = bytes_held(load)};
    if (std::holds_alternative<GravityLoad>(load.load)) feature.name = "gravity";
    if (const auto* nodal = std::get_if<NodalLoad>(&load.load))
      feature.name = nodal->is_moment ? "nodal moment" : "nodal force",
      feature.detail = counted(nodal->nodes.size(), "node");
    if (const auto* pressure = std::get_if<PressureLoad>(&load.load))
      feature.name = "pressure", feature.detail = counted(pressure->sides.size(), "side");
    features.push_back(std::move(feature));
  }
}

void add_initial_states(const Deck& deck, Features& features) {
  const auto count = std::ranges::count_if(deck.initial_conditions,
                                           [](const InitialCondition& one) { return one.from.has_value(); });
  if (count > 0)
    features.push_back({"initial states", "initial_conditions", counted(index(count), "part"), 0});
}

void add_damping(const Deck& deck, const Model& model, Features& features) {
  if (!deck.point_masses.empty())
    features.push_back({"point masses", "point_masses", counted(deck.point_masses.size(), "set"), 0});
  if (!model.springs.empty())
    features.push_back(
        {"springs", "springs", counted(model.springs.spring.size(), "spring"), bytes_held(model.springs)});
  if (!model.damping.empty())
    features.push_back(
        {"damping", listed(keys_of_parts(deck, "damping", [](const Part& part) { return part.damping > 0; })),
         "", bytes_held(model.damping)});
  if (deck.time.relaxation) features.push_back({"relaxation", "time.relaxation", "", 0});
}

void add_contact(const Deck& deck, std::vector<ContactScene>&& contacts, Features& features) {
  for (ContactScene& scene : contacts) {
    const Surface& surface = scene.surface;
    const std::string detail =
        counted(surface.part_name.size(), "part") + ", " + counted(surface.face.size(), "face") + ", " +
        counted(surface.node.size(), "node") + ", " +
        (surface.body_count == 1 ? "1 body" : std::to_string(surface.body_count) + " bodies");
    const bool audit = scene.options.audit;
    features.push_back({"contact", "contact.surfaces", detail, bytes_freed(std::move(scene))});
    if (deck.contact->options.friction > 0) features.push_back({"friction", "contact.friction", "", 0});
    if (deck.contact->options.kinetic_friction)
      features.push_back({"kinetic friction", "contact.kinetic_friction", "", 0});
    if (!deck.contact->pairs.empty())
      features.push_back({"pairs", "contact.pairs", counted(deck.contact->pairs.size(), "pair"), 0});
    if (audit) features.push_back({"audit", "contact.audit", "", 0});
  }
}

}  // namespace

std::vector<BuiltFeature> built_features(const Deck& deck, Model&& model) {
  Features features;
  features.push_back({"nodes", "parts", counted(model.nodes.size(), "node"),
                      bytes_held(model.nodes) + bytes_held(model.assembled_step)});
  if (model.nodes.has_rotations())
    features.push_back(
        {"rotations of nodes",
         listed(keys_of_parts(deck, "element", [](const Part& part) { return has_rotations(part.element); })),
         "", 0});
  add_elements(deck, model, features);
  add_rigid_bodies(deck, model, features);
  add_failure(deck, model, features);
  add_joints(deck, model, features);
  add_conditions(deck, model, features);
  add_initial_states(deck, features);
  add_damping(deck, model, features);
  add_contact(deck, std::move(model.contacts), features);
  return features;
}

std::vector<std::string> features_not_built(const Model& model) {
  const auto lacks = [&](CellType cell) {
    return std::none_of(model.blocks.begin(), model.blocks.end(), [&](const Block& block) {
      return !std::holds_alternative<Rigid>(block.element) && traits_of(block.element).cell == cell;
    });
  };
  const std::vector<std::pair<const char*, bool>> all{
      {"hexahedra", lacks(hexahedron_cell)},
      {"shells", lacks(quadrilateral_cell)},
      {"beams", lacks(line_cell)},
      {"particles", lacks(vertex_cell)},
      {"rigid bodies", model.rigid.empty()},
      {"merged nodes", model.merged.empty()},
      {"ties", model.ties.found.empty()},
      {"deletion", !model.erosion},
      {"prescribed motion", model.prescribed.empty() && bodies_with_given_motion(model.rigid) == 0},
      {"rigid walls", model.walls.empty()},
      {"loads", model.loads.empty()},
      {"springs", model.springs.empty()},
      {"damping", model.damping.empty()},
      {"mass scaling", !model.added_mass},
      {"contact", model.contacts.empty()}};
  std::vector<std::string> names;
  for (const auto& [name, is_missing] : all)
    if (is_missing) names.emplace_back(name);
  return names;
}

}  // namespace brio
