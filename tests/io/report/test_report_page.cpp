// The page of a small result, read as a browser would.

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>

#include "io/files/file_error.hpp"
#include "io/report/quantize.hpp"
#include "io/report/write_report.hpp"
#include "io/results/write_results.hpp"
#include "src/base/index.hpp"
#include "tests/io/results/result_scene.hpp"

namespace brio {
namespace {

using nlohmann::json;

constexpr int dumps = 7;
/// Cells that are gone at each dump.
constexpr int deleted[dumps] = {0, 0, 1, 1, 2, 2, 3};

const char* const deck = R"(title: "</script><b>"
units: {length: mm, stress: MPa}
parts:
  block: {element: hex8}
  skin: {element: {type: shell4, thickness: 0.25}}
  rod: {element: {type: beam2, section: {rectangle: {width: 2, height: 3}}, orientation: [0, 0, 1]}}
  dust: {element: particle}
)";

/// Cells of four parts: hexahedra, shells, a beam, a particle.
Snapshot snapshot(int dump) {
  Snapshot s = test::mixed_snapshot(dump, deleted[dump]);
  const std::size_t cells = s.topology.cell_type.size();
  s.cell_fields.pop_back();
  FieldArray part{"part", 1, {}, Storage::integer, true}, id{"element_id", 1, {}, Storage::integer, true};
  FieldArray radius{"radius", 1, {}};
  for (std::size_t c = 8 - cells; c < 8; ++c) {
    part.values.push_back(c < 4 ? 0 : c < 6 ? 1 : c < 7 ? 2 : 3);
    id.values.push_back(static_cast<double>(c));
    radius.values.push_back(c < 6 ? 0 : 0.5);
  }
  s.cell_fields.insert(s.cell_fields.end(), {part, id, radius});
  return s;
}

class ReportPage : public testing::Test {
 protected:
  void SetUp() override {
    ResultWriter writer(folder_ / "scene.results", "scene",
                        {"</script><b>", "scene.yaml", deck, {"time.end=1"}, "0.1.0", 1},
                        {"time", "kinetic"});
    for (int dump = 0; dump < dumps; ++dump) writer.write(snapshot(dump));
    History history({"time", "kinetic"});
    for (int i = 0; i < 10; ++i) history.append(std::vector<double>{0.1 * i, i * 2.0});
    writer.write(history);
  }

  std::string page(ReportOptions options = {}) {
    options.result = folder_ / "scene.results";
    return report_page(options);
  }

  test::Folder folder_;
};

std::string content(const std::string& page, const std::string& id) {
  const std::size_t begin = page.find("id=\"" + id + "\">") + id.size() + 6;
  return page.substr(begin, page.find("</script>", begin) - begin);
}

std::vector<unsigned char> bytes(const std::string& page, const std::string& id) {
  const std::string letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::vector<unsigned char> result;
  std::uint32_t group = 0;
  int bits = 0;
  for (const char c : content(page, id)) {
    if (c == '=') break;
    group = group << 6 | static_cast<std::uint32_t>(letters.find(c));
    bits += 6;
    if (bits >= 8) result.push_back(static_cast<unsigned char>(group >> (bits -= 8)));
  }
  return result;
}

std::uint16_t number(const std::vector<unsigned char>& table, std::size_t i) {
  return static_cast<std::uint16_t>(table.at(2 * i) | table.at(2 * i + 1) << 8);
}

TEST_F(ReportPage, HoldsPositionsToHalfAStepOfTheBox) {
  const std::string text = page();
  const json shown = json::parse(content(text, "head"))["scene"];
  ASSERT_EQ(shown["nodes"], 27);
  const std::vector<unsigned char> table = bytes(text, "positions");
  ASSERT_EQ(table.size(), 2u * 3 * 27 * dumps);
  for (int dump = 0; dump < dumps; ++dump) {
    const std::vector<double> points = test::mixed_points(dump);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double min = shown["box"]["min"][i % 3], max = shown["box"]["max"][i % 3];
      const double value = min + (max - min) * number(table, index(dump) * points.size() + i) / 65534;
      EXPECT_NEAR(value, points[i], 0.5 * (max - min) / 65534 * (1 + 1e-9));
    }
  }
}

