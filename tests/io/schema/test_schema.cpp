#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "io/deck/read_deck.hpp"
#include "io/schema/write_schema.hpp"
#include "io/study/read_study.hpp"
#include "tests/io/deck/deck_text.hpp"

namespace brio {
namespace {

namespace fs = std::filesystem;

TEST(Schema, HoldsRangesAndDefaultsOfTheTables) {
  const auto schema = nlohmann::json::parse(deck_schema());
  const auto& time = schema.at("properties").at("time").at("properties");
  EXPECT_EQ(time.at("end").at("exclusiveMinimum"), 0);
  EXPECT_EQ(time.at("step_scale").at("maximum"), 1);
  EXPECT_EQ(time.at("step_scale").at("default"), TimeSection{}.step_scale);
  EXPECT_EQ(schema.at("additionalProperties"), false);
  EXPECT_EQ(schema.at("definitions").at("material").at("oneOf").size(), std::variant_size_v<Material>);
  EXPECT_EQ(schema.at("definitions").at("mesh").at("oneOf").size(), std::variant_size_v<MeshSource>);
  EXPECT_EQ(schema.at("required"), (nlohmann::json{"materials", "parts", "time"}));
}

void expect_committed(const std::string& name, const std::string& text, const std::string& command) {
  std::ifstream file(BRIO_SOURCE_DIR "/docs/" + name);
  std::istringstream reference(text);
  std::string committed, expected;
  while (std::getline(reference, expected)) {
    std::getline(file, committed);
    ASSERT_EQ(committed, expected) << "write it anew: " << command << " > docs/" << name;
  }
  EXPECT_FALSE(std::getline(file, committed)) << committed;
}

TEST(Schema, CommittedReferencesAreUpToDate) {
  expect_committed("deck.md", deck_reference(), "brio schema --markdown");
  expect_committed("study.md", study_reference(), "brio schema --study --markdown");
  expect_committed("results.md", results_reference(), "brio schema --results");
}

/// What validate_decks.py says of each deck; nothing if Python lacks a package.
std::map<std::string, std::string> verdicts(const std::vector<std::string>& decks,
                                            const std::string& schema_text = deck_schema()) {
  const fs::path schema = fs::temp_directory_path() / ("brio_schema_" + std::to_string(::getpid()) + ".json");
  std::ofstream(schema) << schema_text;
  std::string command =
      BRIO_PYTHON " '" BRIO_SOURCE_DIR "/tests/io/schema/validate_decks.py' '" + schema.string() + "'";
  for (const std::string& deck : decks) command += " '" + deck + "'";
  std::map<std::string, std::string> result;
  if (std::FILE* pipe = popen(command.c_str(), "r")) {
    std::string line(4096, '\0');
    while (std::fgets(line.data(), static_cast<int>(line.size()), pipe) != nullptr) {
      std::istringstream words(line.c_str());
      std::string verdict, path;
      words >> verdict;
      std::getline(words >> std::ws, path);
      if (verdict == "bad" || verdict == "good") result[path.substr(0, path.find(".yaml") + 5)] = verdict;
    }
    pclose(pipe);
  }
  fs::remove(schema);
  return result;
}

TEST(Schema, AcceptsTheDecksThatComeWithBrio) {
  std::vector<std::string> decks;
  for (const auto& entry : fs::directory_iterator(BRIO_SOURCE_DIR "/inputs"))
    if (entry.path().extension() == ".yaml") decks.push_back(entry.path().string());
  const fs::path plain = fs::temp_directory_path() / "brio_plain_deck.yaml";
  const fs::path systems = fs::temp_directory_path() / "brio_deck_with_systems.yaml";
  std::ofstream(plain) << plain_deck;
  std::ofstream(systems) << deck_with_systems();
  decks.insert(decks.end(), {plain.string(), systems.string()});
  const auto said = verdicts(decks);
  fs::remove(plain);
  fs::remove(systems);
  ASSERT_FALSE(said.empty()) << BRIO_PYTHON " lacks jsonschema or yaml (python3-jsonschema, python3-yaml)";
  for (const std::string& deck : decks) EXPECT_EQ(said.at(deck), "good") << deck;
}

std::vector<std::string> shipped_studies() {
  std::vector<std::string> studies;
  for (const auto& entry : fs::directory_iterator(BRIO_SOURCE_DIR "/inputs/studies"))
    if (entry.path().extension() == ".yaml") studies.push_back(entry.path().string());
  return studies;
}

TEST(Schema, AcceptsTheStudiesThatComeWithBrio) {
  const std::vector<std::string> studies = shipped_studies();
  ASSERT_GE(studies.size(), 8u);
  const auto said = verdicts(studies, study_schema());
  for (const std::string& study : studies) {
    EXPECT_EQ(said.at(study), "good") << study;
    EXPECT_NO_THROW(read_study(study)) << study;
  }
}

TEST(Schema, RefusesBadDecks) {
  // Faults that a schema can see; names that do not exist and keys that stand twice are not among them.
  std::vector<std::string> decks;
  for (const char* name : {"a_list",           "a_word",          "empty",           "half_an_element",
                           "incompressible",   "list_as_key",     "missing_key",     "missing_value",
                           "negative_density", "second_document", "too_few_numbers", "two_meshes",
                           "unclosed_bracket", "unknown_element", "unknown_key",     "unknown_mesh",
                           "unknown_model",    "wrong_type",      "zero_interval",   "zero_size"})
    decks.push_back(BRIO_SOURCE_DIR "/tests/io/bad_decks/" + std::string(name) + ".yaml");
  const auto said = verdicts(decks);
  ASSERT_FALSE(said.empty()) << BRIO_PYTHON " lacks jsonschema or yaml (python3-jsonschema, python3-yaml)";
  for (const std::string& deck : decks) EXPECT_EQ(said.at(deck), "bad") << deck;
}

TEST(Inputs, AreGoodDecks) {
  for (const auto& entry : fs::directory_iterator(BRIO_SOURCE_DIR "/inputs")) {
    if (entry.path().extension() != ".yaml") continue;
    EXPECT_NO_THROW(read_deck(entry.path().string())) << entry.path();
  }
}

}  // namespace
}  // namespace brio
