#pragma once
/// The law of the parts of a snapshot.

#include <gtest/gtest.h>

#include <algorithm>

#include "src/base/index.hpp"
#include "src/output/snapshot.hpp"

namespace brio::test {

/// Parts follow one another, hold all cells, each its own, and the points that these refer to.
inline void expect_parts_hold_their_cells(const Snapshot& snapshot) {
  const auto part_of_cell = std::ranges::find(snapshot.cell_fields, "part", &FieldArray::name);
  ASSERT_NE(part_of_cell, snapshot.cell_fields.end());
  const Topology& topology = snapshot.topology;
  std::int64_t cell = 0;
  for (std::size_t p = 0; p < snapshot.parts.size(); ++p) {
    const SnapshotPart& part = snapshot.parts[p];
    EXPECT_EQ(part.first_cell, cell);
    EXPECT_LE(3 * (part.first_point + part.points), static_cast<std::int64_t>(snapshot.points.size()));
    for (; cell < part.first_cell + part.cells; ++cell) {
      const auto at = index(cell);
      EXPECT_EQ(part_of_cell->values[at], static_cast<double>(p));
      EXPECT_EQ(topology.cell_type[at], topology.cell_type[index(part.first_cell)]);
      for (std::int64_t i = topology.offset[at]; i < topology.offset[at + 1]; ++i) {
        EXPECT_GE(topology.connectivity[index(i)], part.first_point);
        EXPECT_LT(topology.connectivity[index(i)], part.first_point + part.points);
      }
    }
  }
  EXPECT_EQ(cell, static_cast<std::int64_t>(topology.cell_type.size()));
}

}  // namespace brio::test
