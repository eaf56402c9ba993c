#include "io/run/initial_state.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>
#include <memory>
#include <unordered_map>

#include "elements/element_state.hpp"
#include "io/files/checksum.hpp"
#include "io/files/file_error.hpp"
#include "io/files/run_record.hpp"
#include "io/restart/deck_difference.hpp"
#include "io/run/earlier_result.hpp"
#include "io/yaml/deck_error.hpp"
#include "src/base/index.hpp"
#include "src/fields/cell_variables.hpp"

namespace brio {

namespace {

namespace fs = std::filesystem;
using NodePointer = std::shared_ptr<const YamlNode>;

fs::path path_of(const StateSource& source, const Deck& deck) {
  return (fs::path(deck.file).parent_path() / source.result).lexically_normal();
}

/// Takes the state of one part out of a result.
class PartStateReader {
 public:
  PartStateReader(const Deck& deck, std::size_t part, const StateSource& source, const EarlierResult& result)
      : part_(deck.parts[part]),
        deck_(deck),
        source_(source),
        result_(result),
        name_(source.part.value_or(part_.name)),
        dump_(result.dump_at(source.time)) {
    state_.part = part;
    state_.place = source.place;
  }

  PartState read(Mesh& mesh) {
    const std::int64_t number = result_.part(name_);
    expect_elements_that_suffice();
    find_cells(mesh, number);
    find_points(mesh, number);
    if (takes(StateField::velocity)) read_velocities();
    if (takes(StateField::state)) read_states();
    if (takes(StateField::stress)) state_.stress = rows<std::array<double, 6>>(cell_field("stress"), cell_);
    if (takes(StateField::plastic_strain)) read_plastic_strain();
    if (takes(StateField::positions)) {
      expect_same_shape();
      mesh.reference = std::move(mesh.position);
      mesh.position = rows<Vector3d>(result_.reader().field("position", dump_), point_);
    }
    return std::move(state_);
  }

 private:
  bool takes(StateField field) const { return source_.takes(field); }

  [[noreturn]] void refuse(const std::string& fault) const { throw DeckError(source_.place + ": " + fault); }

  // What a result does not hold is not made up.
  void expect_elements_that_suffice() const {
    const std::string kind(brio::name_of(part_.element));
    if (result_.element(name_) != kind)
      refuse(fmt::format(
          "part '{}' is of elements '{}', and '{}' is of '{}' in the result; accepted are the same",
          part_.name, kind, name_, result_.element(name_)));
    const Material& law = *material();
    const bool strained = takes(StateField::plastic_strain);
    if (takes(StateField::stress) || strained)
      if (const std::string_view why = why_not_by_stress(part_.element, law, strained); !why.empty())
        refuse(
            fmt::format("part '{}' {}, which stress and plastic strain of a result do not tell; accepted "
                        "is 'state', of a result written with output.fields.variables: [default, state]",
                        part_.name, why));
    if (takes(StateField::positions) && !takes(StateField::state) &&
        traits_of(part_.element).cell == line_cell)
      refuse("positions of beams without the rotations of their ends; 'state' is wanted beside them");
    if (takes(StateField::state)) expect_same_state(law);
  }

  const Material* material() const {
    for (const auto& [name, law] : deck_.materials)
      if (name == part_.material) return &law;
    return nullptr;
  }

  void expect_same_state(const Material& law) const {
    expect_field("state", "output.fields.variables: [default, state]");
    if (result_.record().program != program_checksum_text())
      refuse(
          fmt::format("'state' was written by another build of brio (version {}); it is read by the program "
                      "that wrote it, stress and plastic_strain by all",
                      result_.record().version));
    const std::string model(brio::name_of(law));
    if (result_.model(name_) != model)
      refuse(
          fmt::format("part '{}' is of material model '{}', and of '{}' in the result; accepted are the same",
                      part_.name, model, result_.model(name_)));
    if (const std::string other = difference_in("element"); !other.empty())
      refuse(
          fmt::format("the state of part '{}' is of other elements: {} in the result; accepted are the same "
                      "settings",
                      part_.name, other));
  }

  // Positions and tensors are taken as they are, and masses are those of the mesh. Of mesh files a part may
  // be left, so that the file is another.
  void expect_same_shape() const {
    std::string other = difference_in("placement");
    if (other.empty())
      other = std::holds_alternative<MeshFromFile>(part_.mesh) ? difference_in("mesh", "scale")
                                                               : difference_in("mesh");
    if (!other.empty())
      refuse(
          fmt::format("part '{}' does not lie where it lay: {} in the result; accepted are the same mesh and "
                      "placement",
                      part_.name, other));
  }

