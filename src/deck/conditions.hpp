#pragma once
/// Conditions of a deck: where they act, how they go with time, what is given at the start, prescribed, and
/// applied from outside.

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "src/base/fields.hpp"
#include "src/deck/coordinate_system.hpp"
#include "src/deck/expression.hpp"
#include "src/deck/initial_state.hpp"
#include "src/deck/mesh_source.hpp"

namespace brio {

// ---- where: sets
// -----------------------------------------------------------------------------------------------

/// Nodes of a named set (`part.set`), or of all parts (or one) inside a region.
struct BoxRegion {
  static constexpr std::string_view name = "box";
  static constexpr std::string_view meaning = "inside a box";
  Vector3d lower{};
  Vector3d upper{};
  static constexpr auto fields() {
    return field_table(
        required("lower", &BoxRegion::lower, any_number, "corner with the least coordinates"),
        required("upper", &BoxRegion::upper, any_number, "corner with the largest coordinates"));
  }
  constexpr std::string_view fault() const {
    const bool ordered = lower.x <= upper.x && lower.y <= upper.y && lower.z <= upper.z;
    return ordered ? "" : "the box is inside out; no component of lower may exceed that of upper";
  }
};
struct PlaneRegion {
  static constexpr std::string_view name = "plane";
  static constexpr std::string_view meaning = "near a plane";
  Vector3d point{};
  Vector3d normal{};
  double tolerance = 0;
  static constexpr auto fields() {
    return field_table(
        required("point", &PlaneRegion::point, any_number, "a point of the plane"),
        required("normal", &PlaneRegion::normal, any_number, "normal of the plane"),
        required("tolerance", &PlaneRegion::tolerance, non_negative, "distance within which nodes belong"));
  }
  constexpr std::string_view fault() const {
    return is_zero(normal) ? "the normal has no direction; at least one component must differ from 0" : "";
  }
};
struct SphereRegion {
  static constexpr std::string_view name = "sphere";
  static constexpr std::string_view meaning = "inside a sphere";
  Vector3d centre{};
  double radius = 0;
  static constexpr auto fields() {
    return field_table(required("centre", &SphereRegion::centre, any_number, "centre"),
                       required("radius", &SphereRegion::radius, positive, "radius"));
  }
};
/// In a deck: `set: can.bottom`, or `set: {box: {...}, part: can}`.
using Region = std::variant<std::monostate, BoxRegion, PlaneRegion, SphereRegion>;
struct NodeSelection {
  std::string set;  ///< "part.set" or "part"
  Region region;
  std::string part;     ///< limits a region; empty: all parts
  std::string place{};  ///< in the deck
};

// ---- when: curves
// ----------------------------------------------------------------------------------------------

/// Piecewise linear in time, constant beyond its ends. In a deck a number, or a list of [time, value]; or an
/// expression of time, of which the points are samples, for what asks where it bends.
struct Curve {
  std::vector<std::array<double, 2>> points;
  std::shared_ptr<const Expression> expression{};  ///< of t; null: the points are all

  double operator()(double time) const;
  /// Its time derivative, from the right at a corner; of an expression a difference of fourth order.
  double slope(double time) const;

  bool operator==(const Curve& other) const;
};

/// A curve, or an expression of position and time.
struct SpaceTimeCurve : Curve {
  SpaceTimeCurve() = default;
  SpaceTimeCurve(Curve curve) : Curve(std::move(curve)) {}  // implicit: the same everywhere
  bool varies_in_space = false;

