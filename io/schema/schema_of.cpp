#include "io/schema/schema_of.hpp"

#include "src/base/floating_point.hpp"

namespace brio {

namespace {

void limit(Schema& schema, const Range& range) {
  if (range.lower != -infinity) schema[range.lower_open ? "exclusiveMinimum" : "minimum"] = range.lower;
  if (range.upper != infinity) schema[range.upper_open ? "exclusiveMaximum" : "maximum"] = range.upper;
}

}  // namespace

Schema number_schema(const Range& range) {
  Schema schema{{"type", {"number", "string"}}};  // an expression in quotes
  limit(schema, range);
  return schema;
}

Schema integer_schema(const Range& range) {
  Schema schema{{"type", {"integer", "string"}}};
  limit(schema, range);
  return schema;
}

Schema boolean_schema() { return {{"type", "boolean"}}; }

Schema text_schema() { return {{"type", "string"}}; }

Schema list_schema(Schema items) { return {{"type", "array"}, {"items", std::move(items)}}; }

Schema array_schema(Schema items, std::size_t size) {
  return {{"type", "array"}, {"items", std::move(items)}, {"minItems", size}, {"maxItems", size}};
}

Schema words_schema(const std::vector<std::string_view>& words) { return {{"enum", words}}; }

Schema map_of_names(Schema value) {
  return {{"type", "object"},
          {"propertyNames", {{"pattern", "^[A-Za-z0-9_-]+$"}}},
          {"additionalProperties", std::move(value)}};
}

ObjectSchema::ObjectSchema()
    : object_{{"type", "object"}, {"properties", Schema::object()}, {"required", Schema::array()}} {}

void ObjectSchema::add(std::string_view key, bool is_required, Schema property) {
  if (is_required) object_["required"].push_back(key);
  object_["properties"][std::string(key)] = std::move(property);
}

Schema ObjectSchema::finished() {
  object_["additionalProperties"] = false;
  return std::move(object_);
}

void describe(Schema& schema, std::string_view description) { schema["description"] = description; }

void set_default(Schema& schema, Schema value) { schema["default"] = std::move(value); }

void add_meaning(Schema& schema, std::string_view name, std::string_view meaning) {
  schema["title"] = name;
  if (!meaning.empty()) schema["description"] = meaning;
}

void add_named(Schema& choice, std::string_view key, std::string_view name, std::string_view meaning,
               Schema object) {
  Schema properties{{std::string(key), {{"const", name}}}};
  properties.update(object["properties"]);
  object["properties"] = std::move(properties);
  object["required"].insert(object["required"].begin(), key);
  add_meaning(object, name, meaning);
  choice["oneOf"].push_back(std::move(object));
}

void add_single_key(Schema& choice, std::string_view name, std::string_view meaning, const Schema& besides,
                    Schema object) {
  Schema holder{{"type", "object"}, {"properties", Schema::object()}};
  holder["properties"][std::string(name)] = std::move(object);
  holder["properties"].update(besides);
  holder["required"] = {name};
  holder["additionalProperties"] = false;
  add_meaning(holder, name, meaning);
  choice["oneOf"].push_back(std::move(holder));
}

}  // namespace brio
