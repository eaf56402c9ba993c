// Contact pressure and gap against balances and closed forms.

#include <gtest/gtest.h>

#include <cmath>

#include "contact/scene.hpp"
#include "src/base/index.hpp"
#include "src/output/observe.hpp"
#include "tests/core/scene.hpp"

namespace brio {
namespace {

using namespace test;

constexpr int cells = 4;
constexpr double pull_of_earth = 10, edge = 1;

/// A block of 4 x 4 x 2 cells over a floor that does not move.
Deck deck_of_block(double gap) {
  Deck deck;
  deck.materials = {{"material", elastic(0.3)}};
  deck.parts = {box("block", {edge, edge, 0.5}, {cells, cells, 2}, {0, 0, 0.25 + gap}, hex8()),
                box("floor", {3, 3, 0.5}, {5, 5, 1}, {0, 0, -0.25}, hex8())};
  deck.parts[0].damping = 40;
  deck.boundary_conditions = {fix("floor", {0, 1, 2})};
  Gravity load;
  load.acceleration = {0, 0, -pull_of_earth};
  deck.loads = {load};
  deck.contact.emplace();
  deck.time.end = 10;
  return deck;
}

/// Of each point of a part, by its place among the nodes of the part.
std::vector<double> values_of(const Model& model, FieldObserver& observer, const std::string& name,
                              std::size_t part) {
  const Snapshot& snapshot = observer.observe(model);
  for (const FieldArray& field : snapshot.point_fields) {
    if (field.name != name) continue;
    std::size_t first = 0;
    for (std::size_t p = 0; p < part; ++p) first += model.parts[p].node.size();
    const auto begin = field.values.begin() + static_cast<std::ptrdiff_t>(first * index(field.components));
    return {begin,
            begin + static_cast<std::ptrdiff_t>(model.parts[part].node.size() * index(field.components))};
  }
  ADD_FAILURE() << name;
  return {};
}

const std::vector<std::string> contact_fields_wanted{"contact_pressure", "contact_gap"};

double share_of_row(double x) { return std::abs(std::abs(x) - edge / 2) < 0.01 * edge ? 0.5 : 1; }

// The sum of pressure times area is the weight, with what the momentum has changed by.
TEST(ContactFields, PressureOfARestingBlockCarriesItsWeight) {
  Model model = build_model(deck_of_block(0));
  FieldObserver observer(model, contact_fields_wanted);
  const std::vector<double> start(observer.observe(model).points);
  ThreadTeam team(1);
  make_steps(model, 6000, 1, team);
  model.damping = {};
  make_steps(model, 3000, 1, team);
  model.impulse_sums.begin_interval();
  const double before = momentum_of(model)[2];
  make_steps(model, 3000, 1, team);
  const double changed = (momentum_of(model)[2] - before) / model.impulse_sums.duration();
  const std::vector<double> pressure = values_of(model, observer, "contact_pressure", 0);
  const std::vector<double> force = values_of(model, observer, "contact_force", 0);
  const std::vector<double>& now = observer.observe(model).points;
  double width = 0;  // it is compressed, and wider
  for (std::size_t i = 0; i < pressure.size(); ++i)
    if (start[3 * i + 2] < 0.01) width = std::max(width, 2 * now[3 * i]);
  const double weight_of_block = pull_of_earth * model.parts[0].mass;  // it gave way for the gap
  double carried = 0, pushed = 0;
  for (std::size_t i = 0; i < pressure.size(); ++i) {
    const double area =
        width * width / (cells * cells) * share_of_row(start[3 * i]) * share_of_row(start[3 * i + 1]);
    if (!std::isnan(pressure[i])) carried += pressure[i] * area;  // inside there is none
    pushed += force[3 * i + 2];
    EXPECT_EQ(pressure[i] > 0, start[3 * i + 2] < 0.01) << i;
  }
  EXPECT_NEAR(changed / weight_of_block, 0, 1e-6);
  EXPECT_NEAR(carried / weight_of_block, 1, 1e-6);
  EXPECT_NEAR(pushed / weight_of_block, 1, 1e-6);
}

// Side faces carry nothing of a force from below; both sides of a shell may be pushed upon.
TEST(ContactFields, AreaIsThatOfFacesThatAreBeneath) {
  const Model block = build_model(deck_of_block(0.02));
  const ContactScene& scene = block.contacts.front();
  const auto area_at = [&](const Vector3d& x, const Vector3d& direction) {
    for (const int node : block.parts[0].node)
      if (norm(vector_at(block.nodes.record[index(node)].position) - x) < 0.01) {
        double all = 0;
        return pushed_area(scene.surface, block.nodes, scene.surface.slave(node), direction, all);
      }
    ADD_FAILURE() << testing::PrintToString(x);
    return 0.0;
  };
  const double face = edge * edge / (cells * cells), side = edge / cells * 0.25;
  const Vector3d up{0, 0, 1}, slanted = Vector3d{3, 0, 4} / 5;
  EXPECT_NEAR(area_at({0, 0, 0.02}, up), face, 1e-12);
  EXPECT_NEAR(area_at({edge / 2, 0, 0.02}, up), face / 2, 1e-12);
  EXPECT_NEAR(area_at({edge / 2, edge / 2, 0.02}, up), face / 4, 1e-12);
  EXPECT_NEAR(area_at({edge / 2, 0, 0.02}, Vector3d{-1, 0, 0}), side / 2, 1e-12);
  EXPECT_NEAR(area_at({-edge / 2, 0, 0.02}, slanted), 0.8 * face / 2 + 0.6 * side / 2, 1e-12);
  EXPECT_EQ(area_at({0, 0, 0.52}, up), 0);
}

// The gap of a node is its distance beyond that of contact, twice the skin of a solid.
TEST(ContactFields, GapIsTheDistanceBeyondContact) {
  const double height = 2e-3;  // less than the band of 0.02 edges of cells
  Deck deck = deck_of_block(height);
  deck.loads.clear();
  Model model = build_model(deck);
  FieldObserver observer(model, contact_fields_wanted);
  const std::vector<double> points = observer.observe(model).points;
  ThreadTeam team(1);
  make_steps(model, 1, 1, team);
  const std::vector<double> gap = values_of(model, observer, "contact_gap", 0);
  int near = 0;
  for (std::size_t i = 0; i < gap.size(); ++i) {
    const bool is_bottom = points[3 * i + 2] < 0.01;
    EXPECT_EQ(std::isnan(gap[i]), !is_bottom) << i;
    if (!is_bottom) continue;
    ++near;
    EXPECT_NEAR(gap[i], height - 2 * model.contacts.front().features.skin, 1e-12) << i;
  }
  EXPECT_EQ(near, (cells + 1) * (cells + 1));
  EXPECT_EQ(values_of(model, observer, "contact_pressure", 0)[0], 0);
}

// A dump holds means since the one before.
TEST(ContactFields, ForcesAreMeansSinceTheLastDump) {
  Deck deck = deck_of_block(0);
  deck.initial_conditions = {moving("block", {0, 0, -1})};
  deck.loads.clear();
  deck.parts[0].damping = 0;
  Model model = build_model(deck);
  FieldObserver observer(model);
  ThreadTeam team(1);
  double impulse = 0;
  const double before = momentum_of(model)[2];
  for (int dump = 0; dump < 5; ++dump) {
    make_steps(model, 7, 1, team);
    const std::vector<double> force = values_of(model, observer, "contact_force", 0);
    for (std::size_t i = 2; i < force.size(); i += 3) impulse += force[i] * model.impulse_sums.duration();
    model.impulse_sums.begin_interval();
  }
  EXPECT_GT(impulse, 0);
  EXPECT_NEAR(momentum_of(model)[2] - before, impulse, 1e-10 * impulse);
}

}  // namespace
}  // namespace brio
