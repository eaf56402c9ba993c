/// The velocity check judged by exact rational arithmetic on queries chosen to be difficult.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include "tests/contact/geometry/adversarial_queries.hpp"
#include "tests/contact/geometry/exact_geometry.hpp"
#include "tests/contact/geometry/exact_judge.hpp"

namespace brio {
namespace {

struct Tally {
  int queries = 0;
  int touching = 0;  // by exact arithmetic
  int reported = 0;
  int false_positives = 0;
  int false_negatives = 0;
  int late = 0;    // reported after the exact first touch
  int beyond = 0;  // farther at the reported time than the stated tolerance, or the weights are wrong
  int wrong_side = 0;
};

// The tolerance that is promised, from its definition, in extended precision.
double promised_tolerance(const Query& query) {
  const auto largest = [](const Vector3d& a, const Vector3d& b) {
    long double most = 0;
    for (int k = 0; k < 3; ++k) most = std::max(most, std::abs(static_cast<long double>(a[k]) - b[k]));
    return most;
  };
  const MovingFace& face = query.face;
  long double size = 0;
  for (std::size_t k = 0; k < 4; ++k)
    size = std::max(
        size, largest(face.start[k], face.start[0]) + largest(face.displacement[k], face.displacement[0]));
  const long double scale = largest(query.node.start, face.start[0]) +
                            largest(query.node.displacement, face.displacement[0]) + size;
  return static_cast<double>(1.5e-14L * scale);
}

void judge(const Query& query, Tally& tally) {
  ++tally.queries;
  std::optional<exact::Number> truth = exact::first_contact(query.node, query.face);
  const std::optional<VelocityContact> contact = velocity_check(query.node, query.face);
  tally.touching += truth.has_value();
  tally.reported += contact.has_value();
  tally.false_positives += contact && !truth;
  tally.false_negatives += truth && !contact;
  if (!contact) return;
  if (truth) tally.late += exact::compare(*truth, exact::dyadic(contact->time)) < 0;
  double sum = 0;
  bool negative = false;
  for (const double weight : contact->weights) {
    sum += weight;
    negative = negative || weight < 0;
  }
  const double tolerance = promised_tolerance(query);
  const bool near = exact::within(query.node, query.face, contact->time, tolerance) &&
                    exact::point_within(query.node, query.face, contact->weights, contact->time, tolerance);
  tally.beyond += !near || negative || std::abs(sum - 1) > 1e-15;
  if (contact->side != 0 && contact->time > 0) {
    // The side is a statement on the cubic: somewhere before the contact the node was surely there.
    bool seen = false;
    for (int k = 0; k <= 8 && !seen; ++k)
      seen = exact::side_at(query.node, query.face, contact->sub_triangle, contact->time * k / 8) ==
             contact->side;
    for (int k = 4; k < 60 && !seen; ++k)
      seen = exact::side_at(query.node, query.face, contact->sub_triangle,
                            contact->time * (1 - std::ldexp(1.0, -k))) == contact->side;
    tally.wrong_side += !seen;
  }
}

void judge_family(Family family, int queries, std::uint64_t seed) {
  Random random(seed + static_cast<std::uint64_t>(family));
  Tally tally;
  for (int i = 0; i < queries; ++i) judge(adversarial_query(family, random), tally);
  const int apart = tally.queries - tally.touching;
  std::printf(
      "%-16s queries %7d, touching %7d, reported %7d, false negatives %d, false positives %d (%.2f %% of "
      "%d)\n",
      std::string(name_of(family)).c_str(), tally.queries, tally.touching, tally.reported,
      tally.false_negatives, tally.false_positives, apart > 0 ? 100.0 * tally.false_positives / apart : 0.0,
      apart);
  EXPECT_EQ(tally.false_negatives, 0);
  EXPECT_EQ(tally.late, 0);
  EXPECT_EQ(tally.beyond, 0);
  EXPECT_EQ(tally.wrong_side, 0);
  EXPECT_GT(tally.touching, 0);
  EXPECT_EQ(tally.reported, tally.touching + tally.false_positives);
}

class VelocityCheckExact : public testing::TestWithParam<int> {};
class VelocityCheckExactSlow : public testing::TestWithParam<int> {};

// 50,400 queries here, 250,000 below.
TEST_P(VelocityCheckExact, MissesNothingAndIsNeverFarFromTheFace) {
  judge_family(static_cast<Family>(GetParam()), 3600, 1);
}
TEST_P(VelocityCheckExactSlow, MissesNothingInManyQueries) {
  judge_family(static_cast<Family>(GetParam()), 18000, 1000);
}

std::string family_name(const testing::TestParamInfo<int>& info) {
  std::string name(name_of(static_cast<Family>(info.param)));
  std::replace(name.begin(), name.end(), ' ', '_');
  return name;
}

INSTANTIATE_TEST_SUITE_P(Families, VelocityCheckExact, testing::Range(0, family_count), family_name);
INSTANTIATE_TEST_SUITE_P(Families, VelocityCheckExactSlow, testing::Range(0, family_count), family_name);

}  // namespace
}  // namespace brio
