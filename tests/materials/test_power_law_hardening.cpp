#include <gtest/gtest.h>

#include <algorithm>
#include <boost/multiprecision/cpp_dec_float.hpp>

#include "materials/power_law_hardening.hpp"
#include "tests/materials/paths.hpp"

namespace brio {
namespace {

using Exact = boost::multiprecision::cpp_dec_float_50;

constexpr double young = 200e9;
constexpr double poisson = 0.3;

/// Plastic strain beyond the plateau: of which fifty digits of the strain would leave off what is next to its
/// end.
Exact beyond_plateau(const PowerHardening& law, double plastic_strain, double rest) {
  return (Exact(plastic_strain) - Exact(law.luders_strain)) + Exact(rest);
}

Exact exact_yield_stress(const PowerHardening& law, const Exact& beyond) {
  if (beyond <= 0) return Exact(law.yield_stress);
  return Exact(law.yield_stress) + Exact(law.constant) * pow(beyond, Exact(law.exponent));
}

/// dp of: effective_stress - stiffness dp = yield stress(start + dp); \param start beyond the plateau.
/// Bisection in the logarithm of the strain u beyond the plateau, which may span many decades, and then
/// Newton's method.
Exact exact_increment(const PowerHardening& law, const Exact& start, double effective_stress,
                      double stiffness) {
  const Exact over_plateau = Exact(effective_stress) - Exact(law.yield_stress);
  const Exact base = -start;
  const Exact height = over_plateau - Exact(stiffness) * base;
  if (height <= 0) return over_plateau / Exact(stiffness);
  const auto missing = [&](const Exact& u) -> Exact {
    return height - Exact(stiffness) * u - Exact(law.constant) * pow(u, Exact(law.exponent));
  };
  Exact low("1e-30000"), high = height / Exact(stiffness);
  for (int k = 0; k < 60; ++k) {
    const Exact middle = sqrt(low * high);
    (missing(middle) > 0 ? low : high) = middle;
  }
  Exact u = low;
  for (int k = 0; k < 4; ++k) {
    const Exact slope =
        Exact(stiffness) + Exact(law.exponent) * Exact(law.constant) * pow(u, Exact(law.exponent) - 1);
    u += missing(u) / slope;
  }
  return base + u;
}

double spacing(double x) { return std::nextafter(std::abs(x), HUGE_VAL) - std::abs(x); }

struct Case {
  PowerHardening law;
  double start, rest, effective_stress, stiffness;
};

Case random_case(RandomPath& random) {
  const double exponents[] = {0.05, 0.1, 0.294, 0.5, 0.9, 1.0, random.uniform(0.05, 1)};
  const double ludersen[] = {0, 0, 0.005, 0.02, random.uniform(0, 0.1)};
  Case c;
  c.law = {350e6, random.uniform(0, 1) < 0.05 ? 0 : 350e6 * std::pow(10.0, random.uniform(-4, 3)),
           exponents[static_cast<int>(random.uniform(0, 7))],
           ludersen[static_cast<int>(random.uniform(0, 5))]};
  const double luders = c.law.luders_strain;
  const double beyond = std::pow(10.0, random.uniform(-18, 1));
  const double starts[] = {0,
                           luders,
                           std::nextafter(luders, 0),
                           std::nextafter(luders, 1),
                           luders + beyond,
                           luders + beyond,
                           luders * random.uniform(0, 1)};
  c.start = starts[static_cast<int>(random.uniform(0, 7))];
  c.stiffness = 3 * young / 2.6;
  // Next to the end of the plateau, below the last digit of the strain there.
  c.rest = c.start == luders ? std::pow(10.0, random.uniform(-60, -19)) : 0;
  const double yield = c.law.at(c.start, c.rest).stress;
  c.effective_stress = yield * (1 + std::pow(10.0, random.uniform(-16, 4)));
  return c;
}

/// The stress is that of the strain; up to a strain of 1e-200 beyond the plateau, which no line tells from
/// its end, that of any strain there.
void expect_on_curve(const PowerHardening& law, const HardeningPoint<double>& end) {
  const Exact beyond = beyond_plateau(law, end.plastic_strain, end.rest);
  const Exact yield = exact_yield_stress(law, beyond);
  if (beyond <= Exact("1e-200")) {
    const Exact most = exact_yield_stress(law, Exact("1e-200"));
    ASSERT_LE(static_cast<double>(yield / Exact(end.stress)), 1 + 1e-15);
    ASSERT_LE(static_cast<double>(Exact(end.stress) / most), 1 + 1e-15);
  } else {
    ASSERT_LE(static_cast<double>(abs(Exact(end.stress) / yield - 1)), 1e-12);
  }
}

void expect_fifty_digits(unsigned seed, int cases) {
  RandomPath random(seed);
  for (int k = 0; k < cases; ++k) {
    const Case c = random_case(random);
    const HardeningPoint<double> end = c.law.meet(c.law.at(c.start, c.rest), c.effective_stress, c.stiffness);
    ASSERT_TRUE(std::isfinite(end.plastic_strain) && std::isfinite(end.stress));
    expect_on_curve(c.law, end);
    const Exact start = beyond_plateau(c.law, c.start, c.rest);
    const Exact increment = exact_increment(c.law, start, c.effective_stress, c.stiffness);
    // The yield stress at the start is a rounded number: what that does to the increment is no error of the
    // solution.
    const double allowed = 4 * spacing(c.effective_stress) / c.stiffness;
    const Exact flow = beyond_plateau(c.law, end.plastic_strain, end.rest) - start;
    const double strain_error = static_cast<double>(abs(flow - increment));
    const Exact line = Exact(c.effective_stress) - Exact(c.stiffness) * increment;
    ASSERT_LE(static_cast<double>(abs(Exact(end.stress) - line)),
              1e-12 * end.stress + 2 * spacing(c.effective_stress))
        << k;
    ASSERT_LE(strain_error, allowed + 1e-12 * static_cast<double>(increment))
        << k << " n " << c.law.exponent << " A " << c.law.constant << " start " << c.start << " luders "
        << c.law.luders_strain << " q " << c.effective_stress;
  }
}

TEST(PowerHardening, MeetsTheFallingLineToRoundOffOfFiftyDigits) { expect_fifty_digits(11, 200); }
TEST(PowerHardeningSlow, MeetsTheFallingLineToRoundOffOfFiftyDigits) { expect_fifty_digits(17, 1500); }

TEST(PowerHardening, LanesAgreeWithPlainNumbers) {
  RandomPath random(12);
  for (int round = 0; round < 400; ++round) {
    Case c = random_case(random);
    Lanes<double> start, rest, stress;
    double starts[8], rests[8], stresses[8];
    for (int lane = 0; lane < 8; ++lane) {
      const Case other = random_case(random);
      starts[lane] = other.start;
      const double ratio = other.effective_stress / other.law.at(other.start, other.rest).stress;
      stresses[lane] = c.law.at(other.start, other.rest).stress * (lane == 3 ? 1.0 : ratio);
      rests[lane] = other.rest;
      start.set(lane, starts[lane]);
      rest.set(lane, rests[lane]);
      stress.set(lane, stresses[lane]);
    }
    const auto end = c.law.meet(c.law.at(start, rest), stress, Lanes<double>(c.stiffness));
    for (int lane = 0; lane < 8; ++lane) {
      const auto expected = c.law.meet(c.law.at(starts[lane], rests[lane]), stresses[lane], c.stiffness);
      ASSERT_NEAR(end.plastic_strain[lane], expected.plastic_strain,
                  4 * spacing(expected.plastic_strain) + 1e-12 * (expected.plastic_strain - starts[lane]) +
                      1e-13 * stresses[lane] / c.stiffness);
      expect_on_curve(c.law, {end.plastic_strain[lane], end.stress[lane], end.slope[lane], end.rest[lane]});
    }
  }
}

/// Plastic strain beyond the plateau, in single precision.
float flow_of(const HardeningPoint<float>& point, double luders) {
  return (point.plastic_strain - static_cast<float>(luders)) + point.rest;
}

TEST(PowerHardening, SinglePrecisionFollowsDouble) {
  RandomPath random(13);
  for (int k = 0; k < 20000; ++k) {
    const Case c = random_case(random);
    using T = Lanes<float>;
    const auto start = static_cast<float>(c.start);
    const float yield = c.law.at(T(c.start)).stress[0];
    const float stress = yield * static_cast<float>(1 + std::pow(10.0, random.uniform(-7, 4)));
    const auto lanes = c.law.meet(c.law.at(T(c.start)), T(static_cast<double>(stress)), T(c.stiffness));
    const HardeningPoint<float> end{lanes.plastic_strain[0], lanes.stress[0], lanes.slope[0], lanes.rest[0]};
    ASSERT_TRUE(std::isfinite(end.plastic_strain) && std::isfinite(end.stress));
    const float curve = c.law.at(lanes.plastic_strain, lanes.rest).stress[0];
    if (flow_of(end, c.law.luders_strain) > 0) {
      ASSERT_NEAR(end.stress / curve, 1, 4e-6);
    } else {
      // On the plateau, or at its end where the curve is too steep for single precision: that of the line.
      const double line = static_cast<double>(stress) -
                          c.stiffness * (static_cast<double>(end.plastic_strain) - start + end.rest);
      ASSERT_NEAR(end.stress, std::max(line, static_cast<double>(curve)), 4e-6 * end.stress + 2e-7 * stress);
      ASSERT_GE(end.stress, curve * (1 - 1e-6F));
    }
    const auto exact =
        c.law.meet(c.law.at(static_cast<double>(start)), static_cast<double>(stress), c.stiffness);
    const double spacing_of_strain = std::nextafter(end.plastic_strain, HUGE_VALF) - end.plastic_strain;
    const double spacing_of_stress = std::nextafter(stress, HUGE_VALF) - stress;
    ASSERT_NEAR(static_cast<double>(end.plastic_strain), exact.plastic_strain,
                4 * spacing_of_strain + 8 * spacing_of_stress / c.stiffness +
                    1e-5 * (exact.plastic_strain - c.start));
  }
}

// Far beyond any metal: the search must come to its end, which it says by a number.
template <Floating Real>
void expect_found(unsigned seed) {
  using T = Lanes<Real>;
  RandomPath random(seed);
  const auto decades = [&](double low, double high) { return std::pow(10.0, random.uniform(low, high)); };
  for (int k = 0; k < 100000; ++k) {
    const double yield = decades(0, 10);
    const double exponent = random.uniform(0, 1) < 0.5 ? decades(-3, 0) : random.uniform(0.05, 1);
    const double luders = random.uniform(0, 1) < 0.5 ? 0 : decades(-6, 0);
    const double constant = random.uniform(0, 1) < 0.05 ? 0 : yield * decades(-6, 4);
    const PowerHardening law{yield, constant, exponent, luders};
    const double starts[] = {0, luders, luders * (1 + decades(-16, 0)), decades(-300, 1),
                             luders + decades(-20, 2)};
    const T start(starts[static_cast<int>(random.uniform(0, 5))]);
    const HardeningPoint<T> near = law.at(start);
    const T stress = near.stress * T(1 + decades(-17, 4));
    const HardeningPoint<T> end = law.meet(near, stress, T(yield * decades(-1, 6)));
    ASSERT_TRUE(std::isfinite(end.plastic_strain[0]) && std::isfinite(end.stress[0]))
        << k << " n " << exponent << " luders " << luders << " start " << start[0];
    ASSERT_GE(end.plastic_strain[0], start[0]);
  }
}
TEST(PowerHardening, SearchComesToItsEnd) {
  expect_found<double>(21);
  expect_found<float>(22);
}

}  // namespace
}  // namespace brio
