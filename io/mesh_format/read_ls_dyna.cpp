#include "io/mesh_format/read_ls_dyna.hpp"

#include <algorithm>
#include <map>
#include <set>

#include "io/mesh_file/element_kinds.hpp"
#include "io/mesh_file/line_reader.hpp"
#include "io/mesh_file/mesh_builder.hpp"
#include "src/base/index.hpp"

namespace brio {

namespace {

/// Keywords that bring nodes or elements from elsewhere: without them the mesh would lack some.
constexpr std::string_view bringing[] = {"INCLUDE", "NODE_TRANSFORM", "NODE_MERGE", "ELEMENT_GENERATE_"};
constexpr std::string_view silent_cards[] = {"KEYWORD", "END", "TITLE"};

/// A card: its fields by width, or between commas.
class Card {
 public:
  void read(std::string_view line, const std::vector<int>& widths) {
    if (line.find(',') != std::string_view::npos) {
      split_at_commas(line, fields_);
      return;
    }
    fields_.clear();
    for (const int width : widths) {
      if (line.empty()) break;
      const auto taken = std::min(line.size(), index(width));
      fields_.push_back(trimmed(line.substr(0, taken)));
      line.remove_prefix(taken);
    }
    while (!fields_.empty() && fields_.back().empty()) fields_.pop_back();
  }
  std::size_t size() const { return fields_.size(); }
  /// Empty beyond the last.
  std::string_view operator[](std::size_t i) const {
    return i < fields_.size() ? fields_[i] : std::string_view();
  }

 private:
  std::vector<std::string_view> fields_;
};

const std::vector<int> node_widths{8, 16, 16, 16, 8, 8}, set_widths{10, 10, 10, 10, 10, 10, 10, 10},
    element_widths(10, 8), part_widths(8, 10);

class DynaReader {
 public:
  DynaReader(std::string_view text, const std::string& file) : lines_(text), mesh_(file) {
    mesh_.number_by_dimension();
  }

  FileMesh read() {
    std::string_view line;
    while (next_line(line)) {
      if (!line.starts_with('*'))
        fail(in_quotes(line) + " stands where a keyword is expected, such as *NODE");
      std::string keyword(trimmed(line.substr(1)));
      for (char& c : keyword)
        if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
      if (keyword == "END") break;
      read_keyword(keyword);
    }
    make_blocks();
    if (!skipped_.empty()) {
      std::string list;
      for (const std::string& name : skipped_) list += (list.empty() ? "*" : ", *") + name;
      mesh_.notice("keywords that are not read: " + list);
    }
    return mesh_.finish();
  }

 private:
  [[noreturn]] void fail(const std::string& fault) const { mesh_.fail(lines_.line(), fault); }

  bool next_line(std::string_view& line) {
    while (lines_.next(line))
      if (!line.starts_with('$') && !trimmed(line).empty()) return true;
    return false;
  }
  /// The next card; false before a keyword.
  bool next_card(std::string_view& line) {
    if (!next_line(line)) return false;
    if (!line.starts_with('*')) return true;
    lines_.put_back();
    return false;
  }
  void expect_card(std::string_view& line, const char* what) {
    if (!next_card(line)) fail(std::string(what) + " is missing");
  }

  std::int64_t integer(std::string_view field, const char* what) const {
    const auto number = number_in<std::int64_t>(field);
    if (!number) fail(in_quotes(field) + " is not " + what + "; an integer is expected");
    return *number;
  }
  /// Empty fields are 0.
  std::int64_t integer_or_0(std::string_view field, const char* what) const {
    return field.empty() ? 0 : integer(field, what);
  }

  void read_keyword(const std::string& name) {
    if (name.ends_with('+') || name.ends_with('%') || name.find("LONG=") != std::string::npos)
      fail("*" + name.substr(0, 40) +
           " asks for long columns; accepted are the standard ones of 8 and 16, or commas");
    if (name == "NODE")
      read_nodes();
    else if (name == "ELEMENT_SOLID")
      read_solids();
    else if (name == "ELEMENT_SHELL")
      read_shells();
    else if (name == "ELEMENT_BEAM")
      read_beams();
    else if (name == "ELEMENT_SPH")
      read_particles();
    else if (name == "PART")
      read_parts();
    else if (name.starts_with("SET_NODE") && !name.starts_with("SET_NODE_ADD"))
      read_node_set(name);
    else if (name == "SET_SEGMENT" || name == "SET_SEGMENT_TITLE")
      read_segments(name);
    else
      skip(name);
  }

