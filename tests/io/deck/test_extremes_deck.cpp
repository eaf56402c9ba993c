// Decks at their ends: a number that is none anywhere, names twice or of nothing, intervals of nothing,
// another locale, a hundred thousand parts.

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <clocale>
#include <filesystem>
#include <fstream>
#include <locale>
#include <regex>
#include <sstream>

#include "io/deck/read_deck.hpp"
#include "io/mesh/generate_mesh.hpp"
#include "io/run/run_deck.hpp"
#include "io/yaml/deck_error.hpp"
#include "src/base/index.hpp"
#include "src/build/build.hpp"
#include "src/step/advance.hpp"
#include "tests/io/deck/deck_text.hpp"
#include "tests/io/text_of.hpp"

namespace brio {
namespace {

namespace fs = std::filesystem;

// ---- numbers

struct Number {
  std::size_t at, size;
  long line;
};
/// Numbers of a deck: what stands in a comment, in a title, in a name or in a list of words is none.
std::vector<Number> numbers_of(const std::string& text) {
  static const std::regex number(R"((^|[\s\[,:])([-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?)(?=[\s,\]}]|$))");
  std::vector<Number> found;
  std::istringstream lines(text);
  std::string line;
  std::size_t start = 0;
  for (long count = 1; std::getline(lines, line); ++count, start += line.size() + 1) {
    if (line.starts_with("title:") || line.starts_with("units:")) continue;
    const std::string code = line.substr(0, line.find('#'));
    for (auto at = std::sregex_iterator(code.begin(), code.end(), number); at != std::sregex_iterator(); ++at)
      found.push_back({start + index(at->position(2)), index(at->length(2)), count});
  }
  return found;
}

TEST(ExtremesDeck, EveryNumberOfEveryShippedDeckIsRefusedWhereItIsNone) {
  int decks = 0;
  std::size_t numbers = 0;
  for (const auto& entry : fs::directory_iterator(BRIO_SOURCE_DIR "/inputs")) {
    if (entry.path().extension() != ".yaml") continue;
    const std::string text = test::text_of(entry.path());
    const std::string name = entry.path().string();
    ASSERT_EQ(fault_of(text, {}, name), "") << name;
    ++decks;
    for (const Number& number : numbers_of(text)) {
      ++numbers;
      for (const char* wrong :
           {".nan", ".inf", "-.inf", "1e999", "-1e999", "nan", "inf", "1e", "0x", "--1", "1,5,"}) {
        std::string damaged = text;
        damaged.replace(number.at, number.size, wrong);
        const std::string fault = fault_of(damaged, {}, name);
        const std::string place = name + ":" + std::to_string(number.line) + ":";
        EXPECT_EQ(fault.substr(0, place.size()), place)
            << entry.path().filename() << " line " << number.line << ' '
            << text.substr(number.at, number.size) << " -> " << wrong << ": " << fault;
      }
    }
  }
  EXPECT_GT(decks, 10);
  EXPECT_GT(numbers, 300U);
}

TEST(ExtremesDeck, OverridesThatAreNoNumbersAreRefused) {
  for (const char* wrong : {".nan", ".inf", "-.inf", "1e999", "nan"})
    for (const std::string key : {"time.end", "materials.steel.density", "parts.left.mesh.box.size.1",
                                  "boundary_conditions.1.velocity.z.1.0", "output.history.every"}) {
      const std::string fault = fault_of(plain_deck, {key + "=" + wrong});
      EXPECT_EQ(fault.find("--set " + key), 0U) << key << '=' << wrong << ": " << fault;
    }
}

// ---- words

TEST(ExtremesDeck, NamesThatStandTwiceOrNowhereAreRefusedWithTheirPlace) {
  const std::vector<std::array<std::string, 3>> faults{
      {"  right:", "  left:", "a.yaml:9:3: duplicate key 'left'; it stands already at a.yaml:5:3"},
      {"parts:", "  steel: {model: elastic}\nparts:", "a.yaml:4:3: duplicate key 'steel'"},
      {"title: Two boxes", "title: a\ntitle: b", "a.yaml:2:1: duplicate key 'title'"},
      {"material: steel", "material: stel",
       "a.yaml:8:15: no material is called 'stel'; did you mean 'steel'?"},
      {"{part: left,", "{part: lift,", "no part is called 'lift'; did you mean 'left'?"},
      {"right.top", "right.tip", "part 'right' has no set 'tip'"},
      {"exclude: [left]", "exclude: [laft]", "no part is called 'laft'"},
      {"right.inside", "wrong.inside", "no part is called 'wrong'"},
      {"material: steel", "material: *steel", "a.yaml:8:"},
  };
  for (const auto& [from, to, message] : faults) {
    const std::string fault = fault_of(with(from, to));
    EXPECT_NE(fault.find(message), std::string::npos) << fault;
    EXPECT_EQ(fault.find("a.yaml:"), 0U) << fault;
  }
}

TEST(ExtremesDeck, IntervalsOfOutputThatAreNotPositiveAreRefused) {
  for (const char* wrong : {"0", "-5e-5", "-0.0", "0e5"})
    for (const std::string section : {"fields", "history"}) {
      const std::string old = section == "fields" ? "fields: {every: 5e-5}" : "history: {every: 1e-6}";
      const std::string fault = fault_of(with(old, section + ": {every: " + wrong + "}"));
      EXPECT_NE(fault.find("a.yaml:27:"), std::string::npos) << fault;
      EXPECT_NE(fault.find("expected a number > 0"), std::string::npos) << fault;
    }
}

// ---- surroundings

/// A locale in which one and a half is written 1,5 and a thousand 1.000.
struct CommaPunctuation : std::numpunct<char> {
  char do_decimal_point() const override { return ','; }
  char do_thousands_sep() const override { return '.'; }
  std::string do_grouping() const override { return "\3"; }
};
class CommaLocale {
 public:
  CommaLocale()
      : before_(std::locale::global(std::locale(std::locale(), new CommaPunctuation))),
        c_before_(std::setlocale(LC_ALL, nullptr)) {
    std::setlocale(LC_ALL, "de_DE.UTF-8");  // where it is installed
  }
  ~CommaLocale() {
    std::setlocale(LC_ALL, c_before_.c_str());
    std::locale::global(before_);
  }

