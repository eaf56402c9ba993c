#pragma once
/// Reads any struct of the deck from its table of `fields()`: types, ranges, missing and unknown keys.

#include <algorithm>
#include <array>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <unordered_map>
#include <utility>
#include <variant>
#include <vector>

#include "io/mesh_format/file_meshes.hpp"
#include "io/yaml/closest_word.hpp"
#include "io/yaml/fault_list.hpp"
#include "io/yaml/yaml_source.hpp"
#include "src/base/tensor.hpp"
#include "src/deck/deck.hpp"

namespace brio {

/// Names that later entries of a deck may refer to: what of the deck has been read so far.
class KnownNames {
 public:
  /// \param faults where they gather; null: the first one ends the reading
  KnownNames(const Deck& deck, const YamlNode& root, FaultList* faults = nullptr)
      : deck_(deck), root_(root), faults_(faults) {}

  /// As FaultList has it; without a list a fault goes on to the caller.
  bool attempt(std::string_view name, const std::function<void()>& read) const;
  /// \throws FaultsTold where a thing of that name could not be read.
  void expect_read(std::string_view name) const;
  /// \throws FaultsTold where a list of names may lack some, as there are faults. \param is_complete whether
  /// it cannot
  void expect_complete(bool is_complete) const;

  /// \throws DeckError if no part is called so.
  const Part& part(const YamlNode& node, std::string_view name) const;
  /// The part of that name, or the parts of the mesh file of that name. \throws DeckError if there are none.
  std::vector<const Part*> parts_called(const YamlNode& node, std::string_view name) const;
  /// \throws DeckError if no boundary condition is called so.
  void expect_condition(const YamlNode& node, std::string_view name) const;
  /// \throws DeckError if no material is called so.
  const Material& material(const YamlNode& node) const;
  /// \throws DeckError if no coordinate system is called so.
  const CoordinateSystem& coordinate_system(const YamlNode& node) const;
  /// \throws DeckError if no mesh file is called so.
  const MeshFile& mesh_file(const YamlNode& node) const;
  const Deck& deck() const { return deck_; }
  /// Contents of mesh files, each read once.
  FileMeshes& file_meshes() const { return *file_meshes_; }
  /// What expressions may name.
  const Parameters& parameters() const { return deck_.parameters; }
  /// Of the run, which may be read later: curves are sampled up to it.
  double end_time() const;

