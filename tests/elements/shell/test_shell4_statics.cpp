#include <gtest/gtest.h>

#include <cmath>

#include "tests/elements/shell/shell_statics.hpp"

namespace brio {
namespace {

Shell4 element(double thickness, bool warping_projection, double drilling = 0.01) {
  Shell4 shell;
  shell.thickness = thickness;
  shell.warping_projection = warping_projection;
  shell.drilling_stiffness = drilling;
  return shell;
}

/// Twisted cantilever of MacNeal & Harder (1985), displacement at the tip under a unit load there.
double twisted_beam(int along, int across, double thickness, bool in_plane, bool warping_projection,
                    double drilling = 0.01) {
  const ShellMesh mesh = mapped_grid(along, across, [](double s, double t) {
    const double angle = 0.5 * M_PI * s;
    const double y = 1.1 * (t - 0.5);
    return Eigen::Vector3d(12 * s, y * std::cos(angle), y * std::sin(angle));
  });
  ShellStatics statics(mesh, element(thickness, warping_projection, drilling),
                       {.density = 1, .youngs_modulus = 29e6, .poissons_ratio = 0.22});
  for (int j = 0; j <= across; ++j)
    for (int c = 0; c < 6; ++c) statics.fix(j * (along + 1), c);
  // At the tip the strip lies along z: in its plane is z.
  const int component = in_plane ? 2 : 1;
  for (int j = 0; j <= across; ++j)
    statics.load(j * (along + 1) + along, component, (j == 0 || j == across ? 0.5 : 1.0) / across);
  return statics.solve()[6 * (across / 2 * (along + 1) + along) + component];
}

/// Hemisphere under two pairs of opposite unit loads at the equator; a quarter is modelled.
double hemisphere(int n, double hole_degrees, bool warping_projection) {
  const double top = 0.5 * M_PI - hole_degrees / 180 * M_PI;
  const ShellMesh mesh = mapped_grid(n, n, [&](double s, double t) {
    const double phi = 0.5 * M_PI * s;
    const double theta = top * t;
    return Eigen::Vector3d(10 * std::cos(theta) * std::cos(phi), 10 * std::cos(theta) * std::sin(phi),
                           10 * std::sin(theta));
  });
  ShellStatics statics(mesh, element(0.04, warping_projection),
                       {.density = 1, .youngs_modulus = 6.825e7, .poissons_ratio = 0.3});
  for (int j = 0; j <= n; ++j) {
    for (int c : {1, 3, 5}) statics.fix(j * (n + 1), c);
    for (int c : {0, 4, 5}) statics.fix(j * (n + 1) + n, c);
  }
  statics.fix(0, 2);
  statics.load(0, 0, 1);
  statics.load(n, 1, -1);
  const Eigen::VectorXd u = statics.solve();
  return 0.5 * (u[0] - u[6 * n + 1]);
}

/// Octant of a cylinder with end diaphragms, pinched by opposite loads: times E t / P.
double pinched_cylinder(int n, double drilling) {
  const double radius = 100, length = 200, thickness = 1, modulus = 3e7;
  const ShellMesh mesh = mapped_grid(n, n, [&](double s, double t) {
    return Eigen::Vector3d(radius * std::sin(0.5 * M_PI * s), 0.5 * length * t,
                           radius * std::cos(0.5 * M_PI * s));
  });
  ShellStatics statics(mesh, element(thickness, false, drilling),
                       {.density = 1, .youngs_modulus = modulus, .poissons_ratio = 0.3});
  for (int k = 0; k <= n; ++k) {
    for (int c : {0, 4, 5}) statics.fix(k * (n + 1), c);      // x = 0 under the load
    for (int c : {2, 3, 4}) statics.fix(k * (n + 1) + n, c);  // z = 0
    for (int c : {1, 3, 5}) statics.fix(k, c);                // middle of the length
    for (int c : {0, 2}) statics.fix(n * (n + 1) + k, c);     // diaphragm
  }
  statics.load(0, 2, -0.25);
  return -statics.solve()[2] * modulus * thickness;
}

// References: MacNeal & Harder (1985).
constexpr double twisted_in_plane = 5.424e-3, twisted_out_of_plane = 1.754e-3;
constexpr double thin_in_plane = 5256, thin_out_of_plane = 1294;

TEST(Shell4Statics, TwistedBeam) {
  // With the projection or without it, thin and thick; no stiffness against drilling locks it, however high.
  for (bool projection : {false, true}) {
    for (double drilling : {0.001, 0.01, 0.1}) {
      EXPECT_NEAR(twisted_beam(12, 2, 0.0032, true, projection, drilling) / thin_in_plane, 1, 0.05);
      EXPECT_NEAR(twisted_beam(12, 2, 0.0032, false, projection, drilling) / thin_out_of_plane, 1, 0.05);
    }
    EXPECT_NEAR(twisted_beam(48, 8, 0.32, true, projection) / twisted_in_plane, 1, 0.02);
    EXPECT_NEAR(twisted_beam(48, 8, 0.32, false, projection) / twisted_out_of_plane, 1, 0.04);
  }
}

TEST(Shell4Statics, TwistedBeamOfFreeDrillingNeedsTheWarpingProjection) {
  EXPECT_NEAR(twisted_beam(48, 8, 0.32, true, true, 0) / twisted_in_plane, 1, 0.02);
  EXPECT_GT(twisted_beam(48, 8, 0.32, true, false, 0) / twisted_in_plane, 100)
      << "the original is far too soft";
  EXPECT_GT(twisted_beam(48, 8, 0.0032, true, false, 0) / thin_in_plane, 3);
}

TEST(Shell4Statics, PinchedHemisphereNeitherLocksNorSoftens) {
  for (int n : {8, 16, 32}) {
    EXPECT_NEAR(hemisphere(n, 18, false) / 0.0940, 1, 0.01) << n;
    EXPECT_NEAR(hemisphere(n, 0, false) / 0.0924, 1, 0.015) << n;
  }
}

TEST(Shell4Statics, PinchedCylinder) {
  EXPECT_NEAR(pinched_cylinder(16, 0.01) / 164.24, 1, 0.05);
  EXPECT_NEAR(pinched_cylinder(32, 0.01) / 164.24, 1, 0.005);
  EXPECT_NEAR(pinched_cylinder(32, 0) / 164.24, 1, 0.02) << "not even free spins about the normal soften it";
}

/// Torsional stiffness of a strip of 10 x 1 x 0.1 over that of Saint-Venant.
double strip_torsion(int along, int across, double hourglass_stiffness = 0.05) {
  const ShellMesh mesh =
      mapped_grid(along, across, [](double s, double t) { return Eigen::Vector3d(10 * s, t - 0.5, 0); });
  Shell4 shell = element(0.1, false, 0.001);
  shell.hourglass_stiffness = hourglass_stiffness;
  ShellStatics statics(mesh, shell, {.density = 1, .youngs_modulus = 1.2e6, .poissons_ratio = 0});
  for (int j = 0; j <= across; ++j)
    for (int c = 0; c < 6; ++c) statics.fix(j * (along + 1), c);
  const int right = along, left = across * (along + 1) + along;
  statics.load(left, 2, 1);
  statics.load(right, 2, -1);
  const Eigen::VectorXd u = statics.solve();
  const double twist = u[6 * left + 2] - u[6 * right + 2];
  return 10 / twist / (0.6e6 * 0.312 * 1e-3);
}

// A strip one element wide twists through hourglass control of the deflection alone, however short its
// elements.
TEST(Shell4Statics, StripOfOneElementTwistsAsWideOnes) {
  EXPECT_NEAR(strip_torsion(80, 8), 1, 0.05);
  EXPECT_NEAR(strip_torsion(64, 2), 1, 0.08);
  for (const int along : {4, 16, 64, 256})
    for (const double soft : {0.01, 0.05})
      EXPECT_NEAR(strip_torsion(along, 1, soft), 1, 0.1) << along << ' ' << soft;
}

}  // namespace
}  // namespace brio
