#include "src/build/build_rigid.hpp"

#include <algorithm>
#include <stdexcept>

#include "src/base/index.hpp"
#include "src/build/build.hpp"
#include "src/deck/mass_properties.hpp"
#include "src/motion/skew_supports.hpp"

namespace brio {

namespace {

// A body may begin behind a wall by this share of its size: rounding.
constexpr double touching_share = 1e-9;
// Initial velocities of joined nodes may differ by this share of their size: rounding.
constexpr double velocity_share = 1e-9;

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
    properties.inertia = *rigid.mass / properties.mass * properties.inertia;
    properties.mass = *rigid.mass;
  }
  if (rigid.inertia) {
    const auto& [xx, yy, zz, xy, yz, xz] = *rigid.inertia;
    properties.inertia = {{{xx, xy, xz}, {xy, yy, yz}, {xz, yz, zz}}};
  }
  if (rigid.centre) properties.centre = *rigid.centre;
  return properties;
}

void measure_arms(const Nodes& nodes, RigidBody& body) {
  body.arm.clear();
  for (int node : body.node) body.arm.push_back(vector_at(nodes.record[index(node)].position) - body.centre);
}

RigidBody make_body(std::size_t p, const Part& part, const Mesh& mesh, const Deck& deck, const Model& model) {
  const auto& rigid = std::get<Rigid>(part.element);
  const MassProperties properties = mass_of(part, rigid, mesh, deck);
  RigidBody body;
  body.part = p;
  body.nodes_per_element = mesh.nodes_per_element;
  body.thickness = rigid.thickness.value_or(0);
  body.own = properties;
  body.mass = properties.mass;
  body.inertia = properties.inertia;
  body.centre = properties.centre;
  body.node = model.parts[p].node;
  std::sort(body.node.begin(), body.node.end());
  measure_arms(model.nodes, body);
  for (int node : mesh.connectivity) body.connectivity.push_back(model.parts[p].node[index(node)]);
  return body;
}

bool has_same_motion(const RigidBody& body, const PrescribedNodes& given, std::size_t at) {
  const Curve still{{{0, 0}}};
  bool turns = false;
  for (int axis = 3; axis < 6; ++axis)
    turns = turns || std::ranges::none_of(body.given, [&](const PrescribedRigid& one) {
              return one.axis == axis && one.kind == MotionKind::velocity && one.curve == still;
            });
  return (given.turns() || !turns) && std::ranges::any_of(body.given, [&](const PrescribedRigid& one) {
           return one.axis / 3 == given.axis / 3 && one.kind == given.kind && one.curve == given.curve &&
                  is_along(body.axes.row(one.axis % 3), given.direction_of(at));
         });
}

