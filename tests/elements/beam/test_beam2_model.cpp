#include <gtest/gtest.h>

#include "src/base/index.hpp"
#include "tests/elements/beam/beam_model.hpp"

namespace brio {
namespace {

Beam2 strip(double width, double height) {
  return beam_of(RectangleSection{.width = width, .height = height}, {0, 0, 1});
}

/// Period of a free vibration: from the zero crossings of one node's deflection along z.
double period(BeamModel& model, int node, int half_periods) {
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

/// Lowest circular frequency of a cantilever of length 1 after Timoshenko: the root of the determinant of
/// his boundary conditions (Huang 1961), by bisection.
double timoshenko_cantilever(double area, double moment, double factor, const Elastic& law) {
  const double shear = law.elastic().shear();
  const double r2 = moment / area;
  const double s2 = law.youngs_modulus * moment / (factor * area * shear);
  const auto determinant = [&](double b) {  // b^2 = rho A omega^2 / (E I)
    const double root = std::sqrt(square(r2 - s2) + 4 / (b * b));
    const double alpha = std::sqrt((-(r2 + s2) + root) / 2);
    const double beta = std::sqrt((r2 + s2 + root) / 2);
    return 2 + (b * b * square(r2 - s2) + 2) * std::cosh(b * alpha) * std::cos(b * beta) -
           b * (r2 + s2) / std::sqrt(1 - b * b * r2 * s2) * std::sinh(b * alpha) * std::sin(b * beta);
  };
  double low = 2, high = 3.6;
  for (int k = 0; k < 100; ++k) {
    const double middle = 0.5 * (low + high);
    (determinant(middle) > 0 ? low : high) = middle;
  }
  return low * std::sqrt(law.youngs_modulus * moment / (law.density * area));
}

double cantilever_frequency(double height, int elements) {
  BeamModel model(origin, Eigen::Vector3d(1, 0, 0), elements, strip(height, height), steel());
  model.clamp(0);
  for (int n = 0; n <= elements; ++n) {
    const double b = 1.875104068711961;
    const double s = (std::sinh(b) - std::sin(b)) / (std::cosh(b) + std::cos(b));
    const double x = b * n / elements;
    model.set_velocity(n, {0, 0, 1e-6 * (std::cosh(x) - std::cos(x) - s * (std::sinh(x) - std::sin(x)))});
    model.set_angular_velocity(
        n, {0, -1e-6 * b * (std::sinh(x) + std::sin(x) - s * (std::cosh(x) - std::cos(x))), 0});
  }
  return 2 * M_PI / period(model, elements, 4);
}

TEST(Beam2Vibration, CantileverHasTimoshenkosFrequency) {
  for (const double height : {0.2, 0.1, 0.02}) {
    const double exact = timoshenko_cantilever(height * height, std::pow(height, 4) / 12, 5.0 / 6, steel());
    EXPECT_NEAR(cantilever_frequency(height, 16) / exact, 1, 0.01) << height;
  }
  // Lumped masses: the error falls with the square of the length of the elements.
  const double exact = timoshenko_cantilever(0.0004, std::pow(0.02, 4) / 12, 5.0 / 6, steel());
  const double coarse = cantilever_frequency(0.02, 8) / exact - 1;
  const double fine = cantilever_frequency(0.02, 16) / exact - 1;
  EXPECT_NEAR(fine / coarse, 0.25, 0.05);
}

TEST(Beam2Vibration, RodTwistsAndStretchesWithItsWaveSpeeds) {
  const Elastic law = steel();
  for (const bool twisting : {false, true}) {
    constexpr int elements = 20;
    BeamModel model(origin, Eigen::Vector3d(0, 0, 2), elements,
                    beam_of(CircleSection{.radius = 0.05}, {1, 0, 0}), law);
    model.clamp(0);
    for (int n = 0; n <= elements; ++n) {
      const Eigen::Vector3d v(0, 0, 1e-6 * std::sin(0.5 * M_PI * n / elements));
      twisting ? model.set_angular_velocity(n, v) : model.set_velocity(n, v);
    }
    const double modulus = twisting ? law.elastic().shear() : law.youngs_modulus;
    const double exact = 8 / std::sqrt(modulus / law.density);  // four lengths
    const double step = 0.9 * model.stable_step();
    // The velocity of the end is a cosine: through zero after a quarter.
    const auto speed = [&] {
      return twisting ? model.angular_velocity(elements).z() : model.velocity(elements).z();
    };
    double before = speed();
    for (model.advance(step); speed() > 0; model.advance(step)) before = speed();
    // Velocities belong to the middles of the steps.
    const double crossing = model.time - 0.5 * step - step * speed() / (speed() - before);
    EXPECT_NEAR(crossing / (0.25 * exact), 1, 1e-3) << twisting;
  }
}

/// Tip of a cantilever of length 1 under a force across its first direction that stays so: Euler's elastica,
/// E I theta'' = -P cos(theta), by shooting with a Runge-Kutta method.
std::array<double, 2> elastica(double force) {
  constexpr int steps = 2000;
  std::array<double, 2> tip{};
  const auto end_curvature = [&](double root_curvature) {
    double theta = 0, curvature = root_curvature;
    tip = {0, 0};
    const double h = 1.0 / steps;
    for (int k = 0; k < steps; ++k) {
      const auto slope = [&](double t) { return -force * std::cos(t); };
      const double k1 = curvature, l1 = slope(theta);
      const double k2 = curvature + 0.5 * h * l1, l2 = slope(theta + 0.5 * h * k1);
      const double k3 = curvature + 0.5 * h * l2, l3 = slope(theta + 0.5 * h * k2);
      const double k4 = curvature + h * l3, l4 = slope(theta + h * k3);
      const double next = theta + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
      const double middle = theta + 0.5 * h * k2;
      tip[0] += h / 6 * (std::cos(theta) + 4 * std::cos(middle) + std::cos(next));
      tip[1] += h / 6 * (std::sin(theta) + 4 * std::sin(middle) + std::sin(next));
      curvature += h / 6 * (l1 + 2 * l2 + 2 * l3 + l4);
      theta = next;
    }
    return curvature;
  };
  double low = 0, high = force;
  for (int k = 0; k < 100; ++k) {
    const double middle = 0.5 * (low + high);
    (end_curvature(middle) < 0 ? low : high) = middle;
  }
  return tip;
}

/// To rest, damped near the critical of the mode that `length` says: half a sine over the steps it takes.
void rest(BeamModel& model, double step, double slow_period, int periods) {
  const double keep = 1 - 2 * M_PI * step / slow_period;
  for (double end = model.time + periods * slow_period; model.time < end;) model.advance(step, keep);
}

TEST(Beam2Statics, CantileverUnderALargeForceTakesTheShapeOfTheElastica) {
  // E 1.2e6, 10 x 1 x 0.1, P = 4: P L^2 / (E I) = 4. Published: tip 6.698, shortening 3.286.
  const Elastic law{.density = 1e-3, .youngs_modulus = 1.2e6, .poissons_ratio = 0};
  constexpr int elements = 20;
  BeamModel model(origin, Eigen::Vector3d(10, 0, 0), elements, strip(1, 0.1), law);
  model.clamp(0);
  model.load(elements, {0, 0, 4}, origin);
  const double frequency = 1.8751 * 1.8751 / 100 * std::sqrt(100 / (1e-3 * 0.1));
  rest(model, 0.9 * model.stable_step(), 0.7 * 2 * M_PI / frequency, 8);
  const auto [along, across] = elastica(4);
  EXPECT_NEAR(10 * across, 6.698, 0.01);
  EXPECT_NEAR(10 - 10 * along, 3.286, 0.01);
  const Eigen::Vector3d tip = model.position(elements);
  EXPECT_NEAR(tip.z() / (10 * across), 1, 2e-3);
  EXPECT_NEAR((10 - tip.x()) / (10 - 10 * along), 1, 5e-3);
  EXPECT_LT(model.velocity(elements).norm(), 1e-6 * std::sqrt(1.2e9));
}

TEST(Beam2Statics, EndMomentRollsACantileverUpToAFullCircle) {
  // M = 2 pi E I / L.
  const Elastic law{.density = 1e-3, .youngs_modulus = 1.2e6, .poissons_ratio = 0};
  constexpr int elements = 12;
  const double length = 12;
  BeamModel model(origin, Eigen::Vector3d(length, 0, 0), elements, strip(1, 0.1), law);
  model.clamp(0);
  const double moment = 2 * M_PI * 100 / length;
  const double frequency = 1.8751 * 1.8751 / 144 * std::sqrt(100 / (1e-3 * 0.1));
  const double slow = 2 * M_PI / frequency;
  const double step = 0.5 * model.stable_step();
  const double keep = 1 - 2 * M_PI * step / slow;
  while (model.time < 4 * slow) {
    model.load(elements, origin, {0, -moment * std::min(1.0, model.time / (2 * slow)), 0});
    model.advance(step, keep);
  }
  // The nodes lie on a regular polygon whose corners are 12 chords of length 1 apart: its sides are not
  // stretched.
  EXPECT_LT((model.position(elements) - origin).norm(), 2e-3 * length);
  const double diameter = 1 / std::sin(M_PI / elements);
  EXPECT_NEAR(model.position(elements / 2).z(), diameter, 2e-3 * diameter);
  EXPECT_NEAR(model.moment(0).y() / moment, -1, 2e-3);
}

/// A beam that spins freely, askew to its axes, from no stretch: it vibrates. Largest changes of energy, mean
/// over a turn, and of angular momentum over a number of turns, relative.
std::array<double, 2> drift_of_a_free_spin(int turns) {
  constexpr int elements = 4;
  BeamModel model(Eigen::Vector3d(-1, 0.1, 0.2), Eigen::Vector3d(1, -0.2, 0.1), elements,
                  beam_of(RectangleSection{.width = 0.1, .height = 0.2}, {0, 0, 1}), steel());
  constexpr int steps_a_turn = 320;
  const double step = 0.8 * model.stable_step();
  const Eigen::Vector3d spin = 2 * M_PI / (steps_a_turn * step) * Eigen::Vector3d(0.1, 0.2, 1).normalized();
  for (int n = 0; n <= elements; ++n) {
    model.set_velocity(n, spin.cross(model.position(n)));
    model.set_angular_velocity(n, spin);
  }
  const Eigen::Vector3d start = model.angular_momentum();
  double first = 0;
  std::array<double, 2> largest{};
  for (int turn = 0; turn < turns; ++turn) {
    double energy = 0;
    for (int k = 0; k < steps_a_turn; ++k) {
      const double work = model.work;
      model.advance(step);
      energy += model.kinetic_energy() + work;
    }
    if (turn == 0) first = energy;
    largest[0] = std::max(largest[0], std::abs(energy / first - 1));
    largest[1] = std::max(largest[1], (model.angular_momentum() - start).norm() / start.norm());
  }
  EXPECT_GT(model.work, 1e-4 * model.kinetic_energy());
  return largest;
}

TEST(Beam2Dynamics, FreeSpinGoesOnWithoutDrift) {
  const auto [energy, momentum] = drift_of_a_free_spin(300);
  EXPECT_LT(energy, 1e-6);
  EXPECT_LT(momentum, 1e-10);
}

TEST(Beam2Slow, FreeSpinOfTenThousandTurnsGoesOnWithoutDrift) {
  const auto [energy, momentum] = drift_of_a_free_spin(10000);
  EXPECT_LT(energy, 1e-6);
  EXPECT_LT(momentum, 1e-9);
}

TEST(Beam2Dynamics, IsComputedInDoubleWhateverThePrecision) {
  double tip[2];
  for (const Precision precision : {Precision::double_precision, Precision::single_precision}) {
    constexpr int elements = 10;
    BeamModel model(origin, Eigen::Vector3d(1, 0, 0), elements, strip(0.05, 0.05), steel(), precision);
    model.clamp(0);
    model.load(elements, {0, 0, 1e5}, origin);
    const double step = 0.9e-5;
    ASSERT_LT(step, model.stable_step());
    for (int k = 0; k < 1000; ++k) model.advance(step);
    tip[precision == Precision::double_precision ? 0 : 1] = model.position(elements).z();
  }
  EXPECT_GT(std::abs(tip[0]), 0.05);
  EXPECT_EQ(tip[1], tip[0]);
}

TEST(Beam2, LanesDoWhatPlainNumbersDo) {
  constexpr int elements = 11;  // more than a pack, and a part of one
  BeamModel model(origin, Eigen::Vector3d(1, 0.5, 0.2), elements, strip(0.05, 0.1), steel());
  for (int n = 0; n <= elements; ++n) {
    model.set_velocity(n, {std::sin(3.0 * n), std::cos(2.0 * n), std::sin(n * n)});
    model.set_angular_velocity(n, {40 * std::sin(1.0 * n), 50 * std::cos(5.0 * n), 30 * std::sin(7.0 * n)});
  }
  std::vector<SingleBeam<>> single;
  for (int e = 0; e < elements; ++e)
    single.emplace_back(strip(0.05, 0.1), steel(), Pair{model.position(e), model.position(e + 1)});
  const double step = 0.5 * model.stable_step();
  for (int k = 0; k < 5; ++k) {
    model.advance(step);
    std::vector<Eigen::Vector3d> force(elements + 1, origin), moment(elements + 1, origin);
    for (int e = 0; e < elements; ++e) {
      SingleBeam<>& beam = single[index(e)];
      beam.move({model.position(e), model.position(e + 1)},
                {step * model.angular_velocity(e), step * model.angular_velocity(e + 1)}, step);
      for (int n = 0; n < 2; ++n) {
        force[index(e + n)] -= beam.force(n);
        moment[index(e + n)] -= beam.moment(n);
      }
    }
    for (int n = 0; n <= elements; ++n) {
      EXPECT_LT((model.force(n) - force[index(n)]).norm(), 1e-9 * model.force(n).norm());
      EXPECT_LT((model.moment(n) - moment[index(n)]).norm(),
                1e-9 * (model.moment(n).norm() + model.force(n).norm()));
    }
  }
}

}  // namespace
}  // namespace brio
