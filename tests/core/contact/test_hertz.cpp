// Elastic balls of steel that hit a rigid wall and each other: force and duration after Hertz. Waves cross a
// ball a dozen times while it touches, so that it is nearly at rest in itself.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <numbers>
#include <utility>

#include "io/deck/read_deck.hpp"
#include "tests/core/contact/graded_ball.hpp"
#include "tests/core/scene.hpp"

namespace brio {
namespace {

using namespace test;

constexpr double ball_radius = 0.01, ball_young = 207e9, poisson = 0.3, ball_density = 7800, closing = 1;
constexpr double ball_mass =
    4.0 / 3 * std::numbers::pi * ball_radius * ball_radius * ball_radius * ball_density;
constexpr double plane_modulus = ball_young / (1 - poisson * poisson);

/// Johnson (1985), Contact mechanics, section 11.4(a).
struct Hertz {
  double force, duration;
};
Hertz hertz(double mass, double curvature_radius, double modulus) {
  const double k = 4.0 / 3 * modulus * std::sqrt(curvature_radius);
  const double approach = std::pow(1.25 * mass * closing * closing / k, 0.4);
  return {k * std::pow(approach, 1.5), 2.9432 * approach / closing};
}

struct Blow {
  double force = 0, duration = 0;
  double restitution = 0;   ///< relative velocity after over that before
  double momentum = 0;      ///< error along the line of impact, over that of the first ball
  double added = 0;         ///< most that contact has added, over the energy
  double energy_error = 0;  ///< largest relative error of the energy balance
};

void add_ball(Deck& deck, std::vector<Mesh>& meshes, std::string name, Mesh mesh, double velocity,
              const Element& element = hex8()) {
  deck.parts.push_back({name, SphereMesh{}, {}, element, "steel"});
  deck.boundary_conditions.push_back(fix(name + ".xmin", {0}));
  deck.boundary_conditions.push_back(fix(name + ".ymin", {1}));
  deck.initial_conditions.push_back(moving(name, {0, 0, velocity}));
  meshes.push_back(std::move(mesh));
}

Deck steel() {
  Deck deck;
  Elastic law = elastic(poisson);
  law.youngs_modulus = ball_young;
  law.density = ball_density;
  deck.materials = {{"steel", law}};
  deck.time.end = 80e-6;
  return deck;
}

// The force on the first ball is its gain of momentum, mean over a microsecond.
Blow strike(const Deck& deck, const std::vector<Mesh>& meshes) {
  Model model = build(deck, meshes);
  ThreadTeam team(1);
  Blow blow;
  constexpr double window = 1e-6;
  const double before = mean_velocity(model, 0, 2);
  double last = before, window_velocity = before, window_begin = 0, first_touch = -1, last_touch = 0;
  run(model, deck, team, [&](Model& m) {
    const double velocity = mean_velocity(m, 0, 2);
    if (std::abs(velocity - last) > 1e-9) {
      if (first_touch < 0) first_touch = m.times.time;
      last_touch = m.times.time;
    }
    last = velocity;
    if (m.times.time - window_begin < window) return;
    const double impulse = 4 * m.parts[0].mass * (velocity - window_velocity);
    blow.force = std::max(blow.force, std::abs(impulse) / (m.times.time - window_begin));
    window_begin = m.times.time;
    window_velocity = velocity;
  });
  blow.duration = last_touch - first_touch;
  const double other = model.parts.size() == 2 ? mean_velocity(model, 1, 2) : 0;
  blow.restitution = (last - other) / closing;
  if (model.parts.size() == 2) {
    const double first = model.parts[0].mass * before;
    blow.momentum = (model.parts[0].mass * last + model.parts[1].mass * other - first -
                     model.parts[1].mass * 0.5 * closing) /
                    first;
  }
  blow.added = model.energy.contact_added_max / model.energy.kinetic_start;
  blow.energy_error = model.energy.error_max;
  return blow;
}

/// A deck with the settings of a preset, and their element.
struct Settings {
  Deck deck;
  Element element;
};
Settings settings_of(const std::string& preset) {
  Deck read = parse_deck(
      "materials: {steel: {model: elastic, density: 7800, youngs_modulus: 207e9, poissons_ratio: 0.3}}\n"
      "parts: {ball: {mesh: {sphere: {radius: 0.01, elements: 4}}, element: hex8, material: steel}}\n"
      "contact: {surfaces: all}\ntime: {end: 80e-6}\n",
      "deck.yaml", {"numerics.preset=" + preset});
  const Element element = read.parts[0].element;
  read.parts.clear();
  return {std::move(read), element};
}

Blow on_wall(int across, Settings settings = {steel(), hex8()}) {
  Deck& deck = settings.deck;
  std::vector<Mesh> meshes;
  add_ball(deck, meshes, "ball", quarter_of_graded_ball(ball_radius, across, 0.1), -closing,
           settings.element);
  RigidWall floor;
  floor.point = {0, 0, -ball_radius};
  floor.normal = {0, 0, 1};
  deck.boundary_conditions.push_back(floor);
  return strike(deck, meshes);
}

/// The lower ball has as many elements across as `lower` says, and is turned upside down about the line x =
/// y.
Blow on_each_other(int upper, int lower, Settings settings = {steel(), hex8()}) {
  Deck& deck = settings.deck;
  if (!deck.contact) deck.contact.emplace();
  std::vector<Mesh> meshes;
  add_ball(deck, meshes, "upper", quarter_of_graded_ball(ball_radius, upper, 0.1), -0.5 * closing,
           settings.element);
  add_ball(deck, meshes, "lower", quarter_of_graded_ball(ball_radius, lower, 0.1), 0.5 * closing,
           settings.element);
  for (auto& p : meshes[0].position) p[2] += ball_radius;
  for (auto& p : meshes[1].position) p = {p[1], p[0], -p[2] - ball_radius};
  std::swap(meshes[1].node_sets["xmin"], meshes[1].node_sets["ymin"]);
  return strike(deck, meshes);
}

void report(const char* name, int across, const Blow& blow, const Hertz& exact) {
  std::printf(
      "%s, %d elements across: force %.1f N (%+.1f %%), duration %.2f us (%+.1f %%), restitution %.4f, added "
      "%.0e, energy %.0e, momentum %.0e\n",
      name, across, blow.force, 100 * (blow.force / exact.force - 1), 1e6 * blow.duration,
      100 * (blow.duration / exact.duration - 1), blow.restitution, blow.added, blow.energy_error,
      blow.momentum);
}

void expect_hertz(const Blow& blow, const Hertz& exact, double tolerance, double most_added = 1e-5,
                  double least_restitution = 0.99) {
  EXPECT_NEAR(blow.force, exact.force, tolerance * exact.force);
  EXPECT_NEAR(blow.duration, exact.duration, tolerance * exact.duration);
  EXPECT_GT(blow.restitution, least_restitution);
  EXPECT_LE(blow.restitution, 1.0);
  EXPECT_LE(blow.added, most_added);
  EXPECT_LE(blow.energy_error, 1e-3);
  EXPECT_LE(std::abs(blow.momentum), 1e-12);
}

const Hertz hertz_at_wall = hertz(ball_mass, ball_radius, plane_modulus);
const Hertz balls = hertz(ball_mass / 2, ball_radius / 2, plane_modulus / 2);

TEST(HertzSlow, BallOnARigidWall) {
  EXPECT_NEAR(hertz_at_wall.force, 2287.7, 0.1);
  EXPECT_NEAR(hertz_at_wall.duration, 52.54e-6, 1e-8);
  for (int across : {12, 16, 20, 24}) {
    const Blow blow = on_wall(across);
    report("wall", across, blow, hertz_at_wall);
    expect_hertz(blow, hertz_at_wall, 0.05);
  }
}

// Where every node faces one of the other ball, 0.987 to 0.993 by chance, with the time step.
TEST(HertzSlow, TwoBallsOfOneMesh) {
  EXPECT_NEAR(balls.force, 995.8, 0.1);
  EXPECT_NEAR(balls.duration, 60.36e-6, 1e-8);
  for (int across : {16, 20, 24}) {
    const Blow blow = on_each_other(across, across);
    report("balls", across, blow, balls);
    expect_hertz(blow, balls, 0.05, 1e-5, 0.985);
  }
}

TEST(HertzSlow, TwoBallsOfDifferentMeshes) {
  for (int across : {16, 20}) {
    const Blow blow = on_each_other(across, across + 4);
    report("different balls", across, blow, balls);
    expect_hertz(blow, balls, 0.05);
  }
}

// Solved to a tenth of the default's accuracy more gap is missing, and edges meet across the axis, where
// nodes are held sideways: impulses that hardly moved them added four times the energy of the blow in a step.
// What is added by chance (0 to 6e-3, with the time step) stays below what the tolerance leaves.
TEST(HertzSlow, TwoBallsLooselySolved) {
  Settings settings{steel(), hex8()};
  settings.deck.contact.emplace().options.tolerance = 1e-2;
  const Blow blow = on_each_other(20, 24, std::move(settings));
  report("loosely solved", 20, blow, balls);
  expect_hertz(blow, balls, 0.05, 1e-2);
}

double error(double figure, double exact) { return std::abs(figure / exact - 1); }

// Mean over meshes: that of one is a matter of where its nodes lie below the edge of the contact. Of two
// balls chance (speeds changed by 1e-12 to 1e-7) moves the mean over all by 0.6 % of the force.
TEST(HertzSlow, AccurateMeetsForceAndDurationNoWorseThanTheDefault) {
  struct Errors {
    double force_at_wall = 0, force = 0, duration = 0;
  };
  const auto errors_of = [](const std::string& preset) {
    Errors mean;
    for (const int across : {12, 16, 20}) {
      const Blow blow = on_wall(across, settings_of(preset));
      report(("wall, " + preset).c_str(), across, blow, hertz_at_wall);
      mean.force_at_wall += error(blow.force, hertz_at_wall.force) / 3;
      mean.duration += error(blow.duration, hertz_at_wall.duration) / 6;
    }
    mean.force = mean.force_at_wall / 2;
    for (const int across : {12, 16, 20}) {
      const Blow blow = on_each_other(across, across, settings_of(preset));
      report(("balls, " + preset).c_str(), across, blow, balls);
      mean.force += error(blow.force, balls.force) / 6;
      mean.duration += error(blow.duration, balls.duration) / 6;
    }
    std::printf("%s: mean error of the force %.2f %%, at the wall %.2f %%, of the duration %.2f %%\n",
                preset.c_str(), 100 * mean.force, 100 * mean.force_at_wall, 100 * mean.duration);
    return mean;
  };
  const Errors fast = errors_of("fast"), balanced = errors_of("balanced"), accurate = errors_of("accurate");
  EXPECT_LT(accurate.force_at_wall, balanced.force_at_wall + 1e-3);
  EXPECT_LT(accurate.force, balanced.force + 8e-3);
  EXPECT_LT(accurate.duration, balanced.duration + 2e-3);
  for (const Errors& errors : {fast, balanced, accurate}) {
    EXPECT_LT(errors.force, 0.05);
    EXPECT_LT(errors.duration, 0.05);
  }
}

}  // namespace
}  // namespace brio
