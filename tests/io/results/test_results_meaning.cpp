// The manual names everything that results hold: fields, columns of the history, keys of the summary.

#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <sstream>

#include "io/deck/read_deck.hpp"
#include "io/results/write_summary.hpp"
#include "io/run/run_deck.hpp"
#include "src/output/observe.hpp"
#include "src/output/result_tables.hpp"
#include "src/step/advance.hpp"

namespace brio {
namespace {

using Names = std::set<std::string>;

/// First cells of the tables of docs/results.md that stand under a heading.
Names told_under(const std::string& heading) {
  std::ifstream file(BRIO_SOURCE_DIR "/docs/results.md");
  Names names;
  bool is_there = false;
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with("## ")) is_there = line.starts_with("## " + heading);
    if (!is_there || !line.starts_with("| `")) continue;
    std::stringstream cell(line.substr(3, line.find('`', 3) - 3));
    for (std::string name; std::getline(cell, name, ',');)
      names.insert(name.substr(name.find_first_not_of(' ')));
  }
  return names;
}

/// A name with words in capital letters for what the deck names, as an expression for names.
std::regex pattern_of(const std::string& name) {
  const std::string any_name = std::regex_replace(name, std::regex("[A-Z]+"), "[A-Za-z0-9_-]+");
  return std::regex(std::regex_replace(any_name, std::regex("_(m?)x$"), "_$1[xyz]"));
}
/// Those of the names that fit none of the patterns; `used` gets those that fit.
Names left_out(const Names& names, const Names& patterns, Names& used) {
  Names left;
  for (const std::string& name : names) {
    bool is_told = false;
    for (const std::string& pattern : patterns)
      if (std::regex_match(name, pattern_of(pattern))) {
        is_told = true;
        used.insert(pattern);
      }
    if (!is_told) left.insert(name);
  }
  return left;
}

/// With all that has columns, fields and keys of its own.
constexpr const char* rich_deck = R"(
materials:
  steel: {model: power_law_hardening, density: 8000, youngs_modulus: 2e11, poissons_ratio: 0.3, yield_stress: 3e8,
          hardening_constant: 5e8, hardening_exponent: 0.5, failure: {tearing_parameter: 10, damage_growth: sudden}}
  rubber: {model: elastic, density: 1000, youngs_modulus: 1e7, poissons_ratio: 0.3}
parts:
  block: {mesh: {box: {size: [1, 1, 1], elements: [2, 2, 2]}}, element: {type: hex8}, material: steel,
          deletion: {plastic_strain: 0.5}}
  on_top: {mesh: {box: {size: [1, 1, 1], elements: [2, 2, 2]}}, placement: {translate: [0, 0, 1.2]},
           element: {type: hex8}, material: rubber}
  plate: {mesh: {plate: {size: [1, 1], elements: [2, 2]}}, placement: {translate: [0, 0, 3]},
          element: {type: shell4, thickness: 0.1}, material: rubber}
  bar: {mesh: {line: {start: [5, 0, 0], end: [6, 0, 0], elements: 2}},
        element: {type: beam2, section: {circle: {radius: 0.05}}}, material: rubber}
  ball: {mesh: {box: {size: [1, 1, 1], elements: [1, 1, 1]}}, placement: {translate: [9, 0, 0]},
         element: {type: rigid}, material: steel}
springs:
  coil: {from: {part: ball, point: [9, 0, 0]}, to: {point: [9, 0, 3], fixed: true}, stiffness: 10}
  rod: {from: {part: ball, point: [9, 0, 0]}, to: {point: [9, 0, 3], fixed: true}, axis: [0, 0, 1], stiffness: 10}
  bed: {from: {set: on_top.zmax}, to: {set: plate}, stiffness: 10}
boundary_conditions: [{name: foot, set: block.zmin, fix: [x, y, z]}]
contact: {surfaces: all, audit: true}
time: {end: 1e-3, mass_scaling: {step: 1e-5, largest_share: 10}}
output:
  fields: {variables: [all, state]}
  history:
    probes: {top: {part: plate, point: [0, 0, 3]}}
    rigid_bodies: true
    part_energies: true
    forces: {reactions: all, contact: all, sections: {cut: {part: block, point: [0, 0, 0.1], normal: [0, 0, 1]}}}
)";

Model rich_model(Deck& deck) {
  deck = parse_deck(rich_deck, "rich.yaml", {});
  return build_scene(deck);
}

TEST(ResultsMeaning, EveryFieldIsTold) {
  Deck deck;
  const Model model = rich_model(deck);
  const Names told = told_under("Fields");
  FieldObserver observer(model, deck.output.fields_.variables);
  const Snapshot& snapshot = observer.observe(model);
  int fields = 0;
  for (const auto* list : {&snapshot.point_fields, &snapshot.cell_fields})
    for (const FieldArray& field : *list) {
      ++fields;
      EXPECT_TRUE(told.contains(field.name)) << field.name;
    }
  EXPECT_GT(fields, 20);
}

TEST(ResultsMeaning, EveryColumnIsToldAndEveryToldColumnIsWritten) {
  Deck deck;
  const Model model = rich_model(deck);
  Names columns, used;
  for (const std::string& column : brio::history_columns(model)) columns.insert(column);
  Names told = told_under("History");
  EXPECT_EQ(told.size(), common_columns().size() + further_columns().size());
  EXPECT_EQ(left_out(columns, told, used), Names{});
  EXPECT_EQ(used, told);
}

void collect_keys(const nlohmann::json& json, const std::string& before, Names& keys) {
  for (const auto& [key, value] : json.items()) {
    if (value.is_object() && !value.empty())
      collect_keys(value, before + key + ".", keys);
    else
      keys.insert(before + key);
  }
}

TEST(ResultsMeaning, EveryKeyOfTheSummaryIsTold) {
  Deck deck;
  Model model = rich_model(deck);
  Summary summary = observe_end(model);
  summary.restarted_from = "before.h5";
  summary.ties.emplace();
  summary.wall_s.by_stage["elements"] = 1;
  summary.contact.audits->deepest_crossing = summary.contact.audits->deepest_too_close =
      Summary::DeepestContact{1, 2, 3, {"a", "b"}};
  Names keys, used;
  collect_keys(nlohmann::json::parse(summary_json(summary)), "", keys);
  Names told = told_under("Summary"), deep;
  for (const std::string& key : told)  // maps that are told as one
    for (const std::string& one : keys)
      if (one.starts_with(key + ".")) deep.insert(one);
  for (const std::string& one : deep) keys.erase(one);
  EXPECT_EQ(left_out(keys, told, used), Names{});
  EXPECT_GT(used.size(), 40U);
}

}  // namespace
}  // namespace brio
