// Through the end of a Lueders plateau in steps of any size: hardening must set in, however small the plastic
// strain of a step is. Paths along which the stress keeps its direction have an exact curve.

#include <gtest/gtest.h>

#include <cmath>

#include "materials/power_law_hardening.hpp"

namespace brio {
namespace {

constexpr double young = 200e9, poisson = 0.3, yield = 400e6, luders = 0.005;

PowerLawHardening law_of(double constant, double exponent) {
  return {.density = 7800,
          .youngs_modulus = young,
          .poissons_ratio = poisson,
          .yield_stress = yield,
          .hardening_constant = constant,
          .hardening_exponent = exponent,
          .luders_strain = luders};
}

/// Stress at which strain = stress / stiffness + plastic strain, by bisection in the logarithm of the plastic
/// strain u beyond the plateau.
double exact_stress(const PowerLawHardening& law, double stiffness, double strain) {
  if (strain <= yield / stiffness) return stiffness * strain;
  const double height = stiffness * (strain - luders) - yield;
  if (height <= 0) return yield;
  const auto rise = [&](double u) { return law.hardening_constant * std::pow(u, law.hardening_exponent); };
  double low = -690, high = std::log(height / stiffness);
  for (int k = 0; k < 200; ++k) {
    const double middle = 0.5 * (low + high), u = std::exp(middle);
    (stiffness * u + rise(u) < height ? low : high) = middle;
  }
  return yield + height - stiffness * std::exp(low);
}

template <class T>
double number(const T& value) {
  if constexpr (std::is_floating_point_v<T>) {
    return static_cast<double>(value);
  } else {
    return static_cast<double>(value[0]);
  }
}

/// Strain of `end` in equal steps, compared with the curve at each of a hundred strains.
template <class T>
void expect_curve(const PowerLawHardening& law, double end, int steps, double tolerance) {
  PowerLawHardening::History<T> space{T(0.0)}, plane{T(0.0)}, fibre{T(0.0)};
  SymmetricTensor<T> in_space{T(0.0), T(0.0), T(0.0), T(0.0), T(0.0), T(0.0)};
  ShellTensor<T> in_plane{T(0.0), T(0.0), T(0.0), T(0.0), T(0.0)};
  FibreTensor<T> in_fibre{T(0.0), T(0.0), T(0.0)};
  const double shear = young / (2 * (1 + poisson));
  const T step(end / steps), shear_step(end / steps * std::sqrt(3.0) / 2);
  T thinning(0.0);
  for (int k = 1; k <= steps; ++k) {
    law.update(SymmetricTensor<T>{step, -0.5 * step, -0.5 * step, T(0.0), T(0.0), T(0.0)}, in_space, space);
    law.update_plane_stress(ShellTensor<T>{T(0.0), T(0.0), shear_step, T(0.0), T(0.0)}, 1.0, in_plane, plane,
                            thinning);
    law.update_fibre(FibreTensor<T>{step, T(0.0), T(0.0)}, in_fibre, fibre);
    if (k % (steps / 100) != 0) continue;
    const double strain = number(step) * k;
    const double solid = exact_stress(law, 3 * shear, strain), axial = exact_stress(law, young, strain);
    const auto message = [&] { return testing::Message() << "strain " << strain; };
    ASSERT_NEAR(number(in_space.xx - in_space.yy) / solid, 1, tolerance) << message();
    ASSERT_NEAR(std::sqrt(3.0) * number(in_plane.xy) / solid, 1, tolerance) << message();
    ASSERT_NEAR(number(in_fibre.xx) / axial, 1, tolerance) << message();
    ASSERT_NEAR(number(space.equivalent_plastic_strain), strain - solid / (3 * shear), tolerance * end);
    ASSERT_NEAR(number(plane.equivalent_plastic_strain), strain - solid / (3 * shear), tolerance * end);
    ASSERT_NEAR(number(fibre.equivalent_plastic_strain), strain - axial / young, tolerance * end);
  }
}

template <class T>
void expect_curves(int steps, double tolerance) {
  for (const double exponent : {0.05, 0.1, 0.3, 1.0})
    for (const double constant : {1e7, 600e6, 5e9}) {
      SCOPED_TRACE(testing::Message() << "n " << exponent << " A " << constant << " steps " << steps);
      // To a few strains of yield, where the curve is steepest, and far along it.
      for (const double end : {0.011, 0.05})
        expect_curve<T>(law_of(constant, exponent), end, steps, tolerance);
    }
}

TEST(LuedersStrain, HardensInStepsOfAnySize) {
  for (const int steps : {100, 1000, 100000}) expect_curves<Lanes<double>>(steps, 1e-10);
  expect_curves<double>(10000, 1e-10);
}
TEST(LuedersStrain, HardensInSinglePrecision) {
  for (const int steps : {100, 1000, 30000}) expect_curves<Lanes<float>>(steps, 1e-3);
}

// Steps below the last digit of the strain that has gathered.
TEST(LuedersStrain, SumsUpStepsThatSinglePrecisionRoundsAway) {
  using T = Lanes<float>;
  const PowerHardening curve = law_of(600e6, 0.1).hardening();
  HardeningPoint<T> point = curve.at(T(0.04));
  const double start = number(point.plastic_strain);
  for (int k = 0; k < 1000000; ++k) point.flow_by(T(1e-10));
  EXPECT_NEAR(number(point.plastic_strain) + number(point.rest), start + 1e-4, 1e-10);
}

}  // namespace
}  // namespace brio