 private:
  const Deck& deck_;
  const YamlNode& root_;
  FaultList* faults_;
  std::shared_ptr<FileMeshes> file_meshes_ = std::make_shared<FileMeshes>();
  template <class T>
  const T& named(const YamlNode& node, const std::vector<std::pair<std::string, T>>& entries,
                 std::string_view what) const;
  mutable std::unordered_map<std::string_view, const Part*> parts_;  ///< filled when all parts are read
};

/// What a value is for: its key, for messages; what it may be; the names it may refer to.
struct Slot {
  std::string_view key;
  Range range;
  const KnownNames& known;
};

/// "a number > 0", "an integer >= 1 and <= 9", ...
std::string accepted_numbers(const Range& range, std::string_view noun);
/// Range in words: "> 0", ">= 1 and <= 9"; empty if every number belongs to it.
std::string range_text(const Range& range);

void read_value(const YamlNode& node, const Slot& slot, double& value);
void read_value(const YamlNode& node, const Slot& slot, int& value);
void read_value(const YamlNode& node, const Slot& slot, bool& value);
void read_value(const YamlNode& node, const Slot& slot, std::string& value);

// What has a form of its own in a deck (read_parts.cpp, read_functions.cpp,
// read_conditions.cpp).
void read_value(const YamlNode& node, const Slot& slot, Material& material);
void read_value(const YamlNode& node, const Slot& slot, SharedYieldTable& table);
void read_value(const YamlNode& node, const Slot& slot, Element& element);
void read_value(const YamlNode& node, const Slot& slot, MeshSource& mesh);
void read_value(const YamlNode& node, const Slot& slot, BeamSection& section);
void read_value(const YamlNode& node, const Slot& slot, Part& part);
void read_value(const YamlNode& node, const Slot& slot, NodeSelection& selection);
void read_value(const YamlNode& node, const Slot& slot, Curve& curve);
void read_value(const YamlNode& node, const Slot& slot, SpaceTimeCurve& curve);
void read_value(const YamlNode& node, const Slot& slot, Parameters& parameters);
void read_value(const YamlNode& node, const Slot& slot, InitialCondition& condition);
void read_value(const YamlNode& node, const Slot& slot, BoundaryCondition& condition);
void read_value(const YamlNode& node, const Slot& slot, CoordinateSystem& system);
void read_value(const YamlNode& node, const Slot& slot, Load& load);
void read_value(const YamlNode& node, const Slot& slot, Connection& connection);
void read_value(const YamlNode& node, const Slot& slot, ContactPair& pair);
void read_value(const YamlNode& node, const Slot& slot, ContactSection& contact);
void read_value(const YamlNode& node, const Slot& slot, SpringEnd& end);
void read_value(const YamlNode& node, const Slot& slot, Probe& probe);
void read_value(const YamlNode& node, const Slot& slot, ReactionColumns& columns);
void read_value(const YamlNode& node, const Slot& slot, ContactColumns& columns);
void read_value(const YamlNode& node, const Slot& slot, ForceSection& section);

/// The value of an expression in quotes, `"2*v"`, from the parameters of the deck.
/// \throws DeckError with the place inside of the text.
double constant_of(const YamlNode& node, const Slot& slot);
/// A curve from an expression in quotes; without time and place in it a constant.
/// \param variables which it may use
/// \throws DeckError with the place inside of the text, or where the value is not finite at some time.
Curve curve_of(const YamlNode& node, const Slot& slot, Expression::Variables variables);

/// \throws DeckError "KEY is ...; WANTED is expected".
[[noreturn]] void refuse(const YamlNode& node, const Slot& slot, const std::string& wanted);
/// \throws DeckError unless the node is a map.
void require_map(const YamlNode& node, const Slot& slot);
/// \throws DeckError unless the name can stand in `part.set` and in files.
void check_name(const YamlEntry& entry, std::string_view kind);
/// \throws DeckError at the first key that is not among the accepted.
void check_keys(const YamlNode& map, const std::vector<std::string_view>& accepted);
/// \throws DeckError unless the key is among the accepted.
void check_key(const YamlEntry& entry, const std::vector<std::string_view>& accepted);

template <class T>
concept HasFault = requires(const T& value) {
  std::string_view(value.fault());
};
/// A thing that refusals after the deck was read refer to.
template <class T>
concept HasPlace = requires(T& value) {
  value.place = std::string();
};
/// A thing that is called by its key in a map, such as a part.
template <class T>
concept HasOwnName = requires(T& value) {
  value.name = std::string();
};

template <HasNamedValues Enumeration>
void read_value(const YamlNode& node, const Slot& slot, Enumeration& value) {
  std::vector<std::string_view> words;
  for (const auto& named : named_values(Enumeration{})) {
    if (node.is_scalar() && node.text == named.word) {
      value = named.value;
      return;
    }
    words.push_back(named.word);
  }
  if (!node.is_scalar()) refuse(node, slot, "one word of " + accepted_words("", words).substr(10));
  throw DeckError(node.place, "'" + std::string(slot.key) + "' is " + describe(node) + "; " +
                                  accepted_words(node.text, words));
}

template <class T, std::size_t N>
void read_value(const YamlNode& node, const Slot& slot, std::array<T, N>& values) {
  if (!node.is_sequence() || node.items.size() != N) {
    const std::string noun = std::is_same_v<T, int> ? "integers" : "numbers";
    const std::string range = range_text(slot.range);
    refuse(node, slot, "a list of " + std::to_string(N) + " " + noun + (range.empty() ? "" : " " + range));
  }
  for (std::size_t i = 0; i < N; ++i) read_value(*node.items[i], slot, values[i]);
}

inline void read_value(const YamlNode& node, const Slot& slot, Vector3d& vector) {
  std::array<double, 3> components{vector.x, vector.y, vector.z};
  read_value(node, slot, components);
  vector = vector_at(components.data());
}

/// A map of names, or a list. Faults of one entry leave the others to be read.
template <class T>
void read_value(const YamlNode& node, const Slot& slot, std::vector<T>& values) {
  bool complete = true;
  if constexpr (HasOwnName<T>) {
    require_map(node, slot);
    for (const YamlEntry& entry : node.entries) {
      T& value = values.emplace_back();
      value.name = entry.key;
      complete &= slot.known.attempt(entry.key, [&] {
        check_name(entry, slot.key);
        read_value(*entry.value, {entry.key, any_number, slot.known}, value);
        if constexpr (HasPlace<T>) value.place = to_string(entry.place);
      });
    }
  } else {
    if (!node.is_sequence()) refuse(node, slot, "a list");
    for (const auto& item : node.items)
      complete &= slot.known.attempt("", [&] { read_value(*item, slot, values.emplace_back()); });
  }
  if (!complete) throw FaultsTold{};
}
template <class T>
void read_value(const YamlNode& node, const Slot& slot, std::vector<std::pair<std::string, T>>& values) {
  require_map(node, slot);
  bool complete = true;
  for (const YamlEntry& entry : node.entries) {
    T& value = values.emplace_back(entry.key, T{}).second;
    complete &= slot.known.attempt(entry.key, [&] {
      check_name(entry, slot.key);
      read_value(*entry.value, {entry.key, any_number, slot.known}, value);
    });
  }
  if (!complete) throw FaultsTold{};
}

template <class T>
void read_value(const YamlNode& node, const Slot& slot, std::optional<T>& value) {
  read_value(node, slot, value.emplace());
}

/// The keys of a struct's table.
template <HasFields T>
std::vector<std::string_view> keys_of() {
  std::vector<std::string_view> keys;
  T::fields()([&](const auto& field) { keys.push_back(field.key); });
  return keys;
}

/// Reads entries of a map, whatever their types. Faults of one entry leave the others to be read; a key that
/// is missing is not told where one is unknown, which it may be.
class EntryReader {
 public:
  using Read = void (*)(const YamlNode& node, const Slot& slot, void* value);
  /// Checks the keys of the map.
  EntryReader(const YamlNode& map, const Slot& slot, const std::vector<std::string_view>& accepted);
  void read(const Slot& entry, bool is_required, std::string_view meaning, void* value, Read read);
  /// \throws FaultsTold where an entry could not be read.
  void finish() const;

