#pragma once
/// JSON schemas of the types that a deck is made of: the counterpart of read_fields.hpp.

#include <array>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "io/deck/condition_words.hpp"
#include "io/deck/read_fields.hpp"
#include "src/base/floating_point.hpp"
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

inline void limit(Schema& schema, const Range& range) {
  if (range.lower != -infinity) schema[range.lower_open ? "exclusiveMinimum" : "minimum"] = range.lower;
  if (range.upper != infinity) schema[range.upper_open ? "exclusiveMaximum" : "maximum"] = range.upper;
}

/// An object that takes no other keys than those of T's table.
template <HasFields T>
Schema object_of() {
  Schema object{{"type", "object"}, {"properties", Schema::object()}, {"required", Schema::array()}};
  const T defaults{};
  const auto add = [&]<class Member>(const Field<T, Member>& field) {
    Schema property = schema_of<Member>(field.range);
    property["description"] = field.meaning;
    if (field.is_required) {
      object["required"].push_back(field.key);
    } else {
      SchemaOf<Member>::add_default(property, defaults.*field.member);
    }
    object["properties"][std::string(field.key)] = std::move(property);
  };
  T::fields()(add);
  object["additionalProperties"] = false;
  return object;
}

/// The word for a thing beside its name, where it has one.
template <class T>
void add_meaning(Schema& schema) {
  schema["title"] = T::name;
  if constexpr (requires { T::meaning; }) schema["description"] = T::meaning;
}

/// A map whose keys are names.
inline Schema map_of_names(Schema value) {
  return {{"type", "object"},
          {"propertyNames", {{"pattern", "^[A-Za-z0-9_-]+$"}}},
          {"additionalProperties", std::move(value)}};
}

/// What has no default to show.
struct WithoutDefault {
  template <class T>
  static void add_default(Schema&, const T&) {}
};
struct WithDefault {
  template <class T>
  static void add_default(Schema& schema, const T& value) {
    schema["default"] = value;
  }
};

template <>
struct SchemaOf<double> : WithDefault {
  static Schema make(const Range& range) {
    Schema schema{{"type", {"number", "string"}}};  // an expression in quotes
    limit(schema, range);
    return schema;
  }
};
template <>
struct SchemaOf<int> : WithDefault {
  static Schema make(const Range& range) {
    Schema schema{{"type", {"integer", "string"}}};
    limit(schema, range);
    return schema;
  }
};
template <>
struct SchemaOf<bool> : WithDefault {
  static Schema make(const Range&) { return {{"type", "boolean"}}; }
};
template <>
struct SchemaOf<std::string> : WithoutDefault {
  static Schema make(const Range&) { return {{"type", "string"}}; }
};

template <HasNamedValues Enumeration>
struct SchemaOf<Enumeration> {
  static Schema make(const Range&) {
    Schema schema{{"enum", Schema::array()}};
    for (const auto& named : named_values(Enumeration{})) schema["enum"].push_back(named.word);
    return schema;
  }
  static void add_default(Schema& schema, Enumeration value) {
    for (const auto& named : named_values(Enumeration{}))
      if (named.value == value) schema["default"] = named.word;
  }
};

template <class T, std::size_t N>
struct SchemaOf<std::array<T, N>> : WithDefault {
  static Schema make(const Range& range) {
    return {{"type", "array"}, {"items", schema_of<T>(range)}, {"minItems", N}, {"maxItems", N}};
  }
};
template <>
struct SchemaOf<Vector3d> : SchemaOf<std::array<double, 3>> {};
template <class T>
struct SchemaOf<std::vector<T>> : WithoutDefault {
  static Schema make(const Range& range) {
    if constexpr (HasOwnName<T>) return map_of_names(schema_of<T>(any_number));
    return {{"type", "array"}, {"items", schema_of<T>(range)}};
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
Schema named_choice(const std::string& key) {
  Schema choice{{"oneOf", Schema::array()}};
  for_each_alternative(static_cast<const Variant*>(nullptr), [&]<class One>(std::type_identity<One>) {
    Schema object = object_of<One>();
    Schema properties{{key, {{"const", One::name}}}};
    properties.update(object["properties"]);
    object["properties"] = std::move(properties);
    object["required"].insert(object["required"].begin(), key);
    add_meaning<One>(object);
    choice["oneOf"].push_back(std::move(object));
  });
  return choice;
}

/// `{NAME: {...fields}}`, with further keys beside the name.
template <class Variant>
Schema single_key_choice(const Schema& besides = Schema::object()) {
  Schema choice{{"oneOf", Schema::array()}};
  for_each_alternative(static_cast<const Variant*>(nullptr), [&]<class One>(std::type_identity<One>) {
    Schema object{{"type", "object"}, {"properties", Schema::object()}};
    object["properties"][std::string(One::name)] = object_of<One>();
    object["properties"].update(besides);
    object["required"] = {One::name};
    object["additionalProperties"] = false;
    add_meaning<One>(object);
    choice["oneOf"].push_back(std::move(object));
  });
  return choice;
}

}  // namespace brio