  double at(const Vector3d& position, double time) const;
};

/// Names for numbers, known to the expressions of a deck.
struct Parameters {
  std::vector<std::pair<std::string, double>> values;
};

// ---- conditions
// ------------------------------------------------------------------------------------------------

/// Spin of a part or set about an axis through a point.
struct Spin {
  Vector3d point{};
  Vector3d angular_velocity{};
  static constexpr auto fields() {
    return field_table(
        required("point", &Spin::point, any_number, "a point of the axis"),
        required("angular_velocity", &Spin::angular_velocity, any_number, "vector, radian per time"));
  }
};

/// In a deck `part: can` or `set: can.top`, and `velocity`, `spin` or both.
/// Velocity away from an axis, the same at any distance.
struct RadialVelocity {
  Vector3d point{};
  Vector3d axis{};
  double speed = 0;
  static constexpr auto fields() {
    return field_table(required("point", &RadialVelocity::point, any_number, "a point of the axis"),
                       required("axis", &RadialVelocity::axis, any_number, "direction of the axis"),
                       required("speed", &RadialVelocity::speed, any_number,
                                "away from the axis; below 0: towards it, length per time"));
  }
  constexpr std::string_view fault() const {
    return is_zero(axis) ? "the axis has no direction; at least one component must differ from 0" : "";
  }
};

struct InitialCondition {
  NodeSelection where;
  Vector3d velocity{};
  std::optional<Spin> spin;
  std::optional<RadialVelocity> radial{};
  std::optional<StateSource> from{};
  static constexpr auto fields() {
    return field_table(optional("velocity", &InitialCondition::velocity, any_number,
                                "velocity at the start, length per time"),
                       optional("spin", &InitialCondition::spin, any_number,
                                "initial rotation about an axis, added to the velocity"),
                       optional("radial", &InitialCondition::radial, any_number,
                                "away from an axis at the start, added to the velocity; not of rigid parts"),
                       optional("from", &InitialCondition::from, any_number,
                                "of a part that deforms: its state in an earlier result, element by element "
                                "(docs/initial_state.md)"));
  }
};

enum class MotionKind { displacement, velocity, acceleration };

/// One prescribed component of a boundary condition.
struct PrescribedComponent {
  int axis;  ///< 0..2 translations, 3..5 rotations
  Curve curve;
  std::string place{};  ///< in the deck
};

/// `fix: [x, y, z, rx, ry, rz]`, or `displacement|velocity|acceleration: {x: CURVE, ...}`; along the axes of
/// a coordinate system where it names one.
struct PrescribedMotion {
  std::string name;  ///< may be empty
  NodeSelection where;
  MotionKind kind = MotionKind::velocity;
  std::vector<PrescribedComponent> components;
  std::string system{};  ///< name of a coordinate system; empty: the global axes
};

/// Nodes cannot pass the plane; it may move at a given velocity.
struct RigidWall {
  static constexpr std::string_view name = "rigid_wall";
  static constexpr std::string_view meaning = "a plane that nodes cannot pass";
  Vector3d point{};
  Vector3d normal{};
  Vector3d velocity{};
  double friction = 0;
  std::string place{};  ///< in the deck
  std::string label{};  ///< its name in the deck; may be empty
  static constexpr auto fields() {
    return field_table(required("point", &RigidWall::point, any_number, "a point of the plane at the start"),
                       required("normal", &RigidWall::normal, any_number, "points into the free side"),
                       optional("velocity", &RigidWall::velocity, any_number, "velocity of the wall"),
                       optional("friction", &RigidWall::friction, non_negative, "Coulomb coefficient, -"));
  }
  constexpr std::string_view fault() const {
    return is_zero(normal) ? "the normal has no direction; at least one component must differ from 0" : "";
  }
};

using BoundaryCondition = std::variant<PrescribedMotion, RigidWall>;

// ---- loads
// -----------------------------------------------------------------------------------------------------

/// `gravity: [0, 0, -9.81]`, on everything.
struct Gravity {
  static constexpr std::string_view name = "gravity";
  static constexpr std::string_view meaning = "acceleration of everything";
  Vector3d acceleration{};
  Curve factor{{{0, 1}}};
  std::string system{};
  std::string place{};  ///< in the deck
  static constexpr auto fields() {
    return field_table(required("gravity", &Gravity::acceleration, any_number,
                                "acceleration of everything, length per time^2"),
                       optional("factor", &Gravity::factor, any_number, "multiplies it, -"),
                       optional("system", &Gravity::system, any_number,
                                "name of a rectangular coordinate system; default: the global axes"));
  }
};
/// `force: [x, y, z]` on every node of a set, times `factor` (a curve).
struct NodalForce {
  static constexpr std::string_view name = "force";
  static constexpr std::string_view meaning = "the same force on every node of a set";
  NodeSelection where;
  Vector3d force{};
  Curve factor{{{0, 1}}};
  std::string system{};
  static constexpr auto fields() {
    return field_table(required("set", &NodalForce::where, any_number, "nodes that are pushed"),
                       required("force", &NodalForce::force, any_number, "on each of the nodes"),
                       optional("factor", &NodalForce::factor, any_number, "multiplies it, -"),
                       optional("system", &NodalForce::system, any_number,
                                "name of the coordinate system of its components; default: the global axes"));
  }
};
/// `moment: [x, y, z]` on every node of a set, or once on a rigid part, times `factor`.
struct NodalMoment {
  static constexpr std::string_view name = "moment";
  static constexpr std::string_view meaning = "the same moment on every node of a set, or on a rigid part";
  NodeSelection where;
  Vector3d moment{};
  Curve factor{{{0, 1}}};
  std::string system{};
  static constexpr auto fields() {
    return field_table(required("set", &NodalMoment::where, any_number,
                                "nodes of shells and beams, or a rigid part as a whole"),
                       required("moment", &NodalMoment::moment, any_number,
                                "on each of the nodes, once on a rigid part; its direction stays"),
                       optional("factor", &NodalMoment::factor, any_number, "multiplies it, -"),
                       optional("system", &NodalMoment::system, any_number,
                                "name of the coordinate system of its components; default: the global axes"));
  }
};
/// `pressure: CURVE` on a named side set, pushing against the outward normal; follows the surface.
struct Pressure {
  static constexpr std::string_view name = "pressure";
  static constexpr std::string_view meaning = "pressure on sides of elements";
  std::string side_set;  ///< "part.set"
  SpaceTimeCurve pressure;
  std::string place{};  ///< in the deck
  static constexpr auto fields() {
    return field_table(
        required("side_set", &Pressure::side_set, any_number, "sides of elements that are pushed, part.set"),
        required("pressure", &Pressure::pressure, any_number,
                 "against the outward normal; follows the surface"));
  }
};

using Load = std::variant<Gravity, NodalForce, NodalMoment, Pressure>;

// ---- point masses
// ----------------------------------------------------------------------------------------------

/// `point_masses: [{set: frame.top, mass: 2}]`: mass on each node of a set, beside that of its elements.
struct PointMass {
  NodeSelection where;
  double mass = 0;
  static constexpr auto fields() {
    return field_table(required("set", &PointMass::where, any_number, "nodes, of parts that deform"),
                       required("mass", &PointMass::mass, positive,
                                "added to each of the nodes, without inertia of rotation"));
  }
};

}  // namespace brio
