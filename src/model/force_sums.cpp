#include "src/model/force_sums.hpp"

#include <algorithm>
#include <cmath>

#include "src/base/breakdown.hpp"
#include "src/base/index.hpp"
#include "src/deck/part_index.hpp"
#include "src/model/model.hpp"
#include "src/model/part_shape.hpp"

namespace brio {

namespace {

constexpr std::array<const char*, 3> axes{"_x", "_y", "_z"};
constexpr std::array<const char*, 3> moment_axes{"_mx", "_my", "_mz"};

/// Pairs of parts that `all` stands for, at most.
constexpr std::size_t most_pairs = 200;

Vector3d mean_position(std::span<const int> list, const Nodes& nodes) {
  Vector3d sum{};
  for (const int node : list) sum += position(nodes, node);
  return sum / static_cast<double>(list.size());
}

// Of all forces that stand on the nodes ahead of the plane, about its point as it is now.
Impulse force_ahead(const SectionSum& section, const Nodes& nodes) {
  const Vector3d about = mean_position(section.cut, nodes) + section.point;
  Impulse sum;
  for (const int entry : section.ahead) {
    const auto node = index(entry);
    sum.add(position(nodes, entry) - about, vector_at(nodes.force[node].component));
    if (!nodes.has_rotations()) continue;
    sum.angular += vector_at(nodes.moment[node].component);
  }
  return sum;
}

/// Nodes of a part and of all parts that share nodes with it, directly or over others.
std::vector<int> nodes_connected_to(std::size_t part, const Model& model) {
  std::vector<char> found(model.nodes.size(), 0), taken(model.parts.size(), 0);
  const auto take = [&](std::size_t p) {
    taken[p] = 1;
    for (const int node : model.parts[p].node) found[index(node)] = 1;
  };
  take(part);
  for (bool grows = !model.merged.empty(); grows;) {
    grows = false;
    for (std::size_t p = 0; p < model.parts.size(); ++p) {
      const std::vector<int>& own = model.parts[p].node;
      if (taken[p] != 0 || model.parts[p].rigid >= 0) continue;
      if (std::ranges::none_of(own, [&](int node) { return found[index(node)] != 0; })) continue;
      take(p);
      grows = true;
    }
  }
  std::vector<int> nodes;
  for (std::size_t node = 0; node < found.size(); ++node)
    if (found[node] != 0) nodes.push_back(static_cast<int>(node));
  return nodes;
}

SectionSum make_section(const ForceSection& wanted, const Deck& deck, const Model& model) {
  const std::size_t p = part_index(wanted.part, deck);
  const PartInModel& part = model.parts[p];
  if (part.rigid >= 0)
    throw BuildError("section '" + wanted.name + "' cuts part '" + part.name +
                         "', which is rigid; parts that deform are accepted",
                     wanted.place);
  const auto height = [&](int node) {
    return dot(wanted.normal, position(model.nodes, node) - wanted.point);
  };
  SectionSum section;
  section.name = wanted.name;
  for (std::size_t e = 0; e < part.element_slot.size(); ++e) {
    const std::vector<int> nodes = nodes_of_element(model, part, e);
    const auto is_ahead = [&](int node) { return height(node) > 0; };
    const auto ahead = std::ranges::count_if(nodes, is_ahead);
    if (ahead == 0 || ahead == static_cast<std::ptrdiff_t>(nodes.size())) continue;
    section.cut.insert(section.cut.end(), nodes.begin(), nodes.end());
  }
  if (section.cut.empty())
    throw BuildError("section '" + wanted.name + "' cuts no element of part '" + part.name +
                         "'; a plane between nodes of the part is accepted",
                     wanted.place);
  std::ranges::sort(section.cut);
  section.cut.erase(std::unique(section.cut.begin(), section.cut.end()), section.cut.end());
  for (const int node : nodes_connected_to(p, model))
    if (height(node) > 0) section.ahead.push_back(node);
  section.point = wanted.point - mean_position(section.cut, model.nodes);
  return section;
}

std::string name_of_condition(const BoundaryCondition& condition, std::size_t number) {
  const auto* wall = std::get_if<RigidWall>(&condition);
  const std::string& name = wall != nullptr ? wall->label : std::get<PrescribedMotion>(condition).name;
  return name.empty() ? std::to_string(number) : name;
}

void make_reactions(const ReactionColumns& wanted, const Deck& deck, ForceSums& sums) {
  sums.reaction_of_condition.assign(deck.boundary_conditions.size(), -1);
  for (std::size_t c = 0; c < deck.boundary_conditions.size(); ++c) {
    const std::string name = name_of_condition(deck.boundary_conditions[c], c);
    if (!wanted.all && std::ranges::find(wanted.names, name) == wanted.names.end()) continue;
    sums.reaction_of_condition[c] = static_cast<int>(sums.reactions.size());
    sums.reactions.push_back({.name = name});
  }
}

// The last condition of a component prevails, as it is applied last.
void find_conditions_of_nodes(const Model& model, ForceSums& sums) {
  sums.condition_of_node.assign(model.nodes.size(), {-1, -1, -1});
  for (const PrescribedNodes& given : model.prescribed)
    for (const int node : given.nodes)
      if (!given.turns() && !given.is_skew())
        sums.condition_of_node[index(node)][index(given.axis)] = given.condition;
}
void find_skew_conditions(const Model& model, ForceSums& sums) {
  for (const PrescribedNodes& given : model.prescribed)
    for (std::size_t k = 0; k < given.direction.size() && !given.turns(); ++k)
      sums.skew.push_back({given.nodes[k], given.condition, given.direction[k], given.dual[k]});
  std::ranges::stable_sort(sums.skew, {}, &SkewShare::node);
}
void find_conditions_of_bodies(const Model& model, ForceSums& sums) {
  for (const RigidBody& body : model.rigid.body) sums.axes_of_body.push_back(body.axes);
  sums.condition_of_body.assign(model.rigid.body.size(), {-1, -1, -1});
  for (std::size_t b = 0; b < model.rigid.body.size(); ++b)
    for (const PrescribedRigid& given : model.rigid.body[b].given)
      if (given.axis < 3) sums.condition_of_body[b][index(given.axis)] = given.condition;
}

/// Pairs of parts as the columns name them.
std::vector<std::array<int, 2>> pairs_of(const ContactColumns& wanted, const Deck& deck, const Model& model) {
  std::vector<std::array<int, 2>> pairs;
  for (const auto& [first, second] : wanted.pairs)
    pairs.push_back({static_cast<int>(part_index(first, deck)), static_cast<int>(part_index(second, deck))});
  if (!wanted.all) return pairs;
  for (const std::string& first : model.contacts.front().surface.part_name)
    for (const std::string& second : model.contacts.front().surface.part_name)
      if (const auto a = part_index(first, deck), b = part_index(second, deck); a <= b)
        pairs.push_back({static_cast<int>(a), static_cast<int>(b)});
  if (pairs.size() > most_pairs)
    throw BuildError("'contact: all' in output.history.forces stands for " + std::to_string(pairs.size()) +
                         " pairs of parts; at most " + std::to_string(most_pairs) +
                         " are accepted, or a list of pairs",
                     wanted.place);
  return pairs;
}

// Each component to the condition that prescribes it.
void add_components(ForceSums& sums, const std::array<int, 3>& condition, const Vector3d& impulse) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    Vector3d component{};
    component[axis] = impulse[axis];
    sums.add_reaction(condition[axis], component);
  }
}

