#include <gtest/gtest.h>
#include <hdf5.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "io/files/hdf5_file.hpp"
#include "io/results/write_results.hpp"
#include "src/base/index.hpp"
#include "tests/io/results/result_scene.hpp"
#include "tests/io/text_of.hpp"

namespace brio {
namespace {

using Integers = std::vector<std::int64_t>;
using test::Folder;
using test::mixed_snapshot;

const std::vector<std::string> history_columns{"time", "kinetic_energy", "probe.tip"};
/// Also the number of deleted cells; at the end nothing is left.
const std::vector<int> topology_versions{0, 0, 1, 1, 3, 8, 8};

RunRecord record() {
  return {"Can – buckling",         "inputs/can.yaml", "title: Can\nparts: {}\n",
          {"time.end=1e-3", "a=b"}, "0.1.0",           2};
}

void write_all_dumps(ResultWriter& writer) {
  for (std::size_t dump = 0; dump < topology_versions.size(); ++dump) {
    writer.write(mixed_snapshot(static_cast<int>(dump), topology_versions[dump]));
  }
}

/// A result of seven dumps, made once.
class ResultFile : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder = new Folder;
    ResultWriter writer(*folder / "scene.results", "scene", record(), history_columns);
    write_all_dumps(writer);
  }
  static void TearDownTestSuite() {
    delete folder;
    folder = nullptr;
  }
  static Hdf5File open() { return Hdf5File::open_to_read(*folder / "scene.results/scene.vtkhdf"); }

  static Folder* folder;
};
Folder* ResultFile::folder = nullptr;

/// Reads a whole one-dimensional or (n, 1) table of integers.
Integers column(const Hdf5File& file, const std::string& table) {
  return file.read_integers(table, 0, file.dimensions(table).at(0));
}

TEST_F(ResultFile, TypeAttributeIsSixteenAsciiBytesWithoutTerminator) {
  const Hdf5File file = open();
  const Hdf5Handle attribute(H5Aopen_by_name(file.id(), "/VTKHDF", "Type", H5P_DEFAULT, H5P_DEFAULT),
                             H5Aclose);
  const Hdf5Handle type(H5Aget_type(attribute.id()), H5Tclose);
  const Hdf5Handle space(H5Aget_space(attribute.id()), H5Sclose);
  EXPECT_EQ(H5Tget_class(type.id()), H5T_STRING);
  EXPECT_EQ(H5Tis_variable_str(type.id()), 0);
  EXPECT_EQ(H5Tget_size(type.id()), 16u);
  EXPECT_EQ(H5Tget_strpad(type.id()), H5T_STR_NULLPAD);
  EXPECT_EQ(H5Tget_cset(type.id()), H5T_CSET_ASCII);
  EXPECT_EQ(H5Sget_simple_extent_type(space.id()), H5S_SCALAR);
  EXPECT_EQ(file.read_text_attribute("/VTKHDF", "Type"), "UnstructuredGrid");
}

TEST_F(ResultFile, VersionIsTwoSixtyFourBitIntegers) {
  const Hdf5File file = open();
  const Hdf5Handle attribute(H5Aopen_by_name(file.id(), "/VTKHDF", "Version", H5P_DEFAULT, H5P_DEFAULT),
                             H5Aclose);
  const Hdf5Handle type(H5Aget_type(attribute.id()), H5Tclose);
  const Hdf5Handle space(H5Aget_space(attribute.id()), H5Sclose);
  EXPECT_GT(H5Tequal(type.id(), H5T_STD_I64LE), 0);
  EXPECT_EQ(H5Sget_simple_extent_ndims(space.id()), 1);
  ASSERT_EQ(H5Sget_simple_extent_npoints(space.id()), 2);
  Integers version(2);
  ASSERT_GE(H5Aread(attribute.id(), H5T_NATIVE_INT64, version.data()), 0);
  EXPECT_EQ(version, (Integers{2, 0}));
}