  void skip(const std::string& name) {
    for (const std::string_view word : bringing)
      if (name.starts_with(word))
        fail("*" + name.substr(0, 40) +
             " is not followed, and the mesh would lack what it brings; accepted is one "
             "file that lists all nodes and elements");
    if (name.starts_with("ELEMENT_SOLID") || name.starts_with("ELEMENT_SHELL") ||
        name.starts_with("ELEMENT_BEAM") || name.starts_with("ELEMENT_TSHELL"))
      fail("*" + name.substr(0, 40) +
           " is not read; accepted are *ELEMENT_SOLID, _SHELL, _BEAM and _SPH without "
           "options");
    std::string_view line;
    while (next_card(line)) continue;
    const bool is_silent = std::any_of(std::begin(silent_cards), std::end(silent_cards),
                                       [&](std::string_view word) { return name.starts_with(word); });
    if (!is_silent && skipped_.size() < 50) skipped_.insert(name.substr(0, 40));
  }

  void read_nodes() {
    std::string_view line;
    while (next_card(line)) {
      card_.read(line, node_widths);
      const std::int64_t id = integer(card_[0], "the number of a node");
      Vector3d position{};
      for (std::size_t k = 0; k < 3; ++k) {
        if (card_[k + 1].empty()) continue;
        const auto number = fortran_number_in(card_[k + 1]);
        if (!number)
          fail(in_quotes(card_[k + 1]) + " is not a coordinate; a number is expected, in columns of 16");
        position[k] = *number;
      }
      mesh_.add_node(id, position, lines_.line());
      if (integer_or_0(card_[4], "a constraint") != 0 || integer_or_0(card_[5], "a constraint") != 0)
        skipped_.insert("NODE (its constraints TC, RC)");
    }
  }

  void add(std::int64_t part, int element) { elements_of_part_[part].push_back(element); }

  std::span<const std::int64_t> nodes_of_card(std::size_t first, std::size_t count) {
    for (std::size_t k = 0; k < count; ++k)
      nodes_[k] = integer_or_0(card_[first + k], "a node of an element");
    return {nodes_.data(), count};
  }

  void read_solids() {
    std::string_view line;
    while (next_card(line)) {
      const std::uint32_t begin = lines_.line();
      card_.read(line, element_widths);
      const std::int64_t id = integer(card_[0], "the number of an element"),
                         part = integer(card_[1], "a part");
      std::size_t first = 2;
      if (card_.size() <= 2) {  // nodes stand on a card of their own, of up to ten
        expect_card(line, "the card of the nodes of a solid");
        card_.read(line, element_widths);
        first = 0;
      }
      const auto n = nodes_of_card(first, 8);
      if (first == 0 && (integer_or_0(card_[8], "a node") != 0 || integer_or_0(card_[9], "a node") != 0)) {
        add(part, mesh_.add_refused({"tetrahedra with 10 nodes", 3, instead_of_second_order}, id, n.first(4),
                                    begin));
        continue;
      }
      add(part, add_solid(id, n, begin));
    }
  }

  /// Solids of fewer nodes repeat them.
  int add_solid(std::int64_t id, std::span<const std::int64_t> n, std::uint32_t line) {
    const auto same_from = [&](std::size_t first) {
      return std::all_of(n.begin() + static_cast<std::ptrdiff_t>(first), n.end(),
                         [&](std::int64_t node) { return node == n[first] || node == 0; });
    };
    if (same_from(3)) return mesh_.add_refused(tetrahedra(), id, n.first(4), line);
    if (same_from(4)) return mesh_.add_refused(pyramids(), id, n.first(5), line);
    const bool blank = n[6] == 0 && n[7] == 0;  // 6 nodes: n1 to n4 a side, n5 and n6 the edge
    const bool is_wedge = blank || (n[4] == n[5] && n[6] == n[7]);
    if (!is_wedge) return mesh_.add_element(ElementShape::hexahedron, id, n, line);
    const std::int64_t edge = blank ? n[5] : n[6];
    const std::array<std::int64_t, 6> wedge{n[0], n[4], n[1], n[3], edge, n[2]};
    return mesh_.add_element(ElementShape::wedge, id, wedge, line);
  }

  void read_shells() {
    std::string_view line;
    while (next_card(line)) {
      card_.read(line, element_widths);
      const std::int64_t id = integer(card_[0], "the number of an element"),
                         part = integer(card_[1], "a part");
      const auto n = nodes_of_card(2, 4);
      const auto is_set = [&](std::size_t k) { return integer_or_0(card_[k], "a node") != 0; };
      if (is_set(6) || is_set(7) || is_set(8) || is_set(9)) {
        add(part, mesh_.add_refused({"quadrilaterals with 8 nodes", 2, instead_of_second_order}, id, n,
                                    lines_.line()));
        continue;
      }
      const bool is_triangle = n[3] == n[2] || n[3] == 0;
      add(part, mesh_.add_element(is_triangle ? ElementShape::triangle : ElementShape::quadrilateral, id,
                                  n.first(is_triangle ? 3 : 4), lines_.line()));
    }
  }

