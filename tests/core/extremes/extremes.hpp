#pragma once
/// Scenes that every condition of docs/extremes.md is tried on: one element, one body of each kind, all kinds
/// in one contact; and a deck in other units.

#include <array>
#include <cmath>
#include <random>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "contact/audit/audit.hpp"
#include "src/base/index.hpp"
#include "tests/core/floating_point_traps.hpp"
#include "tests/core/scene.hpp"
#include "tests/core/sweep/erosion_scene.hpp"

namespace brio::test {

enum class Kind { hex8, hex8_full, shell, beam, particles, rigid };
inline constexpr std::array kind_names{"hex8", "hex8_full", "shell4", "beam2", "particle", "rigid"};
constexpr const char* name_of_kind(Kind kind) { return kind_names[index(kind)]; }
inline constexpr std::array deformable_kinds{Kind::hex8, Kind::hex8_full, Kind::shell, Kind::beam,
                                             Kind::particles};
inline constexpr std::array all_kinds{Kind::hex8, Kind::hex8_full, Kind::shell,
                                      Kind::beam, Kind::particles, Kind::rigid};

/// A body about the origin, 0.4 wide, of edges of 0.1.
inline Part body(Kind kind, const std::string& name, const std::string& material = "material") {
  switch (kind) {
    case Kind::hex8:
      return box(name, {0.4, 0.4, 0.4}, {4, 4, 4}, {0, 0, 0}, Hex8{}, material);
    case Kind::hex8_full:
      return box(name, {0.4, 0.4, 0.4}, {4, 4, 4}, {0, 0, 0}, Hex8Full{}, material);
    case Kind::rigid:
      return box(name, {0.4, 0.4, 0.4}, {4, 4, 4}, {0, 0, 0}, Rigid{}, material);
    case Kind::shell: {
      PlateMesh mesh;
      mesh.size = {0.4, 0.4};
      mesh.elements = {4, 4};
      Shell4 element;
      element.thickness = 0.03;
      return {name, mesh, {}, element, material};
    }
    case Kind::beam: {
      LineMesh mesh;
      mesh.start = {-0.2, 0, 0};
      mesh.end = {0.2, 0, 0};
      mesh.elements = 4;
      Beam2 element;
      element.section = CircleSection{0.03};
      return {name, mesh, {}, element, material};
    }
    default: {
      ParticleMesh mesh;
      mesh.box = ParticleBox{{0.4, 0.4, 0.4}, 0.1};
      return {name, mesh, {}, Particle{}, material};
    }
  }
}

/// Distance from its nodes at which a body touches.
inline double touching_distance(Kind kind) {
  constexpr std::array distance{0.0, 0.0, 0.015, 0.03, 0.05, 0.0};
  return distance[index(kind)];
}

/// One part in flight at (5, -3, -20) onto another that rests, askew, its lowest node over the middle.
/// \param touching sum of the distances from their nodes at which they touch
inline Deck impact_of(Part upper, Part lower, double touching, const Material& material = elastic(0.3)) {
  lower.placement.rotate = Rotation{{0.3, 1, 0}, 11};
  upper.placement.rotate = Rotation{{1, 0.4, 0.7}, 37};
  Vector3d lowest{0, 0, HUGE_VAL};
  for (const Vector3d& x : generate_mesh(upper.mesh, upper.placement).position)
    if (x[2] < lowest[2]) lowest = x;
  double top = -HUGE_VAL;
  for (const Vector3d& x : generate_mesh(lower.mesh, lower.placement).position) top = std::max(top, x[2]);
  upper.placement.translate = {0.02 - lowest[0], 0.013 - lowest[1], top + touching - lowest[2]};
  Deck deck;
  deck.materials = {{"material", material}};
  deck.parts = {lower, upper};
  deck.initial_conditions = {moving("upper", {5, -3, -20})};
  deck.contact.emplace();
  deck.contact->options.friction = 0.2;
  deck.time.end = 8e-3;
  return deck;
}
inline Deck impact(Kind upper, Kind lower, const Material& material = elastic(0.3)) {
  Deck deck = impact_of(body(upper, "upper"), body(lower, "lower"),
                        touching_distance(upper) + touching_distance(lower), material);
  if (upper == Kind::rigid && lower == Kind::rigid) deck.time.step = 0x1p-14;
  return deck;
}

/// A body of each kind thrown at a sheet that fractures; its free nodes remain in contact.
inline Deck all_kinds_at_once() {
  Deck deck;
  deck.materials = {{"material", elastic(0.3)}, {"sheet", brittle(0.01, 0.02)}};
  PlateMesh mesh;
  mesh.size = {2, 1.5};
  mesh.elements = {16, 12};
  Shell4 thin;
  thin.thickness = 0.02;
  Part sheet{"sheet", mesh, {}, thin, "sheet"};
  sheet.deletion.emplace();
  sheet.deletion->inverted = true;
  sheet.deletion->debris_radius = 0.01;
  deck.parts = {sheet};
  const std::array<Vector3d, 6> places{{{-0.6, -0.4, 0.4},
                                        {0, -0.45, 0.4},
                                        {0.6, -0.4, 0.45},
                                        {-0.6, 0.4, 0.3},
                                        {0, 0.4, 0.42},
                                        {0.6, 0.4, 0.45}}};
  for (std::size_t k = 0; k < all_kinds.size(); ++k) {
    Part part = body(all_kinds[k], name_of_kind(all_kinds[k]));
    part.placement.rotate = Rotation{{1, 0.4, 0.7}, 30};
    part.placement.translate = places[k];
    deck.parts.push_back(part);
    deck.initial_conditions.push_back(moving(part.name, {10, -5, -80}));
  }
  deck.boundary_conditions = {fix("sheet.boundary", {0, 1, 2})};
  deck.contact.emplace();
  deck.contact->options.friction = 0.2;
  deck.time.end = 6e-3;
  deck.numerics.energy_error_limit = 1;
  return deck;
}

// ---- units

/// Units as multiples of those of a deck.
struct Units {
  double length = 1, time = 1, mass = 1;
  double speed() const { return length / time; }
  double energy() const { return mass * length * length / (time * time); }
};
inline constexpr std::array<Units, 4> powers_of_two{
    {{1024, 1, 1}, {1, 0.0078125, 1}, {1, 1, 4096}, {0.0009765625, 0.125, 0.00048828125}}};

inline Vector3d scaled(const Vector3d& v, double factor) {
  return {v[0] * factor, v[1] * factor, v[2] * factor};
}

inline Material in_units(Material material, const Units& u) {
  std::visit(
      [&](auto& law) {
        law.density *= u.mass / (u.length * u.length * u.length);
        const double stress = u.mass / (u.length * u.time * u.time);
        if constexpr (requires { law.youngs_modulus; }) law.youngs_modulus *= stress;
        if constexpr (requires { law.yield_stress *= stress; }) law.yield_stress *= stress;
        if constexpr (requires { law.hardening_modulus; }) law.hardening_modulus *= stress;
        if constexpr (requires { law.hardening_constant; }) law.hardening_constant *= stress;
      },
      material);
  return material;
}

/// What the scenes here are made of, in other units.
inline Deck in_units(Deck deck, const Units& u) {
  for (auto& [name, material] : deck.materials) material = in_units(material, u);
  for (Part& part : deck.parts) {
    part.placement.translate = scaled(part.placement.translate, u.length);
    if (auto* mesh = std::get_if<BoxMesh>(&part.mesh)) mesh->size = scaled(mesh->size, u.length);
    if (auto* mesh = std::get_if<PlateMesh>(&part.mesh))
      for (double& edge : mesh->size) edge *= u.length;
    if (auto* mesh = std::get_if<LineMesh>(&part.mesh)) {
      mesh->start = scaled(mesh->start, u.length);
      mesh->end = scaled(mesh->end, u.length);
    }
    if (auto* mesh = std::get_if<ParticleMesh>(&part.mesh)) {
      mesh->box->size = scaled(mesh->box->size, u.length);
      mesh->box->spacing *= u.length;
    }
    if (auto* shell = std::get_if<Shell4>(&part.element)) shell->thickness *= u.length;
    if (auto* beam = std::get_if<Beam2>(&part.element))
      std::get<CircleSection>(beam->section).radius *= u.length;
    if (part.deletion && part.deletion->debris_radius) *part.deletion->debris_radius *= u.length;
  }
  for (InitialCondition& condition : deck.initial_conditions)
    condition.velocity = scaled(condition.velocity, u.speed());
  for (Load& load : deck.loads)
    if (auto* gravity = std::get_if<Gravity>(&load))
      gravity->acceleration = scaled(gravity->acceleration, u.speed() / u.time);
  deck.time.end *= u.time;
  if (deck.time.step) *deck.time.step *= u.time;
  return deck;
}

// ---- runs

/// What happened at each step, and the end.
struct Watched {
  Model model;
  std::vector<int> contacts, active;
  std::vector<std::size_t> deleted;
  std::int64_t missed = 0;  ///< that audits found
  /// Without crossings of less than a tenth of an edge, which detection by nodes and sharp edges lets
  /// through.
  std::int64_t deep = 0;
  double worst_linear = 0;  ///< imbalance of momentum
  /// \param audit_every steps; 0: never
  explicit Watched(const Deck& deck, Model built, int audit_every = 0) : model(std::move(built)) {
    ThreadTeam team(1);
    int step = 0;
    test::run(model, deck, team, [&](Model& m) {
      if (m.erosion) deleted.push_back(m.erosion->deleted.size());
      Momentum now = momentum(m.nodes);
      add_momentum(m.rigid, now);
      m.momentum.now = now.total;
      m.momentum.linear_scale = std::max(m.momentum.linear_scale, now.linear_size);
      worst_linear = std::max(worst_linear, m.momentum.linear_imbalance());
      if (m.contacts.empty()) return;
      contacts.push_back(m.contacts[0].step.contacts);
      active.push_back(m.contacts[0].step.active);
      if (audit_every > 0 && step++ % audit_every == 0) {
        const Audit found = audit(m.contacts[0], m.nodes, team);
        missed += found.missed();
        deep += found.deep();
      }
    });
  }
  explicit Watched(const Deck& deck, int audit_every = 0) : Watched(deck, build_model(deck), audit_every) {}
  int touched() const {
    int most = 0;
    for (int now : active) most = std::max(most, now);
    return most;
  }
  double overlap() const { return model.contacts[0].totals.deepest_overlap; }
  double added() const { return model.energy.contact_added_max / model.energy.kinetic_start; }
};

inline double speed_of(const Model& model, std::size_t part, std::size_t axis) {
  const int rigid = model.parts[part].rigid;
  return rigid < 0 ? mean_velocity(model, part, axis) : model.rigid.motion[index(rigid)].velocity[axis];
}

}  // namespace brio::test
