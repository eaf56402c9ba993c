#include "io/mesh_format/read_abaqus.hpp"

#include <algorithm>
#include <map>
#include <set>

#include "io/mesh_file/element_kinds.hpp"
#include "io/mesh_file/line_reader.hpp"
#include "io/mesh_file/mesh_builder.hpp"
#include "io/mesh_format/abaqus_types.hpp"
#include "src/base/index.hpp"

namespace brio {

namespace {

std::string upper_case(std::string_view text) {
  std::string upper(text);
  for (char& c : upper)
    if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
  return upper;
}

std::string_view unquoted(std::string_view text) {
  return text.size() > 1 && text.front() == '"' && text.back() == '"' ? text.substr(1, text.size() - 2)
                                                                      : text;
}

/// Keywords that make nodes or elements of others: without them the mesh would lack some.
const std::set<std::string> generating{
    "NGEN",   "NFILL",  "NCOPY",   "NMAP",     "ELGEN",
    "ELCOPY", "SYSTEM", "INCLUDE", "SUBMODEL", "SYMMETRIC MODEL GENERATION"};
/// Keywords without a meaning for the mesh.
const std::set<std::string> silent_keywords{"HEADING",  "PREPRINT",     "ASSEMBLY", "END ASSEMBLY",
                                            "INSTANCE", "END INSTANCE", "PART",     "END PART"};

/// \param count of ids from first to last by step
void add_range(std::vector<std::int64_t>& ids, std::int64_t first, std::int64_t last, std::int64_t step) {
  for (std::int64_t id = first; id <= last; id += step) ids.push_back(id);
}

class AbaqusReader {
 public:
  AbaqusReader(std::string_view text, const std::string& file) : lines_(text), mesh_(file) {}

  FileMesh read() {
    std::string_view line;
    while (next_line(line)) {
      if (!line.starts_with('*'))
        fail(in_quotes(line) + " stands where a keyword is expected, such as *NODE");
      read_keyword(line);
    }
    resolve_lists();
    if (!skipped_.empty()) {
      std::string list;
      for (const std::string& name : skipped_) list += (list.empty() ? "*" : ", *") + name;
      mesh_.notice("keywords that are not read: " + list);
    }
    return mesh_.finish();
  }

 private:
  /// An entry of a set: an element or node, or the name of another set.
  struct List {
    std::string name;  ///< as it is written first
    std::vector<std::int64_t> ids;
    std::vector<std::string> others;  ///< names in upper case
    std::uint32_t line = 0;
    bool is_resolved = false;
  };
  using Lists = std::map<std::string, List>;  ///< by name in upper case

  [[noreturn]] void fail(const std::string& fault) const { mesh_.fail(lines_.line(), fault); }

  /// Without comments and empty lines.
  bool next_line(std::string_view& line) {
    while (lines_.next(line)) {
      line = trimmed(line);
      if (!line.empty() && !line.starts_with("**")) return true;
    }
    return false;
  }
  /// The next line of data; false before a keyword.
  bool next_data(std::string_view& line) {
    if (!next_line(line)) return false;
    if (!line.starts_with('*')) return true;
    lines_.put_back();
    return false;
  }

  std::int64_t integer(std::string_view field, const char* what) const {
    const auto number = number_in<std::int64_t>(field);
    if (!number) fail(in_quotes(field) + " is not " + what + "; an integer is expected");
    return *number;
  }

  /// \param line the keyword; it goes on where it ends in a comma
  void read_keyword(std::string_view line) {
    std::string whole(line);
    while (whole.back() == ',' && next_line(line)) whole += line;
    split_at_commas(whole, fields_);
    const std::string name = upper_case(trimmed(fields_[0].substr(1)));
    parameters_.clear();
    for (std::size_t i = 1; i < fields_.size(); ++i) {
      const std::size_t equals = fields_[i].find('=');
      parameters_[upper_case(trimmed(fields_[i].substr(0, equals)))] =
          equals == std::string_view::npos ? "" : unquoted(trimmed(fields_[i].substr(equals + 1)));
    }
    if (name == "NODE")
      read_nodes();
    else if (name == "ELEMENT")
      read_elements();
    else if (name == "NSET")
      read_set(node_sets_, "NSET");
    else if (name == "ELSET")
      read_set(element_sets_, "ELSET");
    else if (name == "SURFACE")
      read_surface();
    else
      skip(name);
  }

