#include <gtest/gtest.h>

#include <random>
#include <sstream>

#include "io/deck/read_deck.hpp"
#include "tests/io/deck/deck_text.hpp"

namespace brio {
namespace {

using Random = std::mt19937;

std::size_t below(Random& random, std::size_t count) { return random() % count; }

/// One small damage, such as a slip of the keyboard or of a disc.
void damage(std::string& text, Random& random) {
  static constexpr std::string_view marks = "{}[]:,-?&*!|>'\"%@`#~<=.+0123456789eE \t\n\r\\\0\x7f\xc3\xff";
  if (text.empty()) text.push_back(' ');
  const std::size_t at = below(random, text.size());
  const std::size_t length = std::min(text.size() - at, below(random, 12));
  switch (below(random, 7)) {
    case 0:
      text[at] = static_cast<char>(random());
      break;
    case 1:
      text[at] = marks[below(random, marks.size())];
      break;
    case 2:
      text.insert(at, 1, marks[below(random, marks.size())]);
      break;
    case 3:
      text.erase(at, length);
      break;
    case 4:
      text.insert(below(random, text.size()), text.substr(at, length));
      break;
    case 5:
      text.resize(at);
      break;
    default:
      text.insert(at, std::string(below(random, 40), marks[below(random, marks.size())]));
      break;
  }
}

/// Reads, and says whether it was refused; everything but a deck or a DeckError ends the test.
bool refused(const std::string& text, const std::vector<std::string>& overrides = {}) {
  try {
    const Deck deck = parse_deck(text, "a.yaml", overrides);
    EXPECT_FALSE(deck.parts.empty() && deck.time.end <= 0);
    return false;
  } catch (const DeckError& fault) {
    EXPECT_NE(std::string(fault.what()).find(": "), std::string::npos);
    return true;
  }
}

TEST(DeckFuzz, DamagedDecksAreReadOrRefused) {
  Random random(20);
  int refusals = 0;
  const int count = 2000;
  for (int i = 0; i < count; ++i) {
    std::string text = plain_deck;
    const std::size_t times = 1 + below(random, 4);
    for (std::size_t k = 0; k < times; ++k) damage(text, random);
    if (refused(text)) ++refusals;
  }
  // Damage to a title or to a digit may well pass; most of it does not.
  EXPECT_GT(refusals, count / 2);
  EXPECT_LT(refusals, count);
}

TEST(DeckFuzz, DamagedOverridesAreReadOrRefused) {
  Random random(21);
  for (int i = 0; i < 500; ++i) {
    std::string setting = "boundary_conditions.0.fix=[x, y]";
    damage(setting, random);
    refused(plain_deck, {setting});
  }
}

TEST(DeckFuzz, RepeatedOpeningBracketsAreRefused) {
  for (const char* open : {"[", "{a: ", "- ", "? "}) {
    const bool starts_a_line = open[0] == '-' || open[0] == '?';
    std::ostringstream text;
    text << (starts_a_line ? "" : "title: ");
    for (int i = 0; i < 20000; ++i) text << open;
    EXPECT_TRUE(refused(text.str())) << open;
  }
}

TEST(DeckFuzz, AliasesThatDoubleManyTimesAreRefusedAtOnce) {
  std::ostringstream lines;
  lines << "a0: &a0 [1, 1]\n";
  for (int i = 1; i < 60; ++i)
    lines << 'a' << i << ": &a" << i << " [*a" << i - 1 << ", *a" << i - 1 << "]\n";
  const std::string text = lines.str();
  EXPECT_TRUE(refused(text));
  EXPECT_TRUE(refused(text, {"title=x"}));
}

TEST(DeckFuzz, PathsOfOverridesThatGoDeepAreRefused) {
  std::string path = "time";
  for (int i = 0; i < 60000; ++i) path += ".a";
  EXPECT_TRUE(refused(plain_deck, {path + "=1"}));
}

TEST(DeckFuzz, MergedMapsOfManyKeysAreReadInProportionateTime) {
  std::ostringstream lines;
  lines << "a: &a {";
  for (int i = 0; i < 200000; ++i) lines << 'k' << i << ": 1, ";
  lines << "last: 1}\nb: {<<: [*a, *a], x: 1}\n";
  EXPECT_TRUE(refused(lines.str()));
}

}  // namespace
}  // namespace brio
