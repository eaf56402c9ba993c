#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <string>
#include <vector>

#include "materials/material.hpp"
#include "src/base/index.hpp"
#include "tests/materials/paths.hpp"

namespace brio {
namespace {

constexpr double young = 200e9;
constexpr double poisson = 0.3;
constexpr double yield = 350e6;

/// Calls `check(law)` with every plastic law, at ordinary and at extreme parameters.
template <class Check>
void for_every_law(Check check) {
  for (double mix : {0.0, 0.3, 1.0})
    for (double modulus : {0.0, 2e9}) check(ElasticPlastic{7800, young, poisson, yield, modulus, mix});
  for (double exponent : {0.05, 0.294, 1.0})
    for (double luders : {0.0, 0.01})
      for (double constant : {0.0, 600e6}) {
        const PowerLawHardening law{7800, young, poisson, yield, constant, exponent, luders};
        check(law);
      }
  for (const double last : {yield, 900e6, 250e6}) {
    const std::array<double, 2> rows[] = {
        {0, yield}, {0.005, yield}, {0.02, 450e6}, {0.1, 600e6}, {0.7, last}};
    check(TabulatedPlasticity{7800, young, poisson, yield_table(rows)});
  }
}

std::string describe(const ElasticPlastic& law) { return "mix " + std::to_string(law.hardening_mix); }
std::string describe(const PowerLawHardening& law) {
  return "constant " + std::to_string(law.hardening_constant) + " exponent " +
         std::to_string(law.hardening_exponent) + " luders " + std::to_string(law.luders_strain);
}
std::string describe(const TabulatedPlasticity& law) {
  return "table down to " + std::to_string(law.yield_stress->lowest_stress());
}

template <class Law>
using HistoryOf = typename Law::template History<double>;

double yield_stress(const auto& law, const auto& history) {
  return point_of(law.hardening(), history).stress;
}
template <class History>
double effective_stress(const SymmetricTensor<double>& stress, const History& history) {
  return von_mises(relative_deviator(stress, history));
}
double largest(const SymmetricTensor<double>& a) {
  return std::max(
      {std::abs(a.xx), std::abs(a.yy), std::abs(a.zz), std::abs(a.xy), std::abs(a.yz), std::abs(a.xz)});
}

TEST(Plasticity, StressStaysOnOrWithinTheYieldSurfaceAndPlasticWorkIsPositive) {
  for_every_law([](const auto& law) {
    RandomPath path(21);
    SymmetricTensor<double> stress{};
    HistoryOf<std::decay_t<decltype(law)>> history{};
    for (int step = 0; step < 500; ++step) {
      const SymmetricTensor<double> strain = path.next();
      const SymmetricTensor<double> old_stress = stress;
      const double before = history.equivalent_plastic_strain;
      law.update(strain, stress, history);
      const double allowed = yield_stress(law, history);
      const double effective = effective_stress(stress, history);
      const double round_off = 1e-12 * allowed + 1e-15 * largest(stress);
      ASSERT_LE(effective, allowed + round_off);
      ASSERT_GE(history.equivalent_plastic_strain, before);
      if (history.equivalent_plastic_strain > before) {
        ASSERT_NEAR(effective, allowed, round_off);
        const SymmetricTensor<double> plastic = law.elastic().stress(strain) - (stress - old_stress);
        ASSERT_GE(contract(relative_deviator(stress, history), plastic), 0);
      }
    }
    EXPECT_GT(history.equivalent_plastic_strain, 0.02);
  });
}

TEST(Plasticity, PlaneStressStaysOnOrWithinTheYieldSurface) {
  for_every_law([](const auto& law) {
    for (double shear_factor : {0.5, 5.0 / 6.0, 1.0}) {
      RandomPath path(22, 2e-2);
      ShellTensor<double> stress{};
      HistoryOf<std::decay_t<decltype(law)>> history{};
      for (int step = 0; step < 300; ++step) {
        const double before = history.equivalent_plastic_strain;
        double thickness = 0;
        law.update_plane_stress(in_plane(path.next()), shear_factor, stress, history, thickness);
        const double allowed = yield_stress(law, history);
        const double effective = effective_stress(in_space(stress), history);
        ASSERT_LE(effective, allowed * (1 + 1e-12));
        if (history.equivalent_plastic_strain > before) {
          ASSERT_NEAR(effective, allowed, 1e-12 * allowed);
        }
      }
      EXPECT_GT(history.equivalent_plastic_strain, 0.02);
    }
  });
}

/// One return from random states with increments of up to a thousand yield strains, side by side, to the
/// yield surface of the plastic strain that is stored.
template <Floating Real>
void expect_return_from_afar(double exponent, double luders, double tolerance) {
  using T = Lanes<Real>;
  RandomPath random(26);
  for (int trial = 0; trial < 1000; ++trial) {
    const double constant = yield * std::pow(10, random.uniform(-3, 2));
    const PowerLawHardening law{7800, young, random.uniform(-0.3, 0.499), yield, constant, exponent, luders};
    PowerLawHardening::History<T> history{T(0.0)};
    ShellTensor<T> increment, stress{T(0.0), T(0.0), T(0.0), T(0.0), T(0.0)};
    for (int lane = 0; lane < lane_count<Real>; ++lane) {
      const auto any_size = [&](double low, double high) { return std::pow(10, random.uniform(low, high)); };
      if (lane % 3 > 0) history.equivalent_plastic_strain.set(lane, static_cast<Real>(any_size(-8, 0)));
      const double size = yield / young * any_size(-2, 3);
      for (T* component : {&increment.xx, &increment.yy, &increment.xy, &increment.yz, &increment.xz})
        component->set(lane, static_cast<Real>(size * random.uniform(-1, 1)));
    }
    const T before = history.equivalent_plastic_strain;
    T thickness(0.0);
    law.update_plane_stress(increment, random.uniform(0.1, 1), stress, history, thickness);
    const T allowed = point_of(law.hardening(), history).stress;
    const T effective = von_mises(deviator(in_space(stress)));
    const T over = (effective - allowed) / allowed;
    for (int lane = 0; lane < lane_count<Real>; ++lane) {
      ASSERT_LE(over[lane], tolerance) << trial << ' ' << lane;
      if (history.equivalent_plastic_strain[lane] > before[lane]) {
        ASSERT_GE(over[lane], -tolerance) << trial << ' ' << lane;
      }
    }
  }
}
TEST(Plasticity, PlaneStressReturnsFromAThousandYieldStrains) {
  for (const double exponent : {0.05, 0.2, 0.5, 1.0})
    for (const double luders : {0.0, 0.02}) {
      SCOPED_TRACE(std::to_string(exponent) + " " + std::to_string(luders));
      expect_return_from_afar<double>(exponent, luders, 1e-12);
      // At first yield single precision has no plastic strain small enough for exponents below about 0.1.
      if (exponent > 0.1) expect_return_from_afar<float>(exponent, luders, 1e-5);
    }
}

TEST(Plasticity, PlaneStressReturnEndsOnWhatIsNotANumber) {
  const PowerLawHardening law{7800, young, poisson, yield, 600e6, 0.3, 0};
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    PowerLawHardening::History<double> history{};
    ShellTensor<double> stress{};
    double thickness = 0;
    law.update_plane_stress({bad, 0.1, 0.1, 0, 0}, 1, stress, history, thickness);
    EXPECT_FALSE(std::isfinite(stress.xx));
  }
}

TEST(Plasticity, PlaneStressIsTheThreeDimensionalLawWithoutStressAcross) {
  for_every_law([](const auto& law) {
    using History = HistoryOf<std::decay_t<decltype(law)>>;
    RandomPath path(23, 2e-2);
    ShellTensor<double> stress{};
    History history{};
    for (int step = 0; step < 150; ++step) {
      const SymmetricTensor<double> strain = path.next();
      const SymmetricTensor<double> space_start = in_space(stress);
      const History start = history;
      double thickness = 0;
      law.update_plane_stress(in_plane(strain), 1.0, stress, history, thickness);
      SymmetricTensor<double> s;
      History h;
      const auto stress_across = [&](double across) {
        s = space_start;
        h = start;
        law.update({strain.xx, strain.yy, across, strain.xy, strain.yz, strain.xz}, s, h);
        return s.zz;
      };
      double low = -1, high = 1;
      for (int k = 0; k < 70; ++k) {
        const double middle = 0.5 * (low + high);
        (stress_across(middle) < 0 ? low : high) = middle;
      }
      stress_across(0.5 * (low + high));
      ASSERT_NEAR(thickness, 0.5 * (low + high), 1e-12);
      ASSERT_LE(largest(in_space(stress) - s), 1e-9 * yield) << step;
      ASSERT_NEAR(history.equivalent_plastic_strain, h.equivalent_plastic_strain, 1e-12);
    }
  });
}

TEST(Plasticity, TurnedStrainsGiveTurnedStresses) {
  for_every_law([](const auto& law) {
    RandomPath path(24), axes(25);
    const Tensor<double> rotation = random_rotation(axes);
    SymmetricTensor<double> stress{}, turned_stress{};
    HistoryOf<std::decay_t<decltype(law)>> history{}, turned_history{};
    for (int step = 0; step < 100; ++step) {
      const SymmetricTensor<double> strain = path.next();
      law.update(strain, stress, history);
      law.update(rotated(rotation, strain), turned_stress, turned_history);
      ASSERT_LE(largest(rotated(rotation, stress) - turned_stress), 1e-10 * (yield + largest(stress)));
      ASSERT_NEAR(history.equivalent_plastic_strain, turned_history.equivalent_plastic_strain, 1e-12);
    }
  });
}

/// The law in units of stress that are `scale` times smaller.
ElasticPlastic in_other_units(ElasticPlastic law, double scale) {
  law.youngs_modulus *= scale;
  law.yield_stress *= scale;
  law.hardening_modulus *= scale;
  return law;
}
PowerLawHardening in_other_units(PowerLawHardening law, double scale) {
  law.youngs_modulus *= scale;
  law.yield_stress *= scale;
  law.hardening_constant *= scale;
  return law;
}
TabulatedPlasticity in_other_units(TabulatedPlasticity law, double scale) {
  std::vector<std::array<double, 2>> rows;
  for (std::size_t i = 0; i < law.yield_stress->size(); ++i)
    rows.push_back({law.yield_stress->strain()[i], scale * law.yield_stress->stress(0)[i]});
  law.youngs_modulus *= scale;
  law.yield_stress = yield_table(rows);
  return law;
}

TEST(Plasticity, UnitsThatDifferByAPowerOfTwoGiveTheSameBits) {
  for_every_law([](const auto& law) {
    const double scale = 0x1p-20;
    const auto other = in_other_units(law, scale);
    RandomPath path(26);
    SymmetricTensor<double> stress{}, other_stress{};
    ShellTensor<double> shell{}, other_shell{};
    HistoryOf<std::decay_t<decltype(law)>> history{}, other_history{}, shell_history{}, other_shell_history{};
    for (int step = 0; step < 200; ++step) {
      const SymmetricTensor<double> strain = path.next();
      double thickness = 0, other_thickness = 0;
      law.update(strain, stress, history);
      other.update(strain, other_stress, other_history);
      law.update_plane_stress(in_plane(strain), 0.8, shell, shell_history, thickness);
      other.update_plane_stress(in_plane(strain), 0.8, other_shell, other_shell_history, other_thickness);
      ASSERT_EQ(largest(scale * stress - other_stress), 0);
      ASSERT_EQ(largest(in_space(scale * shell - other_shell)), 0);
      ASSERT_EQ(history.equivalent_plastic_strain, other_history.equivalent_plastic_strain);
      ASSERT_EQ(thickness, other_thickness);
    }
  });
}

template <class Real>
SymmetricTensor<double> lane_of(const SymmetricTensor<Lanes<Real>>& a, int lane) {
  const auto at = [lane](Lanes<Real> x) { return static_cast<double>(x[lane]); };
  return {at(a.xx), at(a.yy), at(a.zz), at(a.xy), at(a.yz), at(a.xz)};
}

/// A pack whose lanes follow different paths against one plain number a lane.
template <class Real>
void expect_lanes_follow_plain_numbers(const auto& law, double tolerance) {
  using Law = std::decay_t<decltype(law)>;
  using T = Lanes<Real>;
  constexpr int width = lane_count<Real>;
  std::vector<RandomPath> paths;
  for (unsigned lane = 0; lane < width; ++lane) paths.emplace_back(100 + lane);
  SymmetricTensor<T> stress = isotropic(T(0.0));
  ShellTensor<T> shell{T(0.0), T(0.0), T(0.0), T(0.0), T(0.0)};
  typename Law::template History<T> history{}, shell_history{};
  SymmetricTensor<double> plain_stress[width] = {};
  ShellTensor<double> plain_shell[width] = {};
  HistoryOf<Law> plain_history[width] = {}, plain_shell_history[width] = {};
  for (int step = 0; step < 100; ++step) {
    SymmetricTensor<T> strain;
    SymmetricTensor<double> plain[width];
    for (int lane = 0; lane < width; ++lane) {
      SymmetricTensor<double> given = paths[index(lane)].next();
      const auto put = [lane](T& x, double& value) {
        x.set(lane, static_cast<Real>(value));
        value = static_cast<double>(x[lane]);
      };
      put(strain.xx, given.xx);
      put(strain.yy, given.yy);
      put(strain.zz, given.zz);
      put(strain.xy, given.xy);
      put(strain.yz, given.yz);
      put(strain.xz, given.xz);
      plain[lane] = given;
    }
    T thickness;
    law.update(strain, stress, history);
    law.update_plane_stress(in_plane(strain), 0.8, shell, shell_history, thickness);
    for (int lane = 0; lane < width; ++lane) {
      double plain_thickness = 0;
      law.update(plain[lane], plain_stress[lane], plain_history[lane]);
      law.update_plane_stress(in_plane(plain[lane]), 0.8, plain_shell[lane], plain_shell_history[lane],
                              plain_thickness);
      const double scale = yield + largest(plain_stress[lane]);
      ASSERT_LE(largest(lane_of(stress, lane) - plain_stress[lane]), tolerance * scale)
          << describe(law) << " step " << step;
      ASSERT_LE(largest(lane_of(in_space(shell), lane) - in_space(plain_shell[lane])), 10 * tolerance * yield)
          << step;
      ASSERT_NEAR(static_cast<double>(thickness[lane]), plain_thickness, 10 * tolerance);
    }
  }
}

TEST(Plasticity, LanesFollowPlainNumbers) {
  for_every_law([](const auto& law) { expect_lanes_follow_plain_numbers<double>(law, 1e-11); });
}

TEST(Plasticity, SinglePrecisionFollowsDouble) {
  for_every_law([](const auto& law) {
    // With an exponent of 0.05 a plastic strain of 1e-25, the least that counts in single precision, already
    // gives 6 % of the hardening constant: there the two precisions part at first yield.
    if constexpr (requires { law.hardening_exponent; })
      if (law.hardening_exponent < 0.1) return;
    expect_lanes_follow_plain_numbers<float>(law, 2e-4);
  });
}

template <class T>
void expect_finite_at_extremes(const auto& law) {
  using Law = std::decay_t<decltype(law)>;
  const double luders = [&] {
    if constexpr (requires { law.luders_strain; }) return law.luders_strain;
    return 0.0;
  }();
  const double shear_strain = yield / (std::sqrt(3.0) * 2 * law.elastic().shear());
  for (double start : {0.0, luders, std::nextafter(luders, 1.0), 1e-300, 3.0})
    for (double size : {0.0, 1e-300, 1e-30, shear_strain, std::nextafter(shear_strain, 1.0), 1e-3, 10.0}) {
      SymmetricTensor<T> stress = isotropic(T(0.0));
      ShellTensor<T> shell{T(0.0), T(0.0), T(0.0), T(0.0), T(0.0)};
      typename Law::template History<T> history{}, shell_history{};
      history.equivalent_plastic_strain = shell_history.equivalent_plastic_strain = T(start);
      for (int step = 0; step < 3; ++step) {
        const T d(size);
        T thickness(0.0);
        law.update(SymmetricTensor<T>{T(0.0), d, -d, d, T(0.0), T(0.0)}, stress, history);
        law.update_plane_stress(ShellTensor<T>{T(0.0), T(0.0), d, d, -d}, 0.8, shell, shell_history,
                                thickness);
        for (T value : {stress.yy, stress.xy, history.equivalent_plastic_strain, shell.xy, shell.yz,
                        thickness, shell_history.equivalent_plastic_strain}) {
          ASSERT_TRUE(all(abs(value) < T(1e18))) << "start " << start << " size " << size;
        }
      }
    }
}

TEST(Plasticity, ExtremeIncrementsAndStatesGiveNumbers) {
  for_every_law([](const auto& law) {
    expect_finite_at_extremes<double>(law);
    expect_finite_at_extremes<Lanes<double>>(law);
    expect_finite_at_extremes<Lanes<float>>(law);
  });
}

TEST(Elastic, StressDoesNotDependOnThePath) {
  const Elastic law{7800, young, poisson};
  RandomPath path(31);
  SymmetricTensor<double> stress{}, strain{};
  ShellTensor<double> shell{};
  Elastic::History<double> history;
  double thickness_strain = 0;
  for (int step = 0; step < 200; ++step) {
    const SymmetricTensor<double> increment = path.next();
    double thickness = 0;
    law.update(increment, stress, history);
    law.update_plane_stress(in_plane(increment), 1.0, shell, history, thickness);
    thickness_strain += thickness;
    strain = strain + increment;
  }
  ASSERT_LE(largest(stress - law.elastic().stress(strain)), 1e-12 * young);
  // Plane stress: with the strain across, the three-dimensional law gives the same stress and none across.
  strain.zz = thickness_strain;
  ASSERT_LE(largest(in_space(shell) - law.elastic().stress(strain)), 1e-12 * young);
}

TEST(Elastic, AnEmptyHistoryCostsNothing) {
  struct Point {
    SymmetricTensor<double> stress;
    [[no_unique_address]] Elastic::History<double> history;
  };
  EXPECT_EQ(sizeof(Point), sizeof(SymmetricTensor<double>));
}

}  // namespace
}  // namespace brio
