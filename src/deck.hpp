#pragma once
/// What a deck says. These structs are also the parameters that run: there is no parallel set.

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <variant>
#include <vector>

#include "contact/options.hpp"
#include "elements/block.hpp"
#include "materials/material.hpp"
#include "src/base/fields.hpp"

namespace brio {

using Triple = std::array<double, 3>;

// ---- mesh generators
// -----------------------------------------------------------------------------------------

/// Hexahedra filling a box centred on the origin. Sets: xmin xmax ymin ymax zmin zmax, bottom (= zmin), top,
/// all.
struct BoxMesh {
  static constexpr std::string_view name = "box";
  Triple size{};
  std::array<int, 3> elements{};
  static constexpr auto fields() {
    return std::tuple{required("size", &BoxMesh::size, positive, "edge lengths along x, y, z"),
                      required("elements", &BoxMesh::elements, at_least_one, "elements along x, y, z")};
  }
};

/// Shells in the plane z = 0, centred on the origin. Sets: xmin xmax ymin ymax boundary all.
struct PlateMesh {
  static constexpr std::string_view name = "plate";
  std::array<double, 2> size{};
  std::array<int, 2> elements{};
  static constexpr auto fields() {
    return std::tuple{required("size", &PlateMesh::size, positive, "edge lengths along x, y"),
                      required("elements", &PlateMesh::elements, at_least_one, "elements along x, y")};
  }
};

/// Shells on a cylinder about the z axis, from z = 0 to the height. Sets: bottom top all.
struct CylinderMesh {
  static constexpr std::string_view name = "cylinder";
  double radius = 0;
  double height = 0;
  std::array<int, 2> elements{};
  static constexpr auto fields() {
    return std::tuple{
        required("radius", &CylinderMesh::radius, positive, "radius of the middle surface"),
        required("height", &CylinderMesh::height, positive, "length along z"),
        required("elements", &CylinderMesh::elements, Range{.lower = 1}, "elements around, along z")};
  }
};

/// Hexahedra in the wall of a tube about the z axis, from z = 0 to the height. Sets: bottom top inside
/// outside all.
struct TubeMesh {
  static constexpr std::string_view name = "tube";
  double inner_radius = 0;
  double outer_radius = 0;
  double height = 0;
  std::array<int, 3> elements{};
  static constexpr auto fields() {
    return std::tuple{required("inner_radius", &TubeMesh::inner_radius, positive, "radius of the inside"),
                      required("outer_radius", &TubeMesh::outer_radius, positive, "radius of the outside"),
                      required("height", &TubeMesh::height, positive, "length along z"),
                      required("elements", &TubeMesh::elements, at_least_one,
                               "elements around, along z, through the wall")};
  }
};

/// Hexahedra filling a round rod along z, from z = 0 to the length. Sets: bottom top outside all.
struct RodMesh {
  static constexpr std::string_view name = "rod";
  double radius = 0;
  double length = 0;
  std::array<int, 2> elements{};
  static constexpr auto fields() {
    return std::tuple{required("radius", &RodMesh::radius, positive, "radius"),
                      required("length", &RodMesh::length, positive, "length along z"),
                      required("elements", &RodMesh::elements, at_least_one,
                               "elements across the diameter (even), along z")};
  }
};

using MeshSource = std::variant<BoxMesh, PlateMesh, CylinderMesh, TubeMesh, RodMesh>;

// ---- parts
// ---------------------------------------------------------------------------------------------------

/// Turn about an axis through the origin.
struct Rotation {
  Triple axis{};
  double degrees = 0;
  static constexpr auto fields() {
    return std::tuple{
        required("axis", &Rotation::axis, any_number, "direction of the axis through the origin"),
        required("degrees", &Rotation::degrees, any_number, "angle, right-handed")};
  }
};

/// First turned, then moved.
struct Placement {
  std::optional<Rotation> rotate;
  Triple translate{};
  static constexpr auto fields() {
    return std::tuple{optional("rotate", &Placement::rotate, any_number, "turn before moving"),
                      optional("translate", &Placement::translate, any_number, "move after turning, length")};
  }
};

struct Part {
  std::string name;
  MeshSource mesh;
  Placement placement;
  Element element;
  std::string material;
};

// ---- where: sets
// -----------------------------------------------------------------------------------------------

/// Nodes of a named set (`part.set`), or of all parts (or one) inside a region.
struct BoxRegion {
  Triple lower{};
  Triple upper{};
  static constexpr auto fields() {
    return std::tuple{
        required("lower", &BoxRegion::lower, any_number, "corner with the least coordinates"),
        required("upper", &BoxRegion::upper, any_number, "corner with the largest coordinates")};
  }
};
struct PlaneRegion {
  Triple point{};
  Triple normal{};
  double tolerance = 0;
  static constexpr auto fields() {
    return std::tuple{
        required("point", &PlaneRegion::point, any_number, "a point of the plane"),
        required("normal", &PlaneRegion::normal, any_number, "normal of the plane"),
        required("tolerance", &PlaneRegion::tolerance, non_negative, "distance within which nodes belong")};
  }
};
struct SphereRegion {
  Triple centre{};
  double radius = 0;
  static constexpr auto fields() {
    return std::tuple{required("centre", &SphereRegion::centre, any_number, "centre"),
                      required("radius", &SphereRegion::radius, positive, "radius")};
  }
};
/// In a deck: `set: can.bottom`, or `set: {box: {...}, part: can}`.
struct NodeSelection {
  std::string set;  ///< "part.set" or "part"
  std::variant<std::monostate, BoxRegion, PlaneRegion, SphereRegion> region;
  std::string part;  ///< limits a region; empty: all parts
};

// ---- when: curves
// ----------------------------------------------------------------------------------------------

/// Piecewise linear in time, constant beyond its ends. In a deck a number, or a list of [time, value].
struct Curve {
  std::vector<std::array<double, 2>> points;

