#include "io/study/read_study.hpp"

#include <filesystem>
#include <stdexcept>

#include "io/deck/read_deck.hpp"
#include "io/deck/read_fields.hpp"
#include "io/yaml/yaml_source.hpp"

namespace brio {

// Beside the types of decks in read_fields.hpp.
static void read_value(const YamlNode& node, const Slot& slot, Settings& settings) {
  require_map(node, slot);
  for (const YamlEntry& entry : node.entries)
    settings.overrides.push_back(entry.key + "=" + write_flow_yaml(*entry.value));
}

// Names of settings become names of folders, and tell of values: dots are welcome.
static void read_value(const YamlNode& node, const Slot& slot, NamedSettings& settings) {
  require_map(node, slot);
  for (const YamlEntry& entry : node.entries) {
    constexpr std::string_view letters = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-.";
    if (entry.key.empty() || entry.key.find_first_not_of(letters) != std::string::npos)
      throw DeckError(
          entry.place,
          "'" + entry.key + "' is not a name of a setting; letters, digits, '_', '-' and '.' are accepted");
    settings.emplace_back(entry.key, Settings{});
    read_value(*entry.value, {entry.key, any_number, slot.known}, settings.back().second);
  }
}

namespace {

void check_settings(const YamlNode& knobs) {
  for (const YamlEntry& knob : knobs.entries)
    for (const YamlEntry& setting : knob.value->entries)
      if (setting.value->is_map() && setting.value->entries.empty())
        throw DeckError(
            setting.place,
            "'" + setting.key + "' sets nothing; the deck as it is runs in any case, as 'default'");
}

void check_references(const CheckedStudy& checked, const YamlNode& root) {
  const Study& study = checked.study;
  try {
    if (reference_run(study, checked.runs)) return;
  } catch (const std::invalid_argument& fault) {
    throw DeckError(root.find("reference")->value->place, fault.what());
  }
  for (const YamlEntry& entry : root.find("quantities")->value->entries)
    if (entry.value->find("reference") == nullptr)
      throw DeckError(entry.place,
                      "'" + entry.key +
                          "' has no reference to be compared with; give it a 'reference', or the study "
                          "the name of a reference run");
}

void check_knob(const CheckedStudy& checked, const std::string& name, const Place& place) {
  std::vector<std::string_view> names;
  for (const auto& [knob, settings] : checked.study.knobs) names.push_back(knob);
  if (std::find(names.begin(), names.end(), name) != names.end()) return;
  throw DeckError(place, "no knob is called '" + name + "'; " + accepted_words(name, names));
}

void check_named_knobs(const CheckedStudy& checked, const YamlNode& root) {
  const Study& study = checked.study;
  if (!study.refined.empty()) check_knob(checked, study.refined, root.find("refined")->value->place);
  for (std::size_t i = 0; i < study.physics.size(); ++i)
    check_knob(checked, study.physics[i], root.find("physics")->value->items[i]->place);
}

void check_scales(const CheckedStudy& checked, const YamlNode& root) {
  for (const Quantity& quantity : checked.study.quantities)
    if (quantity.reference == 0.0 && !quantity.scale)
      throw DeckError(
          root.find("quantities")->value->find(quantity.name)->place,
          "'" + quantity.name + "' has 0 as its reference; give it a 'scale' that errors are over");
}

void check_parts(const CheckedStudy& checked, const YamlNode& root) {
  for (const YamlEntry& entry : root.find("quantities")->value->entries) {
    const YamlEntry* part = entry.value->find("part");
    if (part == nullptr) continue;
    const std::vector<std::string_view> names(checked.parts.begin(), checked.parts.end());
    if (std::find(names.begin(), names.end(), part->value->text) == names.end())
      throw DeckError(part->value->place, "the deck has no part '" + part->value->text + "'; " +
                                              accepted_words(part->value->text, names));
  }
}

void read_decks(CheckedStudy& checked) {
  const std::string text = read_text_file(checked.deck);
  for (const StudyRun& run : checked.runs) {
    const Deck deck = parse_deck(text, checked.deck, run.overrides);
    checked.texts.push_back(deck.text);
    std::string& meshes = checked.meshes.emplace_back();
    for (const std::string& mesh : deck.mesh_checksums) meshes += mesh + "\n";
    if (!checked.parts.empty()) continue;
    for (const Part& part : deck.parts) checked.parts.push_back(part.name);
  }
}

}  // namespace

CheckedStudy read_study(const std::string& path) {
  const std::shared_ptr<const YamlNode> root = parse_yaml(read_text_file(path), path);
  if (!root->is_map())
    throw DeckError(root->place, "the study is " + describe(*root) + "; a map of keys is expected");
  CheckedStudy checked;
  const Deck none;
  const KnownNames known(none, *root);
  read_fields(*root, Slot{"study", any_number, known}, checked.study);
  check_settings(*root->find("knobs")->value);
  if (checked.study.quantities.empty())
    throw DeckError(root->find("quantities")->place, "'quantities' is empty; at least one is expected");
  checked.deck = (std::filesystem::path(path).parent_path() / checked.study.deck).string();
  try {
    checked.runs = runs_of(checked.study);
  } catch (const std::invalid_argument& fault) {
    throw DeckError(root->find("combinations")->value->place, fault.what());
  }
  check_references(checked, *root);
  check_scales(checked, *root);
  check_named_knobs(checked, *root);
  read_decks(checked);
  check_parts(checked, *root);
  return checked;
}

}  // namespace brio
