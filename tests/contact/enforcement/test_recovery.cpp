/// What is missing of a gap is opened, under load by no more work than it took.

#include "contact/enforcement/recovery.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace brio {
namespace {

TEST(TargetVelocity, GapsCloseAndOverlapsOpenALittle) {
  const Recovery recovery{.share = 0.1, .deep = 0.1, .cap = 1e-3};
  EXPECT_DOUBLE_EQ(target_velocity(recovery, 0.02, 5, 1, 0, 0.5), -0.04);
  EXPECT_DOUBLE_EQ(target_velocity(recovery, -0.005, 1e-9, 1, 0, 0.5), 0.1 * 0.05 * 0.005 / 0.5);
  EXPECT_DOUBLE_EQ(target_velocity(recovery, -0.3, 1e-9, 1, 0, 0.5), 1e-3 / 0.5);
  // Under load by as much less as it carries more than the mass gains by it.
  EXPECT_DOUBLE_EQ(target_velocity(recovery, -0.3, 4 * 2 * 1e-3 / 0.5, 2, 0, 0.5), 0.25 * 1e-3 / 0.5);
  const double shallow = 0.1 * 0.05 * 0.005 / 0.5;
  EXPECT_DOUBLE_EQ(target_velocity(recovery, -0.005, 4 * 2 * shallow, 2, 0, 0.5), 0.25 * shallow);
  EXPECT_EQ(target_velocity(recovery, -0.005, 0, 1, 0, 0.5), 0)
      << "what carries nothing yet may be under any load";
  EXPECT_EQ(target_velocity(recovery, -0.3, 1, 0, 0, 0.5), 0);
  // What loads may return is opened at any load, but no faster than anything is.
  EXPECT_DOUBLE_EQ(target_velocity(recovery, -0.005, 1e9, 1, 1e-4, 0.5), 1e-4);
  EXPECT_DOUBLE_EQ(target_velocity(recovery, -0.005, 1e9, 1, 1, 0.5), 1e-3 / 0.5);
}

// A collapsing element shortens the time step: bodies that overlap elsewhere are not shot apart.
TEST(TargetVelocity, IsThatOfTheLongestStepWhateverTheStep) {
  const ContactOptions options;
  for (const double overlap : {1e-4, 0.03, 0.2, 0.7}) {
    const double wanted = target_velocity(recovery_of(options, 1, 0.01), -overlap, 1e-9, 1, 0, 0.5);
    EXPECT_GT(wanted, 0);
    for (const double share : {0.3, 1e-4})
      EXPECT_NEAR(target_velocity(recovery_of(options, 1, 0.01, share), -overlap, 1e-9, 1, 0, share * 0.5),
                  wanted, 1e-14);
  }
}

constexpr double dt = 0.5;
constexpr double gap = 0.1;
constexpr Recovery recovery{.share = 0.1, .deep = 1, .cap = 1, .sunk = 0.3 * gap};

/// A node on the middle of a face of three others. \param first number of the nodes
Contact loaded_contact(int first, double depth, double impulse) {
  Contact contact;
  contact.node = {first, first + 1, first + 2, first + 3, first + 3};
  contact.weight = {1, -1 / 3.0, -1 / 3.0, -1 / 3.0, 0};
  contact.normal = {0, 0, 1};
  contact.gap = -depth;
  contact.impulse = impulse;
  return contact;
}

/// Steps of contacts, each with the work that its impulse did on motion.
class Loads : public testing::Test {
 protected:
  Loads() { loaded.resize(100); }
  struct Load {
    Contact contact;
    double work = 0;
  };
  void step(const std::vector<Load>& loads) {
    for (const Load& load : loads) loaded.add(load.contact, load.work);
    loaded.end_step();
  }
  std::vector<double> opening(const std::vector<Contact>& contacts) {
    const std::span<const double> velocity = loaded.opening_velocities(contacts, recovery, dt);
    return {velocity.begin(), velocity.end()};
  }
  double returned(const std::vector<Contact>& contacts) {
    double work = 0;
    const std::vector<double> velocity = opening(contacts);
    for (std::size_t i = 0; i < contacts.size(); ++i) work += velocity[i] * contacts[i].impulse;
    return work;
  }

