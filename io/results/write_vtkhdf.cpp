#include "io/results/write_vtkhdf.hpp"

#include <algorithm>
#include <cassert>
#include <utility>

#include "io/files/checksum.hpp"
#include "io/files/hdf5_file.hpp"
#include "io/results/dump_checksums.hpp"
#include "src/base/index.hpp"

namespace brio {
namespace {

using std::string;

const string root = "/VTKHDF";
const string steps = "/VTKHDF/Steps";
const string mixed_topology = "/xdmf/MixedTopology";

constexpr hsize_t largest_chunk_rows = 16384;
constexpr hsize_t smallest_chunk_rows = 256;
constexpr hsize_t step_chunk_rows = 1024;  // 8 kB of 8-byte numbers

constexpr std::size_t most_parts_shown = 100;  // as many as the history has columns of

hid_t file_type(Storage storage) {
  switch (storage) {
    case Storage::single_precision:
      return H5T_IEEE_F32LE;
    case Storage::double_precision:
      return H5T_IEEE_F64LE;
    case Storage::integer:
      return H5T_STD_I64LE;
  }
  return -1;
}

/// One dump of a small scene fills one chunk.
hsize_t chunk_rows_for(std::int64_t rows_of_a_dump) {
  return std::clamp(static_cast<hsize_t>(rows_of_a_dump), smallest_chunk_rows, largest_chunk_rows);
}

/// PARENT/NAME
string inside(const string& parent, const string& name) {
  string path;
  return path.append(parent).append("/").append(name);
}

/// Where the offsets of a group's fields stand.
string offsets_group(const string& group) { return inside(steps, group).append("Offsets"); }

std::int64_t append_number(Hdf5File& file, const string& table, std::int64_t value) {
  return file.append_rows(table, 1, H5T_NATIVE_INT64, &value);
}

std::int64_t append_list(Hdf5File& file, const string& table, const std::vector<std::int64_t>& values) {
  return file.append_rows(table, values.size(), H5T_NATIVE_INT64, values.data());
}

Topology single_vertex() { return {{vertex_cell}, {0}, {0, 1}}; }

/// Cells as XDMF lists them: a code, for lines and vertices the number of points, the points.
std::vector<std::int64_t> mixed_list(const Topology& topology) {
  std::vector<std::int64_t> list;
  list.reserve(topology.connectivity.size() + 2 * topology.cell_type.size());
  for (std::size_t cell = 0; cell < topology.cell_type.size(); ++cell) {
    const auto begin = topology.connectivity.begin() + topology.offset[cell];
    const auto end = topology.connectivity.begin() + topology.offset[cell + 1];
    [[maybe_unused]] std::int64_t expected = 0;
    switch (topology.cell_type[cell]) {
      case hexahedron_cell:
        list.push_back(9), expected = 8;
        break;
      case quadrilateral_cell:
        list.push_back(5), expected = 4;
        break;
      case line_cell:
        list.insert(list.end(), {2, 2}), expected = 2;
        break;
      case vertex_cell:
        list.insert(list.end(), {1, 1}), expected = 1;
        break;
      default:
        break;
    }
    assert(expected > 0 && end - begin == expected);
    list.insert(list.end(), begin, end);
  }
  return list;
}

/// Rows of the connectivity: numbers of points.
StoredArray connectivity_rows(std::int64_t first, std::int64_t rows, std::int64_t rows_in_file) {
  return {"", root + "/Connectivity", Storage::integer, 1, first, rows, rows_in_file};
}

/// \param row at which the connectivity of the dump begins
std::vector<StoredPart> parts_of(const Snapshot& snapshot, std::int64_t row) {
  const Topology& topology = snapshot.topology;
  const std::int64_t end = row + topology.offset.back();
  std::vector<StoredPart> parts;
  for (const SnapshotPart& part : snapshot.parts) {
    StoredPart& stored = parts.emplace_back(StoredPart{.range = part});
    if (part.cells == 0) continue;
    const auto first = index(part.first_cell), last = index(part.first_cell + part.cells);
    stored.type = static_cast<CellType>(topology.cell_type[first]);
    assert(std::all_of(topology.cell_type.begin() + part.first_cell,
                       topology.cell_type.begin() + part.first_cell + part.cells,
                       [&](unsigned char type) { return type == *stored.type; }));
    stored.connectivity =
        connectivity_rows(row + topology.offset[first], topology.offset[last] - topology.offset[first], end);
  }
  return parts;
}

/// The vertex that stands for a scene without cells, as its first part.
std::vector<StoredPart> parts_of_nothing(const Snapshot& snapshot, std::int64_t row) {
  std::vector<StoredPart> parts;
  for (const SnapshotPart& part : snapshot.parts) parts.push_back({.range = {.name = part.name}});
  parts.front() = {.range = {.name = snapshot.parts.front().name, .cells = 1, .points = 1},
                   .type = vertex_cell,
                   .connectivity = connectivity_rows(row, 1, row + 1)};
  return parts;
}

}  // namespace

bool is_shown_by_parts(const Snapshot& snapshot) {
  return !snapshot.parts.empty() && snapshot.parts.size() <= most_parts_shown;
}

void VtkhdfWriter::create_fields(Hdf5File& file, const string& group, const std::vector<FieldArray>& fields,
                                 std::int64_t rows, int compression) {
  file.create_group(inside(root, group));
  file.create_group(offsets_group(group));
  for (const FieldArray& field : fields) {
    assert(!field.name.empty() && field.name.find('/') == string::npos && field.components > 0);
    const auto columns = static_cast<hsize_t>(field.components);
    file.create_table(inside(inside(root, group), field.name),
                      {file_type(field.storage), columns, chunk_rows_for(rows), compression});
    file.create_table(inside(offsets_group(group), field.name), {H5T_STD_I64LE, 0, step_chunk_rows});
  }
}

void VtkhdfWriter::create_layout(Hdf5File& file, const Snapshot& snapshot, const Topology& topology) const {
  const auto points = static_cast<std::int64_t>(snapshot.points.size() / 3);
  const auto cells = static_cast<std::int64_t>(topology.cell_type.size());
  const auto corners = static_cast<std::int64_t>(topology.connectivity.size());
  file.create_group(root);
  file.write_attribute(root, "Version", std::vector<std::int64_t>{2, 0});
  file.write_ascii_attribute(root, "Type", "UnstructuredGrid");
  file.create_group(steps);
  file.write_attribute(steps, "NSteps", 0);
  for (const char* name : {"NumberOfPoints", "NumberOfCells", "NumberOfConnectivityIds"}) {
    file.create_table(inside(root, name), {H5T_STD_I64LE, 0, step_chunk_rows});
  }
  file.create_table(root + "/Points", {H5T_IEEE_F64LE, 3, chunk_rows_for(points), compression_});
  file.create_table(root + "/Connectivity", {H5T_STD_I64LE, 0, chunk_rows_for(corners)});
  file.create_table(root + "/Offsets", {H5T_STD_I64LE, 0, chunk_rows_for(cells + 1)});
  file.create_table(root + "/Types", {H5T_STD_U8LE, 0, chunk_rows_for(cells)});
  for (const char* name : {"PartOffsets", "NumberOfParts", "PointOffsets"}) {
    file.create_table(inside(steps, name), {H5T_STD_I64LE, 0, step_chunk_rows});
  }
  for (const char* name : {"CellOffsets", "ConnectivityIdOffsets"}) {
    file.create_table(inside(steps, name), {H5T_STD_I64LE, 1, step_chunk_rows});
  }
  create_fields(file, "PointData", snapshot.point_fields, points, compression_);
  create_fields(file, "CellData", snapshot.cell_fields, cells, compression_);
  create_fields(file, "FieldData", snapshot.global_fields, 1, 0);
  file.create_group(steps + "/FieldDataSizes");
  for (const FieldArray& field : snapshot.global_fields) {
    file.create_table(steps + "/FieldDataSizes/" + field.name, {H5T_STD_I64LE, 2, step_chunk_rows});
  }
  if (!is_shown_by_parts(snapshot)) {
    file.create_group("/xdmf");
    file.create_table(mixed_topology, {H5T_STD_I64LE, 0, chunk_rows_for(corners)});
  }
  file.create_table(steps + "/Values", {H5T_IEEE_F64LE, 0, step_chunk_rows});
}

void VtkhdfWriter::append_topology(Hdf5File& file, const Topology& topology, std::int64_t points,
                                   bool by_parts, Progress& next) {
  assert(topology.offset.size() == topology.cell_type.size() + 1 && topology.offset.front() == 0);
  assert(topology.offset.back() == static_cast<std::int64_t>(topology.connectivity.size()));
  next.points = points;
  next.cells = static_cast<std::int64_t>(topology.cell_type.size());
  next.connectivity_row = append_list(file, root + "/Connectivity", topology.connectivity);
  append_list(file, root + "/Offsets", topology.offset);
  next.cell_row = file.append_rows(root + "/Types", topology.cell_type.size(), H5T_NATIVE_UCHAR,
                                   topology.cell_type.data());
  if (!by_parts) {
    const std::vector<std::int64_t> list = mixed_list(topology);
    const auto length = static_cast<std::int64_t>(list.size());
    const std::int64_t first = append_list(file, mixed_topology, list);
    next.mixed_topology = {"", mixed_topology, Storage::integer, 1, first, length, first + length};
  }
  append_number(file, root + "/NumberOfPoints", points);
  append_number(file, root + "/NumberOfCells", next.cells);
  append_number(file, root + "/NumberOfConnectivityIds",
                static_cast<std::int64_t>(topology.connectivity.size()));
  ++next.parts;
}

std::int64_t VtkhdfWriter::append_values(Hdf5File& file, const string& table, const FieldArray& field,
                                         std::int64_t rows) {
  const auto count = static_cast<hsize_t>(rows);
  assert(field.values.size() == count * static_cast<hsize_t>(field.components));
  switch (field.storage) {
    case Storage::single_precision:
      single_.resize(field.values.size());
      std::transform(field.values.begin(), field.values.end(), single_.begin(),
                     [](double value) { return static_cast<float>(value); });
      return file.append_rows(table, count, H5T_NATIVE_FLOAT, single_.data());
    case Storage::double_precision:
      return file.append_rows(table, count, H5T_NATIVE_DOUBLE, field.values.data());
    case Storage::integer:
      integers_.resize(field.values.size());
      std::transform(field.values.begin(), field.values.end(), integers_.begin(),
                     [](double value) { return static_cast<std::int64_t>(value); });
      return file.append_rows(table, count, H5T_NATIVE_INT64, integers_.data());
  }
  return 0;
}

void VtkhdfWriter::append_fields(Hdf5File& file, const string& group, const std::vector<FieldArray>& fields,
                                 std::int64_t rows, bool new_topology, std::vector<std::int64_t>& fixed_row,
                                 std::vector<StoredArray>& stored) {
  fixed_row.resize(fields.size());
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const FieldArray& field = fields[i];
    const string table = inside(inside(root, group), field.name);
    if (new_topology || !field.fixed_by_topology) fixed_row[i] = append_values(file, table, field, rows);
    append_number(file, inside(offsets_group(group), field.name), fixed_row[i]);
    stored.push_back(
        {field.name, table, field.storage, field.components, fixed_row[i], rows, fixed_row[i] + rows});
  }
}

