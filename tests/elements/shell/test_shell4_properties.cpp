#include <gtest/gtest.h>

#include "materials/elastic_plastic.hpp"
#include "src/base/index.hpp"
#include "tests/elements/shell/shell_model.hpp"

namespace brio {
namespace {

ElasticPlastic soft_steel() {
  return {.density = 7850, .youngs_modulus = 200e9, .poissons_ratio = 0.3, .yield_stress = 300e6};
}

/// A crumpling sheet: enough elements to fill packs and leave one partly empty, warped, yielding.
ShellMesh warped_sheet(double size) {
  std::mt19937 random(6);
  std::uniform_real_distribution<double> u(-0.02, 0.02);
  return mapped_grid(7, 5, [&](double s, double t) -> Eigen::Vector3d {
    return size *
           Eigen::Vector3d(s + u(random), t + u(random), 0.1 * std::sin(5 * s) * std::cos(4 * t) + u(random));
  });
}

void set_crumpling_velocity(ShellModel& model, double size, double speed) {
  for (int n = 0; n < static_cast<int>(model.nodes.size()); ++n) {
    const Eigen::Vector3d x = model.position(n) / size;
    model.set_velocity(
        n, speed * Eigen::Vector3d(std::sin(3 * x.y()), -std::cos(2 * x.x()), std::sin(6 * x.x()) * x.y()));
    model.set_angular_velocity(n, speed / size * Eigen::Vector3d(x.y(), -2 * x.x(), 0.1));
  }
}

ShellModel crumpled(const Shell4& shell, Precision precision, int steps, double size = 1) {
  ShellModel model(warped_sheet(size), shell, soft_steel(), precision);
  set_crumpling_velocity(model, size, 40);
  for (int k = 0; k < steps; ++k) model.advance(0.5 * model.stable_step());
  return model;
}

Shell4 sheet_element() {
  Shell4 shell;
  shell.thickness = 0.01;
  shell.warping_projection = true;
  shell.hourglass_viscosity = 0.02;
  return shell;
}

TEST(Shell4Properties, MomentumIsConservedAndEnergyIsAccountedFor) {
  ShellModel model(warped_sheet(1), sheet_element(), soft_steel());
  set_crumpling_velocity(model, 1, 40);
  const auto momenta = [&] {
    std::array<Eigen::Vector3d, 2> sum = {Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
    for (int n = 0; n < static_cast<int>(model.nodes.size()); ++n) {
      const auto i = index(n);
      const Eigen::Vector3d p = model.nodes.mass[i] * model.velocity(n);
      sum[0] += p;
      sum[1] += model.position(n).cross(p) + model.nodes.rotational_inertia[i] * model.angular_velocity(n);
    }
    return sum;
  };
  const double energy = model.kinetic_energy();
  const auto start = momenta();
  const double size = std::sqrt(2 * energy * 7850 * 0.01);
  const int steps = 400;
  for (int k = 0; k < steps; ++k) model.advance(0.5 * model.stable_step());
  const auto end = momenta();
  EXPECT_LT((end[0] - start[0]).norm(), 1e-12 * size);
  EXPECT_LT((end[1] - start[1]).norm(), 1e-11 * size);
  EXPECT_GT(model.work, 0.3 * energy) << "the sheet should have been crumpled";
  EXPECT_NEAR(model.kinetic_energy() + model.work, energy, 5e-3 * energy);
  double plastic = 0;
  for (int e = 0; e < 35; ++e)
    plastic = std::max(plastic, model.sample(e).named("equivalent_plastic_strain"));
  EXPECT_GT(plastic, 1e-3);
}

TEST(Shell4Properties, UnitsScaledByPowersOfTwoGiveTheSameBits) {
  // Lengths times 4 and times as well: velocities and stresses stay.
  Shell4 large = sheet_element();
  large.thickness *= 4;
  const ShellModel one = crumpled(sheet_element(), Precision::double_precision, 60, 1);
  const ShellModel four = crumpled(large, Precision::double_precision, 60, 4);
  for (int n = 0; n < static_cast<int>(one.nodes.size()); ++n) {
    EXPECT_EQ(4 * one.position(n), four.position(n)) << n;
    EXPECT_EQ(one.velocity(n), four.velocity(n)) << n;
  }
  EXPECT_EQ(4 * one.time, four.time);
}

TEST(Shell4Properties, FloatFollowsDouble) {
  const ShellModel wide = crumpled(sheet_element(), Precision::double_precision, 60);
  const ShellModel narrow = crumpled(sheet_element(), Precision::single_precision, 60);
  EXPECT_NEAR(narrow.work / wide.work, 1, 1e-3);
  for (int n = 0; n < static_cast<int>(wide.nodes.size()); ++n)
    EXPECT_LT((wide.velocity(n) - narrow.velocity(n)).norm(), 0.1) << n;
}

TEST(Shell4Properties, LanesGiveWhatOneElementGives) {
  ShellModel model(warped_sheet(1), sheet_element(), soft_steel());
  set_crumpling_velocity(model, 1, 40);
  const ShellMesh mesh = warped_sheet(1);
  const double step = 1e-5;
  std::vector<Eigen::Vector3d> force(mesh.point.size(), Eigen::Vector3d::Zero()), moment = force;
  for (const auto& nodes : mesh.element) {
    Points4 x, v, w;
    for (std::size_t k = 0; k < 4; ++k) {
      x[k] = mesh.point[index(nodes[k])];
      v[k] = model.velocity(nodes[k]);
      w[k] = model.angular_velocity(nodes[k]);
    }
    SingleShell<ElasticPlastic> element(sheet_element(), soft_steel(), x);
    element.move(x, v, w, step);
    for (std::size_t k = 0; k < 4; ++k) {
      force[index(nodes[k])] -= element.force(static_cast<int>(k));
      moment[index(nodes[k])] -= element.moment(static_cast<int>(k));
    }
  }
  model.sweep(step);
  for (int n = 0; n < static_cast<int>(mesh.point.size()); ++n) {
    EXPECT_LT((model.force(n) - force[index(n)]).norm(), 1e-12 * 300e6 * 0.01) << n;
    EXPECT_LT((model.moment(n) - moment[index(n)]).norm(), 1e-12 * 300e6 * 0.01) << n;
  }
}

/// Forces and moments of one yielding element after three steps, its nodes listed from `shift` on and the
/// scene mirrored in the plane x = 0 if asked for.
std::array<std::array<Eigen::Vector3d, 4>, 2> after_three_steps(int shift, bool mirror) {
  std::mt19937 random(12);
  std::uniform_real_distribution<double> u(-1, 1);
  Points4 x = random_quadrilateral(random, 1, 1.3, 0.2, 0.1);
  Points4 v, w;
  for (std::size_t n = 0; n < 4; ++n) {
    v[n] = 5 * Eigen::Vector3d(u(random), u(random), u(random));
    w[n] = 9 * Eigen::Vector3d(u(random), u(random), u(random));
    if (mirror) {  // angular velocities are axial vectors
      x[n].x() = -x[n].x();
      v[n].x() = -v[n].x();
      w[n].y() = -w[n].y();
      w[n].z() = -w[n].z();
    }
  }
  const auto listed = [&](const Points4& field) {
    Points4 out;
    for (int n = 0; n < 4; ++n) {
      const int from =
          mirror ? (4 - n + shift) % 4 : (n + shift) % 4;  // a mirrored element is listed backwards
      out[index(n)] = field[index(from)];
    }
    return out;
  };
  Shell4 shell = sheet_element();
  shell.thickness = 0.1;
  SingleShell<ElasticPlastic> element(shell, soft_steel(), listed(x));
  const double step = 5e-4;
  for (int k = 0; k < 3; ++k) {
    for (std::size_t n = 0; n < 4; ++n) x[n] += step * v[n];
    element.move(listed(x), listed(v), listed(w), step);
  }
  EXPECT_GT(element.plastic_strain(), 1e-4);
  std::array<std::array<Eigen::Vector3d, 4>, 2> out;
  for (int n = 0; n < 4; ++n) {
    const auto from = index(mirror ? (4 - n + shift) % 4 : (n + shift) % 4);
    out[0][from] = element.force(n);
    out[1][from] = element.moment(n);
  }
  return out;
}

TEST(Shell4Properties, RenumberingTheNodesInACircleChangesNothing) {
  const auto reference = after_three_steps(0, false);
  for (int shift : {1, 2, 3}) {
    const auto other = after_three_steps(shift, false);
    for (std::size_t n = 0; n < 4; ++n)
      for (std::size_t kind : {0u, 1u})
        EXPECT_LT((other[kind][n] - reference[kind][n]).norm(), 1e-11 * reference[0][0].norm())
            << shift << " " << n;
  }
}

TEST(Shell4Properties, MirroredSceneGivesMirroredForces) {
  const auto reference = after_three_steps(0, false);
  const auto mirrored = after_three_steps(0, true);
  for (std::size_t n = 0; n < 4; ++n) {
    Eigen::Vector3d force = mirrored[0][n], moment = mirrored[1][n];
    force.x() = -force.x();
    moment.y() = -moment.y();
    moment.z() = -moment.z();
    EXPECT_LT((force - reference[0][n]).norm(), 1e-11 * reference[0][0].norm()) << n;
    EXPECT_LT((moment - reference[1][n]).norm(), 1e-11 * reference[0][0].norm()) << n;
  }
}

/// Rectangle sheared or stretched step by step: x -> F(t) x.
template <class Law>
void drive(SingleShell<Law>& element, const Points4& start, Points4& x, const Eigen::Matrix3d& map,
           double step) {
  Points4 next, v;
  for (std::size_t n = 0; n < 4; ++n) {
    next[n] = map * start[n];
    v[n] = (next[n] - x[n]) / step;
  }
  element.move(next, v, SingleShell<Law>::none(), step);
  x = next;
}

TEST(Shell4Properties, SimpleShearFollowsGreenAndNaghdi) {
  const Points4 start = {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(2, 0, 0), Eigen::Vector3d(2, 1, 0),
                         Eigen::Vector3d(0, 1, 0)};
  Points4 x = start;
  Shell4 shell = sheet_element();
  shell.linear_bulk_viscosity = 0;
  shell.drilling_viscosity = 0;
  SingleShell<> element(shell, steel(), start);
  const int steps = 2000;
  const double shear = 200e9 / 2.6;
  for (int k = 1; k <= steps; ++k) {
    const double gamma = 10.0 * k / steps;
    Eigen::Matrix3d map = Eigen::Matrix3d::Identity();
    map(0, 1) = gamma;
    drive(element, start, x, map, 1e-3);
    if (k % 200 != 0) continue;
    // Dienes (1979), with tan(beta) = gamma / 2.
    const double beta = std::atan(0.5 * gamma);
    const double expected_shear =
        2 * shear * std::cos(2 * beta) *
        (2 * beta - 2 * std::tan(2 * beta) * std::log(std::cos(beta)) - std::tan(beta));
    const double expected_normal =
        4 * shear *
        (std::cos(2 * beta) * std::log(std::cos(beta)) + beta * std::sin(2 * beta) - square(std::sin(beta)));
    const ElementSample s = element.sample();
    EXPECT_NEAR(s.stress.xy, expected_shear, 1e-4 * shear * gamma) << gamma;
    EXPECT_NEAR(s.stress.xx, expected_normal, 1e-4 * shear * gamma) << gamma;
  }
}

TEST(Shell4Properties, TensionThinsThePlateAsMuchAsItNarrows) {
  const Points4 start = {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(1, 1, 0),
                         Eigen::Vector3d(0, 1, 0)};
  Points4 x = start;
  SingleShell<ElasticPlastic> element(sheet_element(), soft_steel(), start);
  double width = 1;
  const int steps = 400;
  for (int k = 1; k <= steps; ++k) {
    // The width at which no lateral stress is left, by secants.
    const double length = 1 + 0.3 * k / steps;
    const auto trial = [&](double w) {
      SingleShell<ElasticPlastic> copy = element;
      Points4 y = x;
      drive(copy, start, y, Eigen::Vector3d(length, w, 1).asDiagonal(), 1e-3);
      return copy.sample().stress.yy;
    };
    double a = width, b = width * 0.9995;
    double fa = trial(a), fb = trial(b);
    for (int iteration = 0; iteration < 30 && std::abs(fb) > 1e-6 * 300e6 && fa != fb; ++iteration) {
      const double c = b - fb * (b - a) / (fb - fa);
      a = b;
      fa = fb;
      b = c;
      fb = trial(b);
    }
    width = b;
    drive(element, start, x, Eigen::Vector3d(length, width, 1).asDiagonal(), 1e-3);
  }
  const double thinning = element.header.thickness / 0.01;
  EXPECT_NEAR(thinning, width, 1e-5);
  // Plastic flow keeps the volume; what is left is elastic: sigma (1 - 2 nu) / E.
  EXPECT_NEAR(1.3 * width * thinning, 1 + 300e6 * 0.4 / 200e9, 2e-5);
  EXPECT_NEAR(element.sample().stress.xx, 300e6, 1e-4 * 300e6);
}

TEST(Shell4Properties, FullyPlasticMomentIsThatOfTheRule) {
  // The moment of a strip is sigma_y h^2 / 4; what a rule gives when all its points have yielded is the sum
  // of weight times distance: 5.5 % too little with five Gauss points, of which the middle one carries
  // nothing.
  for (int count = 2; count <= most_thickness_points; ++count) {
    Shell4 shell = sheet_element();
    shell.thickness_points = count;
    shell.thickness_update = false;
    ElasticPlastic law = soft_steel();
    law.poissons_ratio = 0;
    const Points4 x = {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(1, 1, 0),
                       Eigen::Vector3d(0, 1, 0)};
    SingleShell<ElasticPlastic> element(shell, law, x);
    const Eigen::Vector3d turn(0, 0.5, 0);
    for (int k = 0; k < 400; ++k)
      element.move(x, SingleShell<>::none(), {-1.0 * turn, turn, turn, -1.0 * turn}, 0.01);
    const double moment = element.moment(1).y() + element.moment(2).y();
    double limit = 0;
    for (std::size_t p = 0; p < index(count); ++p)
      limit += shell.rule().weight[p] * std::abs(shell.rule().place[p]);
    // Bent to a cylinder, the strip yields at 2 / sqrt 3 of its strength as the flow turns to plane strain.
    const double strength = 2 / std::sqrt(3.0) * 300e6 * square(shell.thickness);
    EXPECT_NEAR(moment, strength * limit, 0.01 * strength * limit) << count;
    if (count == 5) {
      EXPECT_NEAR(limit / 0.25, 0.945, 1e-3);
    }
    if (count >= 6) {
      EXPECT_NEAR(limit / 0.25, 1, 0.035) << count;
    }
  }
}

}  // namespace
}  // namespace brio
