#include "src/forecast/warnings.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <sstream>

#include "src/base/index.hpp"
#include "src/build/build.hpp"
#include "src/deck/part_index.hpp"
#include "src/model/part_shape.hpp"
#include "src/output/output_schedule.hpp"

namespace brio {

namespace {

using Warnings = std::vector<SceneWarning>;
using Shapes = std::vector<PartShape>;
using Pairs = std::vector<std::pair<std::size_t, std::size_t>>;

std::string number(double value) {
  std::ostringstream text;
  text.precision(3);
  text << value;
  return text.str();
}

bool are_joined(const Model& model, const std::string& a, const std::string& b) {
  const auto of = [](const std::string& name) { return name.substr(0, name.find('.')); };
  for (const MergedParts& merged : model.merged)
    if ((merged.first == a && merged.second == b) || (merged.first == b && merged.second == a)) return true;
  for (const TiedParts& tied : model.ties.found)
    if ((of(tied.nodes) == a && of(tied.surface) == b) || (of(tied.nodes) == b && of(tied.surface) == a))
      return true;
  return false;
}

bool may_touch(const Deck& deck, const std::string& a, const std::string& b) {
  if (!is_in_contact(deck, a) || !is_in_contact(deck, b)) return false;
  for (const ContactPair& pair : deck.contact->pairs)
    if (!pair.touch &&
        ((pair.parts[0] == a && pair.parts[1] == b) || (pair.parts[0] == b && pair.parts[1] == a)))
      return false;
  return true;
}

// Whether the boxes of two parts, each grown by a margin, meet while both keep their velocities.
// \param begin from which time on, to leave out those that meet from the start
bool boxes_meet(const PartShape& a, const PartShape& b, double margin, double begin, double end) {
  for (std::size_t i = 0; i < 3; ++i) {
    const double lower = b.lower[i] - a.upper[i] - margin, upper = b.upper[i] - a.lower[i] + margin;
    const double speed = a.velocity[i] - b.velocity[i];
    if (speed == 0) {
      if (lower > 0 || upper < 0) return false;
      continue;
    }
    begin = std::max(begin, std::min(lower / speed, upper / speed));
    end = std::min(end, std::max(lower / speed, upper / speed));
  }
  return begin < end;
}

// Pairs of parts whose boxes, each grown by the longest edge of all, may meet while they keep their
// velocities: those whose boxes over the whole time overlap, found along the axis that tells most of them
// apart.
Pairs pairs_near(const Shapes& shapes, double end) {
  struct Swept {
    Vector3d lower, upper;
    std::size_t part;
  };
  double margin = 0;
  for (const PartShape& shape : shapes) margin = std::max(margin, shape.edge);
  std::vector<Swept> swept;
  for (std::size_t p = 0; p < shapes.size(); ++p) {
    Swept& box = swept.emplace_back(Swept{shapes[p].lower, shapes[p].upper, p});
    for (std::size_t i = 0; i < 3; ++i) {
      const double way = shapes[p].velocity[i] * end;
      box.lower[i] += std::min(0.0, way) - margin;
      box.upper[i] += std::max(0.0, way) + margin;
      if (!(box.lower[i] <= box.upper[i])) box.lower[i] = -HUGE_VAL, box.upper[i] = HUGE_VAL;  // not numbers
    }
  }
  std::size_t axis = 0;
  double most = -1;
  for (std::size_t i = 0; i < 3; ++i) {
    double least = HUGE_VAL, largest = -HUGE_VAL, length = 0;
    for (const Swept& box : swept) {
      least = std::min(least, box.lower[i]);
      largest = std::max(largest, box.upper[i]);
      length += box.upper[i] - box.lower[i];
    }
    const double apart = (largest - least) / length;
    if (apart > most) most = apart, axis = i;
  }
  std::sort(swept.begin(), swept.end(), [axis](const Swept& a, const Swept& b) {
    return std::pair(a.lower[axis], a.part) < std::pair(b.lower[axis], b.part);
  });
  Pairs pairs;
  for (std::size_t a = 0; a < swept.size(); ++a)
    for (std::size_t b = a + 1; b < swept.size() && !(swept[b].lower[axis] > swept[a].upper[axis]); ++b) {
      bool overlap = true;
      for (std::size_t i = 0; i < 3; ++i)
        overlap =
            overlap && !(swept[b].lower[i] > swept[a].upper[i] || swept[b].upper[i] < swept[a].lower[i]);
      if (overlap) pairs.push_back(std::minmax(swept[a].part, swept[b].part));
    }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

void warn_of_thin_bending(const Deck& deck, const Model& model, const Shapes& shapes, Warnings& warnings) {
  constexpr double slender = 8;  // extent over thickness
  for (std::size_t p = 0; p < deck.parts.size(); ++p) {
    const PartShape& shape = shapes[p];
    if (!std::holds_alternative<Hex8>(deck.parts[p].element) || shape.alone_directions == 0) continue;
    if (shape.alone_directions == 3 || shape.extent() < slender * shape.alone_thickness) continue;
    if (shape.alone_directions == 2 && model.loads.empty()) {
      // A bar that is only hit along its length does not bend.
      std::size_t along = 0;
      for (std::size_t i = 1; i < 3; ++i)
        if (shape.upper[i] - shape.lower[i] > shape.upper[along] - shape.lower[along]) along = i;
      const bool straight = std::all_of(shapes.begin(), shapes.end(), [&](const PartShape& other) {
        const double speed = std::sqrt(dot(other.velocity, other.velocity));
        return std::abs(other.velocity[along]) >= (1 - 1e-9) * speed;
      });
      if (straight) continue;
    }
    warnings.push_back({"part '" + deck.parts[p].name + "'",
                        "one element with one integration point through a thickness of " +
                            number(shape.alone_thickness) + ": nothing but hourglass control resists bending",
                        "three elements through it, hex8_full, or shell4"});
  }
}

void warn_of_meshes_in_contact(const Deck& deck, const Model& model, const Shapes& shapes, const Pairs& near,
                               Warnings& warnings) {
  constexpr double largest_ratio = 4;
  for (const auto& [a, b] : near) {
    const double ratio = std::max(shapes[a].edge, shapes[b].edge) / std::min(shapes[a].edge, shapes[b].edge);
    if (!(ratio > largest_ratio) || !may_touch(deck, deck.parts[a].name, deck.parts[b].name)) continue;
    if (are_joined(model, deck.parts[a].name, deck.parts[b].name)) continue;
    const double margin = std::max(shapes[a].edge, shapes[b].edge);
    if (!boxes_meet(shapes[a], shapes[b], margin, 0, deck.time.end)) continue;
    const std::size_t coarse = shapes[a].edge > shapes[b].edge ? a : b;
    warnings.push_back({"part '" + deck.parts[coarse].name + "'",
                        "its elements are " + number(ratio) + " times as long as those of part '" +
                            deck.parts[a + b - coarse].name + "', with which it may be in contact",
                        "a mesh up to " + number(largest_ratio) + " times as coarse"});
  }
}

void warn_of_tiny_elements(const Deck& deck, const Model& model, const Shapes& shapes, Warnings& warnings) {
  constexpr double few = 0.05;      // of all elements
  constexpr double worth_it = 2.5;  // times the step
  std::vector<double> steps;
  double least = HUGE_VAL;
  std::size_t least_part = 0;
  for (std::size_t p = 0; p < deck.parts.size(); ++p) {
    const Material* material = material_of(deck, deck.parts[p]);
    if (model.parts[p].rigid >= 0 || material == nullptr) continue;
    const double speed =
        std::visit([](const auto& law) { return std::sqrt(law.youngs_modulus / law.density); }, *material);
    for (const double length : shapes[p].length) {
      steps.push_back(length / speed);
      if (steps.back() < least) least = steps.back(), least_part = p;
    }
  }
  if (steps.empty()) return;
  const auto place = static_cast<std::ptrdiff_t>(few * static_cast<double>(steps.size()));
  std::nth_element(steps.begin(), steps.begin() + place, steps.end());
  const double others = steps[index(place)];
  if (!(others > worth_it * least)) return;
  const auto tiny =
      std::count_if(steps.begin(), steps.end(), [&](double s) { return s < others / worth_it; });
  warnings.push_back(
      {"part '" + deck.parts[least_part].name + "'",
       std::to_string(tiny) + " of " + std::to_string(steps.size()) +
           " elements are so short that they alone set the stable time step",
       "without them the time step would be about " + number(others / least) + " times as long"});
}

void warn_of_long_elements(const Deck& deck, const Model& model, const Shapes& shapes, Warnings& warnings) {
  for (std::size_t p = 0; p < deck.parts.size(); ++p)
    if (shapes[p].long_elements > 0 && model.parts[p].rigid < 0)
      warnings.push_back({"part '" + deck.parts[p].name + "'",
                          std::to_string(shapes[p].long_elements) + " elements have edges up to " +
                              number(shapes[p].largest_aspect) + " times as long as their others",
                          "ratios below " + number(aspect_limit)});
}

bool names_system(const Deck& deck, const std::string& name) {
  const auto in_condition = [&](const BoundaryCondition& condition) {
    const auto* motion = std::get_if<PrescribedMotion>(&condition);
    return motion != nullptr && motion->system == name;
  };
  const auto in_load = [&](const Load& load) {
    return std::visit(
        [&](const auto& one) {
          if constexpr (requires { one.system; }) return one.system == name;
          return false;
        },
        load);
  };
  return std::ranges::any_of(deck.boundary_conditions, in_condition) ||
         std::ranges::any_of(deck.loads, in_load);
}

void warn_of_unused(const Deck& deck, const Model& model, Warnings& warnings) {
  for (const auto& [name, material] : deck.materials) {
    const auto uses = [&, &word = name](const Part& part) { return part.material == word; };
    if (std::none_of(deck.parts.begin(), deck.parts.end(), uses))
      warnings.push_back({"material '" + name + "'", "no part uses it", "leave it out"});
  }
  for (const auto& [name, system] : deck.coordinate_systems)
    if (!names_system(deck, name))
      warnings.push_back({"coordinate system '" + name + "'", "nothing uses it", "leave it out"});
  const bool gravity = std::any_of(model.loads.begin(), model.loads.end(), [](const ActiveLoad& load) {
    return std::holds_alternative<GravityLoad>(load.load);
  });
  std::set<int> concerned;  // nodes
  for (const PrescribedNodes& given : model.prescribed)
    concerned.insert(given.nodes.begin(), given.nodes.end());
  for (const ActiveLoad& load : model.loads) {
    if (const auto* nodal = std::get_if<NodalLoad>(&load.load))
      concerned.insert(nodal->nodes.begin(), nodal->nodes.end());
    if (const auto* pressure = std::get_if<PressureLoad>(&load.load))
      for (const auto& side : pressure->sides) concerned.insert(side.begin(), side.end());
  }
  for (const SpringInRun& spring : model.springs.spring)
    for (const SpringAnchor& anchor : spring.end) concerned.insert(anchor.node);
  std::set<std::string> joined_parts;
  for (const MergedParts& merged : model.merged) joined_parts.insert({merged.first, merged.second});
  for (const TiedParts& tied : model.ties.found)
    for (const std::string& name : {tied.nodes, tied.surface})
      for (const std::size_t p : parts_called(name.substr(0, name.find('.')), deck))
        joined_parts.insert(deck.parts[p].name);
  for (std::size_t p = 0; p < deck.parts.size(); ++p) {
    const PartInModel& part = model.parts[p];
    const bool joined = joined_parts.contains(part.name);
    const bool moves = std::any_of(part.node.begin(), part.node.end(), [&](int node) {
      const double* v = model.nodes.record[index(node)].velocity;
      return v[0] != 0 || v[1] != 0 || v[2] != 0 || concerned.contains(node);
    });
    const bool given = part.rigid >= 0 && !model.rigid.body[index(part.rigid)].given.empty();
    if (gravity || joined || moves || given || is_in_contact(deck, part.name)) continue;
    const auto is_said = [&](const SceneWarning& other) {  // that something moves towards it
      return other.subject.find("'" + part.name + "'") != std::string::npos;
    };
    if (std::any_of(warnings.begin(), warnings.end(), is_said)) continue;
    warnings.push_back({"part '" + part.name + "'", "it has no motion, load, support or contact",
                        "remove it, or add it to contact.surfaces"});
  }
}

void warn_of_hourglass(const Deck& deck, const Model& model, Warnings& warnings) {
  for (const Part& part : deck.parts) {
    const auto uncontrolled = [](const auto& element) {
      return element.hourglass_stiffness == 0 && element.hourglass_viscosity == 0;
    };
    const auto* hex = std::get_if<Hex8>(&part.element);
    const auto* shell = std::get_if<Shell4>(&part.element);
    if ((hex != nullptr && uncontrolled(*hex)) || (shell != nullptr && uncontrolled(*shell)))
      warnings.push_back({"part '" + part.name + "'", "nothing resists hourglass motion",
                          "hourglass_stiffness: 0.05, or hex8_full"});
  }
  for (const ActiveLoad& load : model.loads) {
    const auto* nodal = std::get_if<NodalLoad>(&load.load);
    if (nodal == nullptr || nodal->is_moment || nodal->nodes.size() != 1 || is_zero(nodal->force)) continue;
    for (std::size_t p = 0; p < deck.parts.size(); ++p) {
      const std::vector<int>& nodes = model.parts[p].node;
      if (!std::holds_alternative<Hex8>(deck.parts[p].element)) continue;
      if (std::find(nodes.begin(), nodes.end(), nodal->nodes.front()) == nodes.end()) continue;
      warnings.push_back({"part '" + deck.parts[p].name + "'",
                          "a force on a single node excites hourglass motion of hex8",
                          "the same force on the nodes of a side, or a pressure"});
    }
  }
}

void warn_of_flowing_solids(const Deck& deck, Warnings& warnings) {
  constexpr double nearly_incompressible = 0.45;
  for (const Part& part : deck.parts) {
    const auto* particle = std::get_if<Particle>(&part.element);
    const Material* material = material_of(deck, part);
    if (particle == nullptr || !particle->is_eulerian() || material == nullptr) continue;
    if (std::visit([](const auto& law) { return law.poissons_ratio; }, *material) > nearly_incompressible)
      continue;
    warnings.push_back(
        {"part '" + part.name + "'",
         "an updated-Lagrangian (eulerian) kernel for a material with the stiffness of a solid: slow, "
         "with numerical fracture in tension",
         "kernel: total_lagrangian, unless it is a fluid"});
  }
}

void warn_of_missing_contact(const Deck& deck, const Model& model, const Shapes& shapes, const Pairs& near,
                             Warnings& warnings) {
  for (const auto& [a, b] : near) {
    const std::string &first = deck.parts[a].name, &second = deck.parts[b].name;
    if (may_touch(deck, first, second) || are_joined(model, first, second)) continue;
    const bool said = is_in_contact(deck, first) && is_in_contact(deck, second);
    const double size = 1e-6 * std::min(shapes[a].extent(), shapes[b].extent());
    if (said || !boxes_meet(shapes[a], shapes[b], -size, 1e-12 * deck.time.end, deck.time.end)) continue;
    if (boxes_meet(shapes[a], shapes[b], -size, 0, 1e-12 * deck.time.end)) continue;  // as drawn
    warnings.push_back({"parts '" + first + "' and '" + second + "'",
                        "they move towards each other, but contact between them is not defined",
                        deck.contact ? "add them to contact.surfaces" : "contact: {surfaces: all}"});
  }
}

void warn_of_softening(const Deck& deck, Warnings& warnings) {
  for (const auto& [name, material] : deck.materials) {
    const auto* law = std::get_if<TabulatedPlasticity>(&material);
    if (law == nullptr || law->yield_stress->steepest_softening() == 0) continue;
    warnings.push_back({"material '" + name + "'",
                        "its yield stress falls with the plastic strain: strain localizes in one row of "
                        "elements, and results depend on the mesh",
                        "a table that does not fall, with failure by an opening_displacement"});
  }
}

void warn_of_output(const Deck& deck, const Model& model, Warnings& warnings) {
  constexpr double worth_saying = 0.9;
  const double step = model.times.next;
  const auto look = [&](const std::string& key, const std::optional<double>& every) {
    if (every && *every < worth_saying * step)
      warnings.push_back(
          {key, "an interval of " + number(*every) + " is shorter than a time step, " + number(step),
           "every time step is written; choose a longer interval"});
  };
  look("output.fields.every", deck.output.fields_.every);
  look("output.history.every", deck.output.history.every);
  if (deck.numerics.energy_error_limit > 0.25)
    warnings.push_back({"numerics.energy_error_limit",
                        "a run goes on with an energy error of " + number(deck.numerics.energy_error_limit),
                        "results with errors above a few per cent are unreliable; the default is 0.1"});
}

}  // namespace

std::vector<SceneWarning> scene_warnings(const Deck& deck, const Model& model) {
  Shapes shapes;
  for (const PartInModel& part : model.parts) shapes.push_back(shape_of(model, part));
  Warnings warnings;
  const Pairs near = pairs_near(shapes, deck.time.end);
  warn_of_missing_contact(deck, model, shapes, near, warnings);
  warn_of_unused(deck, model, warnings);
  warn_of_thin_bending(deck, model, shapes, warnings);
  warn_of_hourglass(deck, model, warnings);
  warn_of_meshes_in_contact(deck, model, shapes, near, warnings);
  warn_of_tiny_elements(deck, model, shapes, warnings);
  warn_of_long_elements(deck, model, shapes, warnings);
  warn_of_flowing_solids(deck, warnings);
  warn_of_softening(deck, warnings);
  warn_of_output(deck, model, warnings);
  return warnings;
}

}  // namespace brio
