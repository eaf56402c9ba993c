#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <random>

#include "io/files/hdf5_file.hpp"
#include "io/files/read_apart.hpp"
#include "io/results/read_info.hpp"
#include "io/results/write_results.hpp"
#include "io/results/write_summary.hpp"
#include "tests/io/results/result_scene.hpp"

namespace brio {
namespace {

using test::Folder;
using test::mixed_snapshot;

Summary summary() {
  Summary s;
  s.version = "0.1.0";
  s.deck = "can.yaml";
  s.status = "finished";
  s.steps = 1234;
  s.time = 3e-3;
  s.dt = {1e-7, 3e-7, 2e-7};
  s.nodes = 27;
  s.elements["hex8"] = 4;
  s.elements["shell4"] = 2;
  s.elements["beam2"] = s.elements["particle"] = 1;
  s.deleted["hex8"] = 1;
  s.energy.kinetic = 12.5;
  s.energy.error_relative = 1e-4;
  s.momentum.linear = {1, 2, 3};
  s.momentum.angular = {4, 5, 6};
  s.contact = {10, 20, 30, 4, 1e-3, 0, {}};
  s.wall_s.total = 2.5;
  s.wall_s.by_stage = {{"contact", 1.0}, {"forces", 1.5}};
  s.threads = 2;
  s.active_features = {"hex8", "contact"};
  return s;
}

ResultWriter small_result(const Folder& folder) {
  ResultWriter writer(folder.path(), "scene",
                      {"A title", "can.yaml", "title: A title\n", {"a=1"}, "0.1.0", 2},
                      {"time", "kinetic_energy"});
  for (int dump = 0; dump < 4; ++dump) writer.write(mixed_snapshot(dump, dump < 2 ? 0 : 3));
  return writer;
}

std::vector<std::string> keys(const nlohmann::ordered_json& json) {
  std::vector<std::string> names;
  for (const auto& item : json.items()) names.push_back(item.key());
  return names;
}

TEST(SummaryFile, HasTheKeysOfTheContract) {
  using Names = std::vector<std::string>;
  const auto json = nlohmann::ordered_json::parse(summary_json(summary()));
  EXPECT_EQ(keys(json), (Names{"version",
                               "deck",
                               "status",
                               "exit_code",
                               "steps",
                               "time",
                               "dt",
                               "nodes",
                               "elements",
                               "deleted",
                               "deleted_by_cause",
                               "energy",
                               "hourglass_ratio_max",
                               "mass",
                               "momentum",
                               "contact",
                               "wall_s",
                               "element_updates_per_s",
                               "peak_memory_mb",
                               "threads",
                               "ranks",
                               "active_features",
                               "warnings"}));
  EXPECT_EQ(keys(json["deleted_by_cause"]), (Names{"damage", "plastic_strain", "distortion"}));
  EXPECT_EQ(keys(json["dt"]), (Names{"min", "max", "last"}));
  EXPECT_EQ(keys(json["elements"]), (Names{"hex8", "shell4", "beam2", "particle"}));
  EXPECT_EQ(keys(json["deleted"]), (Names{"hex8", "shell4", "beam2", "particle"}));
  EXPECT_EQ(keys(json["energy"]), (Names{"kinetic", "internal", "hourglass", "viscous", "contact", "friction",
                                         "external", "deleted", "total_start", "error_relative"}));
  EXPECT_EQ(keys(json["hourglass_ratio_max"]), (Names{"value", "part", "time"}));
  EXPECT_EQ(keys(json["momentum"]), (Names{"linear", "angular"}));
  EXPECT_EQ(keys(json["contact"]),
            (Names{"searches", "comparisons", "candidate_pairs", "bodies", "constraints_total", "passes_mean",
                   "certified_share", "last_resort_uses", "unresolved", "active_max", "penetration_max",
                   "missed"}));
  Summary audited = summary();
  audited.contact.audits.emplace();
  audited.contact.audits->crossings = 3;
  const auto clean = nlohmann::ordered_json::parse(summary_json(audited));
  EXPECT_FALSE(json.contains("crossings")) << "nobody looked";
  EXPECT_EQ(clean["crossings"], 3);
  Names of_audits{"searches",          "comparisons",   "candidate_pairs", "bodies",
                  "constraints_total", "passes_mean",   "certified_share", "last_resort_uses",
                  "unresolved",        "active_max",    "penetration_max", "missed",
                  "audited_dumps",     "crossed_dumps", "deep_crossings",  "too_close",
                  "swallowed"};
  EXPECT_EQ(keys(clean["contact"]), of_audits);
  audited.contact.audits->deepest_crossing = {.depth = 0.5, .time = 2, .node = 7, .parts = {"a", "b"}};
  audited.contact.audits->deepest_too_close = {.depth = 0.25, .time = 1, .node = 8, .parts = {"b", "a"}};
  const auto contact = nlohmann::ordered_json::parse(summary_json(audited))["contact"];
  of_audits.insert(of_audits.end(), {"deepest_crossing", "deepest_too_close"});
  EXPECT_EQ(keys(contact), of_audits);
  EXPECT_EQ(keys(contact["deepest_crossing"]), (Names{"depth", "time", "node", "parts"}));
  EXPECT_EQ(contact["deepest_crossing"]["node"], 7);
  EXPECT_EQ(contact["deepest_too_close"]["parts"], (Names{"b", "a"}));
  EXPECT_EQ(keys(json["wall_s"]), (Names{"total", "by_stage"}));
  EXPECT_EQ(json["momentum"]["angular"], (std::vector<double>{4, 5, 6}));
  EXPECT_EQ(json["wall_s"]["by_stage"]["forces"], 1.5);
  EXPECT_EQ(json["active_features"], (std::vector<std::string>{"hex8", "contact"}));
}

TEST(SummaryFile, IsJsonWhateverIsInIt) {
  Summary odd = summary();
  odd.energy.kinetic = std::nan("");
  odd.dt.min = std::numeric_limits<double>::infinity();
  odd.deck = "caf\xe9.yaml";  // not UTF-8
  const auto json = nlohmann::json::parse(summary_json(odd));
  EXPECT_TRUE(json["energy"]["kinetic"].is_null());
  EXPECT_TRUE(json["dt"]["min"].is_null());
}

TEST(ResultInfo, TellsWhatIsInAResult) {
  const Folder folder;
  ResultWriter writer = small_result(folder);
  History history({"time", "kinetic_energy"});
  for (int i = 0; i < 5; ++i) history.append(std::vector<double>{i * 0.5, 10.0 - i});
  writer.write(history);
  writer.write(summary());

  for (const auto& path : {folder.path(), folder / "scene.vtkhdf"}) {
    const ResultInfo info = read_info(path);
    EXPECT_EQ(info.title, "A title");
    EXPECT_EQ(info.overrides, (std::vector<std::string>{"a=1"}));
    EXPECT_EQ(info.threads, 2);
    EXPECT_EQ(info.times, (std::vector<double>{0, 1e-3, 2e-3, 3e-3}));
    EXPECT_EQ(info.points, 27);
    EXPECT_EQ(info.cells, (std::map<std::string, std::int64_t>{
                              {"hexahedra", 1}, {"lines", 1}, {"quadrilaterals", 2}, {"vertices", 1}}));
    ASSERT_EQ(info.fields.size(), 7u);
    EXPECT_EQ(info.fields[0].name, "displacement");
    EXPECT_EQ(info.fields[0].components, 3);
    EXPECT_EQ(info.fields[0].min, test::coded(3, 0, 0, 0));
    EXPECT_EQ(info.fields[0].max, test::coded(3, 0, 26, 2));
    EXPECT_EQ(info.history_rows, 5);
    EXPECT_EQ(info.history_last, (std::vector<double>{2, 6}));
    EXPECT_EQ(info.status, "finished");
    EXPECT_EQ(info.energies.front(), (std::pair<std::string, double>{"kinetic", 12.5}));
    const std::string text = info_text(info);
    for (const char* part : {"A title", "4, from time 0 to 0.003", "27 points, 1 hexahedra", "displacement",
                             "5 rows of 2 columns", "finished (exit code 0) after 1234 steps"}) {
      EXPECT_NE(text.find(part), std::string::npos) << part << " is missing in\n" << text;
    }
  }
}

// Ranges are of the elements that have a field.
TEST(ResultInfo, LeavesOutWhatIsNotANumber) {
  const Folder folder;
  ResultWriter writer(folder.path(), "scene", {"A title", "can.yaml", "title: A title\n", {}, "0.1.0", 2},
                      {"time"});
  Snapshot snapshot = mixed_snapshot(0, 0);
  for (double& value : snapshot.cell_fields[0].values) value = std::nan("");
  std::vector<double>& damage = snapshot.cell_fields[1].values;
  damage.assign(damage.size(), std::nan(""));
  damage[1] = 0.25, damage[3] = -2;
  writer.write(snapshot);
  std::size_t found = 0;
  for (const FieldInfo& field : read_info(folder.path()).fields) {
    if (field.name == "stress") {
      EXPECT_TRUE(std::isnan(field.min) && std::isnan(field.max));
      ++found;
    } else if (field.name == "damage") {
      EXPECT_EQ(field.min, -2);
      EXPECT_EQ(field.max, 0.25);
      ++found;
    }
  }
  EXPECT_EQ(found, 2u);
}

TEST(ResultInfo, OfARunningJobHasNoEndState) {
  const Folder folder;
  const ResultWriter writer = small_result(folder);
  const ResultInfo info = read_info(folder.path());
  EXPECT_EQ(info.status, "");
  EXPECT_EQ(info.history_rows, 0);
  EXPECT_NE(info_text(info).find("no summary"), std::string::npos);
}

std::string refusal(const std::filesystem::path& path) {
  try {
    read_info(path);
  } catch (const FileError& error) {
    EXPECT_NE(std::string(error.what()).find(path.string()), std::string::npos) << error.what();
    return error.what();
  }
  return "no error";
}

TEST(ResultInfo, RefusesWhatIsNotAResult) {
  const Folder folder;
  EXPECT_NE(refusal(folder / "missing").find("No such file or directory"), std::string::npos);
  EXPECT_NE(refusal(folder.path()).find("no .vtkhdf file in this folder"), std::string::npos);
  std::ofstream(folder / "empty.vtkhdf");
  EXPECT_NE(refusal(folder / "empty.vtkhdf").find("the file is empty"), std::string::npos);
  std::ofstream(folder / "text.vtkhdf") << "title: a deck\n";
  EXPECT_NE(refusal(folder / "text.vtkhdf").find("not an HDF5 file"), std::string::npos);
  EXPECT_NE(refusal(folder.path()).find("several results"), std::string::npos);
  Hdf5File::create(folder / "other.h5").close();
  EXPECT_NE(refusal(folder / "other.h5").find("not a result of brio"), std::string::npos);
  EXPECT_NE(refusal("/dev/null").find("not a regular file"), std::string::npos);
}

TEST(ResultInfo, OfARunBeforeItsFirstDumpSaysSo) {
  const Folder folder;
  const ResultWriter writer(folder.path(), "scene", {}, {"time"});
  EXPECT_NE(refusal(folder.path()).find("has not completed its first dump"), std::string::npos);
}

/// A damaged file is an error or a result, never a crash: HDF5 itself reads memory that it has freed where a
/// file is damaged, which ends the process that reads.
TEST(ResultInfo, SurvivesDamagedFiles) {
  const Folder folder;
  const ResultWriter writer = small_result(folder);
  std::ifstream stream(folder / "scene.vtkhdf", std::ios::binary);
  const std::string whole((std::istreambuf_iterator<char>(stream)), {});
  std::mt19937 random(7);
  int refused = 0;
  for (int repeat = 0; repeat < 60; ++repeat) {
    std::string damaged = whole;
    if (repeat % 3 == 0) damaged.resize(random() % whole.size());
    for (int byte = 0; byte < 200 && !damaged.empty(); ++byte) {
      damaged[random() % damaged.size()] = static_cast<char>(random());
    }
    std::ofstream(folder / "damaged.vtkhdf", std::ios::binary) << damaged;
    try {
      read_apart(folder / "damaged.vtkhdf", [&] { return read_info(folder / "damaged.vtkhdf").title; });
    } catch (const FileError&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 20);
}

}  // namespace
}  // namespace brio
