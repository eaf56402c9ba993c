#include "io/deck/read_deck.hpp"

#include "io/deck/preset.hpp"
#include "io/deck/read_fields.hpp"
#include "io/deck/yaml_source.hpp"

namespace brio {

namespace {

void check_precision(const Deck& deck, const YamlNode& root) {
  if (deck.numerics.precision == Precision::double_precision) return;
  for (const Part& part : deck.parts)
    if (traits_of(part.element).precision == ElementPrecision::double_only)
      throw DeckError(root.find("numerics")->value->find("precision")->value->place,
                      "part '" + part.name + "' is of particles, which are computed in double only");
}

/// Names that no material of a part knows would be fields of zeros.
void check_history_fields(const Deck& deck, const YamlNode& root) {
  if (deck.output.fields_.history.empty()) return;
  std::vector<std::string_view> known;
  for (const auto& [name, material] : deck.materials)
    for (const std::string_view word : history_names_of(material))
      if (std::ranges::find(known, word) == known.end()) known.push_back(word);
  const YamlNode& list = *root.find("output")->value->find("fields")->value->find("history")->value;
  for (std::size_t i = 0; i < deck.output.fields_.history.size(); ++i) {
    const std::string& name = deck.output.fields_.history[i];
    if (std::ranges::find(known, name) != known.end()) continue;
    throw DeckError(list.items[i]->place,
                    "no material has a history '" + name + "'; " + accepted_words(name, known));
  }
}

}  // namespace

Deck read_deck(const std::string& path, const std::vector<std::string>& overrides) {
  return parse_deck(read_text_file(path), path, overrides);
}

Deck parse_deck(const std::string& text, const std::string& name, const std::vector<std::string>& overrides) {
  std::shared_ptr<const YamlNode> root = parse_yaml(text, name);
  if (root->is_null())
    throw DeckError(root->place, "the deck is empty; materials, parts and time are required");
  if (!root->is_map())
    throw DeckError(root->place, "the deck is " + describe(*root) + "; a map of keys is expected");
  for (const std::string& setting : overrides) root = override_value(root, setting);
  const std::shared_ptr<const YamlNode> as_said = root;
  root = with_preset(root);
  Deck deck;
  deck.file = name;
  const KnownNames known(deck);
  read_fields(*root, Slot{"deck", any_number, known}, deck);
  if (deck.parts.empty())
    throw DeckError(
        root->find("parts")->value->place,
        "'parts' is empty; at least one part is expected, such as {cube: {mesh: ..., element: ..., "
        "material: ...}}");
  check_precision(deck, *root);
  check_history_fields(deck, *root);
  deck.text = overrides.empty() && root == as_said ? text : write_yaml(*root);
  return deck;
}

}  // namespace brio
