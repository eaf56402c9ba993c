#include "io/deck/read_deck.hpp"

#include "io/deck/deck_files.hpp"
#include "io/deck/preset.hpp"
#include "io/deck/read_fields.hpp"
#include "io/yaml/yaml_source.hpp"
#include "src/fields/cell_variables.hpp"
#include "src/fields/contact_fields.hpp"
#include "src/fields/rotation.hpp"

namespace brio {

namespace {

void check_precision(const Deck& deck, const YamlNode& root) {
  if (deck.numerics.precision == Precision::double_precision) return;
  for (const Part& part : deck.parts)
    if (traits_of(part.element).precision == ElementPrecision::double_only)
      throw DeckError(root.find("numerics")->value->find("precision")->value->place,
                      "part '" + part.name + "' is of particles, which are computed in double only");
}

/// Resolves groups of variables. Names that nothing knows would be fields of zeros.
void read_variables(Deck& deck, const YamlNode& root) {
  std::vector<std::string>& wanted = deck.output.fields_.variables;
  if (wanted.empty()) return;
  std::vector<std::string_view> histories;
  for (const auto& [name, material] : deck.materials)
    for (const std::string_view word : history_names_of(material))
      if (std::ranges::find(histories, word) == histories.end()) histories.push_back(word);
  std::vector<std::string_view> others = std::move(histories);
  if (deck.contact)
    for (const PointVariable& variable : contact_variables()) others.push_back(variable.name);
  if (std::ranges::any_of(deck.parts, [](const Part& part) { return has_rotations(part.element); }))
    others.push_back(rotation_variable().name);
  std::vector<std::string_view> known{default_group, all_group, state_variable};
  const auto is_had = [&](const CellVariable& variable) {
    return variable.of == nullptr || std::ranges::any_of(deck.parts, [&](const Part& part) {
             return traits_of(part.element).*variable.of;
           });
  };
  for (const CellVariable& variable : chosen_variables())
    if (is_had(variable)) known.push_back(variable.name);
  known.insert(known.end(), others.begin(), others.end());
  const YamlNode& list = *root.find("output")->value->find("fields")->value->find("variables")->value;
  for (std::size_t i = 0; i < wanted.size(); ++i)
    if (std::ranges::find(known, wanted[i]) == known.end())
      throw DeckError(list.items[i]->place,
                      "no field is called '" + wanted[i] + "'; " + accepted_words(wanted[i], known));
  wanted = named_variables(wanted, others, is_had);
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
  const std::shared_ptr<const YamlNode> as_said = root;
  root = with_includes(root, name);
  for (const std::string& setting : overrides) root = override_value(root, setting);
  root = with_preset(with_tables(root, name));
  Deck deck;
  deck.file = name;
  FaultList faults;
  const KnownNames known(deck, *root, &faults);
  try {
    read_fields(*root, Slot{"deck", any_number, known}, deck);
  } catch (const FaultsTold&) {
    faults.raise();
  }
  if (deck.parts.empty())
    throw DeckError(
        root->find("parts")->value->place,
        "'parts' is empty; at least one part is expected, such as {cube: {mesh: ..., element: ..., "
        "material: ...}}");
  known.file_meshes().describe(deck.mesh_checksums, deck.mesh_notices);
  check_precision(deck, *root);
  read_variables(deck, *root);
  deck.text = root == as_said ? text : write_yaml(*root);
  return deck;
}

}  // namespace brio
