// Each warning where it applies, and silence where it does not.

#include <gtest/gtest.h>

#include <algorithm>

#include "src/forecast/built_features.hpp"
#include "src/forecast/warnings.hpp"
#include "tests/core/scene.hpp"

namespace brio {
namespace {

using namespace test;

// A block that falls onto another: nothing to be said of it.
Deck blocks() {
  Deck deck;
  deck.materials = {{"material", elastic(0.3)}};
  deck.parts = {box("lower", {1, 1, 1}, {3, 3, 3}, {0, 0, 0}, hex8()),
                box("upper", {1, 1, 1}, {3, 3, 3}, {0, 0, 1.1}, hex8())};
  deck.initial_conditions = {moving("upper", {0, 0, -10})};
  deck.contact.emplace();
  deck.time.end = 0.1;
  return deck;
}

std::vector<SceneWarning> warnings_of(const Deck& deck) {
  Model model = build_model(deck);
  ThreadTeam team(1);
  update_velocities(model, 0.1, team);
  return scene_warnings(deck, model);
}

// Exactly one warning, of that subject, with these words.
void expect_one(const Deck& deck, const std::string& subject, const std::string& words) {
  const std::vector<SceneWarning> warnings = warnings_of(deck);
  ASSERT_EQ(warnings.size(), 1u) << (warnings.empty() ? "" : warnings[0].what + "; " + warnings.back().what);
  EXPECT_EQ(warnings[0].subject, subject);
  EXPECT_NE(warnings[0].what.find(words), std::string::npos) << warnings[0].what;
  EXPECT_FALSE(warnings[0].advice.empty());
}

void expect_none(const Deck& deck) {
  for (const SceneWarning& warning : warnings_of(deck))
    ADD_FAILURE() << warning.subject << ": " << warning.what;
}

TEST(Warnings, NoneOfASceneThatIsWellMade) { expect_none(blocks()); }

TEST(Warnings, OfACoordinateSystemThatNothingUses) {
  Deck deck = blocks();
  deck.coordinate_systems = {{"ramp", RectangularSystem{{1, 0, 1}, {0, 1, 0}}}};
  expect_one(deck, "coordinate system 'ramp'", "nothing uses it");
  Deck held = deck;
  held.boundary_conditions = {fix("lower.zmin", {2})};
  std::get<PrescribedMotion>(held.boundary_conditions[0]).system = "ramp";
  expect_none(held);
  deck.loads = {Gravity{{0, 0, -10}, Curve{{{0, 1}}}, "ramp"}};
  expect_none(deck);
}

TEST(Warnings, NoneOfElementsThatAreDeletedAtOnce) {
  Deck deck = blocks();
  deck.parts[0].deletion.emplace().minimum_step = 1;
  Model model = build_model(deck);
  ThreadTeam team(1);
  update_velocities(model, 0.1, team);
  ASSERT_EQ(model.erosion->total_deleted(), 27);
  scene_warnings(deck, model);
}

TEST(Warnings, OfPartsThatMeetWithoutContact) {
  Deck deck = blocks();
  deck.contact.reset();
  expect_one(deck, "parts 'lower' and 'upper'", "towards each other");
  deck.initial_conditions = {moving("upper", {0, 0, 10}), moving("lower", {0, 0, 1})};
  expect_none(deck);
  deck.initial_conditions = {moving("upper", {10, 0, -10}), moving("lower", {1, 0, 0})};
  deck.time.end = 0.005;  // too short to meet
  expect_none(deck);
}

TEST(Warnings, OfAPartThatIsLeftOutOfContact) {
  Deck deck = blocks();
  deck.contact->exclude = {"lower"};
  deck.initial_conditions.push_back(moving("lower", {0, 0, 1}));
  expect_one(deck, "parts 'lower' and 'upper'", "towards each other");
  deck.contact->exclude = {};
  deck.contact->pairs = {ContactPair{{"lower", "upper"}, {}, false}};  // said on purpose
  expect_none(deck);
}

TEST(Warnings, OfMaterialsWithoutAPart) {
  Deck deck = blocks();
  deck.materials.push_back({"forgotten", elastic()});
  expect_one(deck, "material 'forgotten'", "no part");
}

TEST(Warnings, OfAPartThatNothingConcerns) {
  Deck deck = blocks();
  deck.parts.push_back(box("idle", {1, 1, 1}, {3, 3, 3}, {5, 0, 0}, hex8()));
  deck.contact->exclude = {"idle"};
  expect_one(deck, "part 'idle'", "no motion, load");
  for (const BoundaryCondition& condition : {BoundaryCondition{fix("idle.bottom", {0, 1, 2})}}) {
    deck.boundary_conditions = {condition};
    expect_none(deck);
  }
  deck.boundary_conditions = {};
  Gravity gravity;
  gravity.acceleration = {0, 0, -1};
  deck.loads = {gravity};
  expect_none(deck);
}

TEST(Warnings, OfOneElementThroughAPlate) {
  Deck deck = blocks();
  deck.parts[0] = box("lower", {4, 4, 0.3}, {12, 12, 1}, {0, 0, 0}, hex8());
  expect_one(deck, "part 'lower'", "one element with one integration point");
  deck.parts[0] = box("lower", {4, 4, 0.6}, {12, 12, 2}, {0, 0, 0}, hex8());
  expect_none(deck);
  deck.parts[0] = box("lower", {4, 4, 0.3}, {12, 12, 1}, {0, 0, 0}, Hex8Full{});
  expect_none(deck);
  deck.parts[0] = box("lower", {1, 1, 0.3}, {3, 3, 1}, {0, 0, 0}, hex8());  // not slender
  expect_none(deck);
}

TEST(Warnings, OfOneElementAcrossABarUnlessItIsOnlyHitAlong) {
  Deck deck = blocks();
  deck.parts = {box("left", {4, 0.3, 0.3}, {13, 1, 1}, {-2, 0, 0}, hex8()),
                box("right", {4, 0.3, 0.3}, {13, 1, 1}, {2.1, 0, 0}, hex8())};
  deck.initial_conditions = {moving("right", {-10, 0, 0})};
  expect_none(deck);
  deck.initial_conditions = {moving("right", {-10, 0, 1})};
  const std::vector<SceneWarning> warnings = warnings_of(deck);
  ASSERT_EQ(warnings.size(), 2u);
  EXPECT_NE(warnings[0].what.find("one element with one integration point"), std::string::npos);
}

TEST(Warnings, OfElementsWithoutHourglassControl) {
  Deck deck = blocks();
  Hex8 loose;
  loose.hourglass_stiffness = 0;
  deck.parts[0].element = loose;
  expect_one(deck, "part 'lower'", "hourglass");
  loose.hourglass_viscosity = 0.1;
  deck.parts[0].element = loose;
  expect_none(deck);
}

TEST(Warnings, OfAForceOnASingleNode) {
  Deck deck = blocks();
  NodalForce force;
  force.where.region = SphereRegion{{0.5, 0.5, 0.5}, 1e-3};
  force.force = {1, 0, 0};
  deck.loads = {force};
  expect_one(deck, "part 'lower'", "single node");
  deck.parts[0].element = Hex8Full{};
  expect_none(deck);
  deck.parts[0].element = hex8();
  force.where.region = SphereRegion{{0.5, 0.5, 0.5}, 0.4};
  deck.loads = {force};
  expect_none(deck);
}

TEST(Warnings, OfMeshesThatDoNotFitInContact) {
  Deck deck = blocks();
  deck.parts[1] = box("upper", {1, 1, 1}, {15, 15, 15}, {0, 0, 1.1}, hex8());
  expect_one(deck, "part 'lower'", "5 times as long");
  deck.parts[1] = box("upper", {1, 1, 1}, {9, 9, 9}, {0, 0, 1.1}, hex8());
  expect_none(deck);
  deck.parts[1] = box("upper", {1, 1, 1}, {15, 15, 15}, {9, 0, 1.1}, hex8());  // never near
  expect_none(deck);
}

TEST(Warnings, OfFewElementsThatSetTheStep) {
  Deck deck = blocks();
  deck.parts.push_back(box("chip", {0.1, 0.1, 0.1}, {1, 1, 1}, {5, 0, 0}, hex8()));
  deck.initial_conditions.push_back(moving("chip", {1, 0, 0}));
  expect_one(deck, "part 'chip'", "1 of 55 elements");
  deck.parts.back() = box("chip", {0.3, 0.3, 0.3}, {1, 1, 1}, {5, 0, 0}, hex8());
  expect_none(deck);
  deck.parts.back() = box("chip", {0.1, 0.1, 0.1}, {1, 1, 1}, {5, 0, 0}, Rigid{});  // sets no step
  expect_none(deck);
}

TEST(Warnings, OfLongElements) {
  Deck deck = blocks();
  deck.parts[0] = box("lower", {1, 1, 1}, {1, 1, 11}, {0, 0, 0}, hex8());
  const std::vector<SceneWarning> warnings = warnings_of(deck);
  const auto is_long = [](const SceneWarning& w) {
    return w.what.find("11 elements have edges up to 11") == 0;
  };
  EXPECT_EQ(std::count_if(warnings.begin(), warnings.end(), is_long), 1);
}

TEST(Warnings, OfParticlesOfNowThatAreSolid) {
  Deck deck = blocks();
  ParticleMesh mesh;
  mesh.box = {{1, 1, 1}, 0.3};
  Particle particle;
  particle.kernel = ParticleFrame::eulerian;
  deck.parts[1].mesh = mesh;
  deck.parts[1].element = particle;
  expect_one(deck, "part 'upper'", "stiffness of a solid");
  deck.parts[1].element = Particle{};
  expect_none(deck);
  deck.parts[1].element = particle;
  deck.parts[1].material = "fluid";
  deck.materials.push_back({"fluid", elastic(0.495)});
  expect_none(deck);
}

TEST(Warnings, OfTablesThatFall) {
  Deck deck = blocks();
  std::vector<std::array<double, 2>> rows{{0, 1e6}, {0.1, 2e6}};
  deck.materials = {{"tabulated", TabulatedPlasticity{1000, 1e9, 0.3, yield_table(rows)}}};
  for (Part& part : deck.parts) part.material = "tabulated";
  expect_none(deck);
  rows.push_back({0.2, 1.9e6});
  deck.materials.back().second = TabulatedPlasticity{1000, 1e9, 0.3, yield_table(rows)};
  expect_one(deck, "material 'tabulated'", "depend on the mesh");
}

TEST(Warnings, OfOutputAtEveryStepAndLooseLimits) {
  Deck deck = blocks();
  deck.output.history.every = 1e-9;
  expect_one(deck, "output.history.every", "shorter than a time step");
  deck.output.history.every = 1e-3;
  expect_none(deck);
  deck.numerics.energy_error_limit = 0.5;
  expect_one(deck, "numerics.energy_error_limit", "0.5");
}

std::vector<std::string> names_of(const std::vector<BuiltFeature>& features) {
  std::vector<std::string> names;
  for (const BuiltFeature& feature : features) names.push_back(feature.name);
  return names;
}

TEST(BuiltFeatures, NameTheKeyThatAskedForThem) {
  Deck deck = blocks();
  deck.contact->options.friction = 0.1;
  deck.boundary_conditions = {fix("lower.bottom", {0, 1, 2})};
  Model model = build_model(deck);
  const std::vector<std::string> not_built = features_not_built(model);
  const std::vector<BuiltFeature> features = built_features(deck, std::move(model));
  EXPECT_EQ(names_of(features), (std::vector<std::string>{"nodes", "hex8", "elastic", "prescribed motion",
                                                          "contact", "friction"}));
  EXPECT_EQ(features[1].because, "parts.lower.element, parts.upper.element");
  EXPECT_EQ(features[1].detail, "54 elements");
  EXPECT_EQ(features[3].because, "boundary_conditions[0]");
  EXPECT_EQ(features[3].detail, "16 nodes");
  EXPECT_EQ(features[4].detail, "2 parts, 108 faces, 112 nodes, 2 bodies");
#if !defined(__SANITIZE_ADDRESS__)  // which does not tell what is allocated
  EXPECT_GT(features[4].bytes, 108 * sizeof(Face));
#endif
  EXPECT_EQ(not_built, (std::vector<std::string>{"shells", "beams", "particles", "rigid bodies",
                                                 "merged nodes", "ties", "deletion", "rigid walls", "loads",
                                                 "springs", "damping", "mass scaling"}));
}

}  // namespace
}  // namespace brio
