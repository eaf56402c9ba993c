#include <fmt/format.h>

#include "io/schema/write_schema.hpp"
#include "src/fields/cell_variables.hpp"
#include "src/fields/contact_fields.hpp"
#include "src/fields/rotation.hpp"
#include "src/output/result_tables.hpp"

namespace brio {

namespace {

constexpr std::string_view beginning_of_results = R"(# Results: what is written, and what it means

<!-- Written by `brio schema --results`; do not edit. -->

Files, locks, checksums and what a crash can destroy: [result_files.md](result_files.md). Units are those of the deck: `stress` is force over
area, `-` is none.

## Fields

Tensors have the components xx, yy, zz, xy, yz, xz on global axes; stress is Cauchy's, and tension is positive.
`output.fields.variables` chooses those of elements, and of points those that are not always written: `default`, `all` (those that
the kinds of elements of the deck have), or names. What is of some kinds of elements alone is not a number (NaN) in others, and a
deck without any is refused such a name.

A dump has the time that was asked for. Positions and displacements are of that time: in a time step nodes move evenly. Velocities are of
that half step, and all else is of the beginning of the step, except with `state`, where a dump has the time of a step.

| field | components | of | unit | meaning |
| --- | --- | --- | --- | --- |
)";

std::string field_row(std::string_view name, int components, std::string_view of, std::string_view unit,
                      std::string_view meaning) {
  return fmt::format("| `{}` | {} | {} | {} | {} |\n", name,
                     components > 0 ? std::to_string(components) : "by scene", of, unit, meaning);
}

std::string kinds_of(const CellVariable& variable) {
  if (variable.of == &ElementTraits::has_thickness) return "shells";
  if (variable.of == &ElementTraits::has_section) return "beams";
  if (variable.of == &ElementTraits::has_hourglass_control) return "hex8, shells, particles";
  return variable.is_partial() ? "hexahedra, shells" : "elements";
}

std::string field_rows() {
  std::string rows = field_row("displacement", 3, "points", "length", "since the start") +
                     field_row("velocity", 3, "points", "velocity", "of the last half step");
  const PointVariable& force = contact_force_variable();
  rows += field_row(force.name, force.components, "points, with contact", force.unit, force.meaning);
  rows += field_row("node_id", 1, "points, with mesh files", "-",
                    "number in the file; of generated meshes likewise as `element_id`");
  for (const DefaultField& field : default_fields())
    rows += field_row(field.name, field.components, field.of, field.unit, field.meaning);
  for (const CellVariable& variable : chosen_variables())
    rows +=
        field_row(variable.name, variable.components, kinds_of(variable), variable.unit, variable.meaning);
  for (const PointVariable& variable : contact_variables())
    rows += field_row(variable.name, variable.components, "points, with contact", variable.unit,
                      variable.meaning);
  const PointVariable& rotation = rotation_variable();
  rows += field_row(rotation.name, rotation.components, "points, with shells or beams", rotation.unit,
                    rotation.meaning);
  for (const DefaultField& field : state_fields())
    rows += field_row(field.name, field.components, field.of, field.unit, field.meaning);
  return rows +
         "| a name of a material's history, such as `temperature` | 1 | elements | of the law | largest or "
         "mean of "
         "the integration points; NaN in materials that do not know it |\n";
}

template <class Rows>
std::string table_of(std::string_view heading, std::string_view text, std::string_view what,
                     const Rows& rows) {
  std::string out =
      fmt::format("\n## {}\n\n{}\n\n| {} | unit | meaning |\n| --- | --- | --- |\n", heading, text, what);
  for (const auto& one : rows) out += fmt::format("| `{}` | {} | {} |\n", one.name, one.unit, one.meaning);
  return out;
}

}  // namespace

std::string results_reference() {
  return std::string(beginning_of_results) + field_rows() +
         table_of("History",
                  "Columns of `NAME.history.csv` and of `/history` of the result. A name that ends in `_x` "
                  "stands for those of y and z as well. Of every run:",
                  "column", common_columns()) +
         table_of("History of what a deck has or asks for", "Capital letters stand for names of the deck.",
                  "column", further_columns()) +
         table_of("Summary", "Keys of `NAME.summary.json`; keys inside of a map are joined by points.", "key",
                  summary_table());
}

}  // namespace brio
