// Tables in decks.

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <functional>

#include "io/deck/read_deck.hpp"
#include "io/restart/deck_difference.hpp"
#include "tests/io/deck/deck_text.hpp"

namespace brio {
namespace {

namespace fs = std::filesystem;

/// A folder that is gone at the end.
class Folder {
 public:
  Folder() : path_(fs::temp_directory_path() / ("brio_functions_" + std::to_string(::getpid()))) {
    fs::create_directories(path_);
  }
  ~Folder() { fs::remove_all(path_); }
  std::string write(const std::string& name, const std::string& text) const {
    fs::create_directories((path_ / name).parent_path());
    std::ofstream(path_ / name) << text;
    return (path_ / name).string();
  }

 private:
  fs::path path_;
};

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}
std::string plain_with(const std::string& from, const std::string& to) {
  return replaced(plain_deck, from, to);
}

std::string fault_of(const std::function<void()>& read) {
  try {
    read();
  } catch (const DeckError& fault) {
    return fault.what();
  }
  return {};
}
std::string fault_of_text(const std::string& text) {
  return fault_of([&] { parse_deck(text, "a.yaml"); });
}

constexpr const char* elastic =
    "{model: elastic, density: 7.34e-4, youngs_modulus: 30e6, poissons_ratio: 0.3}";
std::string tabulated(const std::string& yield_stress) {
  return "{model: tabulated_plasticity, density: 7.34e-4, youngs_modulus: 30e6, poissons_ratio: 0.3, "
         "yield_stress: " +
         yield_stress + "}";
}
std::string plain_with_table(const std::string& yield_stress) {
  return plain_with(elastic, tabulated(yield_stress));
}

const YieldTable& table_of(const Deck& deck) {
  return *std::get<TabulatedPlasticity>(deck.materials[0].second).yield_stress;
}

TEST(Tables, OfTheDeckAreRead) {
  const Deck deck = parse_deck(plain_with_table("[[0, 40e3], [0.1, 55e3], [0.5, 50e3]]"), "a.yaml");
  ASSERT_EQ(table_of(deck).size(), 3u);
  EXPECT_EQ(table_of(deck).stress(0)[1], 55e3);
  EXPECT_EQ(table_of(deck).slope(0)[2], 0);
  const Deck longer =
      parse_deck(plain_with_table("{table: [[0, 40e3], [0.1, 55e3]], beyond: last_slope}"), "a.yaml");
  EXPECT_NEAR(table_of(longer).slope(0)[1], 150e3, 1e-9);
  const Deck rates = parse_deck(
      plain_with_table(
          "{rates: [{rate: 1, table: [[0, 40e3]]}, {rate: 100, table: [[0, 50e3], [0.1, 60e3]]}]}"),
      "a.yaml");
  EXPECT_EQ(table_of(rates).curves(), 2u);
}

TEST(Tables, FaultsNameTheirRow) {
  const auto fault = [](const std::string& table) { return fault_of_text(plain_with_table(table)); };
  const auto expect = [&](const std::string& table, const std::string& message) {
    EXPECT_NE(fault(table).find(message), std::string::npos) << fault(table);
  };
  expect("[[0.1, 40e3]]", "begin with 0.1; 0 is accepted");
  expect("[[0, 40e3], [0.1, 50e3], [0.1, 60e3]]", "do not grow: 0.1 after 0.1");
  expect("[[0, 0]]", "stresses > 0 are accepted");
  expect("[[0, 40e3], [0.1, -1]]", "stresses > 0 are accepted");
  expect("[[0, 40e3, 1]]", "a list of 2 numbers");
  expect("[]", "a list of [equivalent plastic strain, yield stress], or {file: NAME.csv}");
  expect("40e3", "a list of [equivalent plastic strain, yield stress], or {file: NAME.csv}");
  expect("{beyond: constant}", "has either 'table' or 'rates'");
  expect("{table: [[0, 1]], beyond: slope}", "accepted: constant, last_slope");
  expect("{table: [[0, 50e3], [0.1, 40e3]], beyond: last_slope}", "would come down to 0");
  expect("{rates: [{rate: 1, table: [[0, 1]]}]}", "a list of two or more");
  expect("{rates: [{rate: 1, table: [[0, 1]]}, {rate: 1, table: [[0, 1]]}]}", "the rates do not grow");
  expect("{rates: [{rate: 0, table: [[0, 1]]}, {rate: 1, table: [[0, 1]]}]}",
         "'rate' is '0'; expected a number > 0");
  expect("[[0, 40e3], [1e-9, 1e3]]", "falls too steeply");
}

TEST(Tables, OfFilesAreThoseOfTheDeck) {
  const Folder folder;
  folder.write("tests/steel.csv",
               "# tension\nstrain; rolled; drawn\n0; 40e3; 45e3\n\n0.1; 55e3; 60e3 # last\n");
  folder.write("ramp.csv", "0, 0\n1e-3, 5\n");
  const std::string path = folder.write(
      "deck.yaml", replaced(plain_with_table("{file: tests/steel.csv, columns: [strain, drawn]}"),
                            "{z: [[0, 0], [1e-3, 5]]}", "{z: {file: ramp.csv}}"));
  const Deck deck = read_deck(path);
  ASSERT_EQ(table_of(deck).size(), 2u);
  EXPECT_EQ(table_of(deck).stress(0)[0], 45e3);
  EXPECT_EQ(table_of(deck).stress(0)[1], 60e3);
  const auto& motion = std::get<PrescribedMotion>(deck.boundary_conditions[1]);
  EXPECT_EQ(motion.components[0].curve.points, (std::vector<std::array<double, 2>>{{0, 0}, {1e-3, 5}}));
  // The deck as run holds the rows: it is read again without the files, and a changed file is another deck.
  EXPECT_EQ(table_of(parse_deck(deck.text, "elsewhere/saved.yaml")).stress(0)[1], 60e3);
  folder.write("tests/steel.csv", "0 40e3 45e3\n0.1 55e3 61e3\n");
  const Deck changed =
      read_deck(path, {"materials.steel.yield_stress={file: tests/steel.csv, columns: [1, 3]}"});
  EXPECT_EQ(deck_difference(deck.text, changed.text),
            "materials.steel.yield_stress.1.1 is '61e3', and was '60e3'");
}

TEST(Tables, FaultsOfFilesNameFileAndLine) {
  const Folder folder;
  const auto fault = [&](const std::string& csv, const std::string& columns) {
    folder.write("steel.csv", csv);
    const std::string path = folder.write("deck.yaml", plain_with_table("{file: steel.csv" + columns + "}"));
    const std::string message = fault_of([&] { read_deck(path); });
    return message.substr(message.rfind('/') + 1);
  };
  EXPECT_EQ(fault("p, s\n0, 1\n0.1, abc\n", "").substr(0, 16), "steel.csv:3:6: '");
  EXPECT_EQ(fault("0, 1\n0.2, 2\n0.1, 3\n", "").substr(0, 15), "steel.csv:3:1: ");
  EXPECT_EQ(fault("0, 1\n0.2\n", ""), "steel.csv:2:1: the row has 1 columns; column 2 is expected");
  EXPECT_NE(fault("p, s\n0, 1\n", ", columns: [p, S]").find("did you mean 's'?"), std::string::npos);
  EXPECT_NE(fault("0, 1\n", ", columns: [1]").find("expected a list of 2 columns"), std::string::npos);
  EXPECT_NE(fault("0, 1\n", ", column: [1, 2]").find("unknown key 'column' beside the file of a table"),
            std::string::npos);
  EXPECT_NE(fault("# nothing\n", "").find("has no rows"), std::string::npos);
  const std::string path = folder.write("deck.yaml", plain_with_table("{file: no.csv}"));
  EXPECT_NE(fault_of([&] { read_deck(path); }).find("deck.yaml:3:"), std::string::npos);
  EXPECT_NE(fault_of([&] { read_deck(path); }).find("there is no file"), std::string::npos);
}

}  // namespace
}  // namespace brio
