/// What the audit by brute force finds, the audit finds.

#include <gtest/gtest.h>

#include "contact/audit.hpp"
#include "tests/contact/adversarial_queries.hpp"
#include "tests/contact/audit/audit_scene.hpp"

namespace brio::test {
namespace {

// Bodies of all kinds thrown into a box so that some overlap by little, some by much.
TEST(Audit, FindsWhateverBruteForceFound) {
  ThreadTeam team(1);
  int found_by_brute_force = 0, found_more = 0;
  for (std::uint64_t seed = 1; seed <= 3000; ++seed) {
    Random random(seed);
    AuditScene scene;
    const auto anyhow = [&]() -> AuditScene::Map {
      const Eigen::Matrix3d turn =
          Eigen::AngleAxisd(seed % 3 == 0 ? 0 : random.uniform(0, 6), random.vector(1).normalized())
              .toRotationMatrix();
      const Vector3d to = random.vector(1);
      return [turn, to](const Vector3d& x) -> Vector3d { return turn * x + to; };
    };
    const auto point = [&] { return random.vector(1); };
    scene.add_box({2, 2, 2}, {0.8, 0.8, 0.8}, anyhow());
    if (random.coin()) scene.add_box({2, 1, 2}, {0.8, 0.3, 0.5}, anyhow());
    if (random.coin()) scene.add_sheet({2, 2}, {0.6, 0.6}, 0.1, anyhow());
    if (random.coin()) scene.add_sheet({2, 2}, {0.6, 0.6}, 0.1, anyhow());
    if (random.coin()) scene.add_beams({point(), point()}, 0.05);
    if (random.coin()) scene.add_beams({point(), point()}, 0.05);
    if (random.coin()) scene.add_particles({point()}, 0.05);
    scene.start();
    scene.step();
    if (seed % 5 == 0)  // own bodies too
      for (int n = 0; n < scene.count(); ++n)
        scene.place(n, scene.positions()[static_cast<std::size_t>(n)] + random.vector(0.3));
    const int known = brute_force_audit(scene.scene, scene.nodes, team).missed();
    const Audit found = scene.found();
    if (known > 0) {
      EXPECT_GT(found.missed(), 0) << seed;
      ++found_by_brute_force;
    } else if (found.missed() > 0) {
      ++found_more;
    }
  }
  EXPECT_GT(found_by_brute_force, 500);
  EXPECT_GT(found_more, 50) << "and more";
}

}  // namespace
}  // namespace brio::test