  void read_beams() {
    std::string_view line;
    while (next_card(line)) {
      card_.read(line, element_widths);
      const std::int64_t id = integer(card_[0], "the number of an element"),
                         part = integer(card_[1], "a part");
      add(part, mesh_.add_element(ElementShape::line, id, nodes_of_card(2, 2), lines_.line()));
    }
  }

  /// A negative mass is a volume.
  void read_particles() {
    std::string_view line;
    while (next_card(line)) {
      card_.read(line, {8, 8, 16, 8});
      const std::int64_t node = integer(card_[0], "the node of a particle"),
                         part = integer(card_[1], "a part");
      const auto mass = card_[2].empty() ? 0.0 : fortran_number_in(card_[2]);
      if (!mass) fail(in_quotes(card_[2]) + " is not the mass of a particle; a number is expected");
      const int element = mesh_.add_element(ElementShape::point, node, {&node, 1}, lines_.line());
      if (*mass < 0) mesh_.set_volume(element, -*mass);
      add(part, element);
    }
  }

  void read_parts() {
    std::string_view line;
    while (next_card(line)) {
      const std::string title(trimmed(line));
      expect_card(line, "the card of a part");
      card_.read(line, set_widths);
      const std::int64_t part = integer(card_[0], "the number of a part");
      if (!title.empty()) title_of_part_[part] = title;
    }
  }

  void make_blocks() {
    std::map<std::string, int> uses;
    for (const auto& [part, title] : title_of_part_)
      if (elements_of_part_.contains(part)) ++uses[title];
    for (const auto& [part, elements] : elements_of_part_) {
      const auto title = title_of_part_.find(part);
      const bool is_named = title != title_of_part_.end() && uses[title->second] == 1;
      const std::size_t block = mesh_.block(is_named ? title->second : std::to_string(part), part);
      for (const int element : elements) mesh_.add_to_block(block, element);
    }
  }

  /// The name of a set: its title, else its kind and number, since each kind has numbers of its own.
  std::string name_of_set(const std::string& keyword, const char* kind) {
    std::string_view line;
    std::string title;
    if (keyword.ends_with("_TITLE")) {
      expect_card(line, "the title of a set");
      title = trimmed(line);
    }
    expect_card(line, "the card of a set");
    card_.read(line, set_widths);
    const std::int64_t number = integer(card_[0], "the number of a set");
    return title.empty() ? kind + std::to_string(number) : title;
  }

  void read_node_set(const std::string& keyword) {
    std::string kind = keyword.ends_with("_TITLE") ? keyword.substr(0, keyword.size() - 6) : keyword;
    if (kind != "SET_NODE" && kind != "SET_NODE_LIST" && kind != "SET_NODE_LIST_GENERATE")
      return skip(keyword);
    const std::string name = name_of_set(keyword, "node_set_");
    std::string_view line;
    while (next_card(line)) {
      card_.read(line, set_widths);
      for (std::size_t k = 0; k < std::min<std::size_t>(card_.size(), 8); ++k) {
        const std::int64_t node = integer_or_0(card_[k], "a node of a set");
        if (node == 0) continue;
        if (kind != "SET_NODE_LIST_GENERATE") {
          mesh_.add_to_set(name, node, lines_.line());
          continue;
        }
        const std::int64_t last = integer(card_[++k], "the last of a range");
        if (last < node) fail("a range ends before it begins");
        mesh_.add_range_to_set(name, node, last);
      }
    }
  }

  void read_segments(const std::string& keyword) {
    const std::string name = name_of_set(keyword, "side_set_");
    std::string_view line;
    while (next_card(line)) {
      card_.read(line, set_widths);
      const auto n = nodes_of_card(0, 4);
      const bool is_triangle = n[3] == n[2] || n[3] == 0;
      mesh_.add_face(name, n.first(is_triangle ? 3 : 4), lines_.line());
    }
  }

  LineReader lines_;
  MeshBuilder mesh_;
  Card card_;
  std::array<std::int64_t, 10> nodes_{};
  std::map<std::int64_t, std::vector<int>> elements_of_part_;
  std::map<std::int64_t, std::string> title_of_part_;
  std::set<std::string> skipped_;
};

}  // namespace

FileMesh read_ls_dyna(std::string_view text, const std::string& file) {
  return DynaReader(text, file).read();
}

}  // namespace brio