TEST_F(ReportPage, HoldsFieldsOfCellsThatAreLeft) {
  const std::string text = page({.fields = {"damage", "velocity", "stress_xy"}});
  const json fields = json::parse(content(text, "head"))["scene"]["fields"];
  ASSERT_EQ(fields.size(), 3u);
  EXPECT_EQ(fields[0]["name"], "damage");
  EXPECT_EQ(fields[1]["points"], true);
  const std::vector<unsigned char> damage = bytes(text, fields[0]["table"]);
  ASSERT_EQ(damage.size(), 2u * 8 * dumps);
  for (int dump = 0; dump < dumps; ++dump)
    for (int cell = 0; cell < 8; ++cell) {
      const std::uint16_t code = number(damage, index(8 * dump + cell));
      EXPECT_EQ(code == no_value, cell < deleted[dump]) << dump << ' ' << cell;
      if (cell < deleted[dump]) continue;
      const double min = fields[0]["min"], max = fields[0]["max"];
      EXPECT_NEAR(min + (max - min) * code / 65534, test::coded(dump, 3, index(cell - deleted[dump]), 0),
                  0.5 * (max - min) / 65534 * (1 + 1e-9));
    }
}

TEST_F(ReportPage, ThinsFrames) {
  const json shown = json::parse(content(page({.frames = 3}), "head"))["scene"];
  EXPECT_EQ(shown["times"], (json{0.0, 0.003, 0.006}));
  EXPECT_EQ(shown["dumps"], dumps);
}

TEST_F(ReportPage, KnowsShapesAndUnitsOfTheDeck) {
  const std::string text = page();
  const json head = json::parse(content(text, "head"));
  const json& parts = head["scene"]["parts"];
  ASSERT_EQ(parts.size(), 4u);
  EXPECT_EQ(parts[0]["name"], "block");
  EXPECT_EQ(parts[2]["section"], (json{{"kind", "rectangle"}, {"width", 2.0}, {"height", 3.0}}));
  EXPECT_EQ(parts[2]["orientation"], (json{0.0, 0.0, 1.0}));
  EXPECT_EQ(head["units"]["stress"], "MPa");
  const std::vector<unsigned char> sizes = bytes(text, "cell_size");
  ASSERT_EQ(sizes.size(), 4u * 8);
  float thickness = 0, radius = 0;
  std::memcpy(&thickness, &sizes[4 * 4], 4);
  std::memcpy(&radius, &sizes[4 * 7], 4);
  EXPECT_EQ(thickness, 0.25F) << "of the deck";
  EXPECT_EQ(radius, 0.5F) << "of the result";
}

TEST_F(ReportPage, TakesTextsOfAResultForNothingButText) {
  const std::string text = page();
  EXPECT_EQ(text.find("<b>"), std::string::npos);
  EXPECT_EQ(json::parse(content(text, "head"))["title"], "</script><b>");
  EXPECT_NE(text.find("<title>&lt;/script>&lt;b></title>"), std::string::npos);
}

TEST_F(ReportPage, AsksForNothingElse) {
  const std::string text = page();
  for (const char* word : {"http://", "https://", " src=", "@import", "url(", "fetch(", "import("})
    EXPECT_EQ(text.find(word), std::string::npos) << word;
  EXPECT_NE(text.find("default-src 'none'"), std::string::npos);
}

TEST_F(ReportPage, NamesTheFieldsThatThereAre) {
  try {
    page({.fields = {"dammage"}});
    FAIL();
  } catch (const FileError& fault) {
    const std::string said = fault.what();
    for (const char* name : {"'dammage'", "damage", "von_mises", "velocity_x"})
      EXPECT_NE(said.find(name), std::string::npos) << said;
  }
}

TEST(ReportPageName, StandsBesideTheResult) {
  const auto name = [](const char* result) { return page_of({.result = result}).string(); };
  EXPECT_EQ(name("runs/can.results"), "runs/can.html");
  EXPECT_EQ(name("runs/can.results/"), "runs/can.html");
  EXPECT_EQ(name("can.results/can.vtkhdf"), "can.results/can.html");
  EXPECT_EQ(name("v1.2"), "v1.2.html");
  EXPECT_EQ(page_of({.result = "a.results", .output = "b.htm"}).string(), "b.htm");
}

}  // namespace
}  // namespace brio
