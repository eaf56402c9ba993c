#include "io/read_deck.hpp"

#include "io/read_fields.hpp"
#include "io/yaml_source.hpp"

namespace brio {

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
  Deck deck;
  deck.file = name;
  const KnownNames known(deck);
  read_fields(*root, Slot{"deck", any_number, known}, deck);
  deck.text = overrides.empty() ? text : write_yaml(*root);
  return deck;
}

}  // namespace brio
