// `brio study`: runs, table, pictures, going on where it was.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <map>
#include <vector>

#include "tests/system/bar_deck.hpp"
#include "tests/system/program.hpp"

namespace brio {
namespace {

namespace fs = std::filesystem;
using ProgramStudy = test::Program;

const std::string bar_study = R"(
title: A bar
deck: bar.yaml
reference: mesh.fine
quantities:
  end: {field: displacement, component: x, point: [0.5, 0.05, 0.05]}
  length: {field: position, component: x, part: bar, take: range, time: 1e-3}
  stress: {field: stress, component: xx, take: max, whole_run: true}
  kinetic: {history: kinetic, take: mean}
  pull: {history: support_impulse_x, rate_over: 1e-4, take: min, factor: -1}
  late_pull: {history: support_impulse_x, rate_over: 1e-4, time: 2e-3, factor: -1}
  late_impulse: {history: support_impulse_x, time: 2e-3, factor: -1}
  before: {history: support_impulse_x, time: 1.9e-3, factor: -1}
  viscous: {summary: energy.viscous, per: energy.total_start}
  speed: {history: momentum_x, time: 0, reference: 1, scale: 2, tolerance: 0.3}
refined: mesh
knobs:
  mesh:
    coarse: {"parts.bar.mesh.box.elements": [10, 1, 1]}
    middle: {"parts.bar.mesh.box.elements": [20, 1, 1]}
    fine: {parts.bar.mesh.box.elements: [40, 1, 1]}
  precision:
    float: {numerics.precision: float}
)";

using Table = std::map<std::string, std::map<std::string, std::string>>;
Table table_of(const std::string& csv) {
  Table table;
  std::istringstream text(csv);
  std::vector<std::string> names;
  for (std::string line; std::getline(text, line);) {
    std::istringstream cells(line);
    std::vector<std::string> row;
    for (std::string cell; std::getline(cells, cell, ',');) row.push_back(cell);
    if (names.empty()) {
      names = row;
      continue;
    }
    for (std::size_t i = 0; i < row.size(); ++i) table[row[0]][names[i]] = row[i];
  }
  return table;
}

TEST_F(ProgramStudy, MakesATableAndPictures) {
  write("bar.yaml", test::bar_deck);
  write("bars.yaml", bar_study);
  const Ending ending = brio("study bars.yaml --jobs 2");
  ASSERT_EQ(ending.exit_code, 0) << ending.faults;
  Table table = table_of(read("bars.study/bars.csv"));
  ASSERT_EQ(table.size(), 5u);
  const auto value = [&](const char* run, const char* column) { return std::stod(table[run][column]); };
  EXPECT_GT(value("mesh.fine", "error"), 0) << "the speed is compared with a number";
  EXPECT_EQ(value("mesh.fine", "length_error"), 0);
  EXPECT_GT(value("mesh.coarse", "length_error"), value("default", "length_error"));
  EXPECT_LT(value("precision.float", "kinetic_error"), 2 * value("default", "kinetic_error"));
  for (const char* run : {"default", "mesh.coarse", "mesh.fine", "precision.float"}) {
    const std::string summary = std::string("bars.study/runs/") + run + "/bar.summary.json";
    const nlohmann::json end = nlohmann::json::parse(read(summary));
    EXPECT_NEAR(value(run, "viscous"),
                end["energy"]["viscous"].get<double>() / end["energy"]["total_start"].get<double>(), 1e-8);
    EXPECT_EQ(value(run, "steps"), end["steps"].get<double>());
    // Nodes of the free end alone move at the start: half an element of mass.
    const double elements = run == std::string("mesh.coarse") ? 10
                            : run == std::string("mesh.fine") ? 40
                                                              : 20;
    EXPECT_NEAR(value(run, "speed"), 1000 * 0.01 / elements / 2, 1e-3 * 0.25);
    EXPECT_GT(value(run, "stress"), 0);
    EXPECT_GT(value(run, "pull"), 0);
    EXPECT_NEAR(value(run, "late_pull"), (value(run, "late_impulse") - value(run, "before")) / 1e-4,
                1e-4 * value(run, "pull"));
  }
  for (const char* picture :
       {"bars.front.svg", "bars.front.png", "bars.knobs.svg", "bars.knobs.png", "bars.gp"})
    EXPECT_GT(read(fs::path("bars.study") / picture).size(), 500u) << picture;
  EXPECT_NE(ending.output.find("| mesh.coarse |"), std::string::npos) << ending.output;
  // Half an element of mass: 0.25 of the reference 1, and half of that with each mesh.
  EXPECT_NE(ending.output.find("speed beyond 30 %"), std::string::npos) << ending.output;
  EXPECT_NE(ending.output.find("Order of convergence"), std::string::npos) << ending.output;
}

TEST_F(ProgramStudy, HoldsAnotherProblemToNoComparison) {
  write("bar.yaml", test::bar_deck);
  write("bars.yaml", bar_study +
                         "  end: {sooner: {time.end: 1e-3}, at_once: {time.end: 1e-5}}\n  mass: {heavier: "
                         "{materials.rubber.density: 1010}}\nphysics: [end, mass]\n");
  const Ending ending = brio("study bars.yaml --jobs 2");
  ASSERT_EQ(ending.exit_code, 0) << ending.faults;
  Table table = table_of(read("bars.study/bars.csv"));
  for (const char* run : {"end.sooner", "end.at_once", "mass.heavier"})
    EXPECT_EQ(table[run]["on_front"], "0");
  EXPECT_NE(ending.output.find("another problem"), std::string::npos) << ending.output;
  EXPECT_NE(ending.output.find("not measured"), std::string::npos)
      << "too short for a rate: " << ending.output;
}

TEST_F(ProgramStudy, DrawsWhereNamesHoldQuotes) {
  write("bar.yaml", test::bar_deck);
  write("it's.yaml", bar_study);
  ASSERT_EQ(brio("study \"it's.yaml\"").exit_code, 0);
  EXPECT_GT(read("it's.study/it's.front.svg").size(), 500u) << read("it's.study/gnuplot.txt");
}

TEST_F(ProgramStudy, GoesOnWhereItWas) {
  write("bar.yaml", test::bar_deck);
  write("bars.yaml", bar_study);
  ASSERT_EQ(brio("study bars.yaml").exit_code, 0);
  const std::string first = read("bars.study/bars.csv");
  const Ending again = brio("study bars.yaml");
  EXPECT_EQ(again.faults, "") << "nothing is run, so nothing is reported";
  EXPECT_EQ(read("bars.study/bars.csv"), first);
  fs::remove(folder_ / "bars.study/runs/mesh.coarse/run.json");
  const Ending one = brio("study bars.yaml");
  EXPECT_NE(one.faults.find("1 of 1  mesh.coarse"), std::string::npos) << one.faults;
  write("bar.yaml", test::bar_deck + "title: another\n");
  EXPECT_NE(brio("study bars.yaml").faults.find("5 of 5"), std::string::npos) << "the deck has changed";
}

TEST_F(ProgramStudy, KeepsWhatFailedInTheTable) {
  write("bar.yaml", test::bar_deck);
  std::string study = bar_study;
  study += "  step:\n    too_large: {time.step: 1e-3}\n";
  write("bars.yaml", study);
  const Ending ending = brio("study bars.yaml");
  EXPECT_EQ(ending.exit_code, 3) << ending.faults;
  Table table = table_of(read("bars.study/bars.csv"));
  EXPECT_EQ(table["step.too_large"]["exit_code"], "3");
  EXPECT_EQ(table["mesh.coarse"]["exit_code"], "0") << "the rest is run all the same";
  const Ending again = brio("study bars.yaml");
  EXPECT_EQ(again.exit_code, 3);
  EXPECT_EQ(again.faults, "") << "what failed is remembered";
  EXPECT_NE(ending.output.find("ended with 3: brio: the constant time step"), std::string::npos)
      << ending.output;
}

TEST_F(ProgramStudy, FaultsNameThePlaceBeforeAnythingRuns) {
  const auto with = [](std::string text, const std::string& from, const std::string& to) {
    return text.replace(text.find(from), from.size(), to);
  };
  write("bar.yaml", test::bar_deck);
  const std::vector<std::pair<std::string, std::string>> faulty{
      {with(bar_study, "deck: bar.yaml", "deck: rod.yaml"), "rod.yaml"},
      {with(bar_study, "reference: mesh.fine", "reference: mesh.finest"), "bad.yaml:4:12: no run is called"},
      {with(bar_study, "reference: mesh.fine\n", ""),
       "bad.yaml:5:3: 'end' has no reference to be compared with"},
      {with(bar_study, "take: mean", "take: median"), "bad.yaml:9:"},
      {with(bar_study, "part: bar", "part: rod"), "bad.yaml:7:"},
      {with(bar_study, "history: kinetic,", "history: kinetic, field: stress,"), "bad.yaml:9:"},
      {with(bar_study, "reference: 1, scale: 2", "reference: 0"), "bad.yaml:15:"},
      {with(bar_study, "{numerics.precision: float}", "{numerics.precission: float}"), "numerics.precission"},
      {with(bar_study, "{numerics.precision: float}", "{}"), "bad.yaml:23:"},
      {with(bar_study, "knobs:", "combinations: [[mesh.fine, mesh.odd]]\nknobs:"), "bad.yaml:17:"},
      {with(bar_study, "knobs:", "physics: [mesh, friction]\nknobs:"),
       "bad.yaml:17:17: no knob is called 'friction'"},
      {with(bar_study, "title:", "titel:"), "bad.yaml:2:1"},
  };
  for (const auto& [text, place] : faulty) {
    write("bad.yaml", text);
    const Ending ending = brio("study bad.yaml");
    EXPECT_EQ(ending.exit_code, 2) << text;
    EXPECT_NE(ending.faults.find(place), std::string::npos) << place << " in " << ending.faults;
    EXPECT_FALSE(fs::exists(folder_ / "bad.study"));
  }
}

}  // namespace
}  // namespace brio