void VtkhdfWriter::append_global_fields(Hdf5File& file, const std::vector<FieldArray>& fields,
                                        std::vector<StoredArray>& stored) {
  for (const FieldArray& field : fields) {
    const string table = root + "/FieldData/" + field.name;
    const std::int64_t row = append_values(file, table, field, 1);
    append_number(file, steps + "/FieldDataOffsets/" + field.name, row);
    const std::int64_t size[] = {field.components, 1};
    file.append_rows(steps + "/FieldDataSizes/" + field.name, 1, H5T_NATIVE_INT64, size);
    stored.push_back({field.name, table, field.storage, field.components, row, 1, row + 1});
  }
}

StoredDump VtkhdfWriter::append(Hdf5File& file, const Snapshot& snapshot) {
  assert(!snapshot.points.empty() && snapshot.points.size() % 3 == 0);
  const bool nothing_left = snapshot.topology.cell_type.empty();
  const Topology vertex = single_vertex();
  const Topology& topology = nothing_left ? vertex : snapshot.topology;
  Progress next = progress_;
  file.take_appended();  // rows of the history
  if (next.steps == 0) create_layout(file, snapshot, topology);

  const auto points = static_cast<std::int64_t>(snapshot.points.size() / 3);
  const bool new_topology = next.steps == 0 || snapshot.topology_version != next.topology_version;
  const bool by_parts = is_shown_by_parts(snapshot);
  if (new_topology) append_topology(file, topology, points, by_parts, next);
  next.topology_version = snapshot.topology_version;
  assert(next.points == points && next.cells == static_cast<std::int64_t>(topology.cell_type.size()));

  StoredDump dump;
  dump.time = snapshot.time;
  if (!by_parts)
    dump.parts = {{.range = {.name = "scene", .cells = next.cells, .points = points},
                   .connectivity = next.mixed_topology}};
  else
    dump.parts = nothing_left ? parts_of_nothing(snapshot, next.connectivity_row)
                              : parts_of(snapshot, next.connectivity_row);
  const std::int64_t point_row = file.append_rows(root + "/Points", static_cast<hsize_t>(points),
                                                  H5T_NATIVE_DOUBLE, snapshot.points.data());
  dump.coordinates = {"",        root + "/Points", Storage::double_precision, 3,
                      point_row, points,           point_row + points};
  append_fields(file, "PointData", snapshot.point_fields, points, new_topology, next.fixed_point_row,
                dump.point_fields);
  std::vector<FieldArray> zeros;
  if (nothing_left) {
    zeros = snapshot.cell_fields;
    for (FieldArray& field : zeros) field.values.assign(index(field.components), 0.0);
  }
  append_fields(file, "CellData", nothing_left ? zeros : snapshot.cell_fields, next.cells, new_topology,
                next.fixed_cell_row, dump.cell_fields);
  append_global_fields(file, snapshot.global_fields, dump.global_fields);

  append_number(file, steps + "/PartOffsets", next.parts - 1);
  append_number(file, steps + "/NumberOfParts", 1);
  append_number(file, steps + "/PointOffsets", point_row);
  append_number(file, steps + "/CellOffsets", next.cell_row);
  append_number(file, steps + "/ConnectivityIdOffsets", next.connectivity_row);
  std::vector<AppendedRows> rows = file.take_appended();
  rows.push_back({steps + "/Values", next.steps, 1, checksum(&snapshot.time, sizeof snapshot.time)});
  append_dump_checksums(file, next.steps, rows);
  file.commit();
  ++next.steps;
  file.write_attribute(steps, "NSteps", next.steps);
  file.commit();
  file.append_rows(steps + "/Values", 1, H5T_NATIVE_DOUBLE, &snapshot.time);
  file.commit();
  progress_ = std::move(next);
  return dump;
}

}  // namespace brio
