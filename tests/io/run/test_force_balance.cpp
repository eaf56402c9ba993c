// Forces of the history against the momentum of every part, in coarse forms of four scenes.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <set>

#include "io/deck/read_deck.hpp"
#include "io/results/read_result.hpp"
#include "io/run/run_deck.hpp"
#include "src/base/index.hpp"
#include "src/output/observe.hpp"
#include "src/step/advance.hpp"

namespace brio {
namespace {

namespace fs = std::filesystem;
using Momenta = std::vector<Vector3d>;

/// Number of the body of each part: parts that share nodes are one.
std::vector<std::size_t> bodies_of_parts(const Model& model) {
  std::vector<std::size_t> body(model.parts.size());
  std::map<int, std::size_t> part_of_node;
  for (std::size_t p = 0; p < model.parts.size(); ++p) {
    body[p] = p;
    for (const int node : model.parts[p].node) {
      const std::size_t other = part_of_node.try_emplace(node, p).first->second;
      if (body[other] == body[p]) continue;
      const std::size_t from = std::max(body[other], body[p]), to = std::min(body[other], body[p]);
      std::ranges::replace(body, from, to);
    }
  }
  return body;
}

/// By body; `size` gets the sum of all |m v|.
Momenta momenta_of(const Model& model, const std::vector<std::size_t>& body_of, double& size) {
  Momenta sum(model.parts.size(), Vector3d{});
  std::set<int> counted;
  size = 0;
  const auto add = [&](std::size_t body, double mass, const double* velocity) {
    for (std::size_t i = 0; i < 3; ++i) {
      sum[body][i] += mass * velocity[i];
      size += std::abs(mass * velocity[i]);
    }
  };
  for (std::size_t p = 0; p < model.parts.size(); ++p)
    for (const int node : model.parts[p].node) {
      const auto n = index(node);
      if (counted.insert(node).second) add(body_of[p], model.nodes.mass[n], model.nodes.record[n].velocity);
    }
  for (std::size_t b = 0; b < model.rigid.body.size(); ++b)
    add(body_of[model.rigid.body[b].part], model.rigid.body[b].mass, model.rigid.motion[b].velocity.data());
  return sum;
}

/// Impulses since the last row on each body, by the columns of the history alone.
class ColumnImpulses {
 public:
  ColumnImpulses(const Model& model, const Deck& deck, const std::vector<std::size_t>& body_of)
      : deck_(deck), body_of_(body_of) {
    add_columns(*model.forces, columns_);
  }
  Momenta operator()(const Model& model) {
    row_.clear();
    add_values(*model.forces, row_);
    Momenta sum(body_of_.size(), Vector3d{});
    for (std::size_t c = 0; c < columns_.size(); c += 3) {
      const std::string name = columns_[c].substr(0, columns_[c].size() - 2);
      if (name.ends_with(".friction")) continue;  // is in the force already
      const auto bodies = bodies_of_column(name);
      for (std::size_t i = 0; i < 3; ++i) {
        const double impulse = row_[c + i] * model.forces->duration;
        sum[bodies.first][i] += impulse;
        if (bodies.second < body_of_.size()) sum[bodies.second][i] -= impulse;
        if (name.starts_with("contact.") && bodies.first != bodies.second)
          largest_contact = std::max(largest_contact, std::abs(impulse));
      }
    }
    return sum;
  }
  double largest_contact = 0;

 private:
  std::size_t body_of(const std::string& part) const {
    return body_of_[index(std::ranges::find(deck_.parts, part, &Part::name) - deck_.parts.begin())];
  }
  // Of contact both, and what a part does to itself is taken away again; of a support the one it is on.
  std::pair<std::size_t, std::size_t> bodies_of_column(const std::string& name) const {
    const std::size_t dot = name.find('.'), second = name.find('.', dot + 1);
    if (name.starts_with("contact."))
      return {body_of(name.substr(dot + 1, second - dot - 1)), body_of(name.substr(second + 1))};
    const std::string support = name.substr(dot + 1);
    for (std::size_t c = 0; c < deck_.boundary_conditions.size(); ++c) {
      const auto* motion = std::get_if<PrescribedMotion>(&deck_.boundary_conditions[c]);
      if (motion == nullptr || (motion->name != support && std::to_string(c) != support)) continue;
      return {body_of(motion->where.set.substr(0, motion->where.set.find('.'))), body_of_.size()};
    }
    throw std::runtime_error(name);
  }