TEST_F(ResultFile, NumberOfStepsIsAScalarSixtyFourBitInteger) {
  const Hdf5File file = open();
  const Hdf5Handle attribute(H5Aopen_by_name(file.id(), "/VTKHDF/Steps", "NSteps", H5P_DEFAULT, H5P_DEFAULT),
                             H5Aclose);
  const Hdf5Handle type(H5Aget_type(attribute.id()), H5Tclose);
  const Hdf5Handle space(H5Aget_space(attribute.id()), H5Sclose);
  EXPECT_GT(H5Tequal(type.id(), H5T_STD_I64LE), 0);
  EXPECT_EQ(H5Sget_simple_extent_type(space.id()), H5S_SCALAR);
  EXPECT_EQ(file.read_integer_attribute("/VTKHDF/Steps", "NSteps"), 7);
}

/// Every dataset of the page: its type and its shape.
TEST_F(ResultFile, DatasetsHaveTheTypesAndShapesThatReadersExpect) {
  struct Expected {
    hid_t type;
    Integers shape;
  };
  const hid_t i64 = H5T_STD_I64LE;
  const hid_t f32 = H5T_IEEE_F32LE;
  const hid_t f64 = H5T_IEEE_F64LE;
  const std::map<std::string, Expected> datasets{
      {"NumberOfPoints", {i64, {4}}},
      {"NumberOfCells", {i64, {4}}},
      {"NumberOfConnectivityIds", {i64, {4}}},
      {"Points", {f64, {7 * 27, 3}}},
      {"Connectivity", {i64, {43 + 35 + 19 + 1}}},
      {"Types", {H5T_STD_U8LE, {8 + 7 + 5 + 1}}},
      {"Offsets", {i64, {9 + 8 + 6 + 2}}},
      {"PointData/displacement", {f64, {7 * 27, 3}}},
      {"PointData/velocity", {f32, {7 * 27, 3}}},
      {"CellData/stress", {f32, {8 + 8 + 7 + 7 + 5 + 1 + 1, 6}}},
      {"CellData/damage", {f32, {8 + 8 + 7 + 7 + 5 + 1 + 1, 1}}},
      {"CellData/element_id", {i64, {8 + 7 + 5 + 1, 1}}},
      {"FieldData/total_energy", {f64, {7, 1}}},
      {"FieldData/momentum", {f64, {7, 3}}},
      {"Steps/Values", {f64, {7}}},
      {"Steps/PartOffsets", {i64, {7}}},
      {"Steps/NumberOfParts", {i64, {7}}},
      {"Steps/PointOffsets", {i64, {7}}},
      {"Steps/CellOffsets", {i64, {7, 1}}},
      {"Steps/ConnectivityIdOffsets", {i64, {7, 1}}},
      {"Steps/PointDataOffsets/displacement", {i64, {7}}},
      {"Steps/PointDataOffsets/velocity", {i64, {7}}},
      {"Steps/CellDataOffsets/stress", {i64, {7}}},
      {"Steps/CellDataOffsets/damage", {i64, {7}}},
      {"Steps/CellDataOffsets/element_id", {i64, {7}}},
      {"Steps/FieldDataOffsets/total_energy", {i64, {7}}},
      {"Steps/FieldDataOffsets/momentum", {i64, {7}}},
      {"Steps/FieldDataSizes/total_energy", {i64, {7, 2}}},
      {"Steps/FieldDataSizes/momentum", {i64, {7, 2}}},
  };
  const Hdf5File file = open();
  for (const auto& [name, expected] : datasets) {
    SCOPED_TRACE(name);
    ASSERT_TRUE(file.contains("/VTKHDF/" + name));
    const Hdf5Handle dataset(H5Dopen2(file.id(), ("/VTKHDF/" + name).c_str(), H5P_DEFAULT), H5Dclose);
    const Hdf5Handle type(H5Dget_type(dataset.id()), H5Tclose);
    EXPECT_GT(H5Tequal(type.id(), expected.type), 0);
    EXPECT_EQ(file.dimensions("/VTKHDF/" + name), expected.shape);
  }
  const auto count = [&](const std::string& group) { return file.members("/VTKHDF" + group).size(); };
  EXPECT_EQ(count("") + count("/Steps") + count("/PointData") + count("/CellData") + count("/FieldData") +
                count("/Steps/PointDataOffsets") + count("/Steps/CellDataOffsets") +
                count("/Steps/FieldDataOffsets") + count("/Steps/FieldDataSizes"),
            datasets.size() + 8);  // nothing but these datasets and eight groups
}

