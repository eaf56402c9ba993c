// J2 plasticity by tables against the exact solutions of proportional loading, and the polygon itself against
// a search through all of its pieces.

#include "materials/tabulated/tabulated_plasticity.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <vector>

#include "tests/materials/paths.hpp"

namespace brio {
namespace {

constexpr double young = 200e9;
constexpr double poisson = 0.3;
constexpr double shear_modulus = young / (2 * (1 + poisson));

using Rows = std::vector<std::array<double, 2>>;

// A plateau, hardening of three slopes, and softening.
const Rows steel{{0, 350e6}, {0.01, 350e6}, {0.03, 420e6}, {0.1, 500e6}, {0.3, 560e6}, {0.5, 480e6}};

TabulatedPlasticity law_of(const Rows& rows, BeyondTable beyond = BeyondTable::constant) {
  TabulatedPlasticity law{7800, young, poisson, yield_table(rows, beyond)};
  law.time_step = 1e-6;
  return law;
}

TabulatedPlasticity law_of_rates(const std::vector<std::pair<double, Rows>>& tables) {
  std::vector<YieldCurve> curves;
  for (const auto& [rate, rows] : tables) curves.push_back({rows, rate});
  TabulatedPlasticity law{
      7800, young, poisson, {std::make_shared<const YieldTable>(curves, BeyondTable::constant)}};
  return law;
}

double table_at(const Rows& rows, double strain) {
  for (std::size_t i = 1; i < rows.size(); ++i)
    if (strain < rows[i][0])
      return rows[i - 1][1] +
             (rows[i][1] - rows[i - 1][1]) * (strain - rows[i - 1][0]) / (rows[i][0] - rows[i - 1][0]);
  return rows.back()[1];
}

/// Plastic strain of proportional loading: strain = q / modulus + factor p with q = table(p), by bisection.
double plastic_strain_of(const std::function<double(double)>& yield_stress, double strain, double modulus,
                         double factor) {
  long double low = 0, high = static_cast<long double>(strain) / factor;
  for (int k = 0; k < 100; ++k) {
    const long double middle = (low + high) / 2;
    const long double total =
        yield_stress(static_cast<double>(middle)) / static_cast<long double>(modulus) + factor * middle;
    (total < strain ? low : high) = middle;
  }
  return static_cast<double>(low);
}

struct Point {
  double stress, plastic_strain;
};

/// Loads to a strain in steps of one size; all numbers of a path are of one component.
Point tension(const TabulatedPlasticity& law, double strain, int steps) {
  FibreTensor<double> stress{};
  TabulatedPlasticity::History<double> history{};
  for (int k = 0; k < steps; ++k)
    law.update_fibre(FibreTensor<double>{strain / steps, 0, 0}, stress, history);
  return {stress.xx, history.equivalent_plastic_strain};
}
Point shear(const TabulatedPlasticity& law, double strain, int steps) {
  SymmetricTensor<double> stress{};
  TabulatedPlasticity::History<double> history{};
  for (int k = 0; k < steps; ++k)
    law.update(SymmetricTensor<double>{0, 0, 0, strain / steps, 0, 0}, stress, history);
  return {stress.xy * std::sqrt(3.0), history.equivalent_plastic_strain};
}
Point equal_biaxial(const TabulatedPlasticity& law, double strain, int steps) {
  ShellTensor<double> stress{};
  TabulatedPlasticity::History<double> history{};
  for (int k = 0; k < steps; ++k) {
    double thickness = 0;
    law.update_plane_stress(ShellTensor<double>{strain / steps, strain / steps, 0, 0, 0}, 1.0, stress,
                            history, thickness);
  }
  return {stress.xx, history.equivalent_plastic_strain};
}

void expect_near_exact(const Point& point, double plastic_strain, double yield_stress) {
  EXPECT_NEAR(point.plastic_strain, plastic_strain, 1e-10 * plastic_strain);
  EXPECT_NEAR(point.stress, yield_stress, 1e-10 * yield_stress);
}

// Of proportional loading the return is exact for steps of any size, whatever rows lie within.
TEST(TabulatedPlasticity, TensionShearAndBiaxialStressFollowTheTable) {
  const TabulatedPlasticity law = law_of(steel);
  const auto yield_stress = [](double p) { return table_at(steel, p); };
  for (const double strain : {0.005, 0.02, 0.15, 0.4, 0.9})
    for (const int steps : {1, 7, 1000}) {
      SCOPED_TRACE(std::to_string(strain) + " in " + std::to_string(steps));
      const double in_tension = plastic_strain_of(yield_stress, strain, young, 1);
      expect_near_exact(tension(law, strain, steps), in_tension, yield_stress(in_tension));
      const double root = std::sqrt(3.0);
      const double in_shear = plastic_strain_of(yield_stress, strain, 2 * shear_modulus * root, root / 2);
      expect_near_exact(shear(law, strain, steps), in_shear, yield_stress(in_shear));
      const double in_plane = plastic_strain_of(yield_stress, strain, young / (1 - poisson), 0.5);
      expect_near_exact(equal_biaxial(law, strain, steps), in_plane, yield_stress(in_plane));
    }
}

TEST(TabulatedPlasticity, BeyondTheLastRowTheStressStaysOrGoesOn) {
  const Rows rows{{0, 300e6}, {0.1, 400e6}};
  EXPECT_NEAR(tension(law_of(rows), 1, 1000).stress, 400e6, 1e-4);
  const Point end = tension(law_of(rows, BeyondTable::last_slope), 1, 1000);
  EXPECT_NEAR(end.stress, 300e6 + 1e9 * end.plastic_strain, 1e-4);
  EXPECT_GT(end.plastic_strain, 0.99);
}

const Rows slow{{0, 300e6}, {0.1, 400e6}};
const Rows middle{{0, 350e6}, {0.05, 420e6}, {0.2, 430e6}};
const Rows fast{{0, 500e6}, {0.1, 520e6}};

// Strain rates on, between, below and above those of the tables; curves of other strains each.
TEST(TabulatedPlasticity, StressIsInterpolatedInTheLogarithmOfTheRate) {
  TabulatedPlasticity law = law_of_rates({{1, slow}, {100, middle}, {1e4, fast}});
  const double strain = 0.12;
  const int steps = 200;
  const auto expect_at = [&](double rate, const Rows& below, const Rows& above, double share) {
    SCOPED_TRACE(rate);
    law.time_step = strain / steps / rate;
    const auto yield_stress = [&](double p) {
      return (1 - share) * table_at(below, p) + share * table_at(above, p);
    };
    const double p = plastic_strain_of(yield_stress, strain, young, 1);
    expect_near_exact(tension(law, strain, steps), p, yield_stress(p));
    const double root = std::sqrt(3.0);
    // The rate of shear is 2 / sqrt(3) of the component.
    const double shear_strain = strain * root / 2;
    const double p_shear = plastic_strain_of(yield_stress, shear_strain, 2 * shear_modulus * root, root / 2);
    expect_near_exact(shear(law, shear_strain, steps), p_shear, yield_stress(p_shear));
    // Two of a plane, half as large each, make one across.
    const double p_plane = plastic_strain_of(yield_stress, strain / 2, young / (1 - poisson), 0.5);
    expect_near_exact(equal_biaxial(law, strain / 2, steps), p_plane, yield_stress(p_plane));
  };
  expect_at(0.1, slow, middle, 0);
  expect_at(1, slow, middle, 0);
  expect_at(10, slow, middle, 0.5);
  expect_at(100, middle, fast, 0);
  expect_at(std::pow(10, 3.2), middle, fast, 0.6);
  expect_at(1e4, middle, fast, 1);
  expect_at(1e7, middle, fast, 1);
}

TEST(TabulatedPlasticity, CowperAndSymondsMultiplyTheTable) {
  TabulatedPlasticity law = law_of(steel);
  law.cowper_symonds = CowperSymonds{40.4, 5};
  const double strain = 0.2;
  const int steps = 100;
  for (const double rate : {0.01, 40.4, 1e3}) {
    law.time_step = strain / steps / rate;
    const double factor = 1 + std::pow(rate / 40.4, 0.2);
    const auto yield_stress = [&](double p) { return factor * table_at(steel, p); };
    const double p = plastic_strain_of(yield_stress, strain, young, 1);
    expect_near_exact(tension(law, strain, steps), p, yield_stress(p));
  }
}

TEST(TabulatedPlasticity, StressIsThatOfTheTableOnAnyPath) {
  const TabulatedPlasticity law = law_of(steel);
  RandomPath path(3);
  SymmetricTensor<double> stress{};
  TabulatedPlasticity::History<double> history{};
  int yielded = 0;
  for (int k = 0; k < 2000; ++k) {
    const double before = history.equivalent_plastic_strain;
    law.update(path.next(), stress, history);
    const double bound = table_at(steel, history.equivalent_plastic_strain);
    ASSERT_LE(von_mises(deviator(stress)), bound * (1 + 1e-12));
    if (history.equivalent_plastic_strain == before) continue;
    ++yielded;
    ASSERT_NEAR(von_mises(deviator(stress)), bound, 1e-12 * bound);
  }
  EXPECT_GT(yielded, 500);
}

/// Rows of any number and steepness, softening among them.
Rows random_rows(RandomPath& random) {
  Rows rows{{0, 300e6}};
  const int count = static_cast<int>(random.uniform(0, 40));
  for (int k = 0; k < count; ++k) {
    const double strain = rows.back()[0] + std::pow(10, random.uniform(-5, -1));
    const double slope = random.uniform(0, 1) < 0.3 ? -random.uniform(0, 1e8) : random.uniform(0, 1e11);
    const double stress = rows.back()[1] + slope * (strain - rows.back()[0]);
    if (stress > 0) rows.push_back({strain, stress});
  }
  return rows;
}

/// Where the line meets the polygon, piece by piece.
double crossing(const Rows& rows, double start, double height, double fall) {
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const bool is_last = i + 1 == rows.size();
    const long double slope =
        is_last ? 0 : (rows[i + 1][1] - rows[i][1]) / static_cast<long double>(rows[i + 1][0] - rows[i][0]);
    const long double end =
        (height + fall * static_cast<long double>(start) - rows[i][1] + slope * rows[i][0]) / (fall + slope);
    if (is_last || end < rows[i + 1][0]) return static_cast<double>(end);
  }
  return 0;
}

TEST(TabulatedHardening, MeetsTheFallingLineOfEveryLane) {
  using T = Lanes<double>;
  RandomPath random(5);
  for (int round = 0; round < 300; ++round) {
    const Rows rows = random_rows(random);
    const SharedYieldTable table = yield_table(rows);
    const TabulatedHardening<T> hardening{table.table.get(), T(1.0), T(0.0)};
    const double fall = std::pow(10, random.uniform(11, 12));
    T start, stress;
    for (int lane = 0; lane < 8; ++lane) {
      start.set(lane, lane == 0 ? 0 : rows.back()[0] * random.uniform(0, 1.2));
      stress.set(lane, table_at(rows, start[lane]) * (1 + std::pow(10, random.uniform(-12, 2))));
    }
    const HardeningPoint<T> end = hardening.meet(hardening.at(start), stress, T(fall));
    for (int lane = 0; lane < 8; ++lane) {
      const double expected = crossing(rows, start[lane], stress[lane], fall);
      ASSERT_NEAR(end.plastic_strain[lane], expected, 1e-12 * expected + 1e-15 * stress[lane] / fall) << lane;
      ASSERT_NEAR(end.stress[lane], table_at(rows, expected),
                  1e-12 * end.stress[lane] + 1e-15 * stress[lane]);
    }
  }
}

// A corner from both sides, and rates that come with it.
TEST(TabulatedHardening, ACornerBelongsToThePieceThatBeginsThere) {
  const SharedYieldTable table = yield_table(steel);
  const TabulatedHardening<double> hardening{table.table.get(), 1, 0};
  for (std::size_t i = 0; i + 1 < steel.size(); ++i) {
    const HardeningPoint<double> corner = hardening.at(steel[i][0]);
    EXPECT_EQ(corner.stress, steel[i][1]);
    EXPECT_EQ(corner.slope, (steel[i + 1][1] - steel[i][1]) / (steel[i + 1][0] - steel[i][0]));
    EXPECT_EQ(hardening.end_of_piece(corner), steel[i + 1][0]);
  }
}

TEST(TabulatedPlasticity, ParametersThatDoNotGoTogetherAreFaults) {
  EXPECT_EQ(law_of(steel).fault(), "");
  EXPECT_NE(law_of({{0, 300e6}, {1e-3, 100e6}}).fault().find("too steeply"), std::string_view::npos);
  TabulatedPlasticity twice = law_of_rates({{1, slow}, {100, fast}});
  EXPECT_EQ(twice.fault(), "");
  twice.cowper_symonds = CowperSymonds{1, 5};
  EXPECT_NE(twice.fault().find("one of them"), std::string_view::npos);
}

}  // namespace
}  // namespace brio