  const Deck& deck_;
  const std::vector<std::size_t>& body_of_;
  std::vector<std::string> columns_;
  std::vector<double> row_;
};

void expect_balance(const std::string& deck_name, std::vector<std::string> settings) {
  settings.insert(settings.end(),
                  {"output.history.forces={reactions: all, contact: all}", "contact.audit=false"});
  const Deck deck = read_deck(BRIO_SOURCE_DIR "/inputs/" + deck_name + ".yaml", settings);
  Model model = build_scene(deck, 2);
  ThreadTeam team(2);
  const std::vector<std::size_t> body_of = bodies_of_parts(model);
  ColumnImpulses impulses_of(model, deck, body_of);
  double size = 0, worst = 0;
  Momenta before;
  run(model, deck.numerics.energy_error_limit, team, [&](Model& now) {
    const Momenta after = momenta_of(now, body_of, size);
    const Momenta impulses = impulses_of(now);
    for (std::size_t body = 0; body < before.size(); ++body)
      for (std::size_t i = 0; i < 3; ++i)
        worst = std::max(worst, std::abs(after[body][i] - before[body][i] - impulses[body][i]) / size);
    before = after;
    now.forces->begin_interval();
    return true;
  });
  EXPECT_LE(worst, 1e-12) << deck_name;
  EXPECT_GT(impulses_of.largest_contact, 1e-6 * size) << deck_name;
}

TEST(ForceBalance, OfTheCan) {
  expect_balance("can_buckling", {"parts.can.mesh.cylinder.elements=[32, 20]",
                                  "parts.plate.mesh.box.elements=[8, 4, 1]", "time.end=7e-4"});
}
TEST(ForceBalance, OfTheCutPipe) {
  expect_balance("pipe_cutting", {"parts.pipe.mesh.tube.elements=[32, 24, 2]",
                                  "parts.blade.mesh.wedge.elements=[2, 4, 48]", "time.end=3e-4"});
}
TEST(ForceBalance, OfTheBricks) { expect_balance("brick_stack", {"time.end=1.5e-3"}); }
TEST(ForceBalance, OfTheBird) {
  expect_balance(
      "bird_strike",
      {"parts.bird.mesh.particles.cylinder.spacing=0.016", "parts.panel.mesh.plate.elements=[20, 20]",
       "parts.stiffener1.mesh.line.elements=20", "parts.stiffener2.mesh.line.elements=20",
       "parts.stiffener3.mesh.line.elements=20", "parts.stiffener4.mesh.line.elements=20", "time.end=8e-4"});
}

// Force on a rigid plate that crushes a can, from the columns of the result alone: mass times deceleration.
TEST(ForceBalance, CrushForceIsMassTimesDeceleration) {
  const fs::path folder = fs::path(testing::TempDir()) / "crush_force";
  fs::remove_all(folder);
  RunOptions options;
  options.deck = BRIO_SOURCE_DIR "/inputs/can_buckling.yaml";
  options.output = folder;
  options.overrides = {"parts.can.mesh.cylinder.elements=[32, 20]", "parts.plate.mesh.box.elements=[8, 4, 1]",
                       "parts.plate.element=rigid", "output.history.every=1e-12", "time.end=7e-4"};
  const RunOutcome outcome = run_deck(options);
  ASSERT_EQ(outcome.summary.exit_code, 0) << outcome.message;
  const fs::path result = folder / "can_buckling.vtkhdf";
  const ReadHistory history = ResultReader(result).history();
  const std::vector<double> force = history.column("contact.plate.can_z", result),
                            velocity = history.column("plate.velocity_z", result),
                            step = history.column("dt", result);
  const double mass = 7.34e-4 * 22 * 11 * 2.5;
  const double largest = *std::ranges::max_element(force);
  ASSERT_GT(largest, 1e4);
  for (std::size_t row = 1; row < force.size(); ++row) {
    const double duration = 0.5 * (step[row - 1] + step[row]);  // from half step to half step
    EXPECT_NEAR(force[row], mass * (velocity[row] - velocity[row - 1]) / duration, 1e-9 * largest) << row;
  }
  fs::remove_all(folder);
}

}  // namespace
}  // namespace brio