std::array<int, 2> ascending(const std::array<int, 2>& pair) {
  return {std::min(pair[0], pair[1]), std::max(pair[0], pair[1])};
}

}  // namespace

ImpulseLog make_impulse_log(const ForceOutput& wanted, const Deck& deck, const Model& model) {
  ImpulseLog log;
  log.part_of_node.assign(model.nodes.size(), -1);
  for (std::size_t p = model.parts.size(); p-- > 0;)
    for (const int node : model.parts[p].node) log.part_of_node[index(node)] = static_cast<int>(p);
  for (const RigidBody& body : model.rigid.body) log.part_of_body.push_back(static_cast<int>(body.part));
  for (const std::array<int, 2>& pair : pairs_of(wanted.contact, deck, model))
    log.wanted.push_back(ascending(pair));
  std::ranges::sort(log.wanted);
  log.wanted.erase(std::unique(log.wanted.begin(), log.wanted.end()), log.wanted.end());
  return log;
}

ForceSums make_force_sums(const ForceOutput& wanted, const Deck& deck, const Model& model) {
  ForceSums sums;
  make_reactions(wanted.reactions, deck, sums);
  find_conditions_of_bodies(model, sums);
  find_skew_conditions(model, sums);
  for (const ForceSection& section : wanted.sections)
    sums.sections.push_back(make_section(section, deck, model));
  if (model.contacts.empty()) {
    if (wanted.contact.all || !wanted.contact.pairs.empty())
      throw BuildError("forces of contact are asked for, but the deck has no section 'contact'",
                       wanted.contact.place);
    return sums;
  }
  find_conditions_of_nodes(model, sums);
  const ImpulseLog& log = *model.contacts.front().log;
  for (const std::array<int, 2>& pair : pairs_of(wanted.contact, deck, model)) {
    const auto at = std::ranges::lower_bound(log.wanted, ascending(pair));
    sums.contacts.push_back({.name = deck.parts[index(pair[0])].name + "." + deck.parts[index(pair[1])].name,
                             .pair = index(at - log.wanted.begin()),
                             .sign = pair[0] > pair[1] ? -1.0 : 1.0});
  }
  return sums;
}

void ForceSums::add_reaction(int condition, const Vector3d& impulse) {
  const int at = condition < 0 ? -1 : reaction_of_condition[index(condition)];
  if (at >= 0) reactions[index(at)].impulse += impulse;
}