double size_of(const RigidBody& body) {
  double size = 0;
  for (const Vector3d& arm : body.arm) size = std::max(size, norm(arm));
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

void join_nodes(Model& model) {
  if (model.rigid.empty() || (model.merged.empty() && model.ties.joined.empty())) return;
  std::vector<std::uint8_t> of_elements(model.nodes.size(), 0);
  for (const PartInModel& part : model.parts)
    if (part.rigid < 0)
      for (const int node : part.node) of_elements[index(node)] = 1;
  for (RigidBody& body : model.rigid.body) {
    for (const TiedNode& tied : model.ties.joined)
      if (tied.face_part == static_cast<int>(body.part)) body.node.push_back(tied.tie.node);
    std::sort(body.node.begin(), body.node.end());
    body.node.erase(std::unique(body.node.begin(), body.node.end()), body.node.end());
    body.joint.clear();
    for (std::size_t i = 0; i < body.node.size(); ++i)
      if (of_elements[index(body.node[i])] != 0) body.joint.push_back(i);
    body.joint_before.resize(body.joint.size());
    measure_arms(model.nodes, body);
  }
}

void join_masses(Model& model) {
  Nodes& nodes = model.nodes;
  for (RigidBody& body : model.rigid.body) {
    if (body.joint.empty()) continue;
    const auto at = [&](std::size_t i) { return index(body.node[i]); };
    const auto place_of = [&](std::size_t i) { return vector_at(nodes.record[at(i)].position); };
    body.mass = body.own.mass;
    Vector3d moment = body.own.mass * body.own.centre;
    for (const std::size_t i : body.joint) {
      body.mass += nodes.mass[at(i)];
      moment += nodes.mass[at(i)] * place_of(i);
    }
    body.centre = moment / body.mass;
    body.inertia = body.own.inertia + body.own.mass * inertia_of_point(body.own.centre - body.centre);
    for (const std::size_t i : body.joint) {
      body.inertia += nodes.mass[at(i)] * inertia_of_point(place_of(i) - body.centre);
      nodes.mass[at(i)] = 0;
      if (!nodes.has_rotations()) continue;
      body.inertia += nodes.rotational_inertia[at(i)] * identity<double>();
      nodes.rotational_inertia[at(i)] = 0;
    }
    measure_arms(nodes, body);
  }
}

void release_joined(Model& model) {
  std::vector<int> body_of_node(model.rigid.has_joints() ? model.nodes.size() : 0, -1);
  for (std::size_t b = 0; b < model.rigid.body.size(); ++b)
    for (const std::size_t i : model.rigid.body[b].joint) {
      int& owner = body_of_node[index(model.rigid.body[b].node[i])];
      if (owner >= 0)
        throw BuildError("a node would belong to the rigid parts '" +
                         model.parts[model.rigid.body[index(owner)].part].name + "' and '" +
                         model.parts[model.rigid.body[b].part].name + "'; accepted is one");
      owner = static_cast<int>(b);
    }
  if (body_of_node.empty()) return;
  for (const TiedNode& tied : model.ties.node)
    for (const int node :
         {tied.tie.node, tied.tie.corner[0], tied.tie.corner[1], tied.tie.corner[2], tied.tie.corner[3]})
      if (body_of_node[index(node)] >= 0)
        throw BuildError(
            "a node tied to a part that deforms, or the face that it is tied to, is joined to a "
            "rigid part as well; accepted is one of both",
            model.ties.found[index(tied.connection)].place);
  for (PrescribedNodes& given : model.prescribed)
    for (std::size_t at = given.nodes.size(); at-- > 0;) {
      const int body = body_of_node[index(given.nodes[at])];
      if (body < 0) continue;
      if (!has_same_motion(model.rigid.body[index(body)], given, at))
        throw BuildError(
            "the motion of a node that is joined to a rigid part is prescribed, but not that of the "
            "part; accepted: the same for both, and no rotation of the part",
            given.place);
      release(given, given.nodes[at]);
    }
  combine_supports(model.prescribed, model.nodes);
}

namespace {

// Of the model, ascending, each once.
std::vector<int> nodes_of_part(const PartInModel& part) {
  std::vector<int> nodes = part.node;
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

bool is_joint(const RigidBody& body, int node) {
  return std::any_of(body.joint.begin(), body.joint.end(),
                     [&](std::size_t i) { return body.node[i] == node; });
}

}  // namespace

std::vector<std::size_t> take_rigid(std::vector<int>& nodes, const NodeSelection& where, const Model& model) {
  std::vector<std::size_t> bodies;
  for (std::size_t b = 0; b < model.rigid.body.size(); ++b) {
    const RigidBody& body = model.rigid.body[b];
    const std::vector<int> own = nodes_of_part(model.parts[body.part]);
    std::vector<int> named, left;
    std::set_intersection(nodes.begin(), nodes.end(), own.begin(), own.end(), std::back_inserter(named));
    if (named.size() < own.size()) {
      if (std::all_of(named.begin(), named.end(), [&](int node) { return is_joint(body, node); })) continue;
      throw BuildError("a condition names some nodes of the rigid part '" + model.parts[body.part].name +
                           "', which moves as a whole; accepted: all of them, by the name of the part",
                       where.place);
    }
    std::set_difference(nodes.begin(), nodes.end(), own.begin(), own.end(), std::back_inserter(left));
    nodes = std::move(left);
    bodies.push_back(b);
  }
  return bodies;
}

namespace {

std::vector<Vector3d> velocities_of_joints(const Model& model) {
  std::vector<Vector3d> velocities;
  for (const RigidBody& body : model.rigid.body)
    for (const std::size_t i : body.joint)
      velocities.push_back(vector_at(model.nodes.record[index(body.node[i])].velocity));
  return velocities;
}

void expect_same_velocities(const std::vector<Vector3d>& given, const Model& model) {
  const std::vector<Vector3d> found = velocities_of_joints(model);
  std::size_t next = 0;
  for (const RigidBody& body : model.rigid.body)
    for (std::size_t j = 0; j < body.joint.size(); ++j, ++next)
      if (norm(given[next] - found[next]) > velocity_share * (norm(given[next]) + norm(found[next])))
        throw BuildError("a node joined to rigid part '" + model.parts[body.part].name +
                         "' starts with another velocity than that part; accepted: equal initial velocities");
}

}  // namespace

void start_rigid_bodies(const Deck& deck, std::span<const Mesh> meshes, Model& model) {
  if (model.rigid.empty()) return;
  std::vector<RigidMotion>& motion = model.rigid.motion;
  for (const InitialCondition& condition : deck.initial_conditions) {
    std::vector<int> nodes = select_nodes(condition.where, deck, meshes, model);
    for (const std::size_t b : take_rigid(nodes, condition.where, model)) {
      motion[b].velocity = condition.velocity;
      if (condition.radial)
        throw BuildError(
            "'radial' in initial_conditions names nodes of a rigid part, which moves as a whole; "
            "accepted for it: velocity, spin",
            condition.where.place);
      if (!condition.spin) continue;
      motion[b].angular_velocity = condition.spin->angular_velocity;
      motion[b].velocity +=
          cross(motion[b].angular_velocity, model.rigid.body[b].centre - condition.spin->point);
    }
  }
  for (std::size_t b = 0; b < motion.size(); ++b) {
    const Vector3d velocity = motion[b].velocity;
    const Vector3d angular_velocity = motion[b].angular_velocity;
    start(model.rigid.body[b], motion[b], velocity, angular_velocity);
  }
  const std::vector<Vector3d> given = velocities_of_joints(model);
  ThreadTeam team(1);
  carry_velocities(model.rigid, model.nodes, team);
  expect_same_velocities(given, model);
  check_walls(model);
}

}  // namespace brio