TEST_F(ResultFile, TopologyIsWrittenOnceAVersionAndReferredToByOffsets) {
  const Hdf5File file = open();
  EXPECT_EQ(column(file, "/VTKHDF/Steps/PartOffsets"), (Integers{0, 0, 1, 1, 2, 3, 3}));
  EXPECT_EQ(column(file, "/VTKHDF/Steps/NumberOfParts"), (Integers{1, 1, 1, 1, 1, 1, 1}));
  EXPECT_EQ(column(file, "/VTKHDF/Steps/CellOffsets"), (Integers{0, 0, 8, 8, 15, 20, 20}));
  EXPECT_EQ(column(file, "/VTKHDF/Steps/ConnectivityIdOffsets"), (Integers{0, 0, 43, 43, 78, 97, 97}));
  EXPECT_EQ(column(file, "/VTKHDF/NumberOfPoints"), (Integers{27, 27, 27, 27}));
  EXPECT_EQ(column(file, "/VTKHDF/NumberOfCells"), (Integers{8, 7, 5, 1}));
  EXPECT_EQ(column(file, "/VTKHDF/NumberOfConnectivityIds"), (Integers{43, 35, 19, 1}));
  Integers connectivity, offsets, types;
  for (const int deleted : {0, 1, 3}) {
    const Topology cells = test::mixed_cells(deleted);
    connectivity.insert(connectivity.end(), cells.connectivity.begin(), cells.connectivity.end());
    offsets.insert(offsets.end(), cells.offset.begin(), cells.offset.end());
    types.insert(types.end(), cells.cell_type.begin(), cells.cell_type.end());
  }
  connectivity.push_back(0);  // the vertex that stands for a scene without cells
  offsets.insert(offsets.end(), {0, 1});
  types.push_back(1);
  EXPECT_EQ(column(file, "/VTKHDF/Connectivity"), connectivity);
  EXPECT_EQ(column(file, "/VTKHDF/Offsets"), offsets);
  EXPECT_EQ(column(file, "/VTKHDF/Types"), types);
}

TEST_F(ResultFile, MixedListNamesCellsInTheCodesOfXdmf) {
  const Hdf5File file = open();
  const Integers list = column(file, "/xdmf/MixedTopology");
  // The last quadrilateral, the line and the vertex of the first version.
  const Integers first(list.begin() + 43, list.begin() + 53);
  EXPECT_EQ(list[0], 9);
  EXPECT_EQ(list[36], 5);
  EXPECT_EQ(first, (Integers{24, 25, 22, 2, 2, 23, 26, 1, 1, 26}));
  EXPECT_EQ(list.back(), 0);
  EXPECT_EQ(list.size(), 53u + 44u + 26u + 3u);
}

TEST_F(ResultFile, EveryDumpReadsBackThroughItsOffsets) {
  const Hdf5File file = open();
  for (int dump = 0; dump < 7; ++dump) {
    SCOPED_TRACE(dump);
    const int version = topology_versions[index(dump)];
    const Snapshot expected = mixed_snapshot(dump, version);
    const auto offset = [&](const std::string& name) {
      return file.read_integers("/VTKHDF/Steps/" + name, dump, 1).at(0);
    };
    EXPECT_EQ(file.read_rows("/VTKHDF/Steps/Values", dump, 1).at(0), expected.time);
    EXPECT_EQ(file.read_rows("/VTKHDF/Points", offset("PointOffsets"), 27), expected.points);
    for (const FieldArray& field : expected.point_fields) {
      EXPECT_EQ(
          file.read_rows("/VTKHDF/PointData/" + field.name, offset("PointDataOffsets/" + field.name), 27),
          field.values);
    }
    const auto cells = static_cast<std::int64_t>(expected.topology.cell_type.size());
    for (const FieldArray& field : expected.cell_fields) {
      EXPECT_EQ(
          file.read_rows("/VTKHDF/CellData/" + field.name, offset("CellDataOffsets/" + field.name), cells),
          field.values);
    }
    for (const FieldArray& field : expected.global_fields) {
      EXPECT_EQ(
          file.read_rows("/VTKHDF/FieldData/" + field.name, offset("FieldDataOffsets/" + field.name), 1),
          field.values);
      EXPECT_EQ(file.read_integers("/VTKHDF/Steps/FieldDataSizes/" + field.name, dump, 1),
                (Integers{field.components, 1}));
    }
  }
}