void ForceSums::add_skew_support(int node, const Vector3d& impulse) {
  const auto comes_before = [](const SkewShare& share, int other) { return share.node < other; };
  for (auto share = std::lower_bound(skew.begin(), skew.end(), node, comes_before);
       share != skew.end() && share->node == node; ++share) {
    Vector3d push = share->direction;
    for (double& component : push) component *= dot(share->dual, impulse);
    add_reaction(share->condition, push);
  }
}

void ForceSums::add_support_of_body(std::size_t body, const Vector3d& impulse) {
  const Vector3d along = axes_of_body[body] * impulse;
  for (int axis = 0; axis < 3; ++axis)
    add_reaction(condition_of_body[body][index(axis)], along[axis] * axes_of_body[body].row(axis));
}

void ForceSums::add(const ImpulseLog& log) {
  for (const SupportImpulse& support : log.supports) {
    const Vector3d impulse = support.impulse;
    if (support.node < 0) {
      add_support_of_body(index(support.body), impulse);
      continue;
    }
    add_components(*this, condition_of_node[index(support.node)], impulse);
    add_skew_support(support.node, impulse);
  }
  for (ContactSum& contact : contacts) {
    contact.impulse += contact.sign * log.impulse[contact.pair];
    contact.friction += contact.sign * log.friction[contact.pair];
  }
}

void ForceSums::begin_interval() {
  duration = 0;
  for (ReactionSum& reaction : reactions) reaction.impulse = {};
  for (ContactSum& contact : contacts) contact.impulse = contact.friction = {};
  for (SectionSum& section : sections) section.impulse = {};
}

std::vector<double> ForceSums::impulses() const {
  std::vector<double> all{duration};
  const auto add_all = [&](const Vector3d& vector) { all.insert(all.end(), vector.begin(), vector.end()); };
  for (const ReactionSum& reaction : reactions) add_all(reaction.impulse);
  for (const ContactSum& contact : contacts) {
    add_all(contact.impulse);
    add_all(contact.friction);
  }
  for (const SectionSum& section : sections) {
    add_all(section.impulse.linear);
    add_all(section.impulse.angular);
  }
  return all;
}

void ForceSums::set_impulses(std::span<const double> saved) {
  begin_interval();
  if (saved.size() != impulses().size()) return;
  duration = saved[0];
  auto next = saved.begin() + 1;
  const auto take = [&](Vector3d& vector) {
    for (double& component : vector) component = *next++;
  };
  for (ReactionSum& reaction : reactions) take(reaction.impulse);
  for (ContactSum& contact : contacts) {
    take(contact.impulse);
    take(contact.friction);
  }
  for (SectionSum& section : sections) {
    take(section.impulse.linear);
    take(section.impulse.angular);
  }
}

void add_columns(const ForceSums& sums, std::vector<std::string>& columns) {
  const auto add = [&](const std::string& name, const std::array<const char*, 3>& endings) {
    for (const char* ending : endings) columns.push_back(name + ending);
  };
  for (const ReactionSum& reaction : sums.reactions) add("reaction." + reaction.name, axes);
  for (const ContactSum& contact : sums.contacts) {
    add("contact." + contact.name, axes);
    add("contact." + contact.name + ".friction", axes);
  }
  for (const SectionSum& section : sums.sections) {
    add("section." + section.name, axes);
    add("section." + section.name, moment_axes);
  }
}

void add_values(const ForceSums& sums, std::vector<double>& row) {
  const std::vector<double> impulses = sums.impulses();
  for (const double impulse : std::span(impulses).subspan(1))
    row.push_back(sums.duration > 0 ? impulse / sums.duration : 0);
}

void note_loads(ForceSums& sums, const Nodes& nodes) {
  for (SectionSum& section : sums.sections) section.force = force_ahead(section, nodes);
}

void measure_sections(ForceSums& sums, const Nodes& nodes) {
  for (SectionSum& section : sums.sections) {
    Impulse on_behind = section.force;  // of loads, less all: minus what the nodes ahead receive
    const Impulse all = force_ahead(section, nodes);
    for (std::size_t i = 0; i < 3; ++i) {
      on_behind.linear[i] -= all.linear[i];
      on_behind.angular[i] -= all.angular[i];
    }
    section.force = on_behind;
  }
}

void begin_step(ForceSums& sums, double step) {
  sums.duration += step;
  for (SectionSum& section : sums.sections) {
    Impulse impulse = section.force;
    impulse *= step;
    section.impulse += impulse;
  }
}

void add_reactions(ForceSums& sums, const PrescribedNodes& given, const Vector3d& linear) {
  if (given.is_skew() && !given.turns())
    for (std::size_t k = 0; k < given.nodes.size(); ++k)
      sums.add_skew_support(given.nodes[k], given.impulse[k]);
  if (!given.is_skew()) sums.add_reaction(given.condition, linear);
}

void add_reactions(ForceSums& sums, const RigidBodies& bodies) {
  for (std::size_t b = 0; b < bodies.body.size(); ++b) sums.add_support_of_body(b, bodies.body[b].support);
}

}  // namespace brio
