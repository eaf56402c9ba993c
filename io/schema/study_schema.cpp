#include "io/schema/schema_of.hpp"
#include "io/schema/write_schema.hpp"
#include "src/forecast/study.hpp"

namespace brio {

template <>
struct SchemaOf<Settings> : WithoutDefault {
  static Schema make(const Range&) {
    return {{"type", "object"}, {"description", "overrides of the deck, KEY.PATH: VALUE"}};
  }
};

// Names of settings tell of values: dots are welcome.
template <>
struct SchemaOf<NamedSettings> : WithoutDefault {
  static Schema make(const Range&) {
    Schema settings = map_of_names(schema_of<Settings>(any_number));
    settings["propertyNames"]["pattern"] = "^[A-Za-z0-9_.-]+$";
    return settings;
  }
};

std::string study_schema() {
  Schema whole{{"$schema", "http://json-schema.org/draft-07/schema#"},
               {"title", "Study of Brio"},
               {"description", "One deck over a table of settings"}};
  whole.update(object_of<Study>());
  return whole.dump(2) + "\n";
}

}  // namespace brio
