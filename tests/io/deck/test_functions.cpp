// Tables, expressions and included files in decks.

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
class ScratchFolder {
 public:
  ScratchFolder() : path_(fs::temp_directory_path() / ("brio_functions_" + std::to_string(::getpid()))) {
    fs::create_directories(path_);
  }
  ~ScratchFolder() { fs::remove_all(path_); }
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

std::string refusal_of(const std::function<void()>& read) {
  try {
    read();
  } catch (const DeckError& fault) {
    return fault.what();
  }
  return {};
}
std::string refusal_of_text(const std::string& text) {
  return refusal_of([&] { parse_deck(text, "a.yaml"); });
}

constexpr const char* elastic_steel =
    "{model: elastic, density: 7.34e-4, youngs_modulus: 30e6, poissons_ratio: 0.3}";
std::string tabulated(const std::string& yield_stress) {
  return "{model: tabulated_plasticity, density: 7.34e-4, youngs_modulus: 30e6, poissons_ratio: 0.3, "
         "yield_stress: " +
         yield_stress + "}";
}
std::string plain_with_table(const std::string& yield_stress) {
  return plain_with(elastic_steel, tabulated(yield_stress));
}

const YieldTable& table_of(const Deck& deck) {
  return *std::get<TabulatedPlasticity>(deck.materials[0].second).yield_stress;
}

TEST(Expressions, StandForAnyNumber) {
  std::string text =
      plain_with("title: Two boxes", "title: Two boxes\nparameters: {v: 5000, n: 2, w: \"2*v\"}");
  text = replaced(text, "velocity: [0, 0, -5000]", "velocity: [0, '-v/2', \"-w\"]");
  text = replaced(text, "elements: [2, 2, 4]", "elements: [2, \"n\", \"2*n\"]");
  text = replaced(text, "end: 3e-3", "end: \"6e-3/n\"");
  const Deck deck = parse_deck(text, "a.yaml");
  EXPECT_EQ(deck.initial_conditions[0].velocity, (Vector3d{0, -2500, -10000}));
  EXPECT_EQ(std::get<BoxMesh>(deck.parts[0].mesh).elements, (std::array<int, 3>{2, 2, 4}));
  EXPECT_EQ(deck.time.end, 3e-3);
  EXPECT_EQ(deck.text, text);
  const Deck faster = parse_deck(text, "a.yaml", {"parameters.v=7000"});
  EXPECT_EQ(faster.initial_conditions[0].velocity, (Vector3d{0, -3500, -14000}));
  EXPECT_EQ(parse_deck(faster.text, "b.yaml").initial_conditions[0].velocity, (Vector3d{0, -3500, -14000}));
  EXPECT_EQ(deck_difference(deck.text, faster.text), "parameters.v is '7000', and was '5000'");
}

TEST(Expressions, OfTimeStandForCurves) {
  std::string text = plain_with("pressure: 100", "pressure: \"p0*exp(-t/1e-3)\"");
  text = replaced(text, "factor: [[0, 0], [1, 1]]", "factor: 'smooth_step(t, 0, 1e-3)'");
  text = replaced(text, "{z: [[0, 0], [1e-3, 5]]}", "{z: \"x*2\"}");
  text = replaced(text, "title: Two boxes", "parameters: {p0: 100, x1: 1}");
  EXPECT_NE(refusal_of_text(text).find("'x' means nothing here"),
            std::string::npos);  // a motion of the place
  text = replaced(text, "\"x*2\"", "\"x1*2\"");
  const Deck deck = parse_deck(text, "a.yaml");
  const auto& pressure = std::get<Pressure>(deck.loads[2]).pressure;
  EXPECT_EQ(pressure(0), 100);
  EXPECT_EQ(pressure(2e-3), 100 * std::exp(-2e-3 / 1e-3));
  EXPECT_FALSE(pressure.varies_in_space);
  EXPECT_EQ(pressure.points.back()[0], 3e-3);
  EXPECT_EQ(std::get<Gravity>(deck.loads[0]).factor(0.5e-3), 0.5);
  const auto& motion = std::get<PrescribedMotion>(deck.boundary_conditions[1]);
  EXPECT_EQ(motion.components[0].curve.expression, nullptr);  // of no time: a number
  EXPECT_EQ(motion.components[0].curve(1), 2);
}

TEST(Expressions, OfPlaceStandForPressures) {
  const Deck deck = parse_deck(plain_with("pressure: 100", "pressure: \"100 + 3*x*t - y/z\""), "a.yaml");
  const auto& pressure = std::get<Pressure>(deck.loads[2]).pressure;
  EXPECT_TRUE(pressure.varies_in_space);
  EXPECT_EQ(pressure.at({1, 2, 4}, 5), 100 + 15 - 0.5);
}

TEST(Expressions, FaultsNameTheirPlaceInsideOfTheText) {
  // Column of "density" in the third line of the plain deck: 36; one more for the quote.
  const auto fault = [](const std::string& density) {
    return refusal_of_text(plain_with("7.34e-4", density));
  };
  const std::string start = plain_deck;
  const std::size_t column = start.find("7.34e-4") - start.find("  steel") + 1;
  const auto place = [&](std::size_t character) {
    return "a.yaml:3:" + std::to_string(column + character) + ": ";
  };
  EXPECT_EQ(fault("\"2*rho\"").substr(0, place(3).size()), place(3));
  EXPECT_NE(fault("\"2*rho\"")
                .find("in the expression \"2*rho\" of 'density', at character 3: 'rho' means nothing "
                      "here; accepted: pi, sin"),
            std::string::npos)
      << fault("\"2*rho\"");
  EXPECT_NE(fault("\"2*sqr(4)\"").find("did you mean 'sqrt'?"), std::string::npos);
  EXPECT_NE(fault("\"t\"").find("'t' means nothing here"), std::string::npos);
  EXPECT_EQ(fault("\"(1 + 2\"").substr(0, place(7).size()), place(7));
  EXPECT_NE(fault("\"1/0\"").find("is infinite; finite numbers are accepted"), std::string::npos);
  EXPECT_NE(fault("\"log(-1)\"").find("is not a number; finite"), std::string::npos);
  EXPECT_NE(fault("\"1 - 2\"").find("'density' is the text \"1 - 2\" = -1; expected a number > 0"),
            std::string::npos);
  EXPECT_NE(fault("2*v").find("expected a number > 0, or an expression in quotes"), std::string::npos);
  EXPECT_NE(refusal_of_text(plain_with("pressure: 100", "pressure: \"1/(t - 1.5e-3)\""))
                .find("is infinite at time 0.0015"),
            std::string::npos);
}

TEST(Expressions, ParametersAreNamedOnceAndNotLikeFunctions) {
  const auto fault = [](const std::string& parameters) {
    return refusal_of_text(plain_with("title: Two boxes", "parameters: " + parameters));
  };
  EXPECT_EQ(fault("{a: 1, b: \"a + 1\"}"), "");
  EXPECT_NE(fault("{b: \"a + 1\", a: 1}").find("'a' means nothing here"), std::string::npos);
  EXPECT_NE(fault("{a: \"a\"}").find("'a' means nothing here"), std::string::npos);
  EXPECT_NE(fault("{t: 1}").find("'t' has a meaning in expressions"), std::string::npos);
  EXPECT_NE(fault("{sin: 1}").find("'sin' has a meaning in expressions"), std::string::npos);
  EXPECT_NE(fault("{a-b: 1}").find("'a-b' cannot be a parameter"), std::string::npos);
  EXPECT_NE(fault("{a: b}").find("'a' is 'b'; expected a number"), std::string::npos);
  EXPECT_NE(fault("[1]").find("'parameters' is a list; expected a map"), std::string::npos);
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
  const auto fault = [](const std::string& table) { return refusal_of_text(plain_with_table(table)); };
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
  const ScratchFolder folder;
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
  const ScratchFolder folder;
  const auto fault = [&](const std::string& csv, const std::string& columns) {
    folder.write("steel.csv", csv);
    const std::string path = folder.write("deck.yaml", plain_with_table("{file: steel.csv" + columns + "}"));
    const std::string message = refusal_of([&] { read_deck(path); });
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
  EXPECT_NE(refusal_of([&] { read_deck(path); }).find("deck.yaml:3:"), std::string::npos);
  EXPECT_NE(refusal_of([&] { read_deck(path); }).find("there is no file"), std::string::npos);
}

TEST(Includes, JoinSectionsAndNameTheirFile) {
  const ScratchFolder folder;
  const std::string line = std::string("  steel: ") + elastic_steel + "\n";
  const std::string without = replaced(plain_with(line, "  other: " + std::string(elastic_steel) + "\n"),
                                       "title: Two boxes", "include: [shared/materials.yaml]");
  folder.write("shared/materials.yaml",
               "include: [more.yaml]\nmaterials:\n" + line + "loads:\n  - {gravity: [1, 0, 0]}\n");
  folder.write("shared/more.yaml", "parameters: {rho: 7e-4}\n");
  const std::string path = folder.write("deck.yaml", without);
  const Deck deck = read_deck(path, {"materials.steel.density=\"rho\""});
  ASSERT_EQ(deck.materials.size(), 2u);
  EXPECT_EQ(deck.materials[0].first, "steel");
  EXPECT_EQ(std::get<Elastic>(deck.materials[0].second).density, 7e-4);
  EXPECT_EQ(deck.loads.size(), 4u);
  EXPECT_EQ(std::get<Gravity>(deck.loads[0]).acceleration, (Vector3d{1, 0, 0}));
  EXPECT_EQ(parse_deck(deck.text, "saved.yaml").materials.size(), 2u);  // without the files

  folder.write("shared/materials.yaml", "materials:\n" + replaced(line, "0.3", "0.5"));
  const std::string fault = refusal_of([&] { read_deck(path); });
  EXPECT_NE(fault.find("shared/materials.yaml:2:"), std::string::npos) << fault;
  folder.write("shared/materials.yaml", "materials:\n  other: {model: elastic}\n");
  EXPECT_NE(refusal_of([&] { read_deck(path); }).find("duplicate key 'other'; it stands already at"),
            std::string::npos);
  folder.write("shared/materials.yaml", "include: [materials.yaml]\n");
  EXPECT_NE(refusal_of([&] { read_deck(path); }).find("is included by itself"), std::string::npos);
  folder.write("shared/materials.yaml", "- 1\n");
  EXPECT_NE(refusal_of([&] { read_deck(path); }).find("is a list; a map of keys"), std::string::npos);
  EXPECT_NE(
      refusal_of_text(plain_with("title: Two boxes", "include: a.yaml")).find("expected a list of paths"),
      std::string::npos);
  EXPECT_NE(refusal_of_text(plain_with("title: Two boxes", "include: [no.yaml]"))
                .find("there is no file 'no.yaml'"),
            std::string::npos);
}

TEST(KineticFriction, NeedsFriction) {
  const auto with = [](const std::string& friction) { return plain_with("friction: 0.1", friction); };
  const Deck deck =
      parse_deck(with("friction: 0.3, kinetic_friction: {coefficient: 0.1, decay: 2}"), "a.yaml");
  EXPECT_NEAR(deck.contact->options.kinetic_friction->share(0.3, 0.5) * 0.3, 0.1 + 0.2 * std::exp(-1), 1e-15);
  EXPECT_NE(refusal_of_text(with("kinetic_friction: {coefficient: 0.1, decay: 2}"))
                .find("accepted is friction > 0"),
            std::string::npos);
}

}  // namespace
}  // namespace brio
