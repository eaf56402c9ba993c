// The XDMF companion: which dumps and parts it describes, and when it is written.

#include <gtest/gtest.h>

#include <set>

#include "io/files/hdf5_file.hpp"
#include "io/results/write_results.hpp"
#include "tests/io/results/result_scene.hpp"
#include "tests/io/text_of.hpp"

namespace brio {
namespace {

using test::by_parts;
using test::Folder;
using test::mixed_snapshot;

std::size_t count_of(const std::string& text, const std::string& what) {
  std::size_t count = 0;
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++count;
  return count;
}

/// The times that a description names.
std::set<std::string> times_in(const std::string& text) {
  const std::string begin = "<Time Value=\"";
  std::set<std::string> times;
  for (std::size_t at = text.find(begin); at != std::string::npos; at = text.find(begin, at + 1))
    times.insert(text.substr(at + begin.size(), text.find('"', at + begin.size()) - at - begin.size()));
  return times;
}

/// What a description says of a part; empty where it has no such part.
std::string block_of(const std::string& text, const std::string& part) {
  const std::size_t begin = text.find("<Grid Name=\"" + part + "\"");
  return begin == std::string::npos ? "" : text.substr(begin, text.find("<Grid Name=", begin + 1) - begin);
}

std::string description_of(const std::vector<Snapshot>& dumps) {
  const Folder folder;
  ResultWriter writer(folder.path(), "scene", {}, {"time"});
  for (const Snapshot& dump : dumps) writer.write(dump);
  writer.write(Summary{});
  return test::text_of(writer.xdmf());
}

TEST(XdmfFile, PartWithoutCellsIsNamedAndHasNoGridAtThatTime) {
  std::vector<Snapshot> dumps;
  for (int deleted = 0; deleted < 7; ++deleted) dumps.push_back(by_parts(mixed_snapshot(deleted, deleted)));
  const std::string text = description_of(dumps);
  EXPECT_EQ(count_of(text, "<Grid Name="), 4u);
  EXPECT_EQ(times_in(block_of(text, "bricks")).size(), 4u);
  EXPECT_EQ(times_in(block_of(text, "plates")).size(), 6u);
  EXPECT_EQ(times_in(block_of(text, "cable")).size(), 7u);
  EXPECT_EQ(times_in(block_of(text, "mass")).size(), 7u);
  EXPECT_EQ(text.find("NumberOfElements=\"0\""), std::string::npos);
}

TEST(XdmfFile, SceneInWhichNothingIsLeftKeepsItsTimes) {
  std::vector<Snapshot> dumps;
  for (int dump = 0; dump < 4; ++dump) dumps.push_back(by_parts(mixed_snapshot(dump, dump < 2 ? 0 : 8)));
  const std::string text = description_of(dumps);
  EXPECT_EQ(times_in(text).size(), 4u);
  EXPECT_EQ(times_in(block_of(text, "bricks")).size(), 4u);  // a vertex stands for the scene
  EXPECT_EQ(times_in(block_of(text, "mass")).size(), 2u);
}

TEST(XdmfFile, PartThatNeverHasACellIsLeftOut) {
  const std::string text = description_of({by_parts(mixed_snapshot(0, 4)), by_parts(mixed_snapshot(1, 5))});
  EXPECT_EQ(block_of(text, "bricks"), "");
  EXPECT_NE(block_of(text, "plates"), "");
}

TEST(XdmfFile, SceneOfMoreThanAHundredPartsIsShownWhole) {
  for (const std::size_t parts : {100u, 101u}) {
    Snapshot scene = by_parts(mixed_snapshot(0, 0));
    while (scene.parts.size() < parts) scene.parts.push_back({.name = "none"});
    const Folder folder;
    ResultWriter writer(folder.path(), "scene", {}, {"time"});
    writer.write(scene);
    const bool whole = parts > 100;
    EXPECT_EQ(Hdf5File::open_to_read(writer.vtkhdf()).contains("/xdmf/MixedTopology"), whole);
    EXPECT_EQ(count_of(test::text_of(writer.xdmf()), "<Grid Name="), whole ? 1u : 4u);
  }
}

TEST(XdmfFile, SixComponentsAreAMatrixOfOneRow) {
  const std::string text = description_of({by_parts(mixed_snapshot(0, 0))});
  EXPECT_NE(block_of(text, "bricks")
                .find("Name=\"stress\" AttributeType=\"Matrix\" Center=\"Cell\">"
                      "<DataItem ItemType=\"HyperSlab\" Dimensions=\"4 1 6\">"),
            std::string::npos);
}

/// So that the time to write it grows with the dumps, not with their square.
TEST(XdmfFile, AllTextsOfARunAreElevenTimesTheLast) {
  const Folder folder;
  ResultWriter writer(folder.path(), "scene", {}, {"time"});
  std::size_t described = 0, written = 0;
  for (std::size_t dump = 1; dump <= 150; ++dump) {
    writer.write(by_parts(mixed_snapshot(static_cast<int>(dump), 0)));
    const std::size_t now = times_in(test::text_of(writer.xdmf())).size();
    EXPECT_LE(now, dump);
    EXPECT_GT(11 * now, 10 * dump) << "a tenth is missing";
    if (now != described) written += now;
    described = now;
  }
  EXPECT_LE(written, 11 * described);
}

TEST(XdmfFile, IsWholeWhenTheRunEnds) {
  std::vector<Snapshot> dumps;
  for (int dump = 0; dump < 12; ++dump) dumps.push_back(by_parts(mixed_snapshot(dump, 0)));
  EXPECT_EQ(times_in(description_of(dumps)).size(), 12u);
}

TEST(XdmfFile, IsWholeWhenTheRunIsSaved) {
  const Folder folder;
  ResultWriter writer(folder.path(), "scene", {}, {"time"});
  for (int dump = 0; dump < 12; ++dump) writer.write(by_parts(mixed_snapshot(dump, 0)));
  ASSERT_EQ(times_in(test::text_of(writer.xdmf())).size(), 11u);
  writer.note_position();
  EXPECT_EQ(times_in(test::text_of(writer.xdmf())).size(), 12u);
}

}  // namespace
}  // namespace brio
