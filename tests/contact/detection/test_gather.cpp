/// Gathered lanes hold the positions of the nodes listed, from records and from compact arrays.

#include "contact/features/gather.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "src/base/index.hpp"
#include "tests/contact/detection/packs.hpp"
#include "tests/contact/geometry/adversarial_queries.hpp"

namespace brio {
namespace {

template <class Rows>
double* position(Rows& rows, std::size_t node) {
  if constexpr (requires { rows[node].position; }) {
    return rows[node].position;
  } else {
    return rows[node].component;
  }
}

template <class Record>
void expect_positions() {
  Random random(81);
  AlignedBuffer<Record> rows(100);
  for (std::size_t node = 0; node < rows.size(); ++node)
    for (int i = 0; i < 3; ++i) position(rows, node)[i] = random.uniform(-1, 1);
  for (int repetition = 0; repetition < 100; ++repetition) {
    int node[8];
    for (int& each : node) each = random.integer(0, 99);
    const Vector3<Pack> packed = gather<Pack>(&rows[0], node);
    for (int lane = 0; lane < 8; ++lane) {
      const double* expected = position(rows, index(node[lane]));
      EXPECT_EQ(packed.x[lane], expected[0]);
      EXPECT_EQ(packed.y[lane], expected[1]);
      EXPECT_EQ(packed.z[lane], expected[2]);
      EXPECT_TRUE(same_bits(packed, lane, gather<double>(&rows[0], node + lane)));
    }
  }
}

TEST(Gather, FromNodeRecords) { expect_positions<NodeRecord>(); }
TEST(Gather, FromCompactPoints) { expect_positions<PointRow>(); }

}  // namespace
}  // namespace brio
