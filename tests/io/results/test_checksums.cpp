/// Every byte that a dump appends has a checksum, and a file that differs is named with dump and table.

#include <gtest/gtest.h>
#include <hdf5.h>

#include <fstream>
#include <functional>
#include <random>

#include "io/files/checksum.hpp"
#include "io/files/hdf5_file.hpp"
#include "io/results/dump_checksums.hpp"
#include "io/results/read_info.hpp"
#include "io/results/write_results.hpp"
#include "src/base/index.hpp"
#include "tests/io/results/result_scene.hpp"

namespace brio {
namespace {

namespace fs = std::filesystem;
using test::Folder;
using test::mixed_snapshot;

std::uint64_t sum(const std::string& text) { return checksum(text.data(), text.size()); }

/// Of the reference implementation.
TEST(Checksum, IsXxHash64) {
  EXPECT_EQ(sum(""), 0xef46db3751d8e999U);
  EXPECT_EQ(sum("a"), 0xd24ec4f1a98c6e5bU);
  EXPECT_EQ(sum("abc"), 0x44bc2cf5ad770999U);
  EXPECT_EQ(sum("Nobody inspects the spammish repetition"), 0xfbcea83c8a378bf1U);
}

TEST(Checksum, SeesEveryBit) {
  std::string text = "The quick brown fox jumps over the lazy dog, twice, and sleeps for the day.";
  const std::uint64_t whole = sum(text);
  for (std::size_t bit = 0; bit < 8 * text.size(); ++bit) {
    text[bit / 8] = static_cast<char>(text[bit / 8] ^ (1 << bit % 8));
    EXPECT_NE(sum(text), whole) << bit;
    text[bit / 8] = static_cast<char>(text[bit / 8] ^ (1 << bit % 8));
  }
}

constexpr int dump_count = 4;

/// Four dumps with a deletion before the third, and history.
fs::path write_result(const Folder& folder, int compression) {
  ResultWriter writer(folder.path(), "scene",
                      {"A title", "deck.yaml", "text of the deck", {"a=1"}, "0.1.0", 2}, {"time", "energy"},
                      {.compression = compression});
  History history({"time", "energy"});
  for (int dump = 0; dump < dump_count; ++dump) {
    writer.write(mixed_snapshot(dump, dump < 2 ? 0 : 3));
    for (int i = 0; i < 3; ++i) history.append(std::vector<double>{dump + 0.25 * i, 10.0 - i});
    writer.write(history);
  }
  return writer.vtkhdf();
}

std::vector<std::string> faults(const fs::path& path) {
  return verify_checksums(Hdf5File::open_to_read(path));
}

/// Names of all tables of numbers.
std::vector<std::string> tables(const fs::path& path) {
  std::vector<std::string> names;
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  const auto add = [](hid_t, const char* name, const H5O_info_t* info, void* list) -> herr_t {
    if (info->type == H5O_TYPE_DATASET) static_cast<std::vector<std::string>*>(list)->emplace_back(name);
    return 0;
  };
  H5Ovisit(file, H5_INDEX_NAME, H5_ITER_INC, add, &names);
  H5Fclose(file);
  return names;
}

/// Adds 1 to the last value of a table.
void change_last_value(const fs::path& path, const std::string& table) {
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  const hid_t dataset = H5Dopen2(file, table.c_str(), H5P_DEFAULT);
  const hid_t space = H5Dget_space(dataset), type = H5Dget_type(dataset);
  if (H5Tget_class(type) == H5T_STRING) {
    std::string text(index(H5Sget_simple_extent_npoints(space)) * H5Tget_size(type), 0);
    H5Dread(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, text.data());
    ++text[0];
    H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, text.data());
  } else {
    std::vector<double> values(index(H5Sget_simple_extent_npoints(space)));
    H5Dread(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
    values.back() += 1;
    H5Dwrite(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
  }
  H5Tclose(type);
  H5Sclose(space);
  H5Dclose(dataset);
  H5Fclose(file);
}

TEST(DumpChecksums, FitWhatWasWritten) {
  for (const int compression : {0, 6}) {
    const Folder folder;
    EXPECT_EQ(faults(write_result(folder, compression)), std::vector<std::string>{});
    EXPECT_NE(verify_result(folder.path()).find("4 dumps and 12 rows"), std::string::npos);
  }
}

TEST(DumpChecksums, NameTheTableThatWasChanged) {
  const Folder folder;
  const fs::path whole = write_result(folder, 0), changed = folder / "changed.h5";
  int seen = 0;
  for (const std::string& table : tables(whole)) {
    SCOPED_TRACE(table);
    fs::copy_file(whole, changed, fs::copy_options::overwrite_existing);
    if (table == "history/columns" || table == "checksums/tables") continue;
    change_last_value(changed, table);
    const std::vector<std::string> found = faults(changed);
    ASSERT_GE(found.size(), 1u);
    ++seen;
    if (table.starts_with("VTKHDF") || table.starts_with("xdmf")) {
      EXPECT_NE(found[0].find("/" + table), std::string::npos) << found[0];
      EXPECT_EQ(found[0].find("dump "), 0u) << found[0];
    } else if (table.starts_with("history")) {
      EXPECT_EQ(found[0].find("history, from row 9 on"), 0u) << found[0];
    } else if (table.starts_with("deck")) {
      EXPECT_EQ(found[0], "/deck is not as it was written");
    }
  }
  EXPECT_GT(seen, 35);
}

TEST(DumpChecksums, TellWhichDump) {
  const Folder folder;
  const fs::path path = write_result(folder, 0);
  change_last_value(path, "/VTKHDF/PointData/velocity");
  EXPECT_EQ(faults(path), (std::vector<std::string>{
                              "dump 3 at time 0.003: /VTKHDF/PointData/velocity is not as it was written"}));
  try {
    verify_result(path);
    ADD_FAILURE() << "not refused";
  } catch (const FileError& error) {
    EXPECT_EQ(error.what(),
              path.string() +
                  ": is damaged\n  dump 3 at time 0.003: /VTKHDF/PointData/velocity is not as it "
                  "was written");
  }
}

TEST(DumpChecksums, MissDumpsThatWereTakenAway) {
  const Folder folder;
  const fs::path path = write_result(folder, 0);
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  const hid_t dataset = H5Dopen2(file, "/VTKHDF/Steps/Values", H5P_DEFAULT);
  const hsize_t fewer = dump_count - 2;
  H5Dset_extent(dataset, &fewer);
  H5Dclose(dataset);
  H5Fclose(file);
  EXPECT_NE(faults(path).at(0).find("NSteps is 4, but there are times of 2 dumps"), std::string::npos);
}

/// Any single bit: it is named, or nothing that is read depends on it.
TEST(DumpChecksums, SeeFlippedBitsOfTheFile) {
  const Folder folder;
  const fs::path whole_path = write_result(folder, 0), path = folder / "changed.vtkhdf";
  std::ifstream stream(whole_path, std::ios::binary);
  const std::string whole((std::istreambuf_iterator<char>(stream)), {});
  const std::string text = info_text(read_info(whole_path));
  std::mt19937 random(3);
  int named = 0, harmless = 0;
  for (int repeat = 0; repeat < 400; ++repeat) {
    std::string changed = whole;
    const std::size_t bit = random() % (8 * whole.size());
    changed[bit / 8] = static_cast<char>(changed[bit / 8] ^ (1 << bit % 8));
    std::ofstream(path, std::ios::binary) << changed;
    try {
      verify_result(path);
      std::string now = info_text(read_info(path));
      now.replace(now.find(path.string()), path.string().size(), whole_path.string());
      EXPECT_EQ(now, text) << "bit " << bit;
      ++harmless;
    } catch (const FileError&) {
      ++named;
    }
  }
  EXPECT_GT(named, 10);
  EXPECT_GT(harmless, 10) << "chunks are filled in part";
}

TEST(DumpChecksums, AreMissedWhereThereAreNone) {
  const Folder folder;
  const fs::path path = folder / "bare.h5";
  Hdf5File::create(path).close();
  EXPECT_THROW(faults(path), FileError);
}

}  // namespace
}  // namespace brio
