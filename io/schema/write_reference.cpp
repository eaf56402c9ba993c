#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "io/schema/write_schema.hpp"
#include "src/base/index.hpp"

namespace brio {

namespace {

using Schema = nlohmann::ordered_json;

constexpr std::string_view study_introduction = R"(# What a study may say

<!-- Written by `brio schema --study --markdown`; do not edit. -->

A study is a YAML file: `brio study STUDY` runs one deck over a table of settings and tells what each costs and how far off it
is. Its keys and what they take are listed here. `brio schema --study` prints the same as JSON schema.

- Runs are called `default` (the deck as it is), `KNOB.SETTING`, and, of combinations, `KNOB.SETTING+KNOB.SETTING`.
- A setting is a map of overrides of the deck, as `--set` takes them: `{time.step_scale: 0.6, contact.friction: 0}`.
- What has been run with the same program, deck and settings is not run again.
)";

constexpr std::string_view introduction = R"md(# What a deck may say

<!-- Written by `brio schema --markdown`; do not edit. -->

A deck is a YAML file. Its keys and what they take are listed here; whatever is not listed is refused, with its place and
what was probably meant. `brio schema` prints the same as JSON schema, for completion and checking in editors.

- Numbers are written as `30e6`, `1e-3`, `.5`, `+1`; infinities and not-a-number are refused.
- An expression in quotes may stand for any number, `velocity: [0, 0, "-2*v"]`. It knows the names of `parameters`, `pi`,
  `+ - * / ^`, comparisons and `A ? B : C`, `sin cos tan asin acos atan atan2 sinh cosh tanh exp log log10 sqrt abs floor
  ceil round min max mod`, and `smooth_step(x, a, b)`, which rises from 0 at a to 1 at b with continuous second derivative.
- For a [curve](#curve) it may depend on the time `t`, `"p0*exp(-t/t0)"`; for a pressure on `x`, `y`, `z` as well, the centre
  of each side.
- Tables may stand in a CSV file, `{file: steel.csv}`: columns apart by commas, semicolons or blanks, comments behind `#`. The
  deck in the results holds their rows, and those of included files.
- Units are those of the author: any consistent set. Nothing is converted.
- Names of parts and materials consist of letters, digits, `_` and `-`.
- YAML anchors, aliases and merge keys (`<<`) work; a key that stands twice is refused.
- `brio run DECK --set KEY.PATH=VALUE` replaces any value, for example `--set time.end=1e-3` or
  `--set boundary_conditions.0.fix=[x]` (entries of lists are counted from 0). The value is YAML and is checked like the
  deck.
)md";

std::string code(const std::string& text) { return fmt::format("`{}`", text); }
std::string value_text(const Schema& value) {
  return value.is_string() ? value.get<std::string>() : value.dump();
}

/// A heading's name as the links of Markdown write it.
std::string anchor(std::string heading) {
  std::string link;
  for (const char c : heading) {
    if (c == ' ') link += '-';
    if ((c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_' || c == '-') link += c;
  }
  return link;
}

std::string limits(const Schema& schema) {
  std::string text;
  const auto add = [&](const char* key, const char* sign) {
    if (!schema.contains(key)) return;
    text += fmt::format("{}{} {}", text.empty() ? " " : " and ", sign, schema[key].get<double>());
  };
  add("exclusiveMinimum", ">");
  add("minimum", ">=");
  add("exclusiveMaximum", "<");
  add("maximum", "<=");
  return text;
}

std::string plural(const std::string& noun) {
  const std::size_t end = noun.find(' ');
  if (end == std::string::npos) return noun + "s";
  return noun.substr(0, end) + "s" + noun.substr(end);
}

/// Of a number, which may be an expression as well: number.
std::string type_of(const Schema& schema) {
  const Schema types = schema.value("type", Schema(""));
  return types.is_array() ? types[0].get<std::string>() : types.get<std::string>();
}

/// What a value is, in a cell of a table.
std::string kind_of(const Schema& schema) {
  if (schema.contains("allOf") && schema["allOf"][0].contains("$ref")) {
    const auto reference = schema["allOf"][0]["$ref"].get<std::string>();
    const std::string name = reference.substr(reference.rfind('/') + 1);
    return fmt::format("[{}](#{})", name, anchor(name));
  }
  if (schema.contains("const")) return code(value_text(schema["const"]));
  if (schema.contains("enum")) {
    std::string words;
    for (const auto& word : schema["enum"]) words += (words.empty() ? "" : ", ") + code(value_text(word));
    return words;
  }
  if (schema.contains("oneOf")) {
    std::string kinds;
    for (const auto& one : schema["oneOf"]) kinds += (kinds.empty() ? "" : " or ") + kind_of(one);
    return kinds;
  }
  const std::string type = type_of(schema);
  if (type == "array") {
    const std::string each = kind_of(schema["items"]);
    if (schema.contains("maxItems")) return fmt::format("{} {}", schema["maxItems"].get<int>(), plural(each));
    return each == "map" ? "list of maps" : "list: " + each;
  }
  if (type == "object") return schema.contains("properties") ? "map" : "map of names";
  if (type == "string") return "text";
  if (type == "boolean") return "`true` or `false`";
  return type + limits(schema);
}

void write_table(const Schema& object, std::string& out) {
  if (object["properties"].empty()) return;
  out += "\n| key | takes | default | meaning |\n| --- | --- | --- | --- |\n";
  for (const auto& [key, property] : object["properties"].items()) {
    bool required = false;
    for (const auto& one : object.value("required", Schema::array())) required = required || one == key;
    const std::string fallback = required                       ? "required"
                                 : property.contains("default") ? code(value_text(property["default"]))
                                                                : "";
    out += fmt::format("| `{}` | {} | {} | {} |\n", key, kind_of(property), fallback,
                       property.value("description", ""));
  }
}

void write_schema(const std::string& path, const Schema& schema, int level, std::string& out);

/// Tables of the maps that stand inside a map.
void write_inner(const std::string& path, const Schema& object, int level, std::string& out) {
  for (const auto& [key, property] : object["properties"].items()) {
    if (type_of(property) != "object") continue;
    const std::string inner = path.empty() ? key : path + "." + key;
    if (property.contains("properties")) write_schema(inner, property, level, out);
    const bool is_named =
        property.contains("additionalProperties") && property["additionalProperties"].is_object();
    if (is_named && property["additionalProperties"].contains("properties"))
      write_schema(inner + ".NAME", property["additionalProperties"], level, out);
  }
}

/// A section of the reference, and below it those of what stands inside.
void write_schema(const std::string& path, const Schema& schema, int level, std::string& out) {
  const auto heading = [&](const std::string& text) {
    out += fmt::format("\n{} {}\n", std::string(index(level), '#'), text);
  };
  if (schema.contains("properties")) {
    heading(path);
    if (schema.contains("description"))
      out += fmt::format("\n{}\n", schema["description"].get<std::string>());
    write_table(schema, out);
    write_inner(path, schema, level + 1, out);
    return;
  }
  heading(path);
  if (schema.contains("description")) out += fmt::format("\n{}\n", schema["description"].get<std::string>());
  if (!schema.contains("oneOf")) {
    out += "\nTakes: " + kind_of(schema) + ".\n";
    return;
  }
  for (const Schema& one : schema["oneOf"]) {
    const std::string title = one.value("title", "");
    if (!one.contains("properties")) {
      out += fmt::format("\nTakes {} ({}): {}.\n", title, kind_of(one), one.value("description", ""));
      continue;
    }
    Schema shown = one;
    // `{box: {...}}`: the table is that of what stands behind the word.
    const bool single_key =
        one["properties"].contains(title) && one["properties"][title].contains("properties");
    if (single_key) {
      shown = one["properties"][title];
      for (const auto& [key, property] : one["properties"].items())
        if (key != title)
          out += fmt::format("\nBeside `{}`: `{}`, {}.\n", title, key, property.value("description", ""));
      if (one.contains("description")) shown["description"] = one["description"];
    }
    write_schema(path + ": " + title, shown, level + 1, out);
  }
}

}  // namespace

namespace {

std::string reference(std::string_view beginning, const std::string& title, const std::string& schema_text) {
  const Schema schema = Schema::parse(schema_text);
  std::string out(beginning);
  out += "\n## " + title + "\n";
  write_table(schema, out);
  for (const auto& [key, property] : schema["properties"].items()) {
    if (type_of(property) == "object" && property.contains("properties")) write_schema(key, property, 2, out);
    for (const char* of_many : {"additionalProperties", "items"}) {
      if (!property.contains(of_many) || !property[of_many].is_object()) continue;
      const Schema& one = property[of_many];
      if (!one.contains("properties") && !one.contains("oneOf")) continue;
      const bool named = std::string_view(of_many) == "additionalProperties";
      write_schema(key + (named ? ".NAME" : ""), one, 2, out);
    }
  }
  if (schema.contains("definitions"))
    for (const auto& [name, definition] : schema["definitions"].items())
      write_schema(name, definition, 2, out);
  return out;
}

}  // namespace

std::string deck_reference() { return reference(introduction, "The keys of a deck", deck_schema()); }

std::string study_reference() { return reference(study_introduction, "The keys of a study", study_schema()); }

}  // namespace brio
