// Sleep leaves no trace: scenes with and without it have the same bits; and the bound it rests on is one.
#include <gtest/gtest.h>

#include <random>

#include "contact/closest_point.hpp"
#include "contact/face_geometry.hpp"
#include "contact/travel.hpp"
#include "tests/contact/spring_model.hpp"

namespace brio::test {
namespace {

using Build = std::function<void(SpringModel&)>;

Map turned(std::mt19937& random, const Vector3d& to) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  const Vector3d axis(uniform(random), uniform(random), uniform(random));
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(3 * uniform(random), axis.normalized()).toRotationMatrix();
  return [turn, to](const Vector3d& x) -> Vector3d { return turn * x + to; };
}

// Blocks and sheets thrown at each other.
void throw_things(SpringModel& model, unsigned seed, double speed, const Vector3d& common_velocity,
                  bool erodible = false) {
  std::mt19937 random(seed);
  int things = 0;
  for (const double x : {0.0, 2.5})
    for (const double y : {0.0, 2.5})
      for (const double z : {0.0, 2.5}) {
        const Vector3d centre(x, y, z);
        const Map map = turned(random, centre);
        const int first = ++things % 3 == 0 ? model.add_sheet({4, 4}, {1.5, 1.5}, 0.1, 10, map)
                                            : model.add_box({2, 2, 2}, {1, 1, 1}, 1, map);
        model.throw_from(first, speed * (Vector3d(1.25, 1.25, 1.25) - centre) + common_velocity);
      }
  model.stiffness = 200;
  ContactOptions options;
  options.friction = 0.2;
  if (erodible)
    model.start_erodible(options);
  else
    model.start(options);
}

// A heap: boxes that fall on a held floor and on each other.
void pile(SpringModel& model) {
  std::mt19937 random(4);
  model.add_box({6, 6, 1}, {6, 6, 1}, 1, shifted({-3, -3, -1}));
  const int floor = model.count();
  for (int level = 0; level < 3; ++level)
    for (const double x : {-1.0, 0.6}) {
      const Map map = turned(random, {x, 0.3 * level, 1.0 + 1.8 * level});
      model.add_box({2, 2, 2}, {1, 1, 1}, 1, map);
    }
  model.stiffness = 2000;
  model.gravity = {0, 0, -10};
  model.damping = 0.2;
  ContactOptions options;
  options.friction = 0.3;
  model.start(options);
  model.hold(0, floor);
}

// A block that slides over another and a sheet that falls on it, with boxes so wide that a search serves for
// many deletions.
void grind(SpringModel& model, double debris_radius) {
  model.debris_radius = debris_radius;
  model.stiffness = 20;
  model.gravity = {0, 0, -5};
  const int floor = model.add_box({6, 4, 2}, {1.2, 0.8, 0.4}, 1, shifted({0, 0, 0}));
  const int above = model.add_box({4, 4, 2}, {0.8, 0.8, 0.4}, 1, shifted({0.03, 0.02, 0.41}));
  model.throw_from(above, {1, 0.1, -0.3});
  model.throw_from(model.add_sheet({4, 4}, {0.8, 0.8}, 0.05, 5, shifted({0.01, 0.03, 1})), {0.5, 0, -1});
  ContactOptions options;
  options.reach_buffer = 1;
  model.start_erodible(options);
  model.hold(floor, above);
}

// A small fast sheet that crosses a cloud of slow blocks.
void cross_fast(SpringModel& model) {
  for (const double x : {0.0, 2.0, 4.0})
    for (const double y : {-1.2, 0.4}) model.add_box({2, 2, 2}, {1, 1, 1}, 1, shifted({x, y, x * 0.1}));
  const int bullet = model.add_sheet({3, 3}, {0.5, 0.5}, 0.05, 100, [](const Vector3d& x) -> Vector3d {
    return {-1.5 + 0.1 * x[0], x[1] - 0.2, x[0] + 0.3};
  });
  model.throw_from(bullet, {60, 3, 0});
  model.stiffness = 500;
  model.start({});
}

// A strip whose ends are driven together.
void fold(SpringModel& model) {
  const int columns = 24;
  model.stiffness = 50;
  model.damping = 1;
  model.add_sheet({columns, 2}, {6, 0.5}, 0.25, 1, [](const Vector3d& x) -> Vector3d {
    return {x[0], x[1], 0.05 * std::sin(std::numbers::pi * x[0] / 6)};
  });
  model.start({});
  for (int n = 0; n < model.count(); ++n) {
    const int column = n % (columns + 1);
    const int grip = column <= 1 ? 1 : column >= columns - 1 ? -1 : 0;
    if (grip == 0) continue;
    model.hold(n, n + 1);
    model.set_velocity(n, {1.0 * grip, 0, 0});
  }
}

// Of the elements of blocks and sheets, some go while things move; what is left without elements flies on.
struct Deletions {
  std::vector<SurfaceElement> living;
  std::mt19937 random{17};
  std::size_t at_once = 2;