  LoadedNodes loaded;
};

TEST_F(Loads, AnImpactReturnsNothing) {
  const Contact contact = loaded_contact(0, gap, 2);
  step({{contact, -5}});
  EXPECT_EQ(opening({contact})[0], 0);
  EXPECT_EQ(loaded.taken(), 0);
}

TEST_F(Loads, ReturnATenthOfWhatWasTaken) {
  const Contact contact = loaded_contact(0, gap, 2);
  step({{contact, -5}});
  double taken = 0;
  for (int i = 1; i <= 5; ++i) {
    step({{contact, -1e-3 * i}});
    taken += 1e-3 * i;
    EXPECT_NEAR(loaded.taken(), taken, 1e-15);
    EXPECT_NEAR(returned({contact}), std::min(0.1 * taken, 2 * 0.1 * 0.7 * gap / dt), 1e-15);
  }
  // What is returned is gone.
  step({{contact, taken}});
  EXPECT_NEAR(opening({contact})[0], 0, 1e-15);
}

TEST_F(Loads, OpenByAShareOfWhatHasSunkTooDeep) {
  step({{loaded_contact(0, gap, 2), -1}});
  step({{loaded_contact(0, gap, 2), -1}});
  EXPECT_NEAR(opening({loaded_contact(0, 0.5 * gap, 2)})[0], 0.1 * 0.2 * gap / dt, 1e-15);
  EXPECT_EQ(opening({loaded_contact(0, 0.29 * gap, 2)})[0], 0);
  EXPECT_EQ(opening({loaded_contact(0, -gap, 2)})[0], 0) << "still apart";
  EXPECT_EQ(opening({loaded_contact(0, gap, 0)})[0], 0) << "carries nothing";
}

// A solution deals the load among constraints of the same nodes anew in every step.
TEST_F(Loads, DoNotDependOnWhichOfSeveralConstraintsCarries) {
  const auto turn = [&](bool first) {
    step({{loaded_contact(0, gap, first ? 2 : 0), first ? -1e-3 : 0},
          {loaded_contact(0, gap, first ? 0 : 2), first ? 0 : -1e-3}});
  };
  for (int i = 0; i <= 4; ++i) turn(i % 2 == 0);
  EXPECT_NEAR(loaded.taken(), 4e-3, 1e-15);
  const std::vector<double> velocity = opening({loaded_contact(0, gap, 2), loaded_contact(0, gap, 1e-13)});
  EXPECT_NEAR(velocity[0], 4e-3 / 20, 1e-15);
  EXPECT_NEAR(velocity[1], 4e-3 / 20, 1e-15);
}

// One that has returned more than it took leaves the less for others.
TEST_F(Loads, TogetherReturnNoMoreThanAllHaveTaken) {
  const Contact one = loaded_contact(0, gap, 1);
  const Contact other = loaded_contact(10, gap, 1);
  step({{one, 0}, {other, 0}});
  step({{one, -3e-3}, {other, 2e-3}});
  EXPECT_NEAR(loaded.taken(), 1e-3, 1e-15);
  EXPECT_NEAR(returned({one, other}), 1e-4, 1e-15);
  // Nor does it matter that it has parted since.
  step({{one, 0}});
  EXPECT_NEAR(loaded.taken(), 1e-3, 1e-15);
  EXPECT_NEAR(returned({one}), 1e-4, 1e-15);
}

TEST_F(Loads, WhatHasPartedIsForgotten) {
  const Contact contact = loaded_contact(0, gap, 1);
  step({{contact, -5}});
  step({{contact, -1e-3}});
  step({});
  EXPECT_NEAR(loaded.taken(), 0, 1e-18);
  EXPECT_EQ(opening({contact})[0], 0);
  step({{contact, -5}});
  EXPECT_EQ(opening({contact})[0], 0) << "an impact again";
}

TEST_F(Loads, GrowWithTheSurface) {
  const Contact contact = loaded_contact(0, gap, 1);
  step({{contact, -5}});
  step({{contact, -1e-3}});
  loaded.resize(200);
  EXPECT_NEAR(returned({contact}), 1e-4, 1e-15);
  step({{contact, 0}, {loaded_contact(150, gap, 1), -1}});
  EXPECT_NEAR(returned({contact}), 1e-4, 1e-15);
}

}  // namespace
}  // namespace brio
