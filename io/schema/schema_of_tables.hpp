#pragma once
/// Schema of tables, which stand in the deck or in a file.

#include "io/schema/schema_of.hpp"

namespace brio {

/// Rows of two numbers. \param title such as "a list of [time, value]"
inline Schema rows_schema(const std::string& title, const std::string& description) {
  Schema rows{{"type", "array"}, {"items", schema_of<std::array<double, 2>>(any_number)}, {"minItems", 1}};
  rows["title"] = title;
  rows["description"] = description;
  return rows;
}

/// The same from two columns of a file.
inline Schema file_schema() {
  Schema file{{"type", "object"}, {"title", "a file"}};
  file["description"] =
      "rows from columns of a CSV file; a relative path begins at the file in which it stands";
  file["properties"]["file"] = {
      {"type", "string"}, {"pattern", "\\.csv$"}, {"description", "path; may begin with a row of names"}};
  file["properties"]["columns"] = {
      {"type", "array"},
      {"items", {{"type", {"integer", "string"}}}},
      {"minItems", 2},
      {"maxItems", 2},
      {"description", "numbers of two columns, from 1, or their names; default: [1, 2]"}};
  file["required"] = {"file"};
  file["additionalProperties"] = false;
  return file;
}

template <>
struct SchemaOf<Curve> : WithoutDefault {
  static Schema make(const Range&) { return of("an expression of t in quotes", "the same at all times"); }

  static Schema of(const char* expression, const char* constant) {
    Schema number{{"type", {"number", "string"}}, {"title", "a number"}};
    number["description"] = std::string(constant) + ", or " + expression;
    return {
        {"oneOf",
         {number,
          rows_schema("a list of [time, value]",
                      "linear between the times, which grow; constant before the first and after the last"),
          file_schema()}}};
  }
};

template <>
struct SchemaOf<SpaceTimeCurve> : WithoutDefault {
  static Schema make(const Range&) {
    return SchemaOf<Curve>::of("an expression of t, x, y and z in quotes",
                               "the same everywhere at all times");
  }
};

template <>
struct SchemaOf<Parameters> : WithoutDefault {
  static Schema make(const Range&) {
    Schema map = map_of_names(schema_of<double>(any_number));
    map["propertyNames"]["pattern"] = "^[A-Za-z_][A-Za-z0-9_]*$";
    return map;
  }
};

template <>
struct SchemaOf<SharedYieldTable> : WithoutDefault {
  static Schema make(const Range&) {
    const Schema rows = rows_schema("a list of [equivalent plastic strain, yield stress]",
                                    "linear between the rows, whose strains grow from 0 on");
    const Schema table{{"oneOf", {rows, file_schema()}}};
    Schema choice = table;
    Schema beyond = schema_of<BeyondTable>(any_number);
    beyond["default"] = "constant";
    beyond["description"] = "the yield stress beyond the last row";
    Schema entry{{"type", "object"}};
    entry["properties"]["rate"] = schema_of<double>(positive);
    entry["properties"]["rate"]["description"] = "strain rate of the table, 1/time";
    entry["properties"]["table"] = table;
    entry["properties"]["table"]["description"] = "as above";
    entry["required"] = {"rate", "table"};
    entry["additionalProperties"] = false;
    const auto add = [&](const char* key, Schema value, const char* description) {
      Schema object{{"type", "object"}, {"title", key}, {"description", description}};
      object["properties"][key] = std::move(value);
      object["properties"]["beyond"] = beyond;
      object["required"] = {key};
      object["additionalProperties"] = false;
      choice["oneOf"].push_back(std::move(object));
    };
    Schema only = table;
    only["description"] = "one table for all strain rates";
    add("table", only, "one table, and how it goes on");
    Schema rates{{"type", "array"}, {"items", entry}, {"minItems", 2}};
    rates["description"] =
        "{rate, table} each: between two rates linear in the logarithm of the rate, constant below the first "
        "and above the last";
    add("rates", rates, "one table a strain rate");
    return choice;
  }
};

}  // namespace brio