  /// Of what both decks say of the part under a key, or under another inside of that; empty where they are
  /// the same.
  std::string difference_in(const std::string& key, const std::string& inside = "") const {
    const NodePointer parts = value_in(parse_yaml(deck_.text, deck_.file), "parts");
    const auto alone = [&](const NodePointer& part) {
      YamlNode map;
      map.kind = YamlNode::Kind::map;
      NodePointer value = value_in(part, key);
      if (!inside.empty()) value = value_in(value, inside);
      if (value) map.entries.push_back({inside.empty() ? key : inside, {}, value});
      return write_yaml(map);
    };
    return deck_difference(alone(result_.deck_of(name_)), alone(value_in(parts, part_.name)));
  }

  void expect_field(const std::string& field, const std::string& wanted) const {
    if (!result_.holds(field))
      refuse(fmt::format("{} holds no '{}'; accepted is a result written with {}", source_.result, field,
                         wanted));
  }

  ReadField cell_field(const std::string& name) const {
    expect_field(name, "it among output.fields.variables");
    return result_.reader().field(name, dump_);
  }

  // Numbers of generated elements begin behind those of other parts. No element is deleted at the start.
  std::int64_t first_id(const Mesh& mesh, std::int64_t number) const {
    if (!mesh.element_id.empty()) return 0;
    const std::vector<std::int64_t> part = result_.reader().cells(0).part;
    const std::vector<double> id = result_.reader().field("element_id", 0).values;
    double first = std::numeric_limits<double>::infinity();
    for (std::size_t c = 0; c < part.size(); ++c)
      if (part[c] == number) first = std::min(first, id[c]);
    return std::isfinite(first) ? static_cast<std::int64_t>(first) : 0;
  }

  void find_cells(const Mesh& mesh, std::int64_t number) {
    cells_ = result_.reader().cells(dump_);
    const std::vector<double> id = result_.reader().field("element_id", dump_).values;
    first_id_ = first_id(mesh, number);
    std::unordered_map<std::int64_t, std::size_t> cell_of;
    for (std::size_t c = 0; c < cells_.part.size(); ++c)
      if (cells_.part[c] == number) cell_of.emplace(static_cast<std::int64_t>(id[c]), c);
    for (std::size_t e = 0; e < mesh.element_count(); ++e) {
      const auto found = cell_of.find(number_of(mesh, e));
      if (found == cell_of.end())
        refuse(
            fmt::format("element {} of part '{}' is not among the {} of '{}' in {} at time {:g}: it was "
                        "deleted, or is of another mesh; accepted are parts whose elements are all there",
                        number_of(mesh, e), part_.name, cell_of.size(), name_, source_.result,
                        result_.reader().times()[dump_]));
      cell_.push_back(found->second);
    }
  }

  /// In the result.
  std::int64_t number_of(const Mesh& mesh, std::size_t element) const {
    return first_id_ + mesh.number_of_element(element);
  }

  // Points of nodes, by the corners of elements.
  void find_points(const Mesh& mesh, std::int64_t number) {
    constexpr std::size_t unknown = index(-1);
    point_.assign(mesh.position.size(), unknown);
    const std::vector<std::int64_t> id = ids_of_points(mesh, number);
    const auto corners = index(mesh.nodes_per_element);
    std::unordered_map<std::size_t, std::size_t> node_of;
    for (std::size_t e = 0; e < cell_.size(); ++e) {
      const auto first = index(cells_.offset[cell_[e]]);
      for (std::size_t corner = 0; corner < corners; ++corner) {
        const auto node = index(mesh.connectivity[e * corners + corner]);
        const auto point = index(cells_.connectivity[first + corner]);
        const bool has_same_id = id.empty() || id[point] < 0 || id[point] == mesh.node_id[node];
        if (point_[node] == unknown) point_[node] = point;
        if (!has_same_id || point_[node] != point || node_of.emplace(point, node).first->second != node)
          refuse_other_nodes(mesh, e);
      }
    }
  }

  // Negative where a point belongs to other parts as well, of which it may have the number; empty without
  // ids.
  std::vector<std::int64_t> ids_of_points(const Mesh& mesh, std::int64_t number) const {
    std::vector<std::int64_t> ids;
    if (mesh.node_id.empty() || !result_.holds("node_id")) return ids;
    for (const double id : result_.reader().field("node_id", dump_).values)
      ids.push_back(static_cast<std::int64_t>(id));
    for (std::size_t c = 0; c < cells_.part.size(); ++c)
      if (cells_.part[c] != number)
        for (auto k = index(cells_.offset[c]); k < index(cells_.offset[c + 1]); ++k)
          ids[index(cells_.connectivity[k])] = -1;
    return ids;
  }

