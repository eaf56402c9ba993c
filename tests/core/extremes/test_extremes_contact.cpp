// Contact at its ends: bodies of unlike mass and stiffness, overlaps and gaps at the start, grazing and seam
// hits, speed, and a sheet that is folded by two others.

#include <gtest/gtest.h>

#include <limits>

#include "src/base/index.hpp"
#include "src/build/build.hpp"
#include "tests/core/extremes/extremes.hpp"

namespace brio {
namespace {

using namespace test;

// ---- unlike bodies

struct Factors {
  double mass = 1, stiffness = 1;
};
Elastic times(const Factors& factors) {
  Elastic law = elastic(0.3);
  law.density *= factors.mass;
  law.youngs_modulus *= factors.stiffness;
  return law;
}

void expect_sound_impact(Kind upper, const Factors& of_upper, Kind lower, const Factors& of_lower) {
  SCOPED_TRACE(testing::Message() << name_of_kind(upper) << ' ' << of_upper.mass << ' ' << of_upper.stiffness
                                  << " on " << name_of_kind(lower) << ' ' << of_lower.mass << ' '
                                  << of_lower.stiffness);
  Deck deck = impact(upper, lower);
  deck.materials = {{"material", times(of_lower)}, {"other", times(of_upper)}};
  deck.parts[1].material = "other";
  deck.initial_conditions[0].velocity = {1, -0.5, -5};
  deck.contact->options.friction = 0;
  deck.time.end = 15e-3;
  const Watched watched(deck, 20);
  const double depth = watched.overlap() / 0.1;
  std::printf("| %s %.0e %.0e | %s %.0e %.0e | %.0e | %.0e | %.0e | %.0e | %ld |\n", name_of_kind(upper),
              of_upper.mass, of_upper.stiffness, name_of_kind(lower), of_lower.mass, of_lower.stiffness,
              watched.worst_linear, watched.added(), depth, watched.model.energy.error_max, watched.missed);
  EXPECT_GT(watched.touched(), 0);
  EXPECT_EQ(watched.deep, 0);
  EXPECT_EQ(watched.missed, 0);
  EXPECT_LE(watched.worst_linear, 1e-12);
  EXPECT_LE(watched.added(), 1e-3);
  EXPECT_LE(depth, 1e-2);
  EXPECT_LE(watched.model.energy.error_max, 1e-2);
}

// The light one is as fast to a wave as the heavy one, or as stiff.
TEST(ExtremesRatios, MassRatioOfAMillionKeepsMomentumAndEnergy) {
  const FloatingPointTraps traps;
  for (const Kind kind : {Kind::hex8, Kind::shell}) {
    expect_sound_impact(kind, {1e6, 1}, Kind::hex8, {});
    expect_sound_impact(kind, {1e6, 1e6}, Kind::hex8, {});
    expect_sound_impact(kind, {1e-6, 1e-6}, Kind::hex8, {});
    expect_sound_impact(kind, {}, Kind::hex8, {1e6, 1});
  }
  expect_sound_impact(Kind::beam, {1e-6, 1e-6}, Kind::shell, {});
  expect_sound_impact(Kind::particles, {}, Kind::hex8, {1e6, 1});
}

TEST(ExtremesRatios, StiffnessRatioOfAHundredThousandKeepsMomentumAndEnergy) {
  const FloatingPointTraps traps;
  for (const Kind kind : {Kind::hex8, Kind::shell, Kind::particles}) {
    expect_sound_impact(kind, {1, 1e-5}, Kind::hex8, {});
    expect_sound_impact(kind, {}, Kind::hex8, {1, 1e-5});
  }
}

// ---- overlaps and gaps at the start

Deck two_cubes(double overlap) {
  Deck deck;
  deck.materials = {{"material", elastic(0.3)}};
  deck.parts = {box("lower", {0.4, 0.4, 0.4}, {4, 4, 4}, {0, 0, 0}, hex8()),
                box("upper", {0.3, 0.3, 0.3}, {3, 3, 3}, {0.02, 0.013, 0.35 - overlap}, hex8())};
  deck.parts[1].placement.rotate = Rotation{{0, 0, 1}, 17};
  deck.contact.emplace();
  deck.time.end = 2e-3;
  return deck;
}

TEST(ExtremesOverlap, OfRoundingOrAThousandthOfAnEdgeLeavesNeitherStrainNorMotion) {
  const FloatingPointTraps traps;
  for (const double overlap : {1e-13, 1e-4}) {  // edges are 0.1
    SCOPED_TRACE(overlap);
    const Deck deck = two_cubes(overlap);
    const Watched watched(deck, 10);
    ASSERT_FALSE(watched.model.initial_overlaps.empty()) << "of the gap at least";
    for (const InitialOverlap& found : watched.model.initial_overlaps) {
      EXPECT_NEAR(found.depth, overlap, 1e-9);
      EXPECT_LE(found.moved, overlap + 2 * watched.model.contacts[0].features.skin);
    }
    EXPECT_EQ(watched.deep, 0);
    EXPECT_EQ(watched.missed, 0);
    double fastest = 0;
    for (const NodeRecord& node : watched.model.nodes.record)
      for (const double speed : node.velocity) fastest = std::max(fastest, std::abs(speed));
    EXPECT_LE(fastest, 1e-9) << "of the speed of sound, 1000";
  }
}

TEST(ExtremesOverlap, OfHalfAnEdgeIsRefusedWithPartsDepthAndPlace) {
  const FloatingPointTraps traps;
  try {
    build_model(two_cubes(0.05));
    FAIL() << "accepted";
  } catch (const BuildError& fault) {
    const std::string text = fault.what();
    EXPECT_NE(text.find("part 'lower' overlaps part 'upper' by 0.05 at ("), std::string::npos) << text;
    EXPECT_NE(text.find("deeper than initial_overlap_limit allows"), std::string::npos) << text;
  }
}

// Empty: it is accepted.
std::string refusal(const Deck& deck) {
  try {
    build_model(deck);
  } catch (const BuildError& fault) {
    return fault.what();
  }
  return "";
}

// Bodies that were drawn in one place, or a part of an edge aside, whichever way their surfaces look there.
TEST(ExtremesOverlap, BodiesInOneAnotherAreRefused) {
  const FloatingPointTraps traps;
  for (const Kind kind : all_kinds)
    for (const double aside : {0.0, 1e-9, 0.013, 0.05})
      for (const double degrees : {0.0, 20.0}) {
        Deck deck;
        deck.materials = {{"material", elastic(0.3)}};
        deck.parts = {body(kind, "one"), body(kind, "two")};
        deck.parts[1].placement.translate = {aside, 0.5 * aside, 0.3 * aside};
        deck.parts[1].placement.rotate = Rotation{{1, 2, 3}, degrees};
        deck.contact.emplace();
        deck.time.end = 1e-3;
        if (kind == Kind::rigid) deck.time.step = 1e-4;
        const std::string text = refusal(deck);
        EXPECT_NE(text.find("contact: part '"), std::string::npos)
            << name_of_kind(kind) << ' ' << aside << ' ' << degrees << ": " << text;
      }
}

TEST(ExtremesOverlap, BeamsAndParticlesInOnePlaceAreRefused) {
  const FloatingPointTraps traps;
  for (const Kind kind : {Kind::beam, Kind::particles})
    for (const double aside : {0.0, 1e-9}) {
      Deck deck;
      deck.materials = {{"material", elastic(0.3)}};
      deck.parts = {body(kind, "one"), body(kind, "two")};
      deck.parts[1].placement.translate = {aside, 0.5 * aside, 0.3 * aside};
      deck.contact.emplace();
      deck.time.end = 1e-3;
      const std::string text = refusal(deck);
      EXPECT_NE(text.find("contact: part 'one' overlaps part 'two' by"), std::string::npos)
          << name_of_kind(kind) << ' ' << aside << ": " << text;
    }
}

// A small body in the middle of an element of a large one.
TEST(ExtremesOverlap, ABodyWhollyInsideAnotherIsRefused) {
  const FloatingPointTraps traps;
  Deck deck;
  deck.materials = {{"material", elastic(0.3)}};
  deck.parts = {box("large", {1, 1, 1}, {1, 1, 1}, {0, 0, 0}, hex8()),
                box("small", {0.01, 0.01, 0.01}, {1, 1, 1}, {0.1, 0, 0}, hex8())};
  deck.contact.emplace();
  deck.time.end = 1e-3;
  try {
    build_model(deck);
    FAIL() << "accepted";
  } catch (const BuildError& fault) {
    EXPECT_NE(std::string(fault.what()).find("contact: part 'small' lies in part 'large', 0.4 deep"),
              std::string::npos)
        << fault.what();
  }
}

TEST(ExtremesOverlap, OfHalfAnEdgeIsRemovedWhereTheDeckAllowsIt) {
  const FloatingPointTraps traps;
  Deck deck = two_cubes(0.05);
  deck.contact->options.initial_overlap_limit = 0.6;
  deck.parts[1].mesh = BoxMesh{{0.2, 0.2, 0.3}, {2, 2, 3}};
  deck.parts[1].placement.rotate.reset();
  const Watched watched(deck, 10);
  EXPECT_NEAR(watched.model.initial_overlaps.at(0).depth, 0.05, 1e-9);
  EXPECT_EQ(watched.deep, 0);
  EXPECT_EQ(watched.missed, 0);
  EXPECT_LE(watched.overlap(), 1e-6);
}

TEST(ExtremesGap, ZeroAndOneUlpAndMoreAreTheSameImpact) {
  const FloatingPointTraps traps;
  const auto rebound = [](double gap) {
    Deck deck = two_cubes(0);
    deck.parts[1].placement.translate[2] += gap;
    deck.initial_conditions = {moving("upper", {0, 0, -5})};
    const Watched watched(deck, 10);
    EXPECT_EQ(watched.deep, 0) << gap;
    EXPECT_EQ(watched.missed, 0);
    EXPECT_GT(watched.touched(), 0) << gap;
    EXPECT_LE(watched.worst_linear, 1e-12) << gap;
    return mean_velocity(watched.model, 1, 2);
  };
  const double touching = rebound(0);
  EXPECT_GT(touching, -3);
  const double ulp = std::nextafter(0.35, 1) - 0.35;
  for (const double gap : {ulp, -ulp, 1e-15, 1e-12, 1e-9}) EXPECT_NEAR(rebound(gap), touching, 1e-3) << gap;
}

// ---- grazing and seam hits

// Its underside passes over the top of the other at a height of `clearance`: no touch, or one that slows
// nothing.
// By distances solids touch at a gap: what passes at less than it is let past, and then lifted.
TEST(ExtremesGrazing, ABlockThatPassesWithinTheGapIsNotHeldUp) {
  const FloatingPointTraps traps;
  const double gap = 2 * skin_share * 0.2 / 3;  // over the smallest edge
  for (const double clearance : {2 * gap, gap, gap + 1e-9, 0.8 * gap, 0.5 * gap}) {
    SCOPED_TRACE(clearance);
    Deck deck;
    deck.materials = {{"material", elastic(0.3)}};
    deck.parts = {box("lower", {0.4, 0.4, 0.4}, {4, 4, 4}, {0, 0, -0.2}, hex8()),
                  box("upper", {0.2, 0.2, 0.2}, {3, 3, 3}, {-0.45, 0.017, 0.1 + clearance}, hex8())};
    deck.initial_conditions = {moving("upper", {100, 0, 0})};
    deck.contact.emplace();
    deck.time.end = 9e-3;
    const Watched watched(deck, 20);
    EXPECT_NEAR(mean_velocity(watched.model, 1, 0), 100, 1e-5);
    EXPECT_NEAR(mean_velocity(watched.model, 1, 2), 0, clearance < gap ? 0.05 : 1e-6);
    EXPECT_EQ(watched.missed, 0);
    EXPECT_LE(watched.added(), 1e-7);
  }
}

// A corner, an edge and a ball of particles come down exactly on a node, a seam and the common corner of four
// bodies.
TEST(ExtremesSeams, HitsOnNodesEdgesAndCornersOfFourBodiesStop) {
  const FloatingPointTraps traps;
  for (const Kind kind : {Kind::hex8, Kind::shell, Kind::beam, Kind::particles})
    for (const Vector3d& aim :
         {Vector3d{0, 0, 0}, Vector3d{0, 0.1, 0}, Vector3d{0.1, 0.1, 0}, Vector3d{0.05, 0, 0}}) {
      SCOPED_TRACE(testing::Message() << name_of_kind(kind) << " at " << aim[0] << ' ' << aim[1]);
      Deck deck;
      deck.materials = {{"material", elastic(0.3)}};
      Part upper = body(kind, "upper");
      upper.placement.rotate = Rotation{{1, -1, 0}, 54.735610317245346};  // a corner of the cube looks down
      Vector3d lowest{0, 0, HUGE_VAL};
      for (const Vector3d& x : generate_mesh(upper.mesh, upper.placement).position)
        if (x[2] < lowest[2]) lowest = x;
      upper.placement.translate = {aim[0] - lowest[0], aim[1] - lowest[1],
                                   0.01 + touching_distance(kind) - lowest[2]};
      deck.parts = {upper};
      for (int k = 0; k < 4; ++k)
        deck.parts.push_back(box("floor" + std::to_string(k), {0.4, 0.4, 0.2}, {4, 4, 2},
                                 {k % 2 == 0 ? -0.2 : 0.2, k < 2 ? -0.2 : 0.2, -0.1}, hex8()));
      deck.initial_conditions = {moving("upper", {0, 0, -20})};
      deck.contact.emplace();
      deck.time.end = 4e-3;
      const Watched watched(deck, 10);
      EXPECT_GT(watched.touched(), 0);
      EXPECT_LE(watched.deep, 1);
      EXPECT_EQ(watched.missed, 0);
      EXPECT_LE(watched.worst_linear, 1e-12);
      EXPECT_LE(watched.added(), 1e-3);
      EXPECT_GT(mean_velocity(watched.model, 0, 2), -15);
    }
}

// ---- speed

// At 2 km/s, twice the speed of sound of the target, a step of the projectile, which is of another material
// and so may be long, passes many faces of the target.
TEST(ExtremesSpeed, ProjectileThatCrossesManyFacesAStepIsStopped) {
  const FloatingPointTraps traps;
  for (const bool of_shells : {false, true}) {
    SCOPED_TRACE(of_shells);
    Deck deck;
    deck.materials = {{"material", elastic(0.3)}};
    PlateMesh mesh;
    mesh.size = {1, 1};
    mesh.elements = {50, 50};
    Rigid target;
    target.thickness = 0.004;
    deck.parts = {of_shells ? Part{"target", mesh, {}, target, "material"}
                            : box("target", {1, 1, 0.02}, {50, 50, 1}, {0, 0, -0.01}, Rigid{}),
                  box("projectile", {0.1, 0.1, 0.1}, {1, 1, 1}, {-0.3, -0.25, 0.1}, hex8())};
    deck.parts[1].placement.rotate = Rotation{{1, 2, 0}, 30};
    deck.boundary_conditions = {fix("target", {0, 1, 2, 3, 4, 5})};
    deck.initial_conditions = {moving("projectile", {1400, 1200, -800})};
    deck.contact.emplace();
    deck.time.end = 4e-4;
    deck.numerics.energy_error_limit = 10;
    Model model = build_model(deck);
    ThreadTeam team(1);
    double longest = 0, lowest = 1;
    std::int64_t missed = 0;
    run(model, deck, team, [&](Model& m) {
      longest = std::max(longest, std::hypot(1400, 1200) * m.times.next / 0.02);
      for (const int node : m.parts[1].node) {
        const double* x = m.nodes.record[index(node)].position;
        if (std::abs(x[0]) < 0.5 && std::abs(x[1]) < 0.5) lowest = std::min(lowest, x[2]);
      }
      missed += audit(m.contacts[0], m.nodes, team).missed();
    });
    std::printf("faces crossed in a step: up to %.1f; lowest node %.1e\n", longest, lowest);
    EXPECT_GT(longest, 3);
    EXPECT_GT(lowest, -1e-3);
    EXPECT_EQ(missed, 0);
    EXPECT_GT(mean_velocity(model, 1, 2), -1);
  }
}

// ---- a fold between two plates

TEST(ExtremesFold, SheetPinchedFromBothSidesIsPassedByNothing) {
  const FloatingPointTraps traps;
  Deck deck;
  ElasticPlastic tin = tough();
  tin.yield_stress = 2e6;
  deck.materials = {{"material", elastic(0.3)}, {"tin", tin}};
  PlateMesh mesh;
  mesh.size = {0.5, 0.8};
  mesh.elements = {3, 40};
  Shell4 thin;
  thin.thickness = 0.02;
  Part sheet{"sheet", mesh, {}, thin, "tin"};
  sheet.placement.rotate = Rotation{{1, 0, 0}, 90};  // it stands on edge
  deck.parts = {sheet, box("below", {0.7, 0.5, 0.1}, {7, 5, 1}, {0, 0, -0.4601}, hex8()),
                box("above", {0.7, 0.5, 0.1}, {6, 4, 1}, {0, 0, 0.4601}, hex8())};
  deck.initial_conditions = {moving("below", {0, 0, 20}), moving("above", {0, 0, -20})};
  // It buckles to one side.
  InitialCondition bulge = moving("", {0, 1, 0});
  bulge.where = {"", BoxRegion{{-1, -1, -0.1}, {1, 1, 0.1}}, "sheet"};
  deck.initial_conditions.push_back(bulge);
  for (const char* plate : {"below", "above"}) {
    PrescribedMotion driven;
    driven.where.set = plate;
    driven.components.push_back({2, Curve{{{0, plate[0] == 'b' ? 20.0 : -20.0}}}});
    deck.boundary_conditions.push_back(driven);
  }
  deck.contact.emplace();
  deck.contact->options.friction = 0.2;
  deck.time.end =
      18.3e-3;  // plates are four thicknesses apart then, and four layers of the sheet between them
  deck.numerics.energy_error_limit = 0.05;
  const Watched watched(deck, 50);
  std::printf("fold: %d touch at most, overlap %.0e of the thickness, error %.0e, added %.0e\n",
              watched.touched(), watched.overlap() / 0.02, watched.model.energy.error_max, watched.added());
  EXPECT_GT(watched.touched(), 50);
  EXPECT_EQ(watched.missed, 0);
  EXPECT_LE(watched.overlap(), 0.01 * 0.02 + 2 * watched.model.contacts[0].features.skin);
}

}  // namespace
}  // namespace brio