  explicit Deletions(const SpringModel& model) {
    int part = 0;
    for (const SurfacePart& of : model.parts()) {
      const int count = static_cast<int>(of.connectivity.size()) / of.nodes_per_element;
      for (int e = 0; e < count; ++e) living.push_back({part, e});
      ++part;
    }
    std::shuffle(living.begin(), living.end(), random);
  }
  std::vector<SurfaceElement> next() {
    const std::size_t left = living.size() - std::min(at_once, living.size());
    const std::vector<SurfaceElement> chosen(living.begin() + static_cast<std::ptrdiff_t>(left),
                                             living.end());
    living.resize(left);
    return chosen;
  }
};

int awake(const SpringModel& model) {
  int count = 0;
  for (int s = 0; s < static_cast<int>(model.scene.surface.slaves()); ++s)
    if (!model.scene.detection.swept.sleeps(model.scene.travel, s)) ++count;
  return count;
}

// Every pair is as far apart as its clearance says, or the node is that far outside.
void expect_true_clearances(const SpringModel& model) {
  const ContactScene& scene = model.scene;
  const Surface& surface = scene.surface;
  for (int s = 0; s < static_cast<int>(surface.slaves()); ++s) {
    const auto faces = scene.candidates.faces_of.of(s);
    for (std::size_t k = 0; k < faces.size(); ++k) {
      const Face& face = surface.face[static_cast<std::size_t>(faces[k])];
      if (!face.alive()) continue;
      const ClosestPoint closest = closest_point_on_quad(model.x(surface.node[static_cast<std::size_t>(s)]),
                                                         vertices(model.nodes, face));
      const bool above = closest.separation.dot(closest.normal) > 0;
      const double reach =
          (above ? influence_outside : influence)(surface, scene.options, scene.candidates, faces[k]) +
          surface.radius[static_cast<std::size_t>(s)];
      ASSERT_LE(scene.detection.swept.clearance(scene.travel, scene.candidates, s, k),
                std::sqrt(closest.squared_distance) - reach + scene.travel.rounding())
          << "slave " << s << " face " << faces[k];
    }
  }
}

// Steps of both; \returns the share of nodes that slept.
double compare(const Build& build, double dt, int steps, int delete_every = 0, double most_woken = 1) {
  SpringModel sleeping, sleepless;
  build(sleeping);
  build(sleepless);
  sleepless.scene.detection.swept.may_sleep = false;
  double asleep = 0;
  std::uint64_t active = 0;
  Deletions deletions(sleeping);
  double woken = 0;  // share of the nodes, by deletions alone
  int deletions_alone = 0;
  for (int step = 0; step < steps; ++step) {
    const bool deletes = delete_every > 0 && step % delete_every == 0;
    if (deletes) {
      const std::vector<SurfaceElement> chosen = deletions.next();
      sleeping.erode(chosen);
      sleepless.erode(chosen);
    }
    sleeping.accelerate(dt);
    resolve(sleeping.scene, sleeping.nodes, dt, sleeping.alone());
    if (deletes) {
      expect_true_clearances(sleeping);
      if (testing::Test::HasFatalFailure()) return 0;
    }
    sleeping.move(dt);
    sleepless.step(dt);
    for (int n = 0; n < sleeping.count(); ++n)
      for (int axis = 0; axis < 3; ++axis)
        if (sleeping.x(n)[axis] != sleepless.x(n)[axis] || sleeping.v(n)[axis] != sleepless.v(n)[axis]) {
          ADD_FAILURE() << "node " << n << " step " << step;
          return 0;
        }
    if (sleeping.scene.contacts.size() != sleepless.scene.contacts.size()) {
      ADD_FAILURE() << "contacts in step " << step;
      return 0;
    }
    if (deletes && !sleeping.scene.step.searched) {
      ++deletions_alone;
      woken += static_cast<double>(sleeping.scene.detection.swept.woken) /
               static_cast<double>(sleeping.scene.surface.slaves());
    }
    active += static_cast<std::uint64_t>(sleeping.scene.step.active);
    asleep += 1 - static_cast<double>(awake(sleeping)) / static_cast<double>(sleeping.scene.surface.slaves());
  }
  EXPECT_GT(active, 20U) << "things met";
  if (delete_every > 0) {
    EXPECT_LT(woken, most_woken * deletions_alone);
  }
  return asleep / steps;
}

TEST(Sleep, LeavesNoTraceInRandomScenes) {
  for (const unsigned seed : {1U, 2U, 3U, 4U}) {
    const auto build = [&](SpringModel& model) { throw_things(model, seed, 2, {0.3, 0, 0}); };
    EXPECT_GT(compare(build, 1e-3, 1000), 0.3);
  }
}

TEST(Sleep, LeavesNoTraceWhereEverythingTravelsTogether) {
  const auto build = [](SpringModel& model) { throw_things(model, 9, 2, {300, -200, 100}); };
  EXPECT_GT(compare(build, 1e-3, 1000), 0.3);
}

TEST(Sleep, LeavesNoTraceWhileElementsAreDeleted) {
  for (const double debris_radius : {0.0, 0.05})
    for (const unsigned seed : {1U, 2U, 3U}) {
      const auto build = [&](SpringModel& model) {
        model.debris_radius = debris_radius;
        throw_things(model, seed, 2, {0.3, 0, 0}, true);
      };
      EXPECT_GT(compare(build, 1e-3, 1000, 25, 0.25), 0.3);
    }
  for (const double debris_radius : {0.0, 0.08})
    compare([&](SpringModel& model) { grind(model, debris_radius); }, 1e-3, 400, 10);
}

// Nothing sleeps while a step carries nodes farther than the buffer.
TEST(Sleep, LeavesNoTraceAtHighSpeed) {
  compare([](SpringModel& model) { throw_things(model, 5, 40, Vector3d::Zero()); }, 1e-3, 200);
  compare(cross_fast, 5e-4, 600);
}

TEST(Sleep, LeavesNoTraceInAPile) { EXPECT_GT(compare(pile, 5e-4, 3000), 0.1); }

TEST(Sleep, LeavesNoTraceWhereAShellFolds) { EXPECT_GT(compare(fold, 2e-3, 1000), 0.1); }

// Nodes that wander while all of them travel: no node comes nearer to any face than the bound says.
TEST(Travel, BoundsHowMuchNearerAnyNodeComesToAnyFace) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const auto vector = [&] { return Vector3d(uniform(random), uniform(random), uniform(random)); };
  constexpr int faces = 12;
  double tightest = std::numeric_limits<double>::infinity();
  for (int trial = 0; trial < 10; ++trial) {
    Surface surface;
    Nodes nodes(4 * faces, false);
    const double speed = std::pow(10.0, 2 * uniform(random));
    const Vector3d common = 100 * vector();
    for (int n = 0; n < 4 * faces; ++n) {
      surface.node.push_back(n);
      const Vector3d x = 3 * vector();
      for (int axis = 0; axis < 3; ++axis) nodes.record[static_cast<std::size_t>(n)].position[axis] = x[axis];
    }
    const auto distance = [&](int n, int f, double ahead) {
      FaceVertices corner;
      const auto at = [&](int node) {
        const NodeRecord& record = nodes.record[static_cast<std::size_t>(node)];
        return Vector3d(Vector3d(record.position) + ahead * Vector3d(record.velocity));
      };
      for (int k = 0; k < 4; ++k) corner[static_cast<std::size_t>(k)] = at(4 * f + k);
      return std::sqrt(closest_point_on_quad(at(n), corner).squared_distance);
    };
    ThreadTeam team(1);
    Travel travel;
    travel.follow(surface, nodes, {}, 0, team);
    travel.restart();
    const auto longest = [&](int f, double (Travel::*of)(int) const) {
      double most = 0;
      for (int k = 0; k < 4; ++k) most = std::max(most, (travel.*of)(4 * f + k));
      return most;
    };
    const auto pair_so_far = [&](int n, int f) { return travel.so_far(n, longest(f, &Travel::path)); };
    std::vector<double> start;
    for (int n = 0; n < 4 * faces; ++n)
      for (int f = 0; f < faces; ++f) start.push_back(distance(n, f, 0) + pair_so_far(n, f));
    for (int step = 0; step < 30; ++step) {
      const double dt = 1e-2 * (1 + 0.5 * uniform(random));
      const Vector3d gust = common + 50 * speed * vector();
      for (int n = 0; n < 4 * faces; ++n) {
        const Vector3d v = gust + speed * vector();
        for (int axis = 0; axis < 3; ++axis)
          nodes.record[static_cast<std::size_t>(n)].velocity[axis] = v[axis];
      }
      travel.follow(surface, nodes, {}, dt, team);
      for (int n = 0; n < 4 * faces; ++n)
        for (int f = 0; f < faces; ++f) {
          if (n / 4 == f) continue;
          const double so_far = pair_so_far(n, f);
          const double ahead = travel.ahead(n, longest(f, &Travel::own_ahead));
          ASSERT_LE(so_far, travel.so_far(n)) << "no pair travels farther than the node and any face";
          ASSERT_LE(ahead, travel.ahead(n));
          const double at_least = start[static_cast<std::size_t>(n * faces + f)] - so_far;
          ASSERT_GE(distance(n, f, 0), at_least - travel.rounding());
          for (const double share : {0.5, 1.0})
            ASSERT_GE(distance(n, f, share * approach_share * dt), at_least - ahead);
          tightest = std::min(tightest, (distance(n, f, 0) - at_least) / (so_far + speed * dt));
        }
      // Contact changes velocities after they were looked at: what counts is where nodes go.
      const Vector3d kick = trial % 2 == 0 ? gust : Vector3d(20 * speed * vector());
      for (int n = 0; n < 4 * faces; ++n) {
        const Vector3d v = kick + speed * vector();
        for (int axis = 0; axis < 3; ++axis)
          nodes.record[static_cast<std::size_t>(n)].position[axis] += dt * v[axis];
      }
    }
  }
  EXPECT_LT(tightest, 0.8) << "a bound this loose would not show a fault";
}

}  // namespace
}  // namespace brio::test