  [[noreturn]] void refuse_other_nodes(const Mesh& mesh, std::size_t element) const {
    refuse(fmt::format(
        "element {} of part '{}' has other nodes in {}, or in another order; accepted is the mesh "
        "of that run, or a part of it",
        number_of(mesh, element), part_.name, source_.result));
  }

  template <class Row>
  static std::vector<Row> rows(const ReadField& field, const std::vector<std::size_t>& wanted) {
    constexpr std::size_t components = Row{}.size();
    std::vector<Row> result(wanted.size());
    for (std::size_t i = 0; i < wanted.size(); ++i)
      std::copy_n(field.values.begin() + static_cast<std::ptrdiff_t>(wanted[i] * components), components,
                  result[i].begin());
    return result;
  }

  void read_velocities() {
    state_.velocity = rows<Vector3d>(result_.reader().field("velocity", dump_), point_);
    if (!has_rotations(part_.element)) return;
    expect_field("angular_velocity", "output.fields.variables: [default, state]");
    state_.angular_velocity = rows<Vector3d>(result_.reader().field("angular_velocity", dump_), point_);
  }

  // How many numbers a row has is known by the block; here they are as the file has them.
  void read_states() {
    const ReadField field = cell_field(std::string(state_variable));
    std::size_t own = field.components;
    const auto is_number = [&](std::size_t cell, std::size_t c) {
      return !std::isnan(field.values[cell * field.components + c]);
    };
    while (own > 0 && !is_number(cell_.front(), own - 1)) --own;
    for (const std::size_t cell : cell_)
      for (std::size_t c = 0; c < own; ++c) {
        if (!is_number(cell, c)) refuse("the result holds no whole state of part '" + name_ + "'");
        state_.element.push_back(field.values[cell * field.components + c]);
      }
  }

  void read_plastic_strain() {
    const ReadField field = cell_field("equivalent_plastic_strain");
    for (const std::size_t cell : cell_) state_.plastic_strain.push_back(field.values[cell]);
  }

  const Part& part_;
  const Deck& deck_;
  const StateSource& source_;
  const EarlierResult& result_;
  std::string name_;  ///< of the part in the result
  std::size_t dump_;
  PartState state_;
  ReadCells cells_;
  std::int64_t first_id_ = 0;              ///< of a generated mesh
  std::vector<std::size_t> cell_, point_;  ///< by element and node of the mesh
};

std::uint64_t checksum_of_file(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::vector<char> block(std::size_t{1} << 22);
  std::vector<std::uint64_t> sums;
  while (file) {
    file.read(block.data(), static_cast<std::streamsize>(block.size()));
    sums.push_back(checksum(block.data(), index(file.gcount())));
  }
  return checksum(sums.data(), sums.size() * sizeof(std::uint64_t));
}

template <class Visit>
void for_each_source(const Deck& deck, const Visit& visit) {
  for (std::size_t i = 0; i < deck.initial_conditions.size(); ++i)
    if (const auto& source = deck.initial_conditions[i].from) visit(i, *source);
}

}  // namespace

bool has_initial_state(const Deck& deck) {
  return std::ranges::any_of(deck.initial_conditions,
                             [](const InitialCondition& one) { return one.from.has_value(); });
}

std::vector<PartState> read_initial_states(const Deck& deck, std::span<Mesh> meshes) {
  std::vector<PartState> states;
  std::map<fs::path, EarlierResult> results;  // each is verified once
  for_each_source(deck, [&](std::size_t condition, const StateSource& source) {
    const std::string& name = deck.initial_conditions[condition].where.set;
    const auto part = index(std::ranges::find(deck.parts, name, &Part::name) - deck.parts.begin());
    for (const PartState& before : states)
      if (before.part == part)
        throw DeckError(source.place + ": part '" + name + "' begins with two states; one is accepted");
    try {
      const fs::path path = path_of(source, deck);
      const EarlierResult& result = results.try_emplace(path, path).first->second;
      states.push_back(PartStateReader(deck, part, source, result).read(meshes[part]));
      states.back().condition = condition;
    } catch (const FileError& fault) {
      throw DeckError(source.place + ": " + fault.what());
    }
  });
  return states;
}

std::vector<std::string> checksums_of_results(const Deck& deck) {
  std::vector<std::string> sums;
  for_each_source(deck, [&](std::size_t, const StateSource& source) {
    sums.push_back(fmt::format("{} {:016x}", source.result, checksum_of_file(path_of(source, deck))));
  });
  return sums;
}

}  // namespace brio
