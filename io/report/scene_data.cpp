#include "io/report/scene_data.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "io/report/deck_labels.hpp"
#include "io/report/quantize.hpp"
#include "io/report/surface.hpp"
#include "src/base/index.hpp"

namespace brio {

namespace {

using nlohmann::json;

// Rows and columns of the scene in the result, and back.
struct Scene {
  const ResultInfo& info;
  const ResultReader& reader;
  const std::vector<std::size_t>& frames;
  SceneCells cells;
  std::vector<Facet> facets;
  std::vector<std::size_t> node;  ///< seen, as in the result
  std::vector<std::size_t> cell;  ///< seen, as in `cells`
};

std::vector<std::int64_t> integers(const ReadField& field) {
  return {field.values.begin(), field.values.end()};
}

void expect(bool holds, const ResultInfo& info, const char* fault) {
  if (!holds) throw FileError(info.file, fault);
}

void check_cells(const SceneCells& cells, const ResultInfo& info) {
  const auto points = info.points;
  expect(cells.offset.size() == cells.size() + 1 && cells.id.size() == cells.size(), info,
         "is broken: numbers of cells differ");
  expect(std::ranges::is_sorted(cells.offset) && cells.offset.front() == 0 &&
             cells.offset.back() == static_cast<std::int64_t>(cells.connectivity.size()),
         info, "is broken: cells begin outside of its connectivity");
  expect(std::ranges::all_of(cells.connectivity, [&](std::int64_t p) { return p >= 0 && p < points; }), info,
         "is broken: cells name points that there are not");
  expect(std::ranges::all_of(cells.part, [](std::int64_t p) { return p >= 0 && p < 65536; }), info,
         "is broken: numbers of parts lie outside of 0 to 65535");
}

SceneCells read_cells(const ResultInfo& info, const ResultReader& reader,
                      const std::vector<std::size_t>& frames) {
  ReadCells first = reader.cells(frames.front());
  SceneCells cells{std::move(first.connectivity), std::move(first.offset), std::move(first.part), {}, {}};
  cells.id = integers(reader.field("element_id", frames.front()));
  cells.until.assign(cells.size(), static_cast<int>(frames.size()));
  check_cells(cells, info);
  for (std::size_t f = 1; f < frames.size(); ++f)
    expect(cells.keep(static_cast<int>(f), integers(reader.field("part", frames[f])),
                      integers(reader.field("element_id", frames[f]))),
           info, "cells appear that were not there at the first dump shown");
  return cells;
}

// Renumbers what is seen. \param used of all \return those of them that are, in order
std::vector<std::size_t> compacted(std::vector<std::int64_t>& used) {
  std::vector<std::size_t> seen;
  for (std::size_t i = 0; i < used.size(); ++i)
    if (used[i] >= 0) {
      used[i] = static_cast<std::int64_t>(seen.size());
      seen.push_back(i);
    }
  return seen;
}

void number_what_is_seen(Scene& scene) {
  std::vector<std::int64_t> node(index(scene.info.points), -1);
  std::vector<std::int64_t> cell(scene.cells.size(), -1);
  for (const Facet& facet : scene.facets) {
    cell[facet.cell] = 0;
    for (const std::int64_t n : facet.node) node[index(n)] = 0;
  }
  scene.node = compacted(node);
  scene.cell = compacted(cell);
  for (Facet& facet : scene.facets) {
    facet.cell = index(cell[facet.cell]);
    for (std::int64_t& n : facet.node) n = node[index(n)];
  }
}

void add_facets(const Scene& scene, PageTables& tables) {
  ByteTable nodes, life, kind;
  for (const Facet& facet : scene.facets) {
    for (const std::int64_t n : facet.node) nodes.add(static_cast<std::uint32_t>(n));
    nodes.add(static_cast<std::uint32_t>(facet.cell));
    life.add(static_cast<std::uint16_t>(facet.from));
    life.add(static_cast<std::uint16_t>(facet.until));
    kind.add(static_cast<std::uint8_t>(facet.kind));
  }
  tables.emplace_back("facets", base64(nodes.bytes()));
  tables.emplace_back("facet_life", base64(life.bytes()));
  tables.emplace_back("facet_kind", base64(kind.bytes()));
}

// Thickness or radius of each cell at the first frame, as far as the result has them.
std::vector<double> sizes_of_cells(const Scene& scene) {
  std::vector<double> sizes(scene.cells.size(), 0.0);
  for (const char* name : {"thickness", "radius"}) {
    if (std::ranges::find(scene.info.fields, name, &FieldInfo::name) == scene.info.fields.end()) continue;
    const ReadField field = scene.reader.field(name, scene.frames.front());
    for (std::size_t c = 0; c < std::min(field.rows, sizes.size()); ++c)
      if ((scene.cells.corners(c) == 4) == (name[0] == 't') && std::isfinite(field.values[c]))
        sizes[c] = field.values[c];
  }
  return sizes;
}

void add_cells(const Scene& scene, const json& parts, PageTables& tables) {
  const std::vector<double> sizes = sizes_of_cells(scene);
  ByteTable part, size;
  for (const std::size_t c : scene.cell) {
    const auto number = index(scene.cells.part[c]);
    const bool is_known = sizes[c] > 0 || scene.cells.corners(c) != 4;
    part.add(static_cast<std::uint16_t>(number));
    size.add(static_cast<float>(is_known ? sizes[c] : parts[number].value("thickness", 0.0)));
  }
  tables.emplace_back("cell_part", base64(part.bytes()));
  tables.emplace_back("cell_size", base64(size.bytes()));
}

// Coordinates of nodes that are seen, by axis.
std::array<std::vector<double>, 3> positions_in(const Scene& scene, std::size_t frame) {
  const ReadField field = scene.reader.field("position", scene.frames[frame]);
  expect(field.components == 3 && field.rows == index(scene.info.points), scene.info,
         "numbers of points differ between dumps");
  std::array<std::vector<double>, 3> place;
  for (const std::size_t n : scene.node)
    for (std::size_t axis = 0; axis < 3; ++axis) place[axis].push_back(field.values[3 * n + axis]);
  return place;
}

void add_positions(const Scene& scene, json& head, PageTables& tables) {
  std::array<QuantizedRange, 3> box;
  for (std::size_t f = 0; f < scene.frames.size(); ++f) {
    const auto place = positions_in(scene, f);
    for (std::size_t axis = 0; axis < 3; ++axis) box[axis].grow(place[axis]);
  }
  ByteTable table;
  for (std::size_t f = 0; f < scene.frames.size(); ++f) {
    const auto place = positions_in(scene, f);
    for (std::size_t n = 0; n < scene.node.size(); ++n)
      for (std::size_t axis = 0; axis < 3; ++axis) table.add(quantized(place[axis][n], box[axis]));
  }
  for (const QuantizedRange& range : box) {
    head["box"]["min"].push_back(range.min);
    head["box"]["max"].push_back(range.max);
  }
  tables.emplace_back("positions", base64(table.bytes()));
}

// Of nodes or cells that are seen; not a number where a cell is gone.
std::vector<double> values_in(const Scene& scene, const ReportField& field, std::size_t frame) {
  const std::vector<double> values = values_of(field, scene.reader.field(field.source, scene.frames[frame]));
  const std::vector<std::size_t>& seen = field.of_points ? scene.node : scene.cell;
  std::vector<double> result(seen.size(), std::nan(""));
  if (field.of_points) {
    for (std::size_t i = 0; i < seen.size(); ++i)
      if (seen[i] < values.size()) result[i] = values[seen[i]];
    return result;
  }
  std::vector<double> of_all(scene.cells.size(), std::nan(""));
  const std::vector<std::size_t> alive = scene.cells.alive(static_cast<int>(frame));
  for (std::size_t row = 0; row < std::min(alive.size(), values.size()); ++row)
    of_all[alive[row]] = values[row];
  for (std::size_t i = 0; i < seen.size(); ++i) result[i] = of_all[seen[i]];
  return result;
}

void add_field(const Scene& scene, const ReportField& field, bool even_if_zero, json& head,
               PageTables& tables) {
  QuantizedRange range;
  for (std::size_t f = 0; f < scene.frames.size(); ++f) range.grow(values_in(scene, field, f));
  if (!even_if_zero && range.min == 0 && range.max == 0) return;
  ByteTable table;
  for (std::size_t f = 0; f < scene.frames.size(); ++f)
    for (const double value : values_in(scene, field, f)) table.add(quantized(value, range));
  const std::string name = "field" + std::to_string(head["fields"].size());
  head["fields"].push_back({{"name", field.name},
                            {"points", field.of_points},
                            {"min", range.min},
                            {"max", range.max},
                            {"table", name}});
  tables.emplace_back(name, base64(table.bytes()));
}

}  // namespace

json scene_data(const ResultInfo& info, const std::vector<std::size_t>& frames,
                const std::vector<std::string>& wanted, PageTables& tables) {
  const ResultReader reader(info.file);
  Scene scene{info, reader, frames, read_cells(info, reader, frames), {}, {}, {}};
  scene.facets = facets_of(scene.cells);
  number_what_is_seen(scene);
  json head{{"dumps", info.times.size()},
            {"nodes", scene.node.size()},
            {"cells", scene.cell.size()},
            {"facets", scene.facets.size()},
            {"fields", json::array()},
            {"times", json::array()},
            {"box", {{"min", json::array()}, {"max", json::array()}}}};
  for (const std::size_t dump : frames) head["times"].push_back(info.times[dump]);
  const std::int64_t parts = scene.cells.part.empty() ? 0 : *std::ranges::max_element(scene.cells.part) + 1;
  head["parts"] = parts_of_deck(info.deck_text, parts);
  add_facets(scene, tables);
  add_cells(scene, head["parts"], tables);
  add_positions(scene, head, tables);
  for (const ReportField& field : report_fields(info, wanted))
    add_field(scene, field, !wanted.empty(), head, tables);
  return head;
}

json history_data(const ResultReader& reader, std::size_t limit, PageTables& tables) {
  const ReadHistory history = reader.history();
  const std::size_t columns = history.columns.size();
  const std::size_t rows = columns > 0 ? history.values.size() / columns : 0;
  const std::vector<std::size_t> kept = rows > 0 ? thinned(rows, limit) : std::vector<std::size_t>{};
  ByteTable table;
  for (std::size_t c = 0; c < columns; ++c)
    for (const std::size_t row : kept) table.add(static_cast<float>(history.values[row * columns + c]));
  tables.emplace_back("history", base64(table.bytes()));
  return {{"columns", history.columns}, {"rows", kept.size()}, {"rows_in_result", rows}};
}

}  // namespace brio
