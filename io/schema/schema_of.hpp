#pragma once
/// JSON schemas of the types that a deck is made of: the counterpart of read_fields.hpp.

#include <array>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "io/deck/condition_words.hpp"
#include "io/deck/read_fields.hpp"
#include "src/base/tensor.hpp"
#include "src/deck/deck.hpp"

namespace brio {

using Schema = nlohmann::ordered_json;

template <class T>
struct SchemaOf;

/// Schema of a value of type T whose numbers are limited to a range.
template <class T>
Schema schema_of(const Range& range) {
  return SchemaOf<T>::make(range);
}

// What does not depend on T (schema_of.cpp): much of it would be compiled with each.

Schema number_schema(const Range& range);
Schema integer_schema(const Range& range);
Schema boolean_schema();
Schema text_schema();
Schema list_schema(Schema items);
Schema array_schema(Schema items, std::size_t size);
/// One of the words.
Schema words_schema(const std::vector<std::string_view>& words);
/// A map whose keys are names.
Schema map_of_names(Schema value);

/// An object that takes no other keys than those that are added.
class ObjectSchema {
 public:
  ObjectSchema();
  void add(std::string_view key, bool is_required, Schema property);
  Schema finished();

 private:
  Schema object_;
};

void describe(Schema& schema, std::string_view description);
void set_default(Schema& schema, Schema value);
/// The word for a thing beside its name. \param meaning none where empty
void add_meaning(Schema& schema, std::string_view name, std::string_view meaning);
/// Of a choice between `{KEY: NAME, ...fields}`. \param object the fields
void add_named(Schema& choice, std::string_view key, std::string_view name, std::string_view meaning,
               Schema object);
/// Of a choice between `{NAME: {...fields}}`, with further keys beside the name.
void add_single_key(Schema& choice, std::string_view name, std::string_view meaning, const Schema& besides,
                    Schema object);

/// An object that takes no other keys than those of T's table.
template <HasFields T>
Schema object_of() {
  ObjectSchema object;
  const T defaults{};
  T::fields()([&]<class Member>(const Field<T, Member>& field) {
    Schema property = schema_of<Member>(field.range);
    describe(property, field.meaning);
    if (!field.is_required) SchemaOf<Member>::add_default(property, defaults.*field.member);
    object.add(field.key, field.is_required, std::move(property));
  });
  return object.finished();
}

template <class T>
constexpr std::string_view meaning_of() {
  if constexpr (requires { T::meaning; }) {
    return T::meaning;
  } else {
    return {};
  }
}

template <class T>
void add_meaning(Schema& schema) {
  add_meaning(schema, T::name, meaning_of<T>());
}

/// What has no default to show.
struct WithoutDefault {
  template <class T>
  static void add_default(Schema&, const T&) {}
};
struct WithDefault {
  template <class T>
  static void add_default(Schema& schema, const T& value) {
    set_default(schema, value);
  }
};

template <>
struct SchemaOf<double> : WithDefault {
  static Schema make(const Range& range) { return number_schema(range); }
};
template <>
struct SchemaOf<int> : WithDefault {
  static Schema make(const Range& range) { return integer_schema(range); }
};
template <>
struct SchemaOf<bool> : WithDefault {
  static Schema make(const Range&) { return boolean_schema(); }
};
template <>
struct SchemaOf<std::string> : WithoutDefault {
  static Schema make(const Range&) { return text_schema(); }
};

template <HasNamedValues Enumeration>
struct SchemaOf<Enumeration> {
  static Schema make(const Range&) {
    std::vector<std::string_view> words;
    for (const auto& named : named_values(Enumeration{})) words.push_back(named.word);
    return words_schema(words);
  }
  static void add_default(Schema& schema, Enumeration value) {
    for (const auto& named : named_values(Enumeration{}))
      if (named.value == value) set_default(schema, named.word);
  }
};

template <class T, std::size_t N>
struct SchemaOf<std::array<T, N>> : WithDefault {
  static Schema make(const Range& range) { return array_schema(schema_of<T>(range), N); }
};
template <>
struct SchemaOf<Vector3d> : SchemaOf<std::array<double, 3>> {};
template <class T>
struct SchemaOf<std::vector<T>> : WithoutDefault {
  static Schema make(const Range& range) {
    if constexpr (HasOwnName<T>) return map_of_names(schema_of<T>(any_number));
    return list_schema(schema_of<T>(range));
  }
};
template <class T>
struct SchemaOf<std::vector<std::pair<std::string, T>>> : WithoutDefault {
  static Schema make(const Range&) { return map_of_names(schema_of<T>(any_number)); }
};
template <class T>
struct SchemaOf<std::optional<T>> : WithoutDefault {
  static Schema make(const Range& range) { return schema_of<T>(range); }
};
template <HasFields T>
struct SchemaOf<T> : WithoutDefault {
  static Schema make(const Range&) { return object_of<T>(); }
};

/// Calls `add` with the type of each alternative that a deck can name.
template <class... Alternative, class Add>
void for_each_alternative(const std::variant<Alternative...>*, const Add& add) {
  const auto offer = [&]<class One>(std::type_identity<One> one) {
    if constexpr (!std::is_same_v<One, std::monostate>) add(one);
  };
  (offer(std::type_identity<Alternative>{}), ...);
}

/// `{KEY: NAME, ...fields}`.
template <class Variant>
Schema named_choice(std::string_view key) {
  Schema choice{{"oneOf", Schema::array()}};
  for_each_alternative(static_cast<const Variant*>(nullptr), [&]<class One>(std::type_identity<One>) {
    add_named(choice, key, One::name, meaning_of<One>(), object_of<One>());
  });
  return choice;
}

/// `{NAME: {...fields}}`, with further keys beside the name.
template <class Variant>
Schema single_key_choice(const Schema& besides = Schema::object()) {
  Schema choice{{"oneOf", Schema::array()}};
  for_each_alternative(static_cast<const Variant*>(nullptr), [&]<class One>(std::type_identity<One>) {
    add_single_key(choice, One::name, meaning_of<One>(), besides, object_of<One>());
  });
  return choice;
}

}  // namespace brio
