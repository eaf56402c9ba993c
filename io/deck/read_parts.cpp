#include "io/deck/read_fields.hpp"
#include "io/deck/read_mesh_from_file.hpp"
#include "io/mesh/generate_mesh.hpp"

namespace brio {

namespace {

/// Kinds of element that have as many nodes as the mesh gives them.
std::vector<std::string_view> elements_with_nodes(int count) {
  std::vector<std::string_view> names;
  const auto add = [&]<class... Kind>(const std::variant<Kind...>&) {
    ((Kind::nodes == count || (Kind::nodes == 0 && count > 2) ? names.push_back(Kind::name) : void()), ...);
  };
  add(Element{});
  return names;
}

/// Laws that have the update which the element needs.
std::vector<std::string_view> laws_accepted_by(const Element& element) {
  std::vector<std::string_view> names;
  const auto add = [&]<class... Law>(const std::variant<Law...>&) {
    ((accepts(element, Material(Law{})) ? names.push_back(Law::name) : void()), ...);
  };
  add(Material{});
  return names;
}

[[noreturn]] void refuse_element(const Part& part, const Place& place) {
  if (const auto* file = std::get_if<MeshFromFile>(&part.mesh))
    throw DeckError(place, "the block of the mesh file has elements of " +
                               std::to_string(file->mesh->nodes_per_element) + " nodes, not '" +
                               std::string(name_of(part.element)) + "'; " +
                               accepted_words("", elements_with_nodes(nodes_per_element(part.mesh))));
  const std::string shape(std::visit([](const auto& source) { return source.name; }, part.mesh));
  throw DeckError(place, "the mesh '" + shape + "' cannot be made of '" + std::string(name_of(part.element)) +
                             "' elements; " +
                             accepted_words("", elements_with_nodes(nodes_per_element(part.mesh))));
}

void check_thickness(const Rigid& rigid, const MeshSource& mesh, const Place& place) {
  const bool shells = nodes_per_element(mesh) == 4;
  if (shells && !rigid.thickness)
    throw DeckError(place, "a rigid part of shells has no 'thickness'; it is required");
  if (!shells && rigid.thickness)
    throw DeckError(place, "a rigid part of solids has a 'thickness'; it is accepted with shells only");
}

void check_deletion(const YamlEntry& entry, const Part& part, const Material& material) {
  if (std::holds_alternative<Rigid>(part.element))
    throw DeckError(entry.place, "'deletion' of a rigid part; parts that deform are accepted");
  if (part.deletion->plastic_strain && !has_plastic_strain(material))
    throw DeckError(entry.place, "deletion by plastic_strain, but the material model '" +
                                     std::string(name_of(material)) +
                                     "' has none; a plastic one is accepted");
  for (const auto& [named, criterion] : {std::pair{part.deletion->volume_ratio.has_value(), "volume_ratio"},
                                         std::pair{part.deletion->corner_inverted, "corner_inverted"}})
    if (named && traits_of(part.element).cell != hexahedron_cell)
      throw DeckError(entry.place, "deletion by " + std::string(criterion) + " of elements '" +
                                       std::string(name_of(part.element)) + "'; hexahedra are accepted");
  if (part.deletion->debris_radius && part.deletion->free_nodes == FreeNodes::drop)
    throw DeckError(entry.place,
                    "debris_radius of nodes that are removed; it is accepted with free_nodes: keep");
}

}  // namespace

void read_value(const YamlNode& node, const Slot& slot, Material& material) {
  read_named_choice(node, slot, "model", material);
}

void read_value(const YamlNode& node, const Slot& slot, Element& element) {
  if (!node.is_scalar()) {
    read_named_choice(node, slot, "type", element);
    return;
  }
  // A word alone stands for a map that holds nothing else.
  YamlNode map;
  map.kind = YamlNode::Kind::map;
  map.place = node.place;
  map.entries.push_back({"type", node.place, std::make_shared<const YamlNode>(node)});
  read_named_choice(map, slot, "type", element);
}

void read_value(const YamlNode& node, const Slot& slot, MeshSource& mesh) {
  if (node.is_map() && (node.find("file") != nullptr || node.find("from") != nullptr))
    read_mesh_from_file(node, slot, mesh.emplace<MeshFromFile>());
  else
    read_single_key_choice(node, slot, mesh, {"from"});
}

void read_value(const YamlNode& node, const Slot& slot, BeamSection& section) {
  read_single_key_choice(node, slot, section);
}

void read_value(const YamlNode& node, const Slot& slot, Part& part) {
  read_fields(node, slot, part);
  for (const MeshFile& file : slot.known.deck().meshes)
    if (file.name == part.name)
      throw DeckError(node.place, "part '" + part.name + "' has the name of a mesh file; '" + part.name +
                                      ".SET' would be of either; another name is accepted");
  const Material& material = slot.known.material(*node.find("material")->value);
  const Place& place = node.find("element")->value->place;
  const std::string kind(name_of(part.element));
  if (const auto* rigid = std::get_if<Rigid>(&part.element)) {
    if (nodes_per_element(part.mesh) <= 2) refuse_element(part, place);
    check_thickness(*rigid, part.mesh, place);
    if (part.deletion) check_deletion(*node.find("deletion"), part, material);
    if (const YamlEntry* damping = node.find("damping"))
      throw DeckError(damping->place, "'damping' of a rigid part; parts that deform are accepted");
    return;
  }
  if (nodes_per_element(part.element) != nodes_per_element(part.mesh)) refuse_element(part, place);
  if (part.deletion) check_deletion(*node.find("deletion"), part, material);
  if (!accepts(part.element, material))
    throw DeckError(place, "the element '" + kind + "' cannot use the material model '" +
                               std::string(name_of(material)) + "' of '" + part.material + "'; " +
                               accepted_words("", laws_accepted_by(part.element)));
}

}  // namespace brio
