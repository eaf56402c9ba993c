// Hourglass control stores and gives back, or dissipates: it never supplies, however its stiffness changes
// with the shape and the material of the element.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "elements/solid/hex8_kernel.hpp"
#include "materials/elastic.hpp"
#include "materials/elastic_plastic.hpp"
#include "src/base/index.hpp"
#include "tests/elements/shell/single_shell.hpp"
#include "tests/elements/solid/hexahedra.hpp"

namespace brio {
namespace {

using std::numbers::pi;
using test::Corners;

const Elastic elastic_law{.density = 1, .youngs_modulus = 260, .poissons_ratio = 0.3};
const ElasticPlastic plastic_law{
    .density = 1, .youngs_modulus = 260, .poissons_ratio = 0.3, .yield_stress = 5, .hardening_modulus = 10};

double smooth(double t) { return 0.5 - 0.5 * std::cos(pi * std::clamp(t, 0.0, 1.0)); }

/// What happens on the way of a closed cycle: first displaced, then squeezed, or both at once; then the one
/// is undone before the other, so that the way back meets another stiffness than the way there.
struct Cycle {
  double squeeze_from, squeeze_back, hourglass_from, hourglass_back;  ///< parts of the cycle, a quarter long
  double share(double t, double from, double back) const {
    return smooth((t - from) / 0.25) - smooth((t - back) / 0.25);
  }
  double squeeze(double t) const { return share(t, squeeze_from, squeeze_back); }
  double hourglass(double t) const { return share(t, hourglass_from, hourglass_back); }
};
constexpr Cycle cycles[] = {
    {0.25, 0.75, 0, 0.5}, {0, 0.5, 0.25, 0.75}, {0, 0.75, 0.25, 0.5}, {0, 0.5, 0, 0.5}};

/// Least and largest energies so far, and the work of the forces.
struct EnergyAccount {
  double work = 0, hourglass = 0, all = 0;
  double least_hourglass = 0, largest = 0, largest_hourglass = 0;
  double stored = 0;
  double largest_mismatch = 0;  ///< between stored energy and the sum of increments

