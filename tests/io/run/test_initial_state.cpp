// Parts that begin with the state of an earlier result.

#include "elements/element_state.hpp"
#include "io/run/check_deck.hpp"
#include "src/base/index.hpp"
#include "tests/io/run/initial_state.hpp"

namespace brio::test {
namespace {

// A damped block comes to rest under its stress; what starts from it is at rest, but for what is left of
// motion.
std::string with_damping(const std::string& text) {
  return with(text, "material: steel}", "material: steel, damping: 2e4}");
}

TEST_F(InitialState, APressedBlockStaysAtRest) {
  for (const std::string element : {"hex8", "hex8_full"}) {
    SCOPED_TRACE(element);
    run("pressing", with_damping(with(pressing, "ELEMENT", element)));
    const std::vector<double> velocity_left = field("pressing", "velocity").values;
    EXPECT_LE(largest(velocity_left), 1e-12);
    const RunOutcome outcome = run("held", with(held, "ELEMENT", element));
    EXPECT_LE(largest(field("held", "displacement").values), 1e-15);
    EXPECT_LE(largest(field("held", "velocity").values), 1e-10);
    const double stress = largest(field("pressing", "stress").values);
    EXPECT_GT(stress, 2e8);
    EXPECT_LE(largest_difference(field("pressing", "stress").values, field("held", "stress").values),
              1e-7 * stress);
    EXPECT_EQ(largest_difference(field("pressing", "equivalent_plastic_strain").values,
                                 field("held", "equivalent_plastic_strain").values),
              0);
    EXPECT_GT(largest(field("held", "equivalent_plastic_strain").values), 1e-4);
    // What elements bring with them is energy of the start.
    EXPECT_LE(outcome.summary.energy.error_relative, 1e-9);
  }
}

// Stress and plastic strain alone: as the result shows them, but no hourglass strain, so that the block
// settles a little.
TEST_F(InitialState, OfStressAndPlasticStrainIsThatOfTheResult) {
  run("pressing", with(with_damping(with(pressing, "ELEMENT", "hex8")), ", variables: [default, state]", ""));
  const std::string text =
      with(with(held, "ELEMENT", "hex8"), "[positions, state]", "[positions, stress, plastic_strain]");
  const Model model = build("new", text);
  const std::vector<double> stress = field("pressing", "stress").values;
  const std::vector<double> strain = field("pressing", "equivalent_plastic_strain").values;
  double elastic_energy = 0;
  for (std::size_t e = 0; e < strain.size(); ++e) {
    const auto slot = index(model.parts[0].element_slot[e]);
    const ElementSample sample = model.blocks[0].kernel.sample(model.blocks[0], model.nodes, slot, true);
    EXPECT_EQ(sample.stress.xx, stress[6 * e]);
    EXPECT_EQ(sample.stress.xz, stress[6 * e + 5]);
    EXPECT_EQ(sample.named("equivalent_plastic_strain"), strain[e]);
    const double* s = &stress[6 * e];
    const double mean = (s[0] + s[1] + s[2]) / 3;
    double square = 2 * (s[3] * s[3] + s[4] * s[4] + s[5] * s[5]);
    for (int i = 0; i < 3; ++i) square += (s[i] - mean) * (s[i] - mean);
    // s:s / 4G + p^2 / 2K
    elastic_energy += 0.012 / 96 * (square / (4 * 2e11 / 2.6) + mean * mean / (2 * 2e11 / 1.2));
  }
  EXPECT_NEAR(model.energy.internal, elastic_energy, 1e-12 * elastic_energy);
  run("held", text);
  EXPECT_LE(largest_difference(stress, field("held", "stress").values), 2e-3 * largest(stress));
  EXPECT_LE(largest(field("held", "displacement").values), 1e-3 * 6e-4);
}

// Of either precision, number by number; of a mesh whose elements lie in another order in memory.
TEST_F(InitialState, TheStateThatWasWrittenIsRead) {
  for (const std::string element : {"hex8", "hex8_full", "{type: hex8, objective_rate: jaumann}"})
    for (const std::string precision : {"double", "float"}) {
      SCOPED_TRACE(element + precision);
      const auto finish = [&](const std::string& text) {
        return with(text, "ELEMENT", element) + "numerics: {precision: " + precision + "}\n";
      };
      run("pressing", finish(with(pressing, "time: {end: 4e-3}", "time: {end: 3e-4}")));
      const Model model = build("held", finish(held));
      const ReadField written = field("pressing", "state");
      const Block& block = model.blocks[0];
      ASSERT_EQ(state_components(block), written.components);
      EXPECT_EQ(block.precision == Precision::double_precision, precision == "double");
      std::vector<double> row(written.components);
      for (std::size_t e = 0; e < written.rows; ++e) {
        read_state(block, index(model.parts[0].element_slot[e]), row.data());
        ASSERT_TRUE(std::equal(row.begin(), row.end(),
                               written.values.begin() + static_cast<std::ptrdiff_t>(e * row.size())));
      }
    }
}

// Mass is that of the mesh before it was deformed, and the dump is chosen.
TEST_F(InitialState, KeepsTheMassAndTakesTheDumpThatIsNamed) {
  run("pressing", with(pressing, "ELEMENT", "hex8"));
  const Model model = build("held", with(held, "ELEMENT", "hex8"));
  EXPECT_NEAR(model.parts[0].mass, 0.3 * 0.2 * 0.2 * 7800, 1e-12);
  const Model first =
      build("first", with(with(held, "ELEMENT", "hex8"), "pressing.vtkhdf,", "pressing.vtkhdf, time: 1e-3,"));
  const ResultReader reader(folder / "pressing.vtkhdf");
  ASSERT_EQ(reader.times().size(), 3u);  // and that of the start
  std::vector<double> positions;
  for (std::size_t i = 0; i < first.parts[0].node.size(); ++i)
    for (const double x : std::span(first.nodes.record[index(first.parts[0].node[i])].position, 3))
      positions.push_back(x);
  EXPECT_EQ(largest_difference(positions, reader.field("position", 1).values), 0);
  EXPECT_GT(largest_difference(positions, reader.field("position", 2).values), 1e-6);
}

// Wherever it stands in either deck: numbers of generated elements go on from part to part.
TEST_F(InitialState, APartIsFoundBehindOthers) {
  const std::string other =
      "\nparts:\n  other: {mesh: {box: {size: [1, 1, 1], elements: [3, 1, 1]}}, "
      "placement: {translate: [5, 0, 0]}, element: hex8, material: steel}\n";
  const auto behind = [&](const std::string& text) {
    return with(with(with_damping(text), "ELEMENT", "hex8"), "\nparts:\n", other);
  };
  run("pressing", behind(pressing));
  EXPECT_EQ(field("pressing", "element_id").values.back(), 3 + 6 * 4 * 4 - 1);
  run("held", with(held, "ELEMENT", "hex8"));
  EXPECT_LE(largest(field("held", "displacement").values), 1e-15);
  EXPECT_GT(largest(field("held", "stress").values), 2e8);
  run("held", behind(held));
  EXPECT_LE(largest(field("held", "displacement").values), 1e-15);
}

TEST_F(InitialState, ADeckWithoutItHasNoneOfIt) {
  const Model model = build("pressing", with(pressing, "ELEMENT", "hex8"));
  EXPECT_EQ(model.energy.internal, 0);
  const Deck deck = read_deck((folder / "pressing.yaml").string());
  EXPECT_TRUE(deck.mesh_checksums.empty());
}

// ---- a strip that is bent, and springs back

// Shells are bent beyond yield by forces at the tip, which are then taken away; damped, so that both come to
// rest.
std::string strip(const std::string& force, const std::string& rest) {
  return R"(
materials:
  steel: {model: elastic_plastic, density: 7800, youngs_modulus: 2e11, poissons_ratio: 0.3, yield_stress: 2e8,
          hardening_modulus: 1e9}
parts:
  strip: {mesh: {plate: {size: [0.1, 0.02], elements: [10, 2]}}, damping: 2e3, material: steel,
          element: {type: shell4, thickness: 0.002}}
boundary_conditions: [{set: strip.xmin, fix: [x, y, z, rx, ry, rz]}]
loads: [{set: strip.xmax, force: [0, 0, 12], factor: )" +
         force + "}]\n" + rest;
}
const std::string forming = strip("[[0, 0], [4e-3, 1], [1.52e-2, 1], [1.62e-2, 0]]", R"(
time: {end: 3.5e-2}
output: {fields: {times: [1.5e-2, 3.5e-2], variables: [all, state]}}
)");
const std::string springback = strip("[[0, 1], [0.2e-3, 1], [1.2e-3, 0]]", R"(
initial_conditions: [{part: strip, from: {result: forming.vtkhdf, time: 1.5e-2, fields: [positions, state, velocity]}}]
time: {end: 2e-2}
output: {fields: {times: [2e-2], variables: [all, state]}}
)");

TEST_F(InitialState, AStripSpringsBackAsInTheRunThatGoesOn) {
  run("forming", forming);
  const RunOutcome outcome = run("springback", springback);
  const ResultReader whole(folder / "forming.vtkhdf");
  const std::vector<double> loaded = whole.field("position", 1).values,
                            end = whole.field("position", 2).values;
  const double recovered = largest_difference(loaded, end);
  EXPECT_GT(recovered, 1e-3);
  EXPECT_LE(largest_difference(field("springback", "position").values, end), 1e-6 * recovered);
  const double residual = largest(whole.field("stress_top", 2).values);
  EXPECT_GT(residual, 1e7);
  EXPECT_LE(largest_difference(field("springback", "stress_top").values, whole.field("stress_top", 2).values),
            2e-5 * residual);
  EXPECT_LE(largest_difference(field("springback", "equivalent_plastic_strain_top").values,
                               whole.field("equivalent_plastic_strain_top", 2).values),
            1e-8);
  EXPECT_LE(outcome.summary.energy.error_relative, 1e-3);
}

// With the rotations of its sections.
TEST_F(InitialState, ABeamSpringsBackAsInTheRunThatGoesOn) {
  const auto of_beams = [](std::string text) {
    text = with(text, "{plate: {size: [0.1, 0.02], elements: [10, 2]}}",
                "{line: {start: [0, 0, 0], end: [0.1, 0, 0], elements: 10}}");
    text = with(text, "{type: shell4, thickness: 0.002}",
                "{type: beam2, section: {rectangle: {width: 0.02, height: 0.002}}, orientation: [0, 0, 1]}");
    text = with(with(text, "strip.xmin", "strip.start"), "strip.xmax", "strip.end");
    return with(text, "force: [0, 0, 12]", "force: [0, 5, 37]");
  };
  run("forming", of_beams(forming));
  run("springback", of_beams(springback));
  const ResultReader whole(folder / "forming.vtkhdf");
  const std::vector<double> end = whole.field("position", 2).values;
  const double recovered = largest_difference(whole.field("position", 1).values, end);
  EXPECT_GT(recovered, 1e-3);
  EXPECT_GT(largest(field("springback", "equivalent_plastic_strain").values), 1e-4);
  EXPECT_LE(largest_difference(field("springback", "position").values, end), 1e-5 * recovered);
  EXPECT_NE(fault_of(with(of_beams(springback), "[positions, state, velocity]", "[positions]"))
                .find("positions of beams without the rotations of their ends"),
            std::string::npos);
}

// Before the first step, where its force is taken away at once, it comes to rest as in steps with damping.
TEST_F(InitialState, AStripIsRelaxed) {
  run("forming", forming);
  std::string text = with(springback, ", velocity]", "]");
  text = with(text, "[[0, 1], [0.2e-3, 1], [1.2e-3, 0]]", "0");
  run("damped", text);
  text = with(text, "time: {end: 2e-2}", "time: {end: 1e-5, relaxation: {tolerance: 1e-6}}");
  run("relaxed", with(text, "times: [2e-2]", "times: [1e-5]"));
  const std::vector<double> loaded = ResultReader(folder / "forming.vtkhdf").field("position", 1).values;
  const std::vector<double> damped = field("damped", "position").values;
  EXPECT_GT(largest_difference(loaded, damped), 1e-3);
  EXPECT_LE(largest_difference(field("relaxed", "position").values, damped),
            1e-4 * largest_difference(loaded, damped));
}

// What is saved of a run that begins so goes on with its bits; another result is refused.
TEST_F(InitialState, GoesOnFromARestartFile) {
  run("forming", forming);
  run("springback", springback);
  RunOptions options;
  options.deck = folder / "springback.yaml";
  options.output = folder / "half";
  options.overrides = {"time.end=2e-3"};
  options.stop_after_s = 0;
  EXPECT_EQ(run_deck(options).summary.status, "stopped");
  options.overrides = {};
  options.stop_after_s.reset();
  options.restart = folder / "half" / "springback.restart.h5";
  run_deck(options);
  const ResultReader half(folder / "half" / "springback.vtkhdf");
  EXPECT_EQ(half.field("position", half.times().size() - 1).values, field("springback", "position").values);
  run("forming", with(forming, "12], factor", "11], factor"));
  try {
    run_deck(options);
    ADD_FAILURE() << "it went on";
  } catch (const DeckError& fault) {
    EXPECT_NE(std::string(fault.what()).find("the file 'forming.vtkhdf' has changed since"),
              std::string::npos)
        << fault.what();
  }
}

TEST_F(InitialState, IsInTheReportOfTheCheck) {
  run("forming", forming);
  write("springback.yaml", springback);
  ForecastOptions options;
  options.deck = folder / "springback.yaml";
  options.timed_run_s = 0.01;
  options.coarse_run_s = 0.1;
  const CheckReport report = check_deck(options);
  const auto found = std::ranges::find(report.built, "initial states", &BuiltFeature::name);
  ASSERT_NE(found, report.built.end());
  EXPECT_EQ(found->detail, "1 part");
  EXPECT_NE(report.forecast.coarse_run_fault.find("states from earlier results"), std::string::npos)
      << report.forecast.coarse_run_fault;
}

}  // namespace
}  // namespace brio::test