 private:
  const YamlNode& map_;
  const Slot& slot_;
  bool complete_ = true, knows_all_keys_;
};

template <class Value>
void read_erased(const YamlNode& node, const Slot& slot, void* value) {
  read_value(node, slot, *static_cast<Value*>(value));
}

/// Reads the entries of a map into a struct, in the order of its table. \param besides keys that the caller
/// reads
template <HasFields T>
void read_fields(const YamlNode& map, const Slot& slot, T& value,
                 const std::vector<std::string_view>& besides = {}) {
  std::vector<std::string_view> accepted = keys_of<T>();
  accepted.insert(accepted.begin(), besides.begin(), besides.end());
  EntryReader reader(map, slot, accepted);
  if constexpr (HasPlace<T>) value.place = to_string(map.place);
  T::fields()([&](const auto& field) {
    auto& entry = value.*field.member;
    reader.read({field.key, field.range, slot.known}, field.is_required, field.meaning, &entry,
                read_erased<std::decay_t<decltype(entry)>>);
  });
  reader.finish();
  if constexpr (HasFault<T>) {
    if (const std::string_view fault = value.fault(); !fault.empty())
      throw DeckError(map.place, std::string(fault));
  }
}

template <HasFields T>
void read_value(const YamlNode& node, const Slot& slot, T& value) {
  read_fields(node, slot, value);
}

/// The names of a variant's alternatives, in its order.
template <class... Alternative>
std::vector<std::string_view> names_of(const std::variant<Alternative...>&) {
  std::vector<std::string_view> names;
  const auto add = [&]<class One>(std::type_identity<One>) {
    if constexpr (!std::is_same_v<One, std::monostate>) names.push_back(One::name);
  };
  (add(std::type_identity<Alternative>{}), ...);
  return names;
}

/// Makes `choice` the alternative called `name` and hands it to `read`; false if none is called so.
template <class Read, class... Alternative>
bool choose_alternative(std::variant<Alternative...>& choice, std::string_view name, const Read& read) {
  const auto offer = [&]<class One>(std::type_identity<One>) {
    if constexpr (!std::is_same_v<One, std::monostate>) {
      if (One::name != name) return false;
      read(choice.template emplace<One>());
      return true;
    }
    return false;
  };
  return (offer(std::type_identity<Alternative>{}) || ...);
}

/// `{KEY: NAME, ...fields}`, as materials and elements are written.
template <class Variant>
void read_named_choice(const YamlNode& map, const Slot& slot, std::string_view key, Variant& choice) {
  require_map(map, slot);
  const YamlEntry* entry = map.find(key);
  if (entry == nullptr)
    throw DeckError(map.place, "'" + std::string(slot.key) + "' has no '" + std::string(key) + "'; " +
                                   accepted_words("", names_of(choice)));
  const bool found = choose_alternative(choice, entry->value->text,
                                        [&](auto& chosen) { read_fields(map, slot, chosen, {key}); });
  if (!found)
    throw DeckError(entry->value->place, "'" + std::string(key) + "' is " + describe(*entry->value) + "; " +
                                             accepted_words(entry->value->text, names_of(choice)));
}

/// `{NAME: {...fields}}`, as meshes and regions are written.
/// \param besides keys that may stand beside the name and are read by the caller
template <class Variant>
void read_single_key_choice(const YamlNode& map, const Slot& slot, Variant& choice,
                            const std::vector<std::string_view>& besides = {}) {
  require_map(map, slot);
  const std::vector<std::string_view> names = names_of(choice);
  std::vector<std::string_view> accepted = names;
  accepted.insert(accepted.end(), besides.begin(), besides.end());
  check_keys(map, accepted);
  const YamlEntry* chosen_entry = nullptr;
  for (const YamlEntry& entry : map.entries) {
    if (std::find(besides.begin(), besides.end(), entry.key) != besides.end()) continue;
    if (chosen_entry != nullptr)
      throw DeckError(entry.place, "'" + std::string(slot.key) + "' is both '" + chosen_entry->key +
                                       "' and '" + entry.key + "'; one is accepted");
    chosen_entry = &entry;
  }
  if (chosen_entry == nullptr)
    throw DeckError(map.place, "'" + std::string(slot.key) + "' is not said; " + accepted_words("", names));
  choose_alternative(choice, chosen_entry->key, [&](auto& chosen) {
    read_value(*chosen_entry->value, Slot{chosen_entry->key, any_number, slot.known}, chosen);
  });
}

}  // namespace brio
