#include "io/schema/write_schema.hpp"

#include "io/mesh/generate_mesh.hpp"
#include "io/schema/schema_of.hpp"
#include "io/schema/schema_of_tables.hpp"

namespace brio {

// What has a form of its own in a deck; the readers are in read_parts.cpp and read_conditions.cpp.

template <>
struct SchemaOf<Material> : WithoutDefault {
  static Schema make(const Range&) { return named_choice<Material>("model"); }
};

template <>
struct SchemaOf<BeamSection> : WithoutDefault {
  static Schema make(const Range&) { return single_key_choice<BeamSection>(); }
};

template <>
struct SchemaOf<Element> : WithoutDefault {
  static Schema make(const Range&) {
    Schema words = Schema::array();
    for_each_alternative(static_cast<const Element*>(nullptr), [&]<class Kind>(std::type_identity<Kind>) {
      if (object_of<Kind>()["required"].empty()) words.push_back(Kind::name);
    });
    Schema choice = named_choice<Element>("type");
    choice["oneOf"].insert(
        choice["oneOf"].begin(),
        Schema{{"enum", words}, {"title", "a word"}, {"description", "the element with its defaults"}});
    return choice;
  }
};

// Its keys stand beside each other.
template <>
struct SchemaOf<MeshFromFile> : WithoutDefault {
  static Schema make(const Range&) {
    Schema object = object_of<MeshFromFile>();
    object["oneOf"] = {{{"required", {"from"}}}, {{"required", {"file"}}}};
    add_meaning<MeshFromFile>(object);
    return object;
  }
};

template <>
struct SchemaOf<MeshSource> : WithoutDefault {
  static Schema make(const Range&) {
    Schema choice = single_key_choice<MeshSource>();
    for (Schema& one : choice["oneOf"])
      if (one["title"] == MeshFromFile::name) one = schema_of<MeshFromFile>(any_number);
    std::size_t i = 0;
    for_each_alternative(static_cast<const MeshSource*>(nullptr),
                         [&]<class Shape>(std::type_identity<Shape>) {
                           std::string meaning(Shape::meaning);
                           const char* separator = "; sets: ";
                           for (const std::string_view set : node_set_names(Shape{})) {
                             meaning += separator + std::string(set);
                             separator = ", ";
                           }
                           choice["oneOf"][i++]["description"] = meaning;
                         });
    return choice;
  }
};

template <>
struct SchemaOf<NodeSelection> : WithoutDefault {
  static Schema make(const Range&) {
    Schema choice = single_key_choice<Region>(
        {{"part", {{"type", "string"}, {"description", "of this part only; default: of all parts"}}}});
    choice["oneOf"].insert(
        choice["oneOf"].begin(),
        Schema{{"type", "string"}, {"title", "a name"}, {"description", "part.set, or part alone"}});
    return choice;
  }
};

template <>
struct SchemaOf<InitialCondition> : WithoutDefault {
  static Schema make(const Range&) {
    Schema object = object_of<InitialCondition>();
    Schema where{{"part", {{"type", "string"}, {"description", "all nodes of a part"}}},
                 {"set", schema_of<NodeSelection>(any_number)}};
    where["set"]["description"] = "nodes, where not a whole part";
    where.update(object["properties"]);
    object["properties"] = std::move(where);
    object["allOf"] = {{{"oneOf", {{{"required", {"part"}}}, {{"required", {"set"}}}}}},
                       {{"anyOf",
                         {{{"required", {"velocity"}}},
                          {{"required", {"spin"}}},
                          {{"required", {"radial"}}},
                          {{"required", {"from"}}}}}}};
    return object;
  }
};

template <>
struct SchemaOf<CoordinateSystem> : WithoutDefault {
  static Schema make(const Range&) { return single_key_choice<CoordinateSystem>(); }
};

/// The components of a prescribed motion, by their words.
struct MotionComponents {};

template <>
struct SchemaOf<MotionComponents> : WithoutDefault {
  static Schema make(const Range&) {
    Schema components{{"type", "object"}, {"properties", Schema::object()}};
    const auto add = [&](const ComponentWords& words, const std::string& where) {
      for (std::size_t axis = 0; axis < words.size(); ++axis) {
        Schema& component = components["properties"][std::string(words[axis])];
        if (!component.is_null()) continue;
        component = schema_of<Curve>(any_number);
        component["description"] = (axis < 3 ? "translation along an axis"
                                             : "rotation about an axis; shells, beams and rigid parts only") +
                                   where;
      }
    };
    add(component_words, "");
    add(cylindrical_words, ", of a cylindrical system");
    components["minProperties"] = 1;
    components["additionalProperties"] = false;
    return components;
  }
};

/// `all`, or a list.
Schema all_or_list(Schema items) {
  return {
      {"oneOf", {{{"const", "all"}, {"title", "all"}}, {{"type", "array"}, {"items", std::move(items)}}}}};
}

template <>
struct SchemaOf<ReactionColumns> : WithoutDefault {
  static Schema make(const Range&) { return all_or_list({{"type", "string"}}); }
};

template <>
struct SchemaOf<ContactColumns> : WithoutDefault {
  static Schema make(const Range&) { return all_or_list(schema_of<std::array<std::string, 2>>(any_number)); }
};

template <>
struct SchemaOf<BoundaryCondition> : WithoutDefault {
  static Schema make(const Range&) {
    const Schema name{
        {"type", "string"}, {"pattern", "^[A-Za-z0-9_-]+$"}, {"description", "for columns of the history"}};
    Schema motion{{"type", "object"}, {"title", "motion"}};
    motion["description"] = "components of the motion of a set are prescribed";
    motion["properties"]["name"] = name;
    motion["properties"]["part"] = {{"type", "string"},
                                    {"description", "all nodes of a part, or a rigid part as a whole"}};
    motion["properties"]["set"] = schema_of<NodeSelection>(any_number);
    motion["properties"]["set"]["description"] = "nodes, where not a whole part";
    motion["properties"]["system"] = {
        {"type", "string"},
        {"description", "name of the coordinate system of the components; default: the global axes"}};
    Schema words = component_words;
    for (const std::string_view word : cylindrical_words)
      if (std::ranges::find(component_words, word) == component_words.end()) words.push_back(word);
    motion["properties"]["fix"] = {
        {"type", "array"},
        {"items", {{"enum", words}}},
        {"minItems", 1},
        {"uniqueItems", true},
        {"description",
         "components that stay; rx, ry, rz, and rr, rt, rz of a cylindrical system, are rotations"}};
    Schema keys = Schema::array({Schema{{"required", {"fix"}}}});
    for (const auto& [key, kind] : motion_keys) {
      Schema components = schema_of<MotionComponents>(any_number);
      components["description"] = "components and their values";
      motion["properties"][std::string(key)] = std::move(components);
      keys.push_back({{"required", {key}}});
    }
    motion["allOf"] = {{{"oneOf", {{{"required", {"part"}}}, {{"required", {"set"}}}}}}};
    motion["oneOf"] = keys;
    motion["additionalProperties"] = false;
    Schema choice = single_key_choice<std::variant<RigidWall>>({{"name", name}});
    choice["oneOf"].insert(choice["oneOf"].begin(), motion);
    return choice;
  }
};

template <>
struct SchemaOf<Load> : WithoutDefault {
  static Schema make(const Range&) {
    Schema choice{{"oneOf", Schema::array()}};
    for_each_alternative(static_cast<const Load*>(nullptr), [&]<class One>(std::type_identity<One>) {
      Schema object = object_of<One>();
      add_meaning<One>(object);
      choice["oneOf"].push_back(std::move(object));
    });
    return choice;
  }
};

template <>
struct SchemaOf<Connection> : WithoutDefault {
  static Schema make(const Range&) {
    Schema choice{{"oneOf", Schema::array()}};
    for_each_alternative(static_cast<const Connection*>(nullptr), [&]<class One>(std::type_identity<One>) {
      Schema object = object_of<One>();
      add_meaning<One>(object);
      object["properties"][std::string(One::name)].update(
          Schema{{"minItems", 2}, {"maxItems", 2}, {"uniqueItems", true}});
      choice["oneOf"].push_back(std::move(object));
    });
    return choice;
  }
};

template <>
struct SchemaOf<ContactSection> : WithoutDefault {
  static Schema make(const Range&) {
    const Schema parts{{"type", "array"}, {"items", {{"type", "string"}}}};
    Schema object = object_of<ContactOptions>();
    Schema properties;
    properties["surfaces"] = {
        {"oneOf", {{{"const", "all"}}, parts}},
        {"description", "all, or a list of the parts in contact with each other and themselves"}};
    properties["exclude"] = parts;
    properties["exclude"]["description"] = "parts that are left out";
    Schema pair = object_of<ContactPair>();
    pair["properties"]["parts"] = parts;
    pair["properties"]["parts"]["description"] = "the two parts, or one twice";
    pair["required"].insert(pair["required"].begin(), "parts");
    properties["pairs"] = {
        {"type", "array"},
        {"items", pair},
        {"description", "of two `parts`, or of one named twice: their `friction`, or `touch: false`"}};
    properties.update(object["properties"]);
    object["properties"] = std::move(properties);
    object["required"].insert(object["required"].begin(), "surfaces");
    return object;
  }
};

namespace {

/// Puts a reference to a definition in place of every copy of it; the description of the place stays beside
/// it.
void replace_by_reference(Schema& schema, const Schema& body, const std::string& name) {
  if (schema.is_object()) {
    Schema bare = schema;
    bare.erase("description");
    if (bare == body) {
      Schema reference;
      reference["allOf"] = Schema::array({{{"$ref", "#/definitions/" + name}}});
      if (schema.contains("description")) reference["description"] = schema["description"];
      schema = reference;
      return;
    }
  }
  if (!schema.is_structured()) return;
  for (auto& child : schema) replace_by_reference(child, body, name);
}

/// A type whose schema stands once, under `definitions`, because it is long or used often.
template <class T>
void define(Schema& definitions, const std::string& name, Schema& schema) {
  const Schema body = schema_of<T>(any_number);
  replace_by_reference(schema, body, name);
  replace_by_reference(definitions, body, name);
  definitions[name] = body;
}

Schema whole_schema() {
  Schema schema = object_of<Deck>();
  // Worked in before the deck is read (io/deck/deck_files.hpp).
  schema["properties"]["include"] = {{"type", "array"}, {"items", {{"type", "string"}}}};
  schema["properties"]["include"]["description"] =
      "paths of files with keys of a deck, which are joined with those of this one; relative to this file";
  Schema definitions;
  define<Material>(definitions, "material", schema);
  define<MeshSource>(definitions, "mesh", schema);
  define<SharedYieldTable>(definitions, "yield_table", schema);
  define<Element>(definitions, "element", schema);
  define<BeamSection>(definitions, "section", schema);
  define<NodeSelection>(definitions, "node_selection", schema);
  define<MotionComponents>(definitions, "components", schema);
  define<Curve>(definitions, "curve", schema);
  define<SpaceTimeCurve>(definitions, "space_time_curve", schema);
  Schema whole{
      {"$schema", "http://json-schema.org/draft-07/schema#"},
      {"title", "Deck of Brio"},
      {"description", "What is computed: materials, parts, conditions, loads, contact, time and output"}};
  whole.update(schema);
  whole["definitions"] = std::move(definitions);
  return whole;
}

}  // namespace

std::string deck_schema() { return whole_schema().dump(2) + "\n"; }

}  // namespace brio
