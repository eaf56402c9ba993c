#include "io/deck/read_fields.hpp"
#include "io/deck/read_systems.hpp"
#include "io/mesh/generate_mesh.hpp"

namespace brio {

namespace {

using SetNames = std::vector<std::string_view> (*)(const MeshSource&);

/// Checks `part.set`, or `part` alone.
void check_set(const YamlNode& node, const Slot& slot, SetNames names_of_sets) {
  const std::size_t dot = node.text.find('.');
  const std::vector<const Part*> parts =
      slot.known.parts_called(node, std::string_view(node.text).substr(0, dot));
  if (dot == std::string::npos) return;
  const std::string_view set = std::string_view(node.text).substr(dot + 1);
  std::vector<std::string_view> names;
  for (const Part* each : parts)
    for (const std::string_view name : names_of_sets(each->mesh))
      if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  const Part& part = *parts.front();
  if (names.empty())
    throw DeckError(node.place, "part '" + part.name +
                                    "' has no sides: it is a line of beams; parts of solids or "
                                    "shells are accepted");
  if (std::find(names.begin(), names.end(), set) == names.end())
    throw DeckError(node.place, "part '" + part.name + "' has no set '" + std::string(set) + "'; " +
                                    accepted_words(set, names));
}

int axis_of(const YamlNode& node, const std::string& word, const ComponentWords& words) {
  const auto found = std::find(words.begin(), words.end(), word);
  if (found == words.end())
    throw DeckError(node.place, "'" + word + "' is not a component of a motion" +
                                    (&words == &cylindrical_words ? " in a cylindrical system; " : "; ") +
                                    accepted_words(word, {words.begin(), words.end()}));
  return static_cast<int>(found - words.begin());
}

/// Prescribed rotations need nodes, or a body, that can turn.
void check_component(const YamlNode& node, const Slot& slot, const NodeSelection& where, int axis) {
  if (axis < 3 || where.set.empty()) return;
  for (const Part* part : slot.known.parts_called(node, where.set.substr(0, where.set.find('.'))))
    if (!has_rotations(part->element) && !std::holds_alternative<Rigid>(part->element))
      throw DeckError(node.place, "the nodes of '" + part->name + "' do not turn: its elements are '" +
                                      std::string(name_of(part->element)) +
                                      "'; accepted: x, y, z, or r, t, z in a cylindrical system");
}

void add_component(const YamlNode& node, const Slot& slot, PrescribedMotion& motion,
                   const ComponentWords& words, const std::string& word, Curve curve) {
  const int axis = axis_of(node, word, words);
  for (const PrescribedComponent& other : motion.components)
    if (other.axis == axis)
      throw DeckError(node.place, "component '" + word + "' is given twice; once is accepted");
  check_component(node, slot, motion.where, axis);
  motion.components.push_back({axis, std::move(curve), to_string(node.place)});
}

/// `part: NAME`, or `set: ...`.
void read_where(const YamlNode& node, const Slot& slot, const std::string& condition, NodeSelection& where) {
  const YamlEntry* part = node.find("part");
  const YamlEntry* set = node.find("set");
  if ((part == nullptr) == (set == nullptr))
    throw DeckError(node.place, condition + " names either 'part' or 'set'");
  if (set != nullptr) {
    read_value(*set->value, Slot{"set", any_number, slot.known}, where);
  } else {
    read_value(*part->value, Slot{"part", any_number, slot.known}, where.set);
    where.place = to_string(part->value->place);
    slot.known.part(*part->value, where.set);
  }
}

void read_motion(const YamlNode& node, const Slot& slot, PrescribedMotion& motion) {
  std::vector<std::string_view> accepted{"name", "part", "set", "system", "fix"};
  for (const auto& [key, kind] : motion_keys) accepted.push_back(key);
  check_keys(node, accepted);
  const YamlEntry* given = nullptr;
  for (const YamlEntry& entry : node.entries) {
    if (entry.key == "set" || entry.key == "part" || entry.key == "name" || entry.key == "system") continue;
    if (given != nullptr)
      throw DeckError(entry.place,
                      "both '" + given->key + "' and '" + entry.key + "'; one is accepted an entry");
    given = &entry;
  }
  read_where(node, slot, "a boundary condition", motion.where);
  if (given == nullptr)
    throw DeckError(node.place, "nothing is prescribed; accepted: fix, displacement, velocity, acceleration");
  const ComponentWords& words = component_words_of(node, slot.known);
  if (const YamlEntry* system = node.find("system")) motion.system = system->value->text;
  if (given->key == "fix") {
    const Slot fix{"fix", any_number, slot.known};
    if (!given->value->is_sequence() || given->value->items.empty())
      refuse(*given->value, fix, "a list of components such as [x, y, z, rx, ry, rz]");
    motion.kind = MotionKind::velocity;
    for (const auto& item : given->value->items)
      add_component(*item, fix, motion, words, item->text, Curve{{{0, 0}}});
    return;
  }
  for (const auto& [key, kind] : motion_keys)
    if (given->key == key) motion.kind = kind;
  const Slot components{given->key, any_number, slot.known};
  if (!given->value->is_map() || given->value->entries.empty())
    refuse(*given->value, components, "a map of components, such as {x: 10} or {x: [[0, 0], [1e-3, 10]]}");
  for (const YamlEntry& entry : given->value->entries) {
    Curve curve;
    read_value(*entry.value, Slot{entry.key, any_number, slot.known}, curve);
    add_component(*entry.value, components, motion, words, entry.key, std::move(curve));
  }
}

std::string name_of_condition(const YamlNode& node, const Slot& slot) {
  const YamlEntry* name = node.find("name");
  if (name == nullptr) return "";
  std::string read;
  read_value(*name->value, Slot{"name", any_number, slot.known}, read);
  if (read.empty() || read.find_first_not_of(name_letters) != std::string::npos)
    throw DeckError(name->value->place, "'" + read +
                                            "' cannot be the name of a boundary condition; accepted " +
                                            "are letters, digits, _ and -");
  return read;
}

void read_part_names(const YamlNode& node, const Slot& slot, std::vector<std::string>& names) {
  if (!node.is_sequence()) refuse(node, slot, "a list of parts");
  for (const auto& item : node.items) {
    std::string& name = names.emplace_back();
    read_value(*item, slot, name);
    slot.known.part(*item, name);
  }
}

}  // namespace

void read_value(const YamlNode& node, const Slot& slot, NodeSelection& selection) {
  selection.place = to_string(node.place);
  if (node.is_scalar()) {
    check_set(node, slot, node_set_names);
    selection.set = node.text;
    return;
  }
  if (!node.is_map()) refuse(node, slot, "part.set, or a region such as {box: {lower: [...], upper: [...]}}");
  read_single_key_choice(node, slot, selection.region, {"part"});
  if (const YamlEntry* part = node.find("part")) {
    read_value(*part->value, Slot{"part", any_number, slot.known}, selection.part);
    slot.known.part(*part->value, selection.part);
  }
}

void read_value(const YamlNode& node, const Slot& slot, Curve& curve) {
  if (node.is_scalar()) {
    if (node.quoted) {
      curve = curve_of(node, slot, Expression::Variables::time);
      return;
    }
    double constant = 0;
    read_value(node, slot, constant);
    curve.points = {{0, constant}};
    return;
  }
  if (!node.is_sequence() || node.items.empty())
    refuse(node, slot, "a number, an expression in quotes or a list of [time, value]");
  curve.points.clear();
  for (const auto& item : node.items) {
    std::array<double, 2>& point = curve.points.emplace_back();
    read_value(*item, slot, point);
    if (curve.points.size() > 1 && point[0] <= curve.points[curve.points.size() - 2][0])
      throw DeckError(item->place, "the times of '" + std::string(slot.key) +
                                       "' do not grow; each must be later than the one before");
  }
}

void read_value(const YamlNode& node, const Slot& slot, SpaceTimeCurve& curve) {
  if (!node.is_scalar() || !node.quoted) {
    read_value(node, slot, static_cast<Curve&>(curve));
    return;
  }
  curve = curve_of(node, slot, Expression::Variables::time_and_position);
  curve.varies_in_space = curve.expression && curve.expression->uses_position();
}

void read_value(const YamlNode& node, const Slot& slot, InitialCondition& condition) {
  read_fields(node, slot, condition, {"part", "set"});
  read_where(node, slot, "an initial condition", condition.where);
  const auto is_given = [&](const char* key) { return node.find(key) != nullptr; };
  const bool moves = is_given("velocity") || is_given("spin") || is_given("radial");
  const YamlEntry* from = node.find("from");
  if (!moves && from == nullptr)
    throw DeckError(node.place, "nothing is given at the start; accepted: velocity, spin, radial, from");
  if (from == nullptr) return;
  if (moves || !is_given("part"))
    throw DeckError(from->place,
                    moves ? "'from' stands beside another velocity; accepted is an entry of its own"
                          : "'from' of a set of nodes; accepted is a part");
  const Part& part = slot.known.part(*node.find("part")->value, condition.where.set);
  if (std::holds_alternative<Rigid>(part.element) || traits_of(part.element).cell == vertex_cell)
    throw DeckError(from->place, "'from' of part '" + part.name + "', which is of elements '" +
                                     std::string(name_of(part.element)) +
                                     "'; accepted are parts of solids, shells and beams");
}

void read_value(const YamlNode& node, const Slot& slot, BoundaryCondition& condition) {
  require_map(node, slot);
  if (const YamlEntry* wall = node.find(RigidWall::name)) {
    check_keys(node, {"name", RigidWall::name});
    auto& read = condition.emplace<RigidWall>();
    read_value(*wall->value, Slot{RigidWall::name, any_number, slot.known}, read);
    read.label = name_of_condition(node, slot);
    return;
  }
  auto& motion = condition.emplace<PrescribedMotion>();
  read_motion(node, slot, motion);
  motion.name = name_of_condition(node, slot);
}

void read_value(const YamlNode& node, const Slot& slot, Load& load) {
  require_map(node, slot);
  for (const std::string_view name : names_of(load)) {
    if (node.find(name) == nullptr) continue;
    choose_alternative(load, name, [&](auto& chosen) { read_fields(node, slot, chosen); });
    if (const YamlEntry* sides = node.find("side_set")) check_set(*sides->value, slot, side_set_names);
    if (const YamlEntry* system = node.find("system")) check_system(*system->value, slot.known, load);
    return;
  }
  throw DeckError(node.place, "nothing is said about the load; " + accepted_words("", names_of(load)));
}

namespace {

/// A point whose nearest node is meant, of one part where it is named.
template <class AtNode>
void read_at_node(const YamlNode& node, const Slot& slot, AtNode& value) {
  read_fields(node, slot, value);
  if (value.part) slot.known.part(*node.find("part")->value, *value.part);
}

}  // namespace

void read_value(const YamlNode& node, const Slot& slot, SpringEnd& end) { read_at_node(node, slot, end); }
void read_value(const YamlNode& node, const Slot& slot, Probe& probe) { read_at_node(node, slot, probe); }

namespace {

bool is_rigid(const Part& part) { return std::holds_alternative<Rigid>(part.element); }

void read_connection(const YamlNode& node, const Slot& slot, Merge& merge) {
  read_fields(node, slot, merge);
  const YamlNode& parts = *node.find("merge")->value;
  for (std::size_t i = 0; i < parts.items.size(); ++i) {
    const Part& part = slot.known.part(*parts.items[i], merge.parts[i]);
    if (!traits_of(part.element).shares_nodes && !is_rigid(part))
      throw DeckError(parts.items[i]->place,
                      "part '" + part.name + "' is of elements '" + std::string(name_of(part.element)) +
                          "', which share no nodes; accepted are parts of solids, shells and beams, and "
                          "one rigid part");
  }
  if (merge.parts.size() != 2 || merge.parts[0] == merge.parts[1])
    throw DeckError(parts.place, "'merge' takes two different parts");
  if (is_rigid(slot.known.part(parts, merge.parts[0])) && is_rigid(slot.known.part(parts, merge.parts[1])))
    throw DeckError(parts.place, "both parts of 'merge' are rigid; accepted is one");
}

void read_connection(const YamlNode& node, const Slot& slot, TieToSurface& tie) {
  read_fields(node, slot, tie);
  const YamlNode& names = *node.find("tie")->value;
  if (tie.names.size() != 2)
    throw DeckError(names.place,
                    "'tie' takes a part or a set, and the part whose faces its nodes are tied to");
  const YamlNode& slave = *names.items[0];
  check_set(slave, slot, node_set_names);
  // Of a mesh file that is several parts.
  const std::vector<const Part*> tied =
      slot.known.parts_called(slave, std::string_view(slave.text).substr(0, slave.text.find('.')));
  for (const Part* part : tied)
    if (is_rigid(*part))
      throw DeckError(slave.place,
                      "part '" + part->name +
                          "' is rigid; nodes of parts that deform can be tied to it, as the second of "
                          "'tie'");
  const Part& main_surface = slot.known.part(*names.items[1], tie.names[1]);
  if (is_rigid(main_surface) && tie.failure)
    throw DeckError(node.find("failure")->place,
                    "'failure' of a tie to a rigid part; ties to parts that deform are accepted");
  if (!is_rigid(main_surface) && !has_faces(traits_of(main_surface.element).cell))
    throw DeckError(names.items[1]->place,
                    "part '" + main_surface.name + "' is of elements '" +
                        std::string(name_of(main_surface.element)) +
                        "', which have no faces; accepted are parts of solids and shells");
  if (tied.size() == 1 && tied.front() == &main_surface)
    throw DeckError(names.place, "'tie' takes two different parts");
}

}  // namespace

void read_value(const YamlNode& node, const Slot& slot, Connection& connection) {
  require_map(node, slot);
  for (const std::string_view name : names_of(connection)) {
    if (node.find(name) == nullptr) continue;
    choose_alternative(connection, name, [&](auto& chosen) { read_connection(node, slot, chosen); });
    return;
  }
  throw DeckError(node.place,
                  "nothing is said about the connection; " + accepted_words("", names_of(connection)));
}

void read_value(const YamlNode& node, const Slot& slot, ContactPair& pair) {
  read_fields(node, slot, pair, {"parts"});
  const YamlEntry* parts = node.find("parts");
  if (parts == nullptr)
    throw DeckError(node.place, "an entry of 'pairs' has no 'parts'; two parts are accepted");
  read_part_names(*parts->value, Slot{"parts", any_number, slot.known}, pair.parts);
  if (pair.parts.size() != 2)
    throw DeckError(parts->value->place, "'parts' of a pair names " + std::to_string(pair.parts.size()) +
                                             "; two are accepted, or one twice");
}

void read_value(const YamlNode& node, const Slot& slot, ContactSection& contact) {
  contact.place = to_string(node.place);
  read_fields(node, slot, contact.options, {"surfaces", "exclude", "pairs"});
  const YamlEntry* surfaces = node.find("surfaces");
  if (surfaces == nullptr)
    throw DeckError(node.place, "'contact' has no 'surfaces'; accepted: all, or a list of parts");
  if (!surfaces->value->is_scalar() || surfaces->value->text != "all")
    read_part_names(*surfaces->value, Slot{"surfaces", any_number, slot.known}, contact.surfaces);
  if (const YamlEntry* exclude = node.find("exclude"))
    read_part_names(*exclude->value, Slot{"exclude", any_number, slot.known}, contact.exclude);
  if (const YamlEntry* pairs = node.find("pairs"))
    read_value(*pairs->value, Slot{"pairs", any_number, slot.known}, contact.pairs);
}

// ---- forces of the history

namespace {

bool is_all(const YamlNode& node) { return node.is_scalar() && node.text == "all"; }

std::string_view name_of(const BoundaryCondition& condition) {
  const auto* wall = std::get_if<RigidWall>(&condition);
  return wall != nullptr ? wall->label : std::get<PrescribedMotion>(condition).name;
}

}  // namespace

void KnownNames::expect_condition(const YamlNode& node, std::string_view name) const {
  std::vector<std::string_view> names;
  for (const BoundaryCondition& condition : deck_.boundary_conditions)
    if (!name_of(condition).empty()) names.push_back(name_of(condition));
  const auto count = std::ranges::count(names, name);
  expect_complete(count > 0);
  if (count == 0)
    throw DeckError(node.place, "no boundary condition is called '" + std::string(name) + "'; " +
                                    (names.empty() ? "none has a name" : accepted_words(name, names)));
  if (count > 1)
    throw DeckError(node.place, "several boundary conditions are called '" + std::string(name) +
                                    "'; a name of its own is expected");
}

void read_value(const YamlNode& node, const Slot& slot, ReactionColumns& columns) {
  columns.all = is_all(node);
  if (columns.all) return;
  if (!node.is_sequence()) refuse(node, slot, "all, or a list of names of boundary conditions");
  for (const auto& item : node.items) {
    read_value(*item, slot, columns.names.emplace_back());
    slot.known.expect_condition(*item, item->text);
  }
}

void read_value(const YamlNode& node, const Slot& slot, ContactColumns& columns) {
  columns.place = to_string(node.place);
  columns.all = is_all(node);
  if (columns.all) return;
  const std::string wanted = "all, or a list of pairs of parts, such as [[plate, can], [can, can]]";
  if (!node.is_sequence()) refuse(node, slot, wanted);
  for (const auto& item : node.items) {
    if (!item->is_sequence() || item->items.size() != 2) refuse(*item, slot, wanted);
    std::array<std::string, 2>& pair = columns.pairs.emplace_back();
    for (std::size_t k = 0; k < 2; ++k) {
      read_value(*item->items[k], slot, pair[k]);
      slot.known.part(*item->items[k], pair[k]);
    }
  }
}

void read_value(const YamlNode& node, const Slot& slot, ForceSection& section) {
  read_fields(node, slot, section);
  slot.known.part(*node.find("part")->value, section.part);
}

}  // namespace brio
