/// The edge check judged by exact rational arithmetic on queries chosen to be difficult.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include "src/base/index.hpp"
#include "tests/contact/geometry/adversarial_edges.hpp"
#include "tests/contact/geometry/exact_edges.hpp"
#include "tests/contact/geometry/exact_geometry.hpp"

namespace brio {
namespace {

struct EdgeTally {
  int queries = 0;
  int touching = 0;  // by exact arithmetic
  int reported = 0;
  int false_positives = 0;
  int false_negatives = 0;
  int late = 0;    // reported after the exact first touch
  int beyond = 0;  // farther at the reported time than the stated tolerance, or not on the edges
  int sided = 0;
  int wrong_side = 0;
  int without_normal = 0;
  int wrong_normal = 0;
};

using Extended = std::array<long double, 3>;

Extended difference(const Vector3d& a, const Vector3d& b) {
  Extended result;
  for (int k = 0; k < 3; ++k) result[index(k)] = static_cast<long double>(a[k]) - b[k];
  return result;
}

// The tolerance that is promised, from its definition, in extended precision.
double promised_tolerance(const EdgeQuery& query) {
  const auto largest = [](const Extended& d) {
    return std::max({std::abs(d[0]), std::abs(d[1]), std::abs(d[2])});
  };
  long double scale = 0;
  for (std::size_t i = 0; i < 2; ++i)
    for (std::size_t j = 0; j < 2; ++j)
      scale = std::max(scale, largest(difference(query.a.start[i], query.b.start[j])) +
                                  largest(difference(query.a.displacement[i], query.b.displacement[j])));
  return static_cast<double>(1.5e-14L * (scale + query.a.radius + query.b.radius));
}

Vector3d place_along(const MovingEdge& edge, double time) {
  Vector3d result;
  const Extended start = difference(edge.start[1], edge.start[0]);
  const Extended displacement = difference(edge.displacement[1], edge.displacement[0]);
  for (std::size_t k = 0; k < 3; ++k)
    result[static_cast<int>(k)] = static_cast<double>(start[k] + time * displacement[k]);
  return result;
}

// The side is a statement on the volume: somewhere before the contact it surely had that sign.
bool side_was_seen(const EdgeQuery& query, const EdgeContact& contact) {
  if (contact.time == 0) return exact::side_at(query.a, query.b, 0) == contact.side;
  for (int k = 0; k <= 8; ++k)
    if (exact::side_at(query.a, query.b, contact.time * k / 8) == contact.side) return true;
  for (int k = 4; k < 60; ++k)
    if (exact::side_at(query.a, query.b, contact.time * (1 - std::ldexp(1.0, -k))) == contact.side)
      return true;
  return false;
}

// A unit vector; without a distance, along the common perpendicular to the side that a comes from.
bool normal_is_right(const EdgeQuery& query, const EdgeContact& contact, double tolerance) {
  if (std::abs(norm(contact.normal) - 1) > 1e-14) return false;
  const bool insides =
      contact.features[0] == SegmentFeature::inside && contact.features[1] == SegmentFeature::inside;
  if (!insides || contact.side == 0 || contact.distance > 8 * tolerance) return true;
  const Vector3d a = place_along(query.a, contact.time);
  const Vector3d b = place_along(query.b, contact.time);
  const Vector3d perpendicular = cross(a, b);
  if (norm(perpendicular) < 1e-6 * norm(a) * norm(b)) return true;
  return contact.side * dot(contact.normal, perpendicular) > (1 - 1e-9) * norm(perpendicular);
}

void judge(const EdgeQuery& query, EdgeTally& tally) {
  ++tally.queries;
  std::optional<exact::Number> truth = exact::first_contact(query.a, query.b);
  const std::optional<EdgeContact> contact = edge_check(query.a, query.b);
  tally.touching += truth.has_value();
  tally.reported += contact.has_value();
  tally.false_positives += contact && !truth;
  tally.false_negatives += truth && !contact;
  if (!contact) return;
  if (truth) tally.late += exact::compare(*truth, exact::dyadic(contact->time)) < 0;
  const double tolerance = promised_tolerance(query);
  bool near = exact::within(query.a, query.b, contact->time, tolerance) &&
              exact::points_within(query.a, query.b, contact->parameters, contact->time, tolerance);
  for (const double parameter : contact->parameters) near = near && parameter >= 0 && parameter <= 1;
  tally.beyond += !near;
  tally.sided += contact->side != 0;
  tally.wrong_side += contact->side != 0 && !side_was_seen(query, *contact);
  const bool has_normal = !is_zero(contact->normal);
  tally.without_normal += !has_normal;
  tally.wrong_normal += has_normal ? !normal_is_right(query, *contact, tolerance)
                                   : contact->time > 0 || contact->distance > tolerance;
}

void judge_family(EdgeFamily family, int queries, std::uint64_t seed) {
  Random random(seed + static_cast<std::uint64_t>(family));
  EdgeTally tally;
  for (int i = 0; i < queries; ++i) judge(adversarial_edges(family, random), tally);
  const int apart = tally.queries - tally.touching;
  std::printf(
      "%-17s queries %6d, touching %6d, reported %6d, false negatives %d, false positives %d (%.2f %% of "
      "%d), "
      "with a side %d, without a normal %d\n",
      std::string(name_of(family)).c_str(), tally.queries, tally.touching, tally.reported,
      tally.false_negatives, tally.false_positives, apart > 0 ? 100.0 * tally.false_positives / apart : 0.0,
      apart, tally.sided, tally.without_normal);
  EXPECT_EQ(tally.false_negatives, 0);
  EXPECT_EQ(tally.late, 0);
  EXPECT_EQ(tally.beyond, 0);
  EXPECT_EQ(tally.wrong_side, 0);
  EXPECT_EQ(tally.wrong_normal, 0);
  EXPECT_GT(tally.touching, 0);
  EXPECT_EQ(tally.reported, tally.touching + tally.false_positives);
}

class EdgeCheckExact : public testing::TestWithParam<int> {};
class EdgeCheckExactSlow : public testing::TestWithParam<int> {};

// 36,000 queries here, 200,000 below.
TEST_P(EdgeCheckExact, MissesNothingAndIsNeverFarFromTouch) {
  judge_family(static_cast<EdgeFamily>(GetParam()), 2000, 1);
}
TEST_P(EdgeCheckExactSlow, MissesNothingInManyQueries) {
  judge_family(static_cast<EdgeFamily>(GetParam()), 11000, 1000);
}

std::string edge_family_name(const testing::TestParamInfo<int>& info) {
  std::string name(name_of(static_cast<EdgeFamily>(info.param)));
  std::replace(name.begin(), name.end(), ' ', '_');
  return name;
}

INSTANTIATE_TEST_SUITE_P(Families, EdgeCheckExact, testing::Range(0, edge_family_count), edge_family_name);
INSTANTIATE_TEST_SUITE_P(Families, EdgeCheckExactSlow, testing::Range(0, edge_family_count),
                         edge_family_name);

}  // namespace
}  // namespace brio
