#pragma once
/// Contents of a deck. These structs are also the parameters of the run: there is no parallel set.
///
/// A rule that binds several entries of a struct is its `fault()`: what is wrong and what is accepted, or
/// nothing.

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "contact/options.hpp"
#include "elements/block.hpp"
#include "materials/material.hpp"
#include "src/base/fields.hpp"
#include "src/deck/conditions.hpp"
#include "src/deck/force_output.hpp"
#include "src/deck/mesh_source.hpp"
#include "src/deck/spring.hpp"
#include "src/deck/time_section.hpp"

namespace brio {

// ---- parts
// ---------------------------------------------------------------------------------------------------

/// Turn about an axis through the origin.
struct Rotation {
  Vector3d axis{};
  double degrees = 0;
  static constexpr auto fields() {
    return field_table(
        required("axis", &Rotation::axis, any_number, "direction of the axis through the origin"),
        required("degrees", &Rotation::degrees, any_number, "angle, right-handed"));
  }
  constexpr std::string_view fault() const {
    return is_zero(axis) ? "the axis has no direction; at least one component must differ from 0" : "";
  }
};

/// First turned, then moved.
struct Placement {
  std::optional<Rotation> rotate;
  Vector3d translate{};
  static constexpr auto fields() {
    return field_table(
        optional("rotate", &Placement::rotate, any_number, "turn before moving"),
        optional("translate", &Placement::translate, any_number, "move after turning, length"));
  }
};

/// A mesh file, of which parts take blocks.
struct MeshFile {
  std::string name{};
  std::string file{};
  std::optional<MeshFormat> format{};
  std::string place{};  ///< in the deck
  static constexpr auto fields() {
    return field_table(
        required("file", &MeshFile::file, any_number, "mesh file, relative to the folder of the deck"),
        optional("format", &MeshFile::format, any_number,
                 "default: by the suffix of the file (.msh, .inp, .k, .key, .dyn, .e, .exo, .g)"));
  }
};

struct Part {
  std::string name;
  MeshSource mesh;
  Placement placement;
  Element element;
  std::string material;
  std::optional<Deletion> deletion{};
  std::string place{};  ///< in the deck
  double damping = 0;
  static constexpr auto fields() {
    return field_table(required("mesh", &Part::mesh, any_number, "shape and number of elements"),
                       optional("placement", &Part::placement, any_number, "where the shape is put"),
                       required("element", &Part::element, any_number, "kind of element"),
                       required("material", &Part::material, any_number, "name of one of the materials"),
                       optional("deletion", &Part::deletion, any_number,
                                "when elements are deleted, besides by failure of the material"),
                       optional("damping", &Part::damping, non_negative,
                                "alpha of mass-proportional damping, a force -alpha m v, 1/time"));
  }
};

// ---- connections
// -----------------------------------------------------------------------------------------------

/// `merge: [panel, stiffener]`: parts that share nodes.
struct Merge {
  static constexpr std::string_view name = "merge";
  static constexpr std::string_view meaning = "parts that share nodes";
  std::vector<std::string> parts;  ///< two
  double tolerance = 0;
  std::string place;  ///< in the deck
  static constexpr auto fields() {
    return field_table(
        required("merge", &Merge::parts, any_number,
                 "two parts; nodes of the second become nodes of the first"),
        required("tolerance", &Merge::tolerance, positive, "largest distance of two nodes that become one"));
  }
};

/// Forces at which a tied node comes off: (normal / normal_force)^2 + (shear / shear_force)^2 = 1, the first
/// term in tension only.
struct TieFailure {
  std::optional<double> normal_force{};
  std::optional<double> shear_force{};
  static constexpr auto fields() {
    return field_table(optional("normal_force", &TieFailure::normal_force, positive,
                                "tension of a tied node, force; absent: tension does not count"),
                       optional("shear_force", &TieFailure::shear_force, positive,
                                "force along the face of a tied node; absent: shear does not count"));
  }
  constexpr std::string_view fault() const {
    return normal_force || shear_force ? "" : "no force is given; accepted: normal_force, shear_force";
  }
};

/// `tie: [stiffener, panel]`: nodes of the first are tied to faces of the second.
struct TieToSurface {
  static constexpr std::string_view name = "tie";
  static constexpr std::string_view meaning = "nodes tied to a surface (tied contact)";
  std::vector<std::string> names;  ///< "part" or "part.set", and a part
  double tolerance = 0;
  std::string place;  ///< in the deck
  std::optional<TieFailure> failure{};
  static constexpr auto fields() {
    return field_table(required("tie", &TieToSurface::names, any_number,
                                "a part or a set whose nodes are tied, and the part with the main surface"),
                       required("tolerance", &TieToSurface::tolerance, positive,
                                "largest distance of a tied node from the surface"),
                       optional("failure", &TieToSurface::failure, any_number,
                                "forces at which tied nodes come off; absent: they never do"));
  }
};

using Connection = std::variant<Merge, TieToSurface>;

// ---- the rest
// --------------------------------------------------------------------------------------------------

/// Rule for contact of two parts, or of a part with itself.
struct ContactPair {
  std::vector<std::string> parts;  ///< two
  std::optional<double> friction{};
  bool touch = true;
  std::string place{};  ///< in the deck
  static constexpr auto fields() {
    return field_table(optional("friction", &ContactPair::friction, non_negative,
                                "Coulomb coefficient between the two in place of that of all, -"),
                       optional("touch", &ContactPair::touch, any_number, "false: the two never touch"));
  }
  constexpr std::string_view fault() const {
    if (touch && !friction) return "nothing is said of the pair; accepted: friction, touch: false";
    return !touch && friction ? "friction of parts that never touch; leave out one of them" : "";
  }
};

/// `surfaces: all` or a list of parts; `exclude` takes parts out. The options stand beside them in the deck.
struct ContactSection {
  std::vector<std::string> surfaces;  ///< empty: all parts
  std::vector<std::string> exclude;
  std::vector<ContactPair> pairs;
  ContactOptions options;
  std::string place{};  ///< in the deck
};

/// Either equally spaced or at given times.
struct FieldOutput {
  std::optional<double> every;
  std::vector<double> times;
  std::vector<std::string> variables;
  static constexpr auto fields() {
    return field_table(
        optional("every", &FieldOutput::every, positive,
                 "time between dumps; default: a twentieth of the end time"),
        optional("times", &FieldOutput::times, non_negative, "times of dumps instead"),
        optional(
            "variables", &FieldOutput::variables, any_number,
            "fields, a list: default, all, von_mises, pressure, triaxiality, internal_energy, "
            "internal_energy_density, hourglass_energy_density, strain (logarithmic), strain_rate; with "
            "contact contact_pressure, contact_gap; of shells stress_top, stress_middle, stress_bottom, "
            "equivalent_plastic_strain_top, equivalent_plastic_strain_middle, "
            "equivalent_plastic_strain_bottom, membrane_force, bending_moment; of beams beam_force, "
            "beam_moment, beam_twist; of nodes of both rotation (not a number in other elements); or a name "
            "of the history of a material, such as temperature (not a number in materials that do not know "
            "it); or state, all that elements remember, from "
            "which other decks can start; part and element_id are written in any case; default: [default] "
            "(docs/results.md)"));
  }
  std::string_view fault() const {
    return every && !times.empty() ? "both 'every' and 'times' are given; one of them is accepted" : "";
  }
};
/// A node whose motion is written to every row of the history.
struct Probe {
  std::string name;
  Vector3d point{};
  std::optional<std::string> part;
  static constexpr auto fields() {
    return field_table(
        required("point", &Probe::point, any_number, "the node that is nearest to it at the start"),
        optional("part", &Probe::part, any_number, "of this part only; default: of all"));
  }
};

struct HistoryOutput {
  std::optional<double> every;
  std::vector<Probe> probes;
  std::optional<ForceOutput> forces;
  bool rigid_bodies = false;
  bool part_energies = false;
  static constexpr auto fields() {
    return field_table(
        optional("every", &HistoryOutput::every, positive,
                 "time between rows; default: a thousandth of the end time"),
        optional("probes", &HistoryOutput::probes, any_number,
                 "a map of names to nodes whose displacement and velocity are written as well"),
        optional("forces", &HistoryOutput::forces, any_number,
                 "forces that are written as well: means over the time since the row before"),
        optional("rigid_bodies", &HistoryOutput::rigid_bodies, any_number,
                 "true: columns PART.centre_x, _y, _z of the centre of mass and PART.rotation_x, _y, _z, the "
                 "rotation vector from the start, in radians and at most pi long, of every rigid part"),
        optional("part_energies", &HistoryOutput::part_energies, any_number,
                 "true: columns PART.kinetic, PART.internal, PART.hourglass of every part"));
  }
};
struct RestartOutput {
  double every = 0;
  static constexpr auto fields() {
    return field_table(required(
        "every", &RestartOutput::every, positive,
        "time between restart files; the last and the one before are kept, and one is written at the "
        "end"));
  }
};
/// When results are brought from the memory of the system to the disk.
enum class Sync { never, end, dumps };
constexpr std::array<NamedValue<Sync>, 3> named_values(Sync) {
  return {{{"never", Sync::never}, {"end", Sync::end}, {"dumps", Sync::dumps}}};
}

struct OutputSection {
  FieldOutput fields_;
  HistoryOutput history;
  std::optional<RestartOutput> restart;
  Sync sync = Sync::end;
  static constexpr auto fields() {
    return field_table(
        optional("fields", &OutputSection::fields_, any_number, "when fields are written"),
        optional("history", &OutputSection::history, any_number, "when energies and momenta are written"),
        optional(
            "restart", &OutputSection::restart, any_number,
            "when the state of the run is saved, to go on from by --restart; a run that is terminated or "
            "stopped saves it in any case"),
        optional("sync", &OutputSection::sync, any_number,
                 "when results are forced to the disk (fsync), so that they outlive a crash of the machine: "
                 "at the end of the run, at every dump, or never"));
  }
};

/// Defaults of settings that a deck leaves open.
enum class Preset { fast, balanced, accurate };
constexpr std::array<NamedValue<Preset>, 3> named_values(Preset) {
  return {{{"fast", Preset::fast}, {"balanced", Preset::balanced}, {"accurate", Preset::accurate}}};
}

struct NumericsSection {
  Preset preset = Preset::balanced;
  Precision precision = Precision::double_precision;
  double energy_error_limit = 0.1;
  double hourglass_warning = 0.1;
  static constexpr auto fields() {
    return field_table(
        optional("preset", &NumericsSection::preset, any_number,
                 "settings for what the deck leaves open; balanced: the defaults of this reference"),
        optional("precision", &NumericsSection::precision, any_number, "of element and material kernels"),
        optional("energy_error_limit", &NumericsSection::energy_error_limit, positive,
                 "relative energy error at which the run stops with exit code 3, -"),
        optional("hourglass_warning", &NumericsSection::hourglass_warning, positive,
                 "ratio of the hourglass energy of a part, where that is a thousandth of the run's energy or "
                 "more, to its "
                 "largest internal energy so far, beyond "
                 "which a run warns, -"));
  }
};

struct Deck {
  // Compiled once: they are a third of the code of a source that takes them.
  Deck();
  Deck(const Deck&);
  Deck(Deck&&) noexcept;
  Deck& operator=(const Deck&);
  Deck& operator=(Deck&&) noexcept;
  ~Deck();

