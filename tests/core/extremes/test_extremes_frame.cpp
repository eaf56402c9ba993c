// A scene in a frame that moves a thousand times as fast, at a place a million sizes away, or with its mesh
// numbered otherwise.

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "src/base/index.hpp"
#include "tests/core/extremes/extremes.hpp"

namespace brio {
namespace {

using namespace test;

Deck seen_from(Deck deck, const Vector3d& frame, const Vector3d& place) {
  for (Part& part : deck.parts) {
    bool moves = false;
    for (InitialCondition& condition : deck.initial_conditions) moves |= condition.where.set == part.name;
    if (!moves) deck.initial_conditions.push_back(moving(part.name, {}));
    for (std::size_t i = 0; i < 3; ++i) part.placement.translate[i] += place[i];
  }
  for (InitialCondition& condition : deck.initial_conditions)
    for (std::size_t i = 0; i < 3; ++i) condition.velocity[i] += frame[i];
  return deck;
}

struct Difference {
  double velocity = 0, position = 0;
};
Difference difference(const Model& a, const Model& b, const Vector3d& frame, const Vector3d& place) {
  Difference largest;
  for (std::size_t i = 0; i < a.nodes.size(); ++i)
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const NodeRecord &p = a.nodes.record[i], &q = b.nodes.record[i];
      const double moved = q.position[axis] - frame[axis] * b.times.time - place[axis];
      largest.velocity =
          std::max(largest.velocity, std::abs(p.velocity[axis] - (q.velocity[axis] - frame[axis])));
      largest.position = std::max(largest.position, std::abs(p.position[axis] - moved));
    }
  return largest;
}

double share_of_equal(const std::vector<int>& a, const std::vector<int>& b) {
  const std::size_t count = std::min(a.size(), b.size());
  int equal = 0;
  for (std::size_t i = 0; i < count; ++i) equal += a[i] == b[i];
  return static_cast<double>(equal) / static_cast<double>(std::max(a.size(), b.size()));
}

/// A bar thrown at bricks that lean against a fixed wall.
Deck few_bricks() {
  Deck deck;
  deck.materials = {{"material", elastic(0.3)}, {"soft", tough()}};
  deck.parts = {box("bar", {0.8, 0.06, 0.06}, {8, 2, 2}, {-0.551, 0.01, 0.07}, hex8(), "soft")};
  for (int k = 0; k < 6; ++k)
    deck.parts.push_back(box("brick" + std::to_string(k), {0.1, 0.2, 0.1}, {1, 2, 1},
                             {-0.1, 0.2 * (k / 3) - 0.1 + 0.05 * (k % 3 % 2), 0.1 * (k % 3)}, hex8()));
  deck.parts.push_back(box("wall", {0.05, 0.6, 0.6}, {1, 4, 4}, {-0.025, 0, 0.1}, hex8()));
  deck.initial_conditions = {moving("bar", {20, 0, 0})};
  deck.contact.emplace();
  deck.time.end = 3e-3;
  return deck;
}

// Bricks that lie flush and do not move: rounding says which of their constraints push, so they are compared
// as a whole.
void expect_same_energy(const Watched& a, const Watched& b) {
  EXPECT_NEAR(a.model.energy.internal, b.model.energy.internal, 1e-3 * a.model.energy.internal);
}

std::vector<std::pair<std::string, Deck>> scenes() {
  std::vector<std::pair<std::string, Deck>> list;
  for (const Kind kind : {Kind::hex8, Kind::hex8_full, Kind::shell, Kind::beam, Kind::particles, Kind::rigid})
    list.emplace_back(std::string(name_of_kind(kind)) + " on hex8", impact(kind, Kind::hex8));
  list.emplace_back("hex8 on shell4", impact(Kind::hex8, Kind::shell));
  list.emplace_back("bricks", few_bricks());
  for (auto& [name, deck] : list) {
    deck.contact->options.friction = 0;
    // How many iterations reach a wider tolerance is a matter of rounding.
    deck.contact->options.passes = 200;
    deck.contact->options.tolerance = 1e-7;
    deck.time.end = 3e-3;
  }
  return list;
}

TEST(ExtremesFrame, AThousandTimesTheSpeedOfTheEventSeesTheSameContacts) {
  const FloatingPointTraps traps;
  const Vector3d frame{10000, -15000, 12000};
  for (const auto& [name, deck] : scenes()) {
    SCOPED_TRACE(name);
    const Watched reference(deck);
    const Watched other(seen_from(deck, frame, {}), 20);
    const Difference found = difference(reference.model, other.model, frame, {});
    std::printf("| frame | %s | %.0e | %.0e | %.4f |\n", name.c_str(), found.velocity / 20, found.position,
                share_of_equal(reference.contacts, other.contacts));
    EXPECT_GT(reference.touched(), 0);
    EXPECT_LE(other.deep, 1);
    EXPECT_EQ(other.missed, 0);
    EXPECT_EQ(reference.contacts, other.contacts);
    if (name != "bricks") {  // of those that lie flush and do not move rounding says which push
      EXPECT_EQ(reference.active, other.active);
    }
    EXPECT_LE(found.velocity, 1e-6 * 20);
    EXPECT_LE(found.position, 1e-8);
  }
}

// An ulp of the position is 1e-10 there, a bit less than 1e-9 of an edge.
TEST(ExtremesFrame, AMillionSizesAwaySeesTheSameContacts) {
  const FloatingPointTraps traps;
  const Vector3d place{1048576, -524288, 786432};
  for (const auto& [name, deck] : scenes()) {
    SCOPED_TRACE(name);
    const Watched reference(deck);
    const Watched other(seen_from(deck, {}, place), 20);
    const Difference found = difference(reference.model, other.model, {}, place);
    std::printf("| place | %s | %.0e | %.0e | %.4f |\n", name.c_str(), found.velocity / 20, found.position,
                share_of_equal(reference.contacts, other.contacts));
    EXPECT_LE(other.deep, 1);
    EXPECT_EQ(other.missed, 0);
    if (name == "bricks") {
      expect_same_energy(reference, other);
      continue;
    }
    EXPECT_GE(share_of_equal(reference.contacts, other.contacts), 0.99);
    EXPECT_LE(found.velocity, 1e-5 * 20);
    EXPECT_LE(found.position, 1e-7);
  }
}

TEST(ExtremesFrame, FastAndFarSeesTheSameContacts) {
  const FloatingPointTraps traps;
  const Vector3d frame{10000, -15000, 12000}, place{1048576, -524288, 786432};
  for (const auto& [name, deck] : scenes()) {
    SCOPED_TRACE(name);
    const Watched reference(deck);
    const Watched other(seen_from(deck, frame, place), 20);
    const Difference found = difference(reference.model, other.model, frame, place);
    std::printf("| both | %s | %.0e | %.0e | %.4f |\n", name.c_str(), found.velocity / 20, found.position,
                share_of_equal(reference.contacts, other.contacts));
    EXPECT_LE(other.deep, 1);
    EXPECT_EQ(other.missed, 0);
    if (name == "bricks") {
      expect_same_energy(reference, other);
      continue;
    }
    EXPECT_GE(share_of_equal(reference.contacts, other.contacts), 0.99);
    EXPECT_LE(found.velocity, 1e-5 * 20);
  }
}

// ---- numbering

struct Renumbered {
  Mesh mesh;
  std::vector<int> node;  ///< new number of each node
};
/// Nodes and elements in another order; the corners of each element stay as they are.
Renumbered shuffled(const Mesh& mesh, std::mt19937& random) {
  Renumbered result{mesh, {}};
  const auto order = [&](std::size_t count) {
    std::vector<int> number(count);
    std::iota(number.begin(), number.end(), 0);
    std::shuffle(number.begin(), number.end(), random);
    return number;
  };
  result.node = order(mesh.position.size());
  const std::vector<int> element =
      mesh.volume.empty() ? order(mesh.element_count()) : result.node;  // a particle is a node
  const auto corners = index(mesh.nodes_per_element);
  for (std::size_t i = 0; i < mesh.position.size(); ++i)
    result.mesh.position[index(result.node[i])] = mesh.position[i];
  for (std::size_t e = 0; e < mesh.element_count(); ++e) {
    const auto to = index(element[e]);
    for (std::size_t k = 0; k < corners; ++k)
      result.mesh.connectivity[to * corners + k] = result.node[index(mesh.connectivity[e * corners + k])];
    if (!mesh.volume.empty()) result.mesh.volume[to] = mesh.volume[e];
  }
  for (auto& [name, set] : result.mesh.node_sets) {
    for (int& node : set) node = result.node[index(node)];
    std::sort(set.begin(), set.end());
  }
  for (auto& [name, sides] : result.mesh.side_sets)
    for (ElementSide& side : sides) side.element = element[index(side.element)];
  return result;
}

TEST(ExtremesNumbering, ShuffledNodesAndElementsGiveTheSameRun) {
  const FloatingPointTraps traps;
  std::mt19937 random(11);
  for (const auto& [name, deck] : scenes()) {
    SCOPED_TRACE(name);
    std::vector<Mesh> meshes, others;
    std::vector<std::vector<int>> number;
    for (const Part& part : deck.parts) {
      meshes.push_back(generate_mesh(part.mesh, part.placement));
      Renumbered renumbered = shuffled(meshes.back(), random);
      others.push_back(std::move(renumbered.mesh));
      number.push_back(std::move(renumbered.node));
    }
    const Watched reference(deck, build(deck, meshes));
    const Watched other(deck, build(deck, others), 20);
    double largest = 0;
    for (std::size_t p = 0; p < meshes.size(); ++p)
      for (std::size_t i = 0; i < number[p].size(); ++i) {
        const auto a = index(reference.model.parts[p].node[i]);
        const auto b = index(other.model.parts[p].node[index(number[p][i])]);
        for (std::size_t axis = 0; axis < 3; ++axis)
          largest = std::max(largest, std::abs(reference.model.nodes.record[a].position[axis] -
                                               other.model.nodes.record[b].position[axis]));
      }
    std::printf("| numbering | %s | %.0e |\n", name.c_str(), largest);
    EXPECT_EQ(reference.model.step, other.model.step);
    EXPECT_EQ(reference.contacts, other.contacts);
    EXPECT_LE(other.deep, 1);
    EXPECT_EQ(other.missed, 0);
    EXPECT_LE(largest, 1e-12);
  }
}

}  // namespace
}  // namespace brio
