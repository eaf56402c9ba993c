#include <gtest/gtest.h>

#include "materials/elastic_plastic.hpp"
#include "tests/elements/shell/shell_model.hpp"

namespace brio {
namespace {

constexpr int first = 5, second = 4;
/// A step in which nothing moves as far as numbers can tell: increments are linear in velocities.
constexpr double instant = 1e-30;

bool inside(int node) {
  const int i = node % (first + 1), j = node / (first + 1);
  return i > 0 && i < first && j > 0 && j < second;
}

TEST(Shell4Patch, LinearMembraneFieldsGiveUniformStressAndNoInnerForces) {
  Shell4 shell;
  shell.thickness = 0.05;
  shell.linear_bulk_viscosity = 0;
  shell.drilling_viscosity = 0;
  ShellModel model(rectangle(1, 1, first, second, 0.3), shell, steel());
  const double exx = 1, eyy = -2, exy = 0.7, spin = 0.4;
  const int count = static_cast<int>(model.nodes.size());
  for (int n = 0; n < count; ++n) {
    const Eigen::Vector3d x = model.position(n);
    model.set_velocity(n, {exx * x.x() + (exy - spin) * x.y(), (exy + spin) * x.x() + eyy * x.y(), 0});
    model.set_angular_velocity(n, {0, 0, spin});
  }
  model.sweep(instant);
  const double stretch = 200e9 / 0.91 * instant;
  for (int e = 0; e < first * second; ++e) {
    const ElementSample s = model.sample(e);
    EXPECT_NEAR(s.stress.xx, stretch * (exx + 0.3 * eyy), 1e-13 * stretch);
    EXPECT_NEAR(s.stress.yy, stretch * (eyy + 0.3 * exx), 1e-13 * stretch);
    EXPECT_NEAR(s.stress.xy, 200e9 / 1.3 * instant * exy, 1e-13 * stretch);
  }
  for (int n = 0; n < count; ++n)
    if (inside(n)) {
      EXPECT_LT(model.force(n).norm(), 1e-13 * stretch * shell.thickness);
      EXPECT_LT(model.moment(n).norm(), 1e-13 * stretch * shell.thickness);
    }
}

/// Deflection w = xx x^2/2 + yy y^2/2 + xy x y with the rotations of a Kirchhoff plate.
void bend(ShellModel& model, double xx, double yy, double xy) {
  for (int n = 0; n < static_cast<int>(model.nodes.size()); ++n) {
    const Eigen::Vector3d x = model.position(n);
    model.set_velocity(n, {0, 0, 0.5 * (xx * x.x() * x.x() + yy * x.y() * x.y()) + xy * x.x() * x.y()});
    model.set_angular_velocity(n, {xy * x.x() + yy * x.y(), -(xx * x.x() + xy * x.y()), 0});
  }
}

TEST(Shell4Patch, ConstantCurvatureGivesItsEnergyAndNoInnerForces) {
  Shell4 shell;
  shell.linear_bulk_viscosity = 0;
  shell.drilling_viscosity = 0;
  shell.thickness = 0.01;  // shear that should not be there would outweigh bending by far
  const double rigidity = 200e9 * std::pow(shell.thickness, 3) / (12 * 0.91);
  for (const Eigen::Vector3d& k : {Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0, 1, 0),
                                   Eigen::Vector3d(0, 0, 1), Eigen::Vector3d(0.3, -0.8, 0.5)}) {
    ShellModel model(rectangle(1, 1, first, second, 0.3), shell, steel());
    const double small = instant;
    bend(model, k[0], k[1], k[2]);
    model.sweep(instant);
    const double energy =
        0.5 * rigidity * small * small * (k[0] * k[0] + k[1] * k[1] + 0.6 * k[0] * k[1] + 1.4 * k[2] * k[2]);
    EXPECT_NEAR(model.last.internal_energy, energy, 1e-12 * energy);
    EXPECT_LT(model.last.hourglass_energy, 1e-18 * energy);
    for (int n = 0; n < static_cast<int>(model.nodes.size()); ++n)
      if (inside(n)) {
        EXPECT_LT(model.force(n).norm(), 1e-11 * rigidity * small);
        EXPECT_LT(model.moment(n).norm(), 1e-11 * rigidity * small);
      }
  }
}

/// Period of a free vibration that starts with a velocity field: from the zero crossings of one node's
/// deflection.
double period(ShellModel& model, int node, int half_periods) {
  const double step = 0.9 * model.stable_step();
  double last_value = 0, first_crossing = 0;
  for (int crossings = 0;;) {
    model.advance(step);
    const double value = model.position(node).z();
    if (model.time > step && value * last_value < 0) {
      const double crossing = model.time - step * value / (value - last_value);
      if (crossings == 0) first_crossing = crossing;
      if (crossings == half_periods) return 2 * (crossing - first_crossing) / half_periods;
      ++crossings;
    }
    last_value = value;
  }
}

/// Lowest circular frequency of a simply supported square plate of side 1 with transverse shear and rotary
/// inertia (Mindlin 1951): the smaller root of its characteristic equation for sin(pi x) sin(pi y).
double mindlin_frequency(double thickness, double density, double modulus, double ratio) {
  const double k2 = 2 * M_PI * M_PI;
  const double rigidity = modulus * std::pow(thickness, 3) / (12 * (1 - ratio * ratio));
  const double shear = 5.0 / 6.0 * modulus / (2 * (1 + ratio)) * thickness;
  const double mass = density * thickness;
  const double inertia = density * std::pow(thickness, 3) / 12;
  const double a = mass * inertia / shear;
  const double b = mass + k2 * (inertia + mass * rigidity / shear);
  const double c = rigidity * k2 * k2;
  return std::sqrt((b - std::sqrt(b * b - 4 * a * c)) / (2 * a));
}

double plate_frequency(double thickness, double distortion) {
  constexpr int n = 16;
  Shell4 shell;
  shell.thickness = thickness;
  ShellModel model(rectangle(1, 1, n, n, distortion), shell, steel());
  for (int k = 0; k < (n + 1) * (n + 1); ++k) {
    const Eigen::Vector3d x = model.position(k);
    const int i = k % (n + 1), j = k / (n + 1);
    if (i == 0 || i == n || j == 0 || j == n) model.fix(k, 2);
    if (i == 0 || i == n) model.fix(k, 3);
    if (j == 0 || j == n) model.fix(k, 4);
    const double v = 1e-6;
    model.set_velocity(k, {0, 0, v * std::sin(M_PI * x.x()) * std::sin(M_PI * x.y())});
    model.set_angular_velocity(k, {v * M_PI * std::sin(M_PI * x.x()) * std::cos(M_PI * x.y()),
                                   -v * M_PI * std::cos(M_PI * x.x()) * std::sin(M_PI * x.y()), 0});
  }
  return 2 * M_PI / period(model, (n + 1) * (n / 2) + n / 2, 2);
}

TEST(Shell4Vibration, SimplySupportedPlateHasMindlinsFrequency) {
  for (double thickness : {0.2, 0.05})
    EXPECT_NEAR(plate_frequency(thickness, 0) / mindlin_frequency(thickness, 7850, 200e9, 0.3), 1, 0.01)
        << thickness;
  EXPECT_NEAR(plate_frequency(0.1, 0.2) / mindlin_frequency(0.1, 7850, 200e9, 0.3), 1, 0.02);
}

TEST(Shell4Vibration, ThinPlateSlow) {
  EXPECT_NEAR(plate_frequency(0.005, 0) / mindlin_frequency(0.005, 7850, 200e9, 0.3), 1, 0.01);
}

TEST(Shell4Vibration, CantileverHasTimoshenkosFrequency) {
  // nu = 0, length 1, depth 0.05: Euler's 1.8751^2 sqrt(E I / m) less 0.3 % for shear and rotary inertia.
  Shell4 shell;
  shell.thickness = 0.05;
  Elastic law = steel();
  law.poissons_ratio = 0;
  constexpr int n = 20;
  ShellModel model(rectangle(1, 0.1, n, 2), shell, law);
  const auto shape = [](double x) {
    const double b = 1.875104068711961;
    const double s = (std::sinh(b) - std::sin(b)) / (std::cosh(b) + std::cos(b));
    return std::array{std::cosh(b * x) - std::cos(b * x) - s * (std::sinh(b * x) - std::sin(b * x)),
                      b * (std::sinh(b * x) + std::sin(b * x) - s * (std::cosh(b * x) - std::cos(b * x)))};
  };
  for (int k = 0; k < 3 * (n + 1); ++k) {
    if (k % (n + 1) == 0)
      for (int c = 0; c < 6; ++c) model.fix(k, c);
    const auto [deflection, slope] = shape(model.position(k).x());
    model.set_velocity(k, {0, 0, 1e-6 * deflection});
    model.set_angular_velocity(k, {0, -1e-6 * slope, 0});
  }
  const double euler = square(1.875104068711961) * std::sqrt(200e9 * square(0.05) / (12 * 7850));
  EXPECT_NEAR(2 * M_PI / period(model, n, 2) / (0.997 * euler), 1, 0.01);
}

}  // namespace
}  // namespace brio
