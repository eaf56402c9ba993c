// Boundary conditions of a deck, and the axes of coordinate systems at nodes.

#include <algorithm>
#include <cmath>

#include "src/base/index.hpp"
#include "src/build/build.hpp"
#include "src/build/build_rigid.hpp"
#include "src/model/node_name.hpp"
#include "src/motion/skew_supports.hpp"

namespace brio {

namespace {

/// Of the largest distance of a node from the axis of a cylindrical system: nodes nearer to it lie on it.
constexpr double on_axis_share = 1e-6;

double on_axis(const CylindricalSystem& system, const Model& model) {
  double farthest = 0;
  for (std::size_t i = 0; i < model.nodes.size(); ++i)
    farthest = std::max(farthest, distance_from_axis(system, position(model.nodes, i)));
  return on_axis_share * farthest;
}

Vector3d unit_normal(const RigidWall& wall) {
  const Vector3d& direction = wall.normal;
  const double size = std::sqrt(dot(direction, direction));
  if (!(size > 0)) throw BuildError("a rigid wall has a normal without length", wall.place);
  return {direction[0] / size, direction[1] / size, direction[2] / size};
}

Tensor<double> rows_of(const SystemAxes& axes) {
  Tensor<double> rows;
  for (int i = 0; i < 3; ++i) rows.set_row(i, axes[index(i)]);
  return rows;
}

// One system for all supports of a body: it moves as a whole.
void constrain_body(const PrescribedMotion& motion, const Deck& deck, int number, const std::string& part,
                    RigidBody& body) {
  Tensor<double> axes = identity<double>();
  if (!motion.system.empty())
    axes = rows_of(axes_everywhere(deck, motion.system, "the motion of a rigid part", motion.where.place));
  if (!body.given.empty() && body.axes != axes)
    throw BuildError("the motion of the rigid part '" + part +
                         "' is prescribed in two coordinate systems; accepted is one for all components of a "
                         "rigid part",
                     motion.where.place);
  body.axes = axes;
  for (const PrescribedComponent& component : motion.components)
    body.given.push_back({motion.kind, component.axis, component.curve, component.place, number});
}

std::vector<Vector3d> directions_of(const std::vector<SystemAxes>& axes, std::size_t component,
                                    const std::vector<int>& nodes, const std::string& system,
                                    const std::string& place, const Model& model) {
  std::vector<Vector3d> directions;
  for (std::size_t k = 0; k < axes.size(); ++k) {
    directions.push_back(axes[k][component]);
    if (is_zero(directions.back())) refuse_on_axis(model, index(nodes[k]), system, place);
  }
  return directions;
}

void constrain_nodes(const PrescribedMotion& motion, const Deck& deck, int number,
                     const std::vector<int>& nodes, Model& model) {
  std::vector<SystemAxes> axes;
  if (!motion.system.empty()) axes = axes_at_nodes(deck, motion.system, nodes, motion.where.place, model);
  for (const PrescribedComponent& component : motion.components) {
    if (component.axis >= 3 && !model.nodes.has_rotations()) continue;  // solids have no rotations to hold
    model.prescribed.push_back(
        {nodes, motion.kind, component.axis, component.curve, component.place, number});
    model.prescribed.back().direction =
        directions_of(axes, index(component.axis % 3), nodes, motion.system, component.place, model);
  }
}

}  // namespace

const CoordinateSystem& system_called(const std::string& name, const Deck& deck, const std::string& place) {
  const auto found = std::ranges::find(deck.coordinate_systems, name,
                                       [](const auto& entry) -> const std::string& { return entry.first; });
  if (found == deck.coordinate_systems.end())
    throw BuildError("no coordinate system is called '" + name + "'", place);
  return found->second;
}

SystemAxes axes_everywhere(const Deck& deck, const std::string& name, const std::string& what,
                           const std::string& place) {
  const auto* system = std::get_if<RectangularSystem>(&system_called(name, deck, place));
  if (system == nullptr)
    throw BuildError("the axes of '" + name + "' differ from place to place, but not those of " + what +
                         "; accepted is a rectangular system",
                     place);
  return axes_of(*system);
}

std::vector<SystemAxes> axes_at_nodes(const Deck& deck, const std::string& name,
                                      const std::vector<int>& nodes, const std::string& place,
                                      const Model& model) {
  const CoordinateSystem& system = system_called(name, deck, place);
  if (const auto* same = std::get_if<RectangularSystem>(&system))
    return std::vector<SystemAxes>(nodes.size(), axes_of(*same));
  const auto& round = std::get<CylindricalSystem>(system);
  const double least = on_axis(round, model);
  std::vector<SystemAxes> axes;
  for (const int node : nodes) axes.push_back(axes_at(round, position(model.nodes, node), least));
  return axes;
}

void refuse_on_axis(const Model& model, std::size_t node, const std::string& system,
                    const std::string& place) {
  throw BuildError(name_of_node(model, node) + " lies on the axis of '" + system +
                       "', where no direction is r or t; accepted there: z, or axes of a rectangular system",
                   place);
}

void constrain(const Deck& deck, std::span<const Mesh> meshes, Model& model) {
  int number = -1;
  for (const BoundaryCondition& condition : deck.boundary_conditions) {
    ++number;
    if (const auto* wall = std::get_if<RigidWall>(&condition)) {
      model.walls.push_back({*wall, number});
      model.walls.back().wall.normal = unit_normal(*wall);
      continue;
    }
    const auto& motion = std::get<PrescribedMotion>(condition);
    std::vector<int> nodes = select_nodes(motion.where, deck, meshes, model);
    for (const std::size_t b : take_rigid(nodes, motion.where, model))
      constrain_body(motion, deck, number, model.parts[model.rigid.body[b].part].name, model.rigid.body[b]);
    if (!nodes.empty()) constrain_nodes(motion, deck, number, nodes, model);
  }
  combine_supports(model.prescribed, model.nodes);
}

}  // namespace brio
