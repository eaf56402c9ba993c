// Fields of cells that a deck chooses.

#include <gtest/gtest.h>

#include <cmath>

#include "src/output/cell_variables.hpp"
#include "src/output/observe.hpp"
#include "tests/core/scene.hpp"

namespace brio {
namespace {

using namespace test;

double derived(const std::string& name, const SymmetricTensor<double>& stress) {
  ElementSample sample;
  sample.stress = stress;
  for (const DerivedVariable& variable : derived_variables())
    if (variable.name == name) return variable.value(sample);
  ADD_FAILURE() << name;
  return 0;
}

TEST(CellVariables, OfUniaxialShearAndBiaxialStress) {
  const SymmetricTensor<double> uniaxial{0, 300, 0, 0, 0, 0}, shear{0, 0, 0, 0, 50, 0},
      biaxial{70, 70, 0, 0, 0, 0}, hydrostatic{-9, -9, -9, 0, 0, 0};
  EXPECT_DOUBLE_EQ(derived("von_mises", uniaxial), 300);
  EXPECT_DOUBLE_EQ(derived("pressure", uniaxial), -100);
  EXPECT_DOUBLE_EQ(derived("triaxiality", uniaxial), 1.0 / 3);
  EXPECT_DOUBLE_EQ(derived("von_mises", shear), 50 * std::sqrt(3.0));
  EXPECT_EQ(derived("triaxiality", shear), 0);
  EXPECT_DOUBLE_EQ(derived("von_mises", biaxial), 70);
  EXPECT_DOUBLE_EQ(derived("triaxiality", biaxial), 2.0 / 3);
  EXPECT_DOUBLE_EQ(derived("pressure", hydrostatic), 9);
  EXPECT_EQ(derived("triaxiality", {0, 0, 0, 0, 0, 0}), 0);
}

std::vector<std::string> names_of(const Snapshot& snapshot) {
  std::vector<std::string> names;
  for (const FieldArray& field : snapshot.cell_fields) names.push_back(field.name);
  return names;
}

TEST(CellVariables, OnlyWhatIsNamedIsWritten) {
  Deck deck;
  deck.materials = {{"material", elastic(0.3)}};
  deck.parts = {box("bar", {1, 1, 1}, {1, 1, 1}, {0, 0, 0}, hex8())};
  deck.initial_conditions = {moving("bar", {0, 0, 1})};
  deck.time.end = 1e-3;
  Model model = build_model(deck);
  ThreadTeam team(1);
  make_steps(model, 3, 1, team);
  const std::vector<std::string> one{"pressure"}, more{"default", "von_mises"};
  EXPECT_EQ(names_of(FieldObserver(model, one).observe(model)),
            (std::vector<std::string>{"part", "element_id", "pressure"}));
  EXPECT_EQ(
      names_of(FieldObserver(model, more).observe(model)),
      (std::vector<std::string>{"stress", "equivalent_plastic_strain", "part", "element_id", "von_mises"}));
  EXPECT_EQ(names_of(FieldObserver(model).observe(model)),
            (std::vector<std::string>{"stress", "equivalent_plastic_strain", "part", "element_id"}));
}

TEST(CellVariables, AllStandsForTheDefaultWhatFollowsFromItAndHistories) {
  const std::vector<std::string> wanted{"pressure", "all"};
  const std::vector<std::string_view> histories{"temperature"};
  EXPECT_EQ(named_variables(wanted, histories),
            (std::vector<std::string>{"pressure", "default", "von_mises", "triaxiality", "internal_energy",
                                      "temperature"}));
}

}  // namespace
}  // namespace brio
