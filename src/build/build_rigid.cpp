#include "src/build/build_rigid.hpp"

#include <algorithm>
#include <stdexcept>

#include "src/build/build.hpp"
#include "src/deck/mass_properties.hpp"

namespace brio {

using Eigen::Vector3d;

namespace {

// A body may begin behind a wall by this share of its size: rounding.
constexpr double touching_share = 1e-9;

double density_of(const Part& part, const Deck& deck) {
  for (const auto& [name, material] : deck.materials)
    if (name == part.material) return std::visit([](const auto& law) { return law.density; }, material);
  throw BuildError("part '" + part.name + "': no material is named '" + part.material + "'", part.place);
}

MassProperties mass_of(const Part& part, const Rigid& rigid, const Mesh& mesh, const Deck& deck) {
  MassProperties properties;
  try {
    properties = mass_properties(mesh, density_of(part, deck), rigid.thickness.value_or(0));
  } catch (const std::invalid_argument& fault) {
    throw BuildError("part '" + part.name + "': " + fault.what(), part.place);
  }
  if (rigid.mass) {
    properties.inertia *= *rigid.mass / properties.mass;
    properties.mass = *rigid.mass;
  }
  if (rigid.inertia) {
    const auto& [xx, yy, zz, xy, yz, xz] = *rigid.inertia;
    properties.inertia << xx, xy, xz, xy, yy, yz, xz, yz, zz;
  }
  if (rigid.centre) properties.centre = Vector3d(rigid.centre->data());
  return properties;
}

void measure_arms(const Nodes& nodes, RigidBody& body) {
  body.arm.clear();
  for (int node : body.node)
    body.arm.push_back(Vector3d(nodes.record[static_cast<std::size_t>(node)].position) - body.centre);
}

RigidBody make_body(std::size_t p, const Part& part, const Mesh& mesh, const Deck& deck, const Model& model) {
  const auto& rigid = std::get<Rigid>(part.element);
  const MassProperties properties = mass_of(part, rigid, mesh, deck);
  RigidBody body;
  body.part = p;
  body.nodes_per_element = mesh.nodes_per_element;
  body.thickness = rigid.thickness.value_or(0);
  body.mass = properties.mass;
  body.inertia = properties.inertia;
  body.centre = properties.centre;
  body.node = model.parts[p].node;
  std::sort(body.node.begin(), body.node.end());
  measure_arms(model.nodes, body);
  for (int node : mesh.connectivity)
    body.connectivity.push_back(model.parts[p].node[static_cast<std::size_t>(node)]);
  return body;
}

double size_of(const RigidBody& body) {
  double size = 0;
  for (const Vector3d& arm : body.arm) size = std::max(size, arm.norm());
  return size;
}

void check_walls(Model& model) {
  for (const WallInRun& wall : model.walls)
    for (RigidBody& body : model.rigid.body) {
      body.touch.reserve(body.node.size());
      const double height = height_above(wall, body, model.nodes);
      if (height < -touching_share * size_of(body))
        throw BuildError("rigid part '" + model.parts[body.part].name + "' begins behind a rigid wall by " +
                             std::to_string(-height),
                         wall.wall.place);
    }
}

}  // namespace

void make_rigid_bodies(const Deck& deck, std::span<const Mesh> meshes, Model& model) {
  for (std::size_t p = 0; p < deck.parts.size(); ++p) {
    if (!std::holds_alternative<Rigid>(deck.parts[p].element)) continue;
    model.parts[p].rigid = static_cast<int>(model.rigid.body.size());
    model.rigid.body.push_back(make_body(p, deck.parts[p], meshes[p], deck, model));
  }
  model.rigid.motion.resize(model.rigid.body.size());
  if (!model.rigid.empty() && model.rigid.body.size() == deck.parts.size() && !deck.time.step &&
      deck.springs.empty())
    throw BuildError("all parts are rigid, so that no element bounds the time step; time.step is required",
                     deck.time.place);
}

void measure_arms(Model& model) {
  for (RigidBody& body : model.rigid.body) measure_arms(model.nodes, body);
}

std::vector<std::size_t> take_rigid(std::vector<int>& nodes, const NodeSelection& where, const Model& model) {
  std::vector<std::size_t> bodies;
  for (std::size_t b = 0; b < model.rigid.body.size(); ++b) {
    const RigidBody& body = model.rigid.body[b];
    std::vector<int> left;
    std::set_difference(nodes.begin(), nodes.end(), body.node.begin(), body.node.end(),
                        std::back_inserter(left));
    const std::size_t named = nodes.size() - left.size();
    if (named == 0) continue;
    if (named < body.node.size())
      throw BuildError("a condition names some nodes of the rigid part '" + model.parts[body.part].name +
                           "', which moves as a whole; accepted: all of them, by the name of the part",
                       where.place);
    nodes = std::move(left);
    bodies.push_back(b);
  }
  return bodies;
}

void start_rigid_bodies(const Deck& deck, std::span<const Mesh> meshes, Model& model) {
  if (model.rigid.empty()) return;
  std::vector<RigidMotion>& motion = model.rigid.motion;
  for (const InitialCondition& condition : deck.initial_conditions) {
    std::vector<int> nodes = select_nodes(condition.where, deck, meshes, model);
    for (const std::size_t b : take_rigid(nodes, condition.where, model)) {
      motion[b].velocity = Vector3d(condition.velocity.data());
      if (condition.radial)
        throw BuildError(
            "'radial' in initial_conditions names nodes of a rigid part, which moves as a whole; "
            "accepted for it: velocity, spin",
            condition.where.place);
      if (!condition.spin) continue;
      motion[b].angular_velocity = Vector3d(condition.spin->angular_velocity.data());
      motion[b].velocity += motion[b].angular_velocity.cross(model.rigid.body[b].centre -
                                                             Vector3d(condition.spin->point.data()));
    }
  }
  for (std::size_t b = 0; b < motion.size(); ++b) {
    const Vector3d velocity = motion[b].velocity;
    const Vector3d angular_velocity = motion[b].angular_velocity;
    start(model.rigid.body[b], motion[b], velocity, angular_velocity);
  }
  ThreadTeam team(1);
  carry_velocities(model.rigid, model.nodes, team);
  check_walls(model);
}

}  // namespace brio
