// Forces between parts of the shipped scenes, coarsely meshed: with the reactions of supports they are all
// that changes the momentum of a part.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <optional>
#include <set>

#include "io/deck/read_deck.hpp"
#include "io/run/run_deck.hpp"
#include "src/forecast/coarser.hpp"
#include "tests/core/scene.hpp"

namespace brio {
namespace {

using namespace test;

/// Parts that share nodes, and the boundary conditions on them; columns of a name that begins so.
struct PartsOfScene {
  std::vector<std::string> parts, reactions;
};
struct PairForceScene {
  std::string deck;
  std::vector<PartsOfScene> bodies;
};

Deck coarse_with_forces(const std::string& name) {
  Deck deck =
      coarser(read_deck(std::filesystem::path(BRIO_SOURCE_DIR) / "inputs" / (name + ".yaml"),
                        {"output.history.forces={reactions: all, contact: all}", "contact.audit=false"}),
              3);
  return deck;
}

struct MomentumOfParts {
  Vector sum{};
  double size = 0;  ///< of the terms
  void add(double mass, const double* velocity) {
    for (std::size_t i = 0; i < 3; ++i) {
      sum[i] += mass * velocity[i];
      size += std::abs(mass * velocity[i]);
    }
  }
};

MomentumOfParts momentum_of(const Model& model, const std::vector<std::string>& names) {
  MomentumOfParts momentum;
  std::set<int> nodes;
  for (const std::string& name : names) {
    const PartInModel& part = model.parts[model.part_number.at(name)];
    if (part.rigid < 0) {
      nodes.insert(part.node.begin(), part.node.end());
      continue;
    }
    const auto body = static_cast<std::size_t>(part.rigid);
    momentum.add(model.rigid.body[body].mass, model.rigid.motion[body].velocity.data());
  }
  for (const int node : nodes)
    momentum.add(model.nodes.mass[static_cast<std::size_t>(node)],
                 model.nodes.record[static_cast<std::size_t>(node)].velocity);
  return momentum;
}

/// The two parts of `contact.A.B_x`, or none.
std::optional<std::array<std::string, 2>> pair_of(const std::string& column) {
  if (!column.starts_with("contact.") || !column.ends_with("_x")) return {};
  const std::string pair = column.substr(8, column.size() - 10);
  const std::size_t point = pair.find('.');
  return std::array{pair.substr(0, point), pair.substr(point + 1)};
}

bool has(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

class HistoryForces {
 public:
  explicit HistoryForces(const Model& model) : duration_(model.forces->duration) {
    std::vector<double> row;
    add_columns(*model.forces, columns_);
    add_values(*model.forces, row);
    for (std::size_t i = 0; i < columns_.size(); ++i) value_[columns_[i]] = row.at(i);
  }
  /// Of the other parts and of supports.
  Vector impulse_on(const PartsOfScene& body) const {
    Vector sum{};
    for (const std::string& column : columns_) {
      const auto pair = pair_of(column);
      if (!pair) continue;
      const int sign = int{has(body.parts, (*pair)[0])} - int{has(body.parts, (*pair)[1])};
      if (sign != 0) add(column, sign, sum);
    }
    for (const std::string& name : body.reactions) add("reaction." + name + "_x", 1, sum);
    return sum;
  }

 private:
  void add(std::string column, double sign, Vector& sum) const {
    for (std::size_t i = 0; i < 3; ++i) {
      column.back() = "xyz"[i];
      sum[i] += sign * duration_ * value_.at(column);
    }
  }

  double duration_;
  std::vector<std::string> columns_;
  std::map<std::string, double> value_;
};

class PairForces : public testing::TestWithParam<PairForceScene> {};

TEST_P(PairForces, WithReactionsAreTheChangeOfMomentum) {
  const Deck deck = coarse_with_forces(GetParam().deck);
  Model model = build_scene(deck);
  ThreadTeam team(2);
  std::vector<MomentumOfParts> before;
  for (const PartsOfScene& body : GetParam().bodies) before.push_back(momentum_of(model, body.parts));
  double largest = 0, worst = 0, scale = 0;
  int steps = 0;
  run(model, deck.numerics.energy_error_limit, team, [&](Model& now) {
    const HistoryForces forces(now);
    for (const MomentumOfParts& one : before) scale = std::max(scale, one.size);
    for (std::size_t b = 0; b < before.size(); ++b) {
      const MomentumOfParts is = momentum_of(now, GetParam().bodies[b].parts);
      const Vector impulse = forces.impulse_on(GetParam().bodies[b]);
      for (std::size_t i = 0; i < 3; ++i) {
        worst = std::max(worst, std::abs(is.sum[i] - before[b].sum[i] - impulse[i]) / scale);
        largest = std::max(largest, std::abs(impulse[i]));
      }
      before[b] = is;
    }
    now.forces->begin_interval();
    return ++steps < 800;
  });
  EXPECT_GT(largest, 1e-4 * scale) << "nothing has touched";
  EXPECT_LT(worst, 1e-12);
}

std::vector<PartsOfScene> bricks() {
  std::vector<PartsOfScene> bodies{{{"wall"}, {"0", "1", "2", "3"}}, {{"bar"}, {}}};
  for (int brick = 1; brick <= 17; ++brick) bodies.push_back({{"brick_" + std::to_string(brick)}, {}});
  return bodies;
}

INSTANTIATE_TEST_SUITE_P(
    Inputs, PairForces,
    testing::Values(
        PairForceScene{"can_buckling", {{{"can"}, {"base"}}, {{"plate"}, {}}}},
        PairForceScene{
            "pipe_cutting",
            {{{"pipe"}, {}}, {{"blade"}, {"guide", "drive"}}, {{"left"}, {"left"}}, {{"right"}, {"right"}}}},
        PairForceScene{"brick_stack", bricks()},
        PairForceScene{"bird_strike",
                       {{{"bird"}, {}},
                        {{"panel", "stiffener1", "stiffener2", "stiffener3", "stiffener4"}, {"frame"}}}}),
    [](const auto& scene) { return scene.param.deck; });

}  // namespace
}  // namespace brio
