// Two snapshots of one observer, filled by turns.

#include <gtest/gtest.h>

#include <variant>

#include "src/output/observe.hpp"
#include "tests/core/sweep/erosion_scene.hpp"

namespace brio {
namespace {

using namespace test;

void expect_same(const std::vector<FieldArray>& fields, const std::vector<FieldArray>& expected) {
  ASSERT_EQ(fields.size(), expected.size());
  for (std::size_t f = 0; f < fields.size(); ++f)
    EXPECT_EQ(fields[f].values, expected[f].values) << expected[f].name;
}

void expect_same(const Snapshot& snapshot, const Snapshot& expected) {
  EXPECT_EQ(snapshot.step, expected.step);
  EXPECT_EQ(snapshot.topology_version, expected.topology_version);
  EXPECT_EQ(snapshot.points, expected.points);
  EXPECT_EQ(snapshot.topology.connectivity, expected.topology.connectivity);
  EXPECT_EQ(snapshot.topology.offset, expected.topology.offset);
  expect_same(snapshot.point_fields, expected.point_fields);
  expect_same(snapshot.cell_fields, expected.cell_fields);
}

TEST(Snapshots, FilledByTurnsAreThoseOfOneAndTheOtherStays) {
  // The farther from the start, the earlier an element goes.
  Deck deck = stretched_bar(4, brittle(0.02, 0.05), 1);
  for (std::size_t i = 1; i <= 4; ++i)
    std::get<PrescribedMotion>(deck.boundary_conditions[1 + i]).components[0].curve =
        Curve{{{0, 0.5 * static_cast<double>(i * i)}}};
  Model model = build_model(deck);
  FieldObserver one(model), two(model);
  two.observe(model);
  Snapshot last;
  std::int64_t deleted = 0;
  ThreadTeam team(1);
  run(model, deck, team, [&](Model& m) {
    const Snapshot& before = two.observe(m);
    last = before;
    expect_same(before, one.observe(m));
    if (m.step % 3 != 0) two.turn();
    const Snapshot& now = two.observe(m);
    expect_same(now, last);
    if (m.step % 3 != 0) expect_same(before, last);
    EXPECT_EQ(&now == &before, m.step % 3 == 0);
    deleted = m.erosion->total_deleted();
  });
  EXPECT_GE(deleted, 3);
}

}  // namespace
}  // namespace brio