  void note(double hourglass_increment, double other_increment, double stored_now) {
    stored = stored_now;
    hourglass += hourglass_increment;
    all += hourglass_increment + other_increment;
    least_hourglass = std::min(least_hourglass, hourglass);
    largest = std::max(largest, all);
    largest_hourglass = std::max(largest_hourglass, hourglass);
    largest_mismatch = std::max(largest_mismatch, std::abs(stored - hourglass));
  }
  double gap() const { return std::abs(work - all) / largest; }
};

template <ObjectiveRate rate, class Law>
EnergyAccount brick_balance(const Law& law, const Cycle& cycle, double squeeze, double coefficient,
                            int steps) {
  using Kernel = Hex8Kernel<rate>;
  Kernel kernel;
  kernel.hourglass_stiffness = coefficient;
  kernel.linear_bulk_viscosity = kernel.quadratic_bulk_viscosity = 0;
  const Corners start = test::box(1, 1.2, 0.9);
  Corners pattern = Corners::Zero();
  for (int n = 0; n < 8; ++n) {
    const Eigen::Vector3d& s = test::corner_sign[index(n)];
    pattern.col(n) = Eigen::Vector3d(0.8, -0.5, 0.6) * (s.y() * s.z()) +
                     Eigen::Vector3d(-0.4, 0.7, 0.5) * (s.z() * s.x()) +
                     Eigen::Vector3d(0.3, 0.6, -0.7) * (s.x() * s.y()) +
                     Eigen::Vector3d(0.2, 0.4, 0.3) * (s.x() * s.y() * s.z());
  }
  test::SingleElement<Kernel, Law> element(kernel, law, start);
  EnergyAccount account;
  Corners x = start, old_force = Corners::Zero();
  double accounted_hourglass = 0, accounted_other = 0;
  for (int i = 1; i <= steps; ++i) {
    const double t = static_cast<double>(i) / steps;
    const Eigen::DiagonalMatrix<double, 3> shape(1 - squeeze * cycle.squeeze(t), 1, 1);
    const Eigen::Matrix3d turn =
        Eigen::AngleAxisd(2 * pi * t, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
    const Corners next = turn * (shape * (start + 0.03 * cycle.hourglass(t) * pattern));
    element.move_to(next, 1.0 / steps);
    account.work += 0.5 * ((element.force + old_force).array() * (next - x).array()).sum();
    old_force = element.force;
    x = next;
    const double other = element.internal_energy + element.viscous_energy;
    account.note(element.hourglass_energy - accounted_hourglass, other - accounted_other,
                 stored_energy(element.header.hourglass));
    accounted_hourglass = element.hourglass_energy;
    accounted_other = other;
  }
  return account;
}

double stored_in(const Shell4Kernel::Header<double, Elastic>& header) {
  const HourglassStiffness<double>& k = header.hourglass_stiffness;
  const auto pair = [](const double(&c)[2]) { return c[0] * c[0] + c[1] * c[1]; };
  const double in_plane[2] = {header.hourglass[0], header.hourglass[1]};
  return 0.5 * (k.membrane * pair(in_plane) + k.normal * square(header.hourglass[2]) +
                k.rotation * pair(header.rotation) + header.drilling_stiffness * square(header.drilling));
}

/// \param spin of all nodes about the normal, over their turning about the axes in the plane
EnergyAccount shell_balance(const Cycle& cycle, double squeeze, double coefficient, int steps,
                            double spin = 0.02) {
  Shell4 shell;
  shell.thickness = 0.1;
  shell.hourglass_stiffness = coefficient;
  shell.linear_bulk_viscosity = shell.drilling_viscosity = 0;
  const Points4 start = {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(1, 1.2, 0),
                         Eigen::Vector3d(0, 1.2, 0)};
  SingleShell<> element(shell, elastic_law, start);
  const auto place = [&](double t) {
    const Eigen::DiagonalMatrix<double, 3> shape(1 - squeeze * cycle.squeeze(t), 1, 1);
    Points4 x;
    for (std::size_t n = 0; n < 4; ++n) {
      const double sign = n % 2 == 0 ? 1 : -1;
      x[n] = shape * (start[n] + 0.03 * cycle.hourglass(t) * sign * Eigen::Vector3d(0.8, -0.6, 0.5));
    }
    return x;
  };
  EnergyAccount account;
  Points4 old_force = SingleShell<>::none(), old_moment = old_force, before = start;
  const double step = 1.0 / steps;
  for (int i = 1; i <= steps; ++i) {
    const Points4 x = place(i * step);
    const double turn = 0.05 * (cycle.hourglass(i * step) - cycle.hourglass((i - 1) * step)) / step;
    Points4 v, w;
    for (std::size_t n = 0; n < 4; ++n) {
      v[n] = (x[n] - before[n]) / step;
      w[n] = (n % 2 == 0 ? turn : -turn) * Eigen::Vector3d(1, 0.7, 0);
      w[n].z() = spin * turn;
    }
    element.move(x, v, w, step);
    for (int n = 0; n < 4; ++n) {
      const auto k = index(n);
      account.work += 0.5 * step * (old_force[k] + element.force(n)).dot(v[k]);
      account.work += 0.5 * step * (old_moment[k] + element.moment(n)).dot(w[k]);
      old_force[k] = element.force(n);
      old_moment[k] = element.moment(n);
    }
    account.note(element.increment.hourglass_energy,
                 element.increment.internal_energy + element.increment.viscous_energy,
                 stored_in(element.header));
    before = x;
  }
  return account;
}

/// Squeezed to a fifth or stretched to four fifths more, and back.
template <class BalanceOf>
void expect_nothing_supplied(const BalanceOf& balance_of, double gap) {
  for (const Cycle& cycle : cycles)
    for (const double squeeze : {0.8, -0.8}) {
      SCOPED_TRACE(testing::Message() << "squeezed from " << cycle.squeeze_from << " to "
                                      << cycle.squeeze_back << " by " << squeeze);
      const EnergyAccount account = balance_of(cycle, squeeze, 2000);
      EXPECT_GT(account.largest_hourglass, 0);
      EXPECT_GE(account.least_hourglass, -1e-12 * account.largest);
      EXPECT_LE(account.largest_mismatch, 1e-12 * account.largest);
      // The work of the forces over a cycle is in the energy account; the difference vanishes with the step.
      EXPECT_LT(account.gap(), gap);
      // Of first order at last; terms of third order may have made the longer steps look better.
      EXPECT_LT(balance_of(cycle, squeeze, 8000).gap(), 0.5 * account.gap() + 1e-9);
    }
}

TEST(HourglassEnergy, OfElasticBricksIsWhatTheirForcesHaveDone) {
  for (const double coefficient : {0.01, 0.1}) {
    expect_nothing_supplied(
        [&](const Cycle& cycle, double squeeze, int steps) {
          return brick_balance<ObjectiveRate::green_naghdi>(elastic_law, cycle, squeeze, coefficient, steps);
        },
        1e-3);
    expect_nothing_supplied(
        [&](const Cycle& cycle, double squeeze, int steps) {
          return brick_balance<ObjectiveRate::jaumann>(elastic_law, cycle, squeeze, coefficient, steps);
        },
        1e-3);
  }
}

TEST(HourglassEnergy, OfBricksThatFlowIsWhatTheirForcesHaveDone) {
  expect_nothing_supplied(
      [&](const Cycle& cycle, double squeeze, int steps) {
        return brick_balance<ObjectiveRate::green_naghdi>(plastic_law, cycle, squeeze, 0.05, steps);
      },
      1e-3);
}

TEST(HourglassEnergy, OfShellsIsWhatTheirForcesHaveDone) {
  for (const double coefficient : {0.01, 0.1})
    expect_nothing_supplied([&](const Cycle& cycle, double squeeze,
                                int steps) { return shell_balance(cycle, squeeze, coefficient, steps); },
                            1e-3);
}

// Resistance to drilling yields at 0.01 rad: the sum of increments then exceeds the stored energy.
TEST(HourglassEnergy, OfShellsThatDrillIsDissipatedBeyondTheLimit) {
  for (const Cycle& cycle : cycles)
    for (const double squeeze : {0.8, -0.8}) {
      const EnergyAccount account = shell_balance(cycle, squeeze, 0.01, 8000, 2);
      EXPECT_GE(account.least_hourglass, 0);
      EXPECT_GT(account.hourglass, account.stored + 1e-9 * account.largest);
      EXPECT_LT(account.gap(), 1e-3);
    }
}

}  // namespace
}  // namespace brio
