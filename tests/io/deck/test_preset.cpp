// Presets fill in what a deck leaves open, and nothing else.

#include <gtest/gtest.h>

#include "io/deck/read_deck.hpp"

namespace brio {
namespace {

const std::string deck_text = R"(
materials:
  m: {model: elastic, density: 1000, youngs_modulus: 1e9, poissons_ratio: 0.3}
parts:
  box: {mesh: {box: {size: [1, 1, 1], elements: [1, 1, 1]}}, element: hex8, material: m}
  chosen:
    mesh: {box: {size: [1, 1, 1], elements: [1, 1, 1]}}
    element: {type: hex8, objective_rate: green_naghdi}
    material: m
  plate:
    mesh: {plate: {size: [1, 1], elements: [2, 2]}}
    element: {type: shell4, thickness: 0.1}
    material: m
contact: {surfaces: all, friction: 0.1}
time: {end: 1}
)";

Deck deck_with(const std::string& more, const std::vector<std::string>& overrides = {}) {
  return parse_deck(deck_text + more, "deck.yaml", overrides);
}
ObjectiveRate rate(const Deck& deck, std::size_t part) {
  return std::get<Hex8>(deck.parts[part].element).objective_rate;
}

TEST(Preset, BalancedIsWhatADeckWithoutPresetIs) {
  const Deck plain = deck_with("");
  const Deck balanced = deck_with("numerics: {preset: balanced}\n");
  EXPECT_EQ(plain.contact->options.passes, balanced.contact->options.passes);
  EXPECT_EQ(plain.time.step_scale, balanced.time.step_scale);
  EXPECT_EQ(rate(plain, 0), rate(balanced, 0));
  EXPECT_EQ(plain.text, deck_text);
}

TEST(Preset, FastFillsInWhatIsLeftOpen) {
  const Deck deck = deck_with("numerics: {preset: fast}\n");
  EXPECT_EQ(deck.numerics.precision, Precision::single_precision);
  EXPECT_EQ(rate(deck, 0), ObjectiveRate::jaumann);
  EXPECT_EQ(rate(deck, 1), ObjectiveRate::green_naghdi) << "the deck says so";
  EXPECT_EQ(std::get<Shell4>(deck.parts[2].element).thickness_points, 3);
  EXPECT_EQ(std::get<Shell4>(deck.parts[2].element).thickness, 0.1);
  EXPECT_LT(deck.contact->options.passes, 5);
  EXPECT_EQ(deck.contact->options.friction, 0.1);
}

TEST(Preset, ComesFromTheCommandLineAsWellAndIsLessThanIt) {
  const Deck deck = deck_with("", {"numerics.preset=fast", "contact.passes=7"});
  EXPECT_EQ(deck.contact->options.passes, 7);
  EXPECT_GT(deck.time.step_scale, 0.9);
}

TEST(Preset, AccurateDampsImpactsLessAndSeesTheSurfacesOfShells) {
  const Deck deck = deck_with("numerics: {preset: accurate}\n"), plain = deck_with("");
  const auto &shell = std::get<Shell4>(deck.parts[2].element),
             &plain_shell = std::get<Shell4>(plain.parts[2].element);
  EXPECT_EQ(shell.quadrature, ThicknessQuadrature::lobatto);
  EXPECT_EQ(shell.thickness_points, plain_shell.thickness_points);
  EXPECT_EQ(shell.hourglass_stiffness, plain_shell.hourglass_stiffness);
  EXPECT_EQ(std::get<Hex8>(deck.parts[0].element).hourglass_stiffness,
            std::get<Hex8>(plain.parts[0].element).hourglass_stiffness);
  EXPECT_LT(std::get<Hex8>(deck.parts[0].element).linear_bulk_viscosity,
            std::get<Hex8>(plain.parts[0].element).linear_bulk_viscosity);
  EXPECT_GT(std::get<Hex8>(deck.parts[0].element).linear_bulk_viscosity, 0);
  EXPECT_GT(deck.time.step_scale, plain.time.step_scale);
}

TEST(Preset, AccurateLeavesWhatTheDeckSays) {
  std::string text = deck_text;
  text.replace(text.find("objective_rate: green_naghdi"), 28, "linear_bulk_viscosity: 0.07  ");
  const Deck deck = parse_deck(text + "numerics: {preset: accurate}\n", "deck.yaml", {"time.step_scale=0.6"});
  EXPECT_EQ(std::get<Hex8>(deck.parts[1].element).linear_bulk_viscosity, 0.07);
  EXPECT_EQ(deck.time.step_scale, 0.6);
}

// Two Lobatto points make bending three times as stiff.
TEST(Preset, AccurateLeavesTheRuleOfShellsWhoseNumberOfPointsIsGiven) {
  const Deck deck = deck_with("numerics: {preset: accurate}\n", {"parts.plate.element.thickness_points=2"});
  EXPECT_EQ(std::get<Shell4>(deck.parts[2].element).quadrature, ThicknessQuadrature::gauss);
}

TEST(Preset, SwitchesNothingOn) {
  std::string text = deck_text;
  text.erase(text.find("contact:"), text.find("time:") - text.find("contact:"));
  for (const char* preset : {"fast", "accurate"})
    EXPECT_FALSE(parse_deck(text, "deck.yaml", {std::string("numerics.preset=") + preset}).contact);
}

std::string deck_with_particles() {
  std::string text = deck_text;
  const std::string hexahedra = "{mesh: {box: {size: [1, 1, 1], elements: [1, 1, 1]}}, element: hex8";
  text.replace(text.find(hexahedra), hexahedra.size(),
               "{mesh: {particles: {sphere: {radius: 1, spacing: 0.5}}}, element: particle");
  return text;
}

TEST(Preset, KeepsParticlesInDouble) {
  EXPECT_EQ(parse_deck(deck_with_particles(), "deck.yaml", {"numerics.preset=fast"}).numerics.precision,
            Precision::double_precision);
}

// The longer step disperses the waves of bricks less; of particles it does not.
TEST(Preset, AccurateKeepsTheStepOfParticles) {
  const std::string text = deck_with_particles();
  EXPECT_EQ(parse_deck(text, "deck.yaml", {"numerics.preset=accurate"}).time.step_scale,
            parse_deck(text, "deck.yaml").time.step_scale);
}

TEST(Preset, ShowsInTheDeckAsRun) {
  const Deck deck = deck_with("numerics: {preset: fast}\n");
  const Deck again = parse_deck(deck.text, "deck.yaml");
  EXPECT_EQ(rate(again, 0), ObjectiveRate::jaumann);
  EXPECT_NE(deck.text.find("jaumann"), std::string::npos);
}

TEST(Preset, OfAnotherNameIsRefused) {
  try {
    deck_with("numerics: {preset: quick}\n");
    FAIL();
  } catch (const DeckError& fault) {
    EXPECT_NE(std::string(fault.what()).find("deck.yaml:16:20"), std::string::npos) << fault.what();
  }
}

TEST(Preset, OfBrokenDecksSaysWhatIsBroken) {
  for (const char* text : {"numerics: {preset: fast}", "numerics: {preset: fast}\nparts: 3\n",
                           "numerics: {preset: fast}\nparts: {a: 1, b: {element: []}}\n", "numerics: fast\n",
                           "numerics: {preset: [fast]}\n", "numerics: {preset: fast}\ncontact: 1\ntime: 2\n"})
    EXPECT_THROW(parse_deck(text, "deck.yaml"), DeckError) << text;
}

}  // namespace
}  // namespace brio