  void skip(const std::string& name) {
    if (generating.contains(name))
      fail("*" + name +
           " is not followed, and the mesh would lack what it makes; accepted is a file that lists "
           "all nodes and elements");
    if (name == "PART" && ++parts_ > 1)
      fail("a second *PART; accepted is one part a file, or a flat input file without parts");
    std::string_view line;
    while (next_data(line))
      if (name == "INSTANCE")
        fail("an instance is moved; accepted is one in its place (see placement in the deck)");
    if (!silent_keywords.contains(name) && skipped_.size() < 50) skipped_.insert(name.substr(0, 40));
  }

  std::string parameter(const char* name) const {
    const auto found = parameters_.find(name);
    return found == parameters_.end() ? std::string() : found->second;
  }

  void read_nodes() {
    if (const std::string system = upper_case(parameter("SYSTEM")); !system.empty() && system != "R")
      fail("coordinates in the system '" + system + "'; accepted are rectangular ones");
    List* set = parameter("NSET").empty() ? nullptr : &list(node_sets_, parameter("NSET"));
    std::string_view line;
    while (next_data(line)) {
      split_at_commas(line, fields_);
      if (fields_.size() < 3 || fields_.size() > 7)
        fail("a node has " + std::to_string(fields_.size()) +
             " numbers; expected are its number and x, y, z");
      const std::int64_t id = integer(fields_[0], "the number of a node");
      Vector3d position{};
      for (std::size_t i = 1; i < std::min<std::size_t>(fields_.size(), 4); ++i) {
        const auto number = fields_[i].empty() ? 0.0 : fortran_number_in(fields_[i]);
        if (!number) fail(in_quotes(fields_[i]) + " is not a coordinate; a number is expected");
        position[i - 1] = *number;
      }
      mesh_.add_node(id, position, lines_.line());
      if (set != nullptr) set->ids.push_back(id);
    }
  }

  void read_elements() {
    const std::string name = upper_case(parameter("TYPE"));
    if (name.empty()) fail("*ELEMENT has no TYPE; it is required");
    const auto type = abaqus_type(name);
    if (!type) fail("elements of type " + name.substr(0, 40) + " are not known; " + instead_of_others);
    const std::string set = parameter("ELSET");
    const std::size_t block = mesh_.block(set.empty() ? name : list(element_sets_, set).name);
    std::string_view line;
    std::vector<std::int64_t> numbers;
    while (next_data(line)) {
      const std::uint32_t begin = lines_.line();
      numbers.clear();
      const auto wanted = index(type->nodes) + 1;
      while (true) {  // an element goes on on the next line
        split_at_commas(line, fields_);
        for (const std::string_view field : fields_)
          numbers.push_back(integer(field, "a node of an element"));
        if (numbers.size() >= wanted || !next_data(line)) break;
      }
      if (type->shape == ElementShape::line && numbers.size() == wanted + 1)
        numbers.pop_back();  // orientation
      if (numbers.size() != wanted)
        mesh_.fail(begin, "an element of type " + name + " has " + std::to_string(numbers.size()) +
                              " numbers; expected are its number and " + std::to_string(type->nodes) +
                              " nodes");
      const std::span<const std::int64_t> nodes(numbers.data() + 1, wanted - 1);
      const int element = type->shape == ElementShape::refused
                              ? mesh_.add_refused(type->refused, numbers[0], nodes, begin)
                              : mesh_.add_element(type->shape, numbers[0], nodes, begin);
      mesh_.add_to_block(block, element);
    }
  }

  List& list(Lists& lists, const std::string& name) {
    List& found = lists[upper_case(name)];
    if (found.name.empty()) found.name = name, found.line = lines_.line();
    return found;
  }

  void read_set(Lists& lists, const char* key) {
    const std::string name = parameter(key);
    if (name.empty()) fail(std::string("*") + key + " has no name");
    List& set = list(lists, name);
    const bool generates = parameters_.contains("GENERATE");
    if (const std::string elements = parameter("ELSET"); key == std::string("NSET") && !elements.empty())
      nodes_of_elements_.push_back({set.name, upper_case(elements), lines_.line()});
    std::string_view line;
    while (next_data(line)) {
      split_at_commas(line, fields_);
      if (generates)
        generate(set.ids);
      else
        for (const std::string_view field : fields_) {
          if (const auto id = number_in<std::int64_t>(field))
            set.ids.push_back(*id);
          else
            set.others.push_back(upper_case(unquoted(field)));
        }
    }
  }

  void generate(std::vector<std::int64_t>& ids) {
    if (fields_.size() < 2 || fields_.size() > 3) fail("first, last and step of a set are expected");
    const std::int64_t first = integer(fields_[0], "the first of a set"),
                       last = integer(fields_[1], "the last"),
                       step = fields_.size() > 2 ? integer(fields_[2], "the step") : 1;
    const auto most = static_cast<std::int64_t>(mesh_.node_count() + mesh_.element_count());
    if (step < 1 || last < first || first < 0 || (last - first) / step >= most + 1)
      fail("a set from " + std::to_string(first) + " to " + std::to_string(last) + " by " +
           std::to_string(step) +
           "; accepted are a first that is not after the last, and no more than there are nodes and elements "
           "before");
    add_range(ids, first, last, step);
  }

