// Power-law hardening at its ends: exponents of 0.05 and 1, a strain that is that at which hardening sets in,
// no hardening at all; where an invalid operation, a division by zero or an overflow stops the program.

#include <gtest/gtest.h>

#include <cmath>
#include <initializer_list>
#include <vector>

#include "materials/power_law_hardening.hpp"
#include "tests/core/floating_point_traps.hpp"

namespace brio {
namespace {

constexpr double young = 200e9, yield = 350e6, stiffness = 3 * young / 2.6;

std::vector<PowerLawHardening> laws() {
  std::vector<PowerLawHardening> all;
  for (const double exponent : {0.05, 0.3, 1.0})
    for (const double constant : {0.0, 1e-3, 500e6})
      for (const double luders : {0.0, 0.02})
        all.push_back({.density = 7800,
                       .youngs_modulus = young,
                       .poissons_ratio = 0.3,
                       .yield_stress = yield,
                       .hardening_constant = constant,
                       .hardening_exponent = exponent,
                       .luders_strain = luders});
  return all;
}

double curve(const PowerLawHardening& law, double strain, double rest = 0) {
  const double beyond = std::max((strain - law.luders_strain) + rest, 0.0);
  return yield + law.hardening_constant * std::pow(beyond, law.hardening_exponent);
}

TEST(ExtremesHardening, FlowToExactlyWhereHardeningSetsInAndOnFromThere) {
  const test::FloatingPointTraps traps;
  for (const PowerLawHardening& law : laws()) {
    const PowerHardening hardening = law.hardening();
    const double end = law.luders_strain;
    const HardeningPoint<double> there =
        hardening.meet(hardening.at(0.0), yield + stiffness * end, stiffness);
    EXPECT_NEAR(there.plastic_strain, end, 1e-15);
    EXPECT_NEAR(there.stress, curve(law, there.plastic_strain, there.rest), 1e-9 * yield);
    for (const double over : {0.0, 1e-16, 1e-12, 1e-6, 1.0, 1e3}) {
      const HardeningPoint<double> on = hardening.meet(hardening.at(end), yield * (1 + over), stiffness);
      EXPECT_GE(on.plastic_strain, end);
      EXPECT_NEAR(on.stress, curve(law, on.plastic_strain, on.rest), 1e-9 * on.stress);
      const double line = yield * (1 + over) - stiffness * ((on.plastic_strain - end) + on.rest);
      EXPECT_NEAR(line, on.stress, 1e-9 * on.stress + 1e-12 * yield * (1 + over));
    }
  }
}

// Each lane has another strain, from none to a hundred: all of them in one pull, in every state of stress.
TEST(ExtremesHardening, EveryStateOfStressEndsOnTheCurveInEveryLane) {
  const test::FloatingPointTraps traps;
  using T = Lanes<double>;
  const double strains[8] = {0, 1e-300, 1e-9, yield / young, 0.02 + yield / young, 0.1, 1, 100};
  for (const PowerLawHardening& law : laws()) {
    T strain;
    for (int lane = 0; lane < 8; ++lane) strain.set(lane, strains[lane]);
    PowerLawHardening::History<T> solid{T(0.0)}, shell{T(0.0)}, fibre{T(0.0)};
    SymmetricTensor<T> stress{T(0.0), T(0.0), T(0.0), T(0.0), T(0.0), T(0.0)};
    ShellTensor<T> in_plane{T(0.0), T(0.0), T(0.0), T(0.0), T(0.0)};
    FibreTensor<T> along{T(0.0), T(0.0), T(0.0)};
    T thinning(0.0);
    for (int pull = 0; pull < 2; ++pull) {
      law.update(SymmetricTensor<T>{strain, -0.5 * strain, -0.5 * strain, T(0.0), T(0.0), T(0.0)}, stress,
                 solid);
      law.update_plane_stress(ShellTensor<T>{strain, -0.5 * strain, T(0.0), T(0.0), T(0.0)}, 5.0 / 6,
                              in_plane, shell, thinning);
      law.update_fibre(FibreTensor<T>{strain, T(0.0), T(0.0)}, along, fibre);
      for (int lane = 0; lane < 8; ++lane) {
        const double axial = stress.xx[lane] - stress.yy[lane];
        const double sheet =
            std::sqrt(in_plane.xx[lane] * in_plane.xx[lane] + in_plane.yy[lane] * in_plane.yy[lane] -
                      in_plane.xx[lane] * in_plane.yy[lane]);
        const auto expect_on_curve = [&](double effective, const PowerLawHardening::History<T>& history) {
          const double plastic = history.equivalent_plastic_strain[lane];
          ASSERT_TRUE(std::isfinite(effective) && std::isfinite(plastic)) << strains[lane];
          const double bound = curve(law, plastic, history.plastic_strain_rest[lane]);
          EXPECT_LE(effective, bound * (1 + 1e-9)) << strains[lane];
          if (plastic > 0) {
            EXPECT_NEAR(effective, bound, 1e-9 * bound) << strains[lane];
          }
        };
        expect_on_curve(axial, solid);
        expect_on_curve(sheet, shell);
        expect_on_curve(std::abs(along.xx[lane]), fibre);
      }
    }
  }
}

}  // namespace
}  // namespace brio
