#pragma once
/// The meshes that a deck can ask for.

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "src/base/fields.hpp"
#include "src/base/tensor.hpp"
#include "src/deck/mesh.hpp"

namespace brio {

/// Nodes and elements are counted by int.
constexpr std::string_view fault_of_size(std::int64_t a, std::int64_t b, std::int64_t c) {
  constexpr std::int64_t largest = std::int64_t{1} << 27;
  const bool fits = a <= largest && b <= largest && c <= largest && a * b <= largest && a * b * c <= largest;
  return fits ? std::string_view{} : "the mesh is too fine; at most 134217728 elements are accepted a part";
}

/// Hexahedra filling a box centred on the origin. Sets: xmin xmax ymin ymax zmin zmax, bottom (= zmin), top,
/// all.
struct BoxMesh {
  static constexpr std::string_view name = "box";
  static constexpr std::string_view meaning = "hexahedra filling a box centred on the origin";
  Vector3d size{};
  std::array<int, 3> elements{};
  static constexpr auto fields() {
    return field_table(required("size", &BoxMesh::size, positive, "edge lengths along x, y, z"),
                       required("elements", &BoxMesh::elements, at_least_one, "elements along x, y, z"));
  }
  constexpr std::string_view fault() const { return fault_of_size(elements[0], elements[1], elements[2]); }
};

/// Shells in the plane z = 0, centred on the origin. Sets: xmin xmax ymin ymax boundary all.
struct PlateMesh {
  static constexpr std::string_view name = "plate";
  static constexpr std::string_view meaning = "shells in the plane z = 0, centred on the origin";
  std::array<double, 2> size{};
  std::array<int, 2> elements{};
  static constexpr auto fields() {
    return field_table(required("size", &PlateMesh::size, positive, "edge lengths along x, y"),
                       required("elements", &PlateMesh::elements, at_least_one, "elements along x, y"));
  }
  constexpr std::string_view fault() const { return fault_of_size(elements[0], elements[1], 1); }
};

/// Shells on a cylinder about the z axis, from z = 0 to the height, all around or over an arc that begins at
/// the x axis. Sets: bottom top all, and start and end (of an arc).
struct CylinderMesh {
  static constexpr std::string_view name = "cylinder";
  static constexpr std::string_view meaning =
      "shells on a cylinder about the z axis, from z = 0 to the height";
  double radius = 0;
  double height = 0;
  std::array<int, 2> elements{};
  std::optional<double> arc{};
  static constexpr auto fields() {
    return field_table(
        required("radius", &CylinderMesh::radius, positive, "radius of the middle surface"),
        required("height", &CylinderMesh::height, positive, "length along z"),
        required("elements", &CylinderMesh::elements, at_least_one, "elements around (at least 3), along z"),
        optional(
            "arc", &CylinderMesh::arc,
            Range{.lower = 0, .upper = 360, .lower_open = true, .upper_open = true},
            "part of the circle, from the x axis towards the y axis, degrees; absent: the whole circle"));
  }
  constexpr std::string_view fault() const {
    if (!arc && elements[0] < 3)
      return "the cylinder does not close; at least 3 elements around are accepted";
    return fault_of_size(elements[0], elements[1], 1);
  }
};

/// Hexahedra in the wall of a tube about the z axis, from z = 0 to the height. Sets: bottom top inside
/// outside all.
struct TubeMesh {
  static constexpr std::string_view name = "tube";
  static constexpr std::string_view meaning =
      "hexahedra in the wall of a tube about the z axis, from z = 0 to the height";
  double inner_radius = 0;
  double outer_radius = 0;
  double height = 0;
  std::array<int, 3> elements{};
  static constexpr auto fields() {
    return field_table(required("inner_radius", &TubeMesh::inner_radius, positive, "radius of the inside"),
                       required("outer_radius", &TubeMesh::outer_radius, positive, "radius of the outside"),
                       required("height", &TubeMesh::height, positive, "length along z"),
                       required("elements", &TubeMesh::elements, at_least_one,
                                "elements around (at least 3), along z, through the wall"));
  }
  constexpr std::string_view fault() const {
    if (outer_radius <= inner_radius)
      return "the wall has no thickness; outer_radius must exceed inner_radius";
    if (elements[0] < 3) return "the tube does not close; at least 3 elements around are accepted";
    return fault_of_size(elements[0], elements[1], elements[2]);
  }
};

/// Hexahedra filling a round rod along z, from z = 0 to the length. Sets: bottom top outside all.
struct RodMesh {
  static constexpr std::string_view name = "rod";
  static constexpr std::string_view meaning =
      "hexahedra filling a round rod along z, from z = 0 to the length";
  double radius = 0;
  double length = 0;
  std::array<int, 2> elements{};
  bool keep_volume = false;
  static constexpr auto fields() {
    return field_table(
        required("radius", &RodMesh::radius, positive, "radius"),
        required("length", &RodMesh::length, positive, "length along z"),
        required("elements", &RodMesh::elements, at_least_one,
                 "elements across the diameter (even), along z"),
        optional("keep_volume", &RodMesh::keep_volume, any_number,
                 "set the outer nodes out so far that the facets enclose the volume of the round rod"));
  }
  constexpr std::string_view fault() const {
    if (elements[0] % 2 != 0) return "the number of elements across the diameter is odd; it must be even";
    return fault_of_size(elements[0], elements[0], elements[1]);
  }
};

/// Hexahedra filling a blade whose edge lies on the y axis and points down. Sets: xmin xmax (the flanks and
/// what is above them) ymin ymax zmax all, and zmin where the tip is flat.
struct WedgeMesh {
  static constexpr std::string_view name = "wedge";
  static constexpr std::string_view meaning =
      "hexahedra filling a blade whose edge lies on the y axis and points down; zmin exists where the tip is "
      "flat";
  double thickness = 0;
  double height = 0;
  double length = 0;
  double half_angle = 0;
  double tip_width = 0;
  std::array<int, 3> elements{};
  static constexpr auto fields() {
    return field_table(
        required("thickness", &WedgeMesh::thickness, positive, "width along x above the edge"),
        required("height", &WedgeMesh::height, positive, "from the tip at z = 0 to the top"),
        required("length", &WedgeMesh::length, positive, "along y, centred on the origin"),
        required("half_angle", &WedgeMesh::half_angle,
                 Range{.lower = 0, .upper = 90, .lower_open = true, .upper_open = true},
                 "between a flank of the edge and the z axis, degrees"),
        optional("tip_width", &WedgeMesh::tip_width, non_negative,
                 "width of the flat tip; 0: a sharp edge of degenerate hexahedra"),
        required("elements", &WedgeMesh::elements, at_least_one, "elements across, up, along the edge"));
  }
  /// Height at which the full thickness is reached.
  double shoulder() const;
  std::string_view fault() const;
};

/// Hexahedra filling a sphere about the origin. Sets: outside all.
struct SphereMesh {
  static constexpr std::string_view name = "sphere";
  static constexpr std::string_view meaning = "hexahedra filling a sphere about the origin";
  double radius = 0;
  int elements = 0;
  bool keep_volume = false;
  static constexpr auto fields() {
    return field_table(
        required("radius", &SphereMesh::radius, positive, "radius"),
        required("elements", &SphereMesh::elements, at_least_one, "elements across the diameter (even)"),
        optional("keep_volume", &SphereMesh::keep_volume, any_number,
                 "draw it so much larger that its elements fill the volume of the round one"));
  }
  constexpr std::string_view fault() const {
    if (elements % 2 != 0) return "the number of elements across the diameter is odd; it must be even";
    return fault_of_size(elements, elements, elements);
  }
};

/// Shells on a sphere about the origin. Set: all.
struct HollowSphereMesh {
  static constexpr std::string_view name = "hollow_sphere";
  static constexpr std::string_view meaning = "shells on a sphere about the origin";
  double radius = 0;
  int elements = 0;
  static constexpr auto fields() {
    return field_table(
        required("radius", &HollowSphereMesh::radius, positive, "radius of the middle surface"),
        required("elements", &HollowSphereMesh::elements, at_least_one,
                 "elements over a quarter of the equator; there are six times its square"));
  }
  constexpr std::string_view fault() const { return fault_of_size(elements, elements, 6); }
};

/// Beams on a straight line. Sets: start end all.
struct LineMesh {
  static constexpr std::string_view name = "line";
  static constexpr std::string_view meaning = "beams of equal length on a straight line";
  Vector3d start{};
  Vector3d end{};
  int elements = 0;
  static constexpr auto fields() {
    return field_table(required("start", &LineMesh::start, any_number, "one end"),
                       required("end", &LineMesh::end, any_number, "the other end"),
                       required("elements", &LineMesh::elements, at_least_one, "elements along the line"));
  }
  constexpr std::string_view fault() const {
    if (start == end) return "the line has no length; its end must differ from its start";
    return fault_of_size(elements, 1, 1);
  }
};

/// Sets: xmin xmax ymin ymax zmin zmax (the outermost layers), bottom (= zmin), top, all.
struct ParticleBox {
  Vector3d size{};
  double spacing = 0;
  static constexpr auto fields() {
    return field_table(required("size", &ParticleBox::size, positive, "edge lengths along x, y, z"),
                       required("spacing", &ParticleBox::spacing, positive,
                                "of the particles; rounded to what divides the edges"));
  }
};
/// Sets: bottom top (the outermost layers), all.
struct ParticleCylinder {
  double radius = 0;
  double height = 0;
  double spacing = 0;
  double inner_radius = 0;
  static constexpr auto fields() {
    return field_table(
        required("radius", &ParticleCylinder::radius, positive, "radius"),
        required("height", &ParticleCylinder::height, positive, "length along z"),
        required("spacing", &ParticleCylinder::spacing, positive,
                 "of the particles; along z rounded to what divides the height"),
        optional("inner_radius", &ParticleCylinder::inner_radius, non_negative, "radius of a hole"));
  }
  constexpr std::string_view fault() const {
    return radius <= inner_radius ? "the wall has no thickness; radius must exceed inner_radius" : "";
  }
};
/// Set: all.
struct ParticleSphere {
  double radius = 0;
  double spacing = 0;
  static constexpr auto fields() {
    return field_table(required("radius", &ParticleSphere::radius, positive, "radius"),
                       required("spacing", &ParticleSphere::spacing, positive, "of the particles"));
  }
};

/// Particles on a cubic lattice inside a shape; their volumes sum up to that of the shape.
struct ParticleMesh {
  static constexpr std::string_view name = "particles";
  static constexpr std::string_view meaning =
      "particles on a cubic lattice inside a shape, whose volume they share; one of the shapes";
  std::optional<ParticleBox> box;
  std::optional<ParticleCylinder> cylinder;
  std::optional<ParticleSphere> sphere;
  static constexpr auto fields() {
    return field_table(optional("box", &ParticleMesh::box, any_number, "a box centred on the origin"),
                       optional("cylinder", &ParticleMesh::cylinder, any_number,
                                "a cylinder or a tube about the z axis, from z = 0 to the height"),
                       optional("sphere", &ParticleMesh::sphere, any_number, "a sphere about the origin"));
  }
  std::string_view fault() const;
};

/// Formats of mesh files.
enum class MeshFormat { gmsh, abaqus, ls_dyna, exodus };
constexpr std::array<NamedValue<MeshFormat>, 4> named_values(MeshFormat) {
  return {{{"gmsh", MeshFormat::gmsh},
           {"abaqus", MeshFormat::abaqus},
           {"ls_dyna", MeshFormat::ls_dyna},
           {"exodus", MeshFormat::exodus}}};
}

/// A block of a mesh file: one named in `meshes`, or a file of its own.
struct MeshFromFile {
  static constexpr std::string_view name = "file";
  static constexpr std::string_view meaning =
      "a block of a mesh file; sets: those of the file that have nodes in the block, and all";
  std::string from{};
  std::string file{};
  std::optional<MeshFormat> format{};
  std::string block{};
  double scale = 1;
  std::optional<double> particle_volume{};
  std::shared_ptr<const Mesh> mesh{};  ///< what was read, scaled, before it is placed; no entry of a deck
  static constexpr auto fields() {
    return field_table(
        optional("from", &MeshFromFile::from, any_number, "name of one of the meshes"),
        optional("file", &MeshFromFile::file, any_number,
                 "mesh file, in place of `from`; relative to the folder of the deck"),
        optional("format", &MeshFromFile::format, any_number,
                 "of `file`; default: by its suffix (.msh, .inp, .k, .key, .dyn, .e, .exo, .g)"),
        optional("block", &MeshFromFile::block, any_number,
                 "name or number of a block of the file; default: the one of the highest dimension"),
        optional("scale", &MeshFromFile::scale, positive, "multiplies the coordinates of the file"),
        optional("particle_volume", &MeshFromFile::particle_volume, positive,
                 "of each particle, for particles whose file gives none, length^3"));
  }
  constexpr std::string_view fault() const {
    if (from.empty() == file.empty())
      return "the mesh is not said once; accepted is one of from (a name in meshes) and file";
    return format && file.empty() ? "format without file; that of `from` stands in meshes" : "";
  }
};

using MeshSource = std::variant<BoxMesh, PlateMesh, CylinderMesh, TubeMesh, RodMesh, WedgeMesh, SphereMesh,
                                HollowSphereMesh, LineMesh, ParticleMesh, MeshFromFile>;

}  // namespace brio