  std::string file;  ///< as given on the command line
  std::string title;
  std::vector<std::pair<std::string, std::string>> units;  ///< labels only: nothing is converted
  std::string text;                                        ///< the deck as run, with overrides, as YAML
  Parameters parameters;
  std::vector<std::pair<std::string, Material>> materials;
  std::vector<MeshFile> meshes;
  std::vector<std::string> mesh_checksums{};  ///< of each mesh file that was read: its name and checksum
  std::vector<std::string> mesh_notices{};    ///< what was left out of mesh files
  std::vector<Part> parts;
  std::vector<Connection> connections;
  std::vector<PointMass> point_masses;
  std::vector<Spring> springs;
  std::vector<std::pair<std::string, CoordinateSystem>> coordinate_systems;
  std::vector<InitialCondition> initial_conditions;
  std::vector<BoundaryCondition> boundary_conditions;
  std::vector<Load> loads;
  std::optional<ContactSection> contact;
  TimeSection time;
  OutputSection output;
  NumericsSection numerics;
  static constexpr auto fields() {
    return field_table(
        optional("title", &Deck::title, any_number, "one line, for people"),
        optional("units", &Deck::units, any_number, "labels such as {length: mm}; nothing is converted"),
        optional("parameters", &Deck::parameters, any_number,
                 "a map of names to numbers, for expressions in quotes; a later one may use those before it"),
        required("materials", &Deck::materials, any_number, "a map of names to laws"),
        optional("meshes", &Deck::meshes, any_number,
                 "a map of names to mesh files, of which parts take blocks"),
        required("parts", &Deck::parts, any_number, "a map of names to parts"),
        optional("connections", &Deck::connections, any_number,
                 "connections between parts: shared nodes and ties"),
        optional("point_masses", &Deck::point_masses, any_number, "masses on nodes; absent: none"),
        optional("springs", &Deck::springs, any_number,
                 "a map of names to springs and dashpots between two points or sets; absent: none"),
        optional("coordinate_systems", &Deck::coordinate_systems, any_number,
                 "a map of names to local coordinate systems, for motions that are prescribed and loads"),
        optional("initial_conditions", &Deck::initial_conditions, any_number,
                 "velocities at the start, and states from earlier results"),
        optional("boundary_conditions", &Deck::boundary_conditions, any_number,
                 "motions that are prescribed"),
        optional("loads", &Deck::loads, any_number, "forces from outside"),
        optional("contact", &Deck::contact, any_number, "contact between parts; absent: none"),
        required("time", &Deck::time, any_number, "end time and time step"),
        optional("output", &Deck::output, any_number, "output of fields and history"),
        optional("numerics", &Deck::numerics, any_number, "how the computer does it"));
  }
};

}  // namespace brio