 private:
  std::locale before_;
  std::string c_before_;
};

TEST(ExtremesLocale, DecksMeanTheSameWhereNumbersHaveCommas) {
  Deck deck;
  std::string fault;
  {
    const CommaLocale commas;
    deck = parse_deck(plain_deck, "a.yaml", {"parts.left.mesh.box.elements=[1000, 2, 4]"});
    fault = fault_of(with("[2, 2, 4]", "[2, 2.5, 4]"));
  }
  EXPECT_EQ(density(deck.materials.at(0).second), 7.34e-4);
  EXPECT_NE(deck.text.find("elements: [1000, 2, 4]"), std::string::npos) << deck.text;
  EXPECT_EQ(fault, "a.yaml:6:49: 'elements' is '2.5'; expected an integer >= 1");
}

TEST(ExtremesLocale, ResultsAreTheSameBytesWhereNumbersHaveCommas) {
  const fs::path folder = fs::temp_directory_path() / ("brio locale " + std::to_string(getpid()));
  fs::create_directories(folder);
  const auto run = [&](const std::string& name) {
    RunOptions options;
    options.deck = BRIO_SOURCE_DIR "/inputs/bar_impact.yaml";
    options.overrides = {"time.end=5.5e-4"};
    options.output = folder / name;
    EXPECT_EQ(run_deck(options).summary.exit_code, 0);
  };
  run("points");
  {
    const CommaLocale commas;
    run("commas");
  }
  for (const char* file : {"bar_impact.history.csv", "bar_impact.xdmf2"}) {
    const std::string points = test::text_of(folder / "points" / file);
    EXPECT_GT(points.size(), 100U);
    EXPECT_EQ(points, test::text_of(folder / "commas" / file));
  }
  const auto steps = [&](const std::string& name) {
    const std::string text = test::text_of(folder / name / "bar_impact.summary.json");
    const std::size_t begin = text.find("\"steps\""), end = text.find("\"elements\"");
    return text.substr(begin, end - begin);
  };
  EXPECT_EQ(steps("points"), steps("commas"));
  EXPECT_NE(steps("points").find("0.00055"), std::string::npos) << steps("points");
  fs::remove_all(folder);
}

// ---- size

TEST(ExtremesDeck, AHundredThousandPartsAreReadBuiltAndSteppedInProportionateTime) {
  const auto seconds_for = [](int count) {
    std::ostringstream text;
    text << "materials: {m: {model: elastic, density: 1000, youngs_modulus: 1e9, poissons_ratio: "
            "0.3}}\nparts:\n";
    for (int i = 0; i < count; ++i)
      text << "  p" << i << ": {mesh: {box: {size: [1, 1, 1], elements: [1, 1, 1]}}, placement: {translate: ["
           << 1.5 * (i % 300) << ", " << 1.5 * (i / 300) << ", 0]}, element: hex8, material: m}\n";
    text << "initial_conditions:\n";
    for (int i = 0; i < count; ++i) text << "  - {part: p" << i << ", velocity: [1, 0, 0]}\n";
    text << "time: {end: 1}\n";
    const auto start = std::chrono::steady_clock::now();
    const Deck deck = parse_deck(text.str(), "a.yaml");
    std::vector<Mesh> meshes;
    for (const Part& part : deck.parts) meshes.push_back(generate_mesh(part.mesh, part.placement));
    Model model = build(deck, meshes);
    ThreadTeam team(1);
    run(model, 0.1, team, [](const Model& now) { return now.step < 3; });
    EXPECT_EQ(model.parts.size(), index(count));
    EXPECT_EQ(model.nodes.size(), 8 * index(count));
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  };
  const double few = seconds_for(10000);
  const double many = seconds_for(100000);
  std::printf("10,000 parts %.2f s, 100,000 parts %.2f s\n", few, many);
  EXPECT_LT(many, 30 * few) << "ten times as many take about ten times as long";
}

}  // namespace
}  // namespace brio