TEST_F(ResultFile, FieldsThatFollowTheTopologyAreNotRepeated) {
  const Hdf5File file = open();
  EXPECT_EQ(column(file, "/VTKHDF/Steps/CellDataOffsets/element_id"), (Integers{0, 0, 8, 8, 15, 20, 20}));
  EXPECT_EQ(column(file, "/VTKHDF/Steps/CellDataOffsets/stress"), (Integers{0, 8, 16, 23, 30, 35, 36}));
}

TEST_F(ResultFile, DeckIsKeptAsRun) {
  const Hdf5File file = open();
  EXPECT_EQ(file.read_text("/deck/title"), "Can – buckling");
  EXPECT_EQ(file.read_text("/deck/path"), "inputs/can.yaml");
  EXPECT_EQ(file.read_text("/deck/text"), "title: Can\nparts: {}\n");
  EXPECT_EQ(file.read_texts("/deck/overrides"), (std::vector<std::string>{"time.end=1e-3", "a=b"}));
  EXPECT_EQ(file.read_text("/deck/version"), "0.1.0");
  EXPECT_EQ(file.read_integer_attribute("/deck", "threads"), 2);
}

TEST_F(ResultFile, NothingTemporaryIsLeftAfterTheFirstDump) {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(*folder / "scene.results")) {
    names.push_back(entry.path().filename().string());
  }
  std::sort(names.begin(), names.end());
  EXPECT_EQ(names, (std::vector<std::string>{"scene.history.csv", "scene.vtkhdf", "scene.xdmf2"}));
}

TEST(ResultWriter, CompressedFilesHoldTheSameNumbers) {
  const Folder folder;
  ResultWriter writer(folder.path(), "scene", record(), history_columns, {.compression = 4});
  write_all_dumps(writer);
  const Hdf5File file = Hdf5File::open_to_read(writer.vtkhdf());
  for (int dump = 0; dump < 7; ++dump) {
    const Snapshot expected = mixed_snapshot(dump, topology_versions[index(dump)]);
    const std::int64_t row = file.read_integers("/VTKHDF/Steps/PointDataOffsets/velocity", dump, 1).at(0);
    EXPECT_EQ(file.read_rows("/VTKHDF/PointData/velocity", row, 27), expected.point_fields[1].values);
  }
}

TEST(HistoryFile, RowsOfAllBatchesAreInBothTablesToTheLastBit) {
  const Folder folder;
  ResultWriter writer(folder.path(), "scene", record(), history_columns);
  History history(history_columns, 10);
  std::vector<double> expected;
  for (int i = 0; i < 37; ++i) {
    const double row[] = {i / 7.0, std::exp(-i * 1.0), i == 5 ? std::nan("") : -1.0 / (i + 1)};
    history.append(row);
    expected.insert(expected.end(), std::begin(row), std::end(row));
    if (i == 12) writer.write(mixed_snapshot(0, 0));
    if (history.full()) writer.write(history);
  }
  writer.write(history);
  EXPECT_EQ(history.pending_rows(), 0u);

  const Hdf5File file = Hdf5File::open_to_read(writer.vtkhdf());
  EXPECT_EQ(file.read_texts("/history/columns"), history_columns);
  const std::vector<double> stored = file.read_rows("/history/values", 0, 37);
  std::istringstream csv(test::text_of(writer.history_csv()));
  std::string line;
  std::getline(csv, line);
  EXPECT_EQ(line, "time,kinetic_energy,probe.tip");
  for (std::size_t i = 0; i < expected.size(); ++i) {
    std::getline(csv, line, i % 3 == 2 ? '\n' : ',');
    const double read = std::stod(line);
    if (std::isnan(expected[i])) {
      EXPECT_TRUE(std::isnan(stored[i]) && std::isnan(read));
    } else {
      EXPECT_EQ(stored[i], expected[i]);
      EXPECT_EQ(read, expected[i]);
    }
  }
  EXPECT_FALSE(std::getline(csv, line));
}

}  // namespace
}  // namespace brio