  void read_surface() {
    const std::string name = parameter("NAME");
    if (name.empty()) fail("*SURFACE has no NAME; it is required");
    const bool of_nodes = upper_case(parameter("TYPE")) == "NODE";
    std::string_view line;
    while (next_data(line)) {
      split_at_commas(line, fields_);
      if (fields_.empty()) continue;
      SurfaceEntry entry{name, upper_case(unquoted(fields_[0])), 0, of_nodes, lines_.line()};
      if (!of_nodes) {
        const std::string side = fields_.size() > 1 ? upper_case(fields_[1]) : "";
        if (side == "SPOS")
          entry.side = 1;
        else if (side == "SNEG")
          entry.side = 2;
        else if (side.size() == 2 && side[0] == 'S' && side[1] >= '1' && side[1] <= '6')
          entry.side = side[1] - '0';
        else if (side.size() == 2 && side[0] == 'E' && side[1] >= '1' && side[1] <= '4')
          entry.side = side[1] - '0' + 2;
        else
          fail("a side of surface '" + name + "' is " + in_quotes(side) +
               "; accepted are S1 to S6, SPOS, SNEG, E1 to E4");
      }
      surfaces_.push_back(entry);
    }
  }

  /// All ids of a set with those of the sets that it names.
  const List& resolved(Lists& lists, const std::string& name, std::uint32_t line, int depth = 0) {
    const auto found = lists.find(name);
    if (found == lists.end()) mesh_.fail(line, "no set is named " + in_quotes(name));
    List& list = found->second;
    if (list.is_resolved) return list;
    if (depth > 50) mesh_.fail(list.line, "set '" + list.name + "' contains itself");
    for (const std::string& other : std::vector<std::string>(list.others)) {
      const std::vector<std::int64_t> ids = resolved(lists, other, list.line, depth + 1).ids;
      list.ids.insert(list.ids.end(), ids.begin(), ids.end());
      std::sort(list.ids.begin(), list.ids.end());
      list.ids.erase(std::unique(list.ids.begin(), list.ids.end()), list.ids.end());
    }
    list.is_resolved = true;
    return list;
  }

  void resolve_lists() {
    for (auto& [name, list] : element_sets_) {
      resolved(element_sets_, name, list.line);
      if (!list.ids.empty()) mesh_.add_elements_to_block(list.name, list.ids, list.line);
    }
    for (auto& [name, list] : node_sets_) {
      resolved(node_sets_, name, list.line);
      for (const std::int64_t id : list.ids) mesh_.add_to_set(list.name, id, list.line);
    }
    for (const auto& [set, elements, line] : nodes_of_elements_)
      mesh_.add_nodes_of_block(set, name_of(elements), line);
    for (const SurfaceEntry& entry : surfaces_) resolve(entry);
  }

  std::string name_of(const std::string& element_set) const {
    const auto found = element_sets_.find(element_set);
    return found == element_sets_.end() ? element_set : found->second.name;
  }

  struct SurfaceEntry {
    std::string surface, of;
    int side;
    bool of_nodes;
    std::uint32_t line;
  };
  void resolve(const SurfaceEntry& entry) {
    const auto id = number_in<std::int64_t>(entry.of);
    if (entry.of_nodes) {
      const std::vector<std::int64_t> nodes =
          id ? std::vector<std::int64_t>{*id} : resolved(node_sets_, entry.of, entry.line).ids;
      for (const std::int64_t node : nodes) mesh_.add_to_set(entry.surface, node, entry.line);
    } else if (id) {
      mesh_.add_side(entry.surface, *id, entry.side, abaqus_sides, entry.line);
    } else {
      mesh_.add_sides_of_block(entry.surface, name_of(entry.of), entry.side, abaqus_sides, entry.line);
    }
  }

  struct NodesOfElements {
    std::string set, elements;
    std::uint32_t line;
  };

  LineReader lines_;
  MeshBuilder mesh_;
  std::vector<std::string_view> fields_;
  std::map<std::string, std::string> parameters_;
  Lists node_sets_, element_sets_;
  std::vector<NodesOfElements> nodes_of_elements_;
  std::vector<SurfaceEntry> surfaces_;
  std::set<std::string> skipped_;
  int parts_ = 0;
};

}  // namespace

FileMesh read_abaqus(std::string_view text, const std::string& file) {
  return AbaqusReader(text, file).read();
}

}  // namespace brio