  double operator()(double time) const;
  /// Its time derivative, from the right at a corner.
  double slope(double time) const;
};

// ---- conditions
// ------------------------------------------------------------------------------------------------

/// Spin of a part or set about an axis through a point.
struct Spin {
  Triple point{};
  Triple angular_velocity{};
  static constexpr auto fields() {
    return std::tuple{
        required("point", &Spin::point, any_number, "a point of the axis"),
        required("angular_velocity", &Spin::angular_velocity, any_number, "vector, radian per time")};
  }
};

/// In a deck `part: can` or `set: can.top`, and `velocity`, `spin` or both.
struct InitialCondition {
  NodeSelection where;
  Triple velocity{};
  std::optional<Spin> spin;
};

enum class MotionKind { displacement, velocity, acceleration };

/// One prescribed component of a boundary condition.
struct PrescribedComponent {
  int axis;  ///< 0..2 translations, 3..5 rotations
  Curve curve;
};

/// `fix: [x, y, z, rx, ry, rz]`, or `displacement|velocity|acceleration: {x: CURVE, ...}`.
struct PrescribedMotion {
  NodeSelection where;
  MotionKind kind = MotionKind::velocity;
  std::vector<PrescribedComponent> components;
};

/// Nodes cannot pass the plane; it may move at a given velocity.
struct RigidWall {
  static constexpr std::string_view name = "rigid_wall";
  Triple point{};
  Triple normal{};
  Triple velocity{};
  double friction = 0;
  static constexpr auto fields() {
    return std::tuple{required("point", &RigidWall::point, any_number, "a point of the plane at the start"),
                      required("normal", &RigidWall::normal, any_number, "points into the free side"),
                      optional("velocity", &RigidWall::velocity, any_number, "velocity of the wall"),
                      optional("friction", &RigidWall::friction, non_negative, "Coulomb coefficient, -")};
  }
};

using BoundaryCondition = std::variant<PrescribedMotion, RigidWall>;

// ---- loads
// -----------------------------------------------------------------------------------------------------

/// `gravity: [0, 0, -9.81]`, on everything.
struct Gravity {
  Triple acceleration{};
  Curve factor{{{0, 1}}};
};
/// `force: [x, y, z]` on every node of a set, times `factor` (a curve).
struct NodalForce {
  NodeSelection where;
  Triple force{};
  Curve factor{{{0, 1}}};
};
/// `pressure: CURVE` on a named side set, pushing against the outward normal; follows the surface.
struct Pressure {
  std::string side_set;  ///< "part.set"
  Curve pressure;
};

using Load = std::variant<Gravity, NodalForce, Pressure>;

// ---- the rest
// --------------------------------------------------------------------------------------------------

/// `surfaces: all` or a list of parts; `exclude` takes parts out. The options stand beside them in the deck.
struct ContactSection {
  std::vector<std::string> surfaces;  ///< empty: all parts
  std::vector<std::string> exclude;
  ContactOptions options;
};

struct TimeSection {
  double end = 0;
  double step_scale = 0.9;
  std::optional<double> step;
  double step_growth = 1.05;
  static constexpr auto fields() {
    return std::tuple{
        required("end", &TimeSection::end, positive, "time at which the run ends"),
        optional("step_scale", &TimeSection::step_scale, Range{.lower = 0, .upper = 1, .lower_open = true},
                 "share of the stable step that is used, -"),
        optional("step", &TimeSection::step, positive, "constant step; refused if above the stable step"),
        optional("step_growth", &TimeSection::step_growth, Range{.lower = 1, .lower_open = true},
                 "largest ratio of a step to the one before, -")};
  }
};

/// Either equally spaced or at given times.
struct FieldOutput {
  std::optional<double> every;
  std::vector<double> times;
  static constexpr auto fields() {
    return std::tuple{optional("every", &FieldOutput::every, positive,
                               "time between dumps; default: a twentieth of the end time"),
                      optional("times", &FieldOutput::times, non_negative, "times of dumps instead")};
  }
};
struct HistoryOutput {
  std::optional<double> every;
  static constexpr auto fields() {
    return std::tuple{optional("every", &HistoryOutput::every, positive,
                               "time between rows; default: a thousandth of the end time")};
  }
};
struct OutputSection {
  FieldOutput fields_;
  HistoryOutput history;
  static constexpr auto fields() {
    return std::tuple{
        optional("fields", &OutputSection::fields_, any_number, "when fields are written"),
        optional("history", &OutputSection::history, any_number, "when energies and momenta are written")};
  }
};

struct NumericsSection {
  Precision precision = Precision::double_precision;
  double energy_error_limit = 0.1;
  static constexpr auto fields() {
    return std::tuple{
        optional("precision", &NumericsSection::precision, any_number, "of element and material kernels"),
        optional("energy_error_limit", &NumericsSection::energy_error_limit, positive,
                 "relative energy error at which the run stops with exit code 3, -")};
  }
};

struct Deck {
  std::string file;  ///< as given on the command line
  std::string title;
  std::string text;  ///< the deck as run, with overrides, as YAML
  std::vector<std::pair<std::string, Material>> materials;
  std::vector<Part> parts;
  std::vector<InitialCondition> initial_conditions;
  std::vector<BoundaryCondition> boundary_conditions;
  std::vector<Load> loads;
  std::optional<ContactSection> contact;
  TimeSection time;
  OutputSection output;
  NumericsSection numerics;
};

}  // namespace brio
