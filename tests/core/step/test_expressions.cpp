// Expressions of time and place in loads and motions, against tables and closed forms.

#include <gtest/gtest.h>

#include <cmath>

#include "src/deck/expression.hpp"
#include "tests/core/scene.hpp"

namespace brio {
namespace {

using namespace test;
using Variables = Expression::Variables;

Curve curve_of(const std::string& text, double end) {
  Curve curve;
  curve.expression = std::make_shared<const Expression>(text, Expression::Parameters{}, Variables::time);
  for (int i = 0; i <= 100; ++i) curve.points.push_back({end * i / 100, curve.expression->at(end * i / 100)});
  return curve;
}

TEST(Expression, HasTheValueOfItsFormula) {
  const std::vector<std::pair<std::string, double>> parameters{{"p0", 5}, {"t0", 2}};
  const auto value = [&](const std::string& text, double time = 0.5) {
    return Expression(text, parameters, Variables::time).at(time);
  };
  EXPECT_EQ(value("p0*exp(-t/t0)"), 5 * std::exp(-0.25));
  EXPECT_EQ(value("-p0^2"), -25);
  EXPECT_EQ(value("2^3^2"), 512);
  EXPECT_EQ(value("log(t0) + log10(100)"), std::log(2.0) + 2);
  EXPECT_EQ(value("t < 1 ? 3 : 4", 0.9), 3);
  EXPECT_EQ(value("t < 1 ? 3 : 4", 1.1), 4);
  EXPECT_EQ(value("atan2(1, -1) + min(2, p0) + max(2, p0) + mod(7, 4)"), std::atan2(1, -1) + 2 + 5 + 3);
  EXPECT_EQ(value("30e6 + .5 + 1e-3"), 30e6 + .5 + 1e-3);
  EXPECT_EQ(value("sin(pi/6)"), std::sin(std::numbers::pi / 6));
}

// 10 s^3 - 15 s^4 + 6 s^5: value, first and second derivative at the ends, and symmetry.
TEST(Expression, SmoothStepRisesWithContinuousSecondDerivative) {
  const Expression step("smooth_step(t, 1, 3)", {}, Variables::time);
  EXPECT_EQ(step.at(0.5), 0);
  EXPECT_EQ(step.at(1), 0);
  EXPECT_EQ(step.at(2), 0.5);
  EXPECT_EQ(step.at(3), 1);
  EXPECT_EQ(step.at(7), 1);
  EXPECT_NEAR(step.at(1.6) + step.at(2.4), 1, 1e-15);
  EXPECT_NEAR(step.at(1.5), 10 * std::pow(0.25, 3) - 15 * std::pow(0.25, 4) + 6 * std::pow(0.25, 5), 1e-15);
  const double h = 1e-4;
  EXPECT_NEAR(step.at(1 + h) / (h * h), 0, 1e-3);
  EXPECT_NEAR((1 - step.at(3 - h)) / (h * h), 0, 1e-3);
}

TEST(Expression, SlopeIsTheDerivative) {
  const Curve curve = curve_of("sin(40*t)", 0.1);
  for (const double time : {0.0, 0.03, 0.1}) EXPECT_NEAR(curve.slope(time), 40 * std::cos(40 * time), 1e-8);
}

// The same ramp, load by load, as a table and as an expression.
TEST(Expression, GivesTheRunOfATable) {
  const double end = 1e-3;
  const auto final_positions = [&](const Curve& factor, const Curve& speed, const Curve& pressure) {
    Deck deck;
    deck.materials = {{"material", elastic(0.3)}};
    deck.parts = {box("a", {1, 1, 1}, {3, 3, 3}, {0, 0, 0}, hex8())};
    PrescribedMotion pull = fix("a.zmin", {0, 1});
    pull.components.push_back({2, speed});
    deck.boundary_conditions = {pull};
    Gravity gravity;
    gravity.acceleration = {0, 3e4, -1e4};
    gravity.factor = factor;
    deck.loads = {gravity, Pressure{"a.zmax", pressure}};
    deck.time.end = end;
    Model model = build_model(deck);
    ThreadTeam team(1);
    run(model, deck, team);
    std::vector<double> positions;
    for (std::size_t i = 0; i < model.nodes.size(); ++i)
      positions.insert(positions.end(), model.nodes.record[i].position, model.nodes.record[i].position + 3);
    return positions;
  };
  const std::vector<double> table =
      final_positions(Curve{{{0, 0}, {1e-3, 1}}}, Curve{{{0, 2}, {1e-3, 8}}}, Curve{{{0, 0}, {1e-3, 1e7}}});
  const std::vector<double> expression =
      final_positions(curve_of("1000*t", end), curve_of("2 + 6000*t", end), curve_of("1e10*t", end));
  ASSERT_EQ(table.size(), expression.size());
  for (std::size_t i = 0; i < table.size(); ++i) EXPECT_NEAR(table[i], expression[i], 1e-12);
}

// p = a + b x on a face of 2 x 1 around x = 1: force a A + b A x_c, and its moment of the centres of sides.
TEST(Expression, PressureOfPositionHasItsResultant) {
  Deck deck;
  deck.materials = {{"material", elastic()}};
  deck.parts = {box("a", {2, 1, 1}, {8, 2, 1}, {1, 0.5, 0.5}, hex8())};
  SpaceTimeCurve pressure;
  pressure.expression = std::make_shared<const Expression>("(3 + 2*x)*t", Expression::Parameters{},
                                                           Variables::time_and_position);
  pressure.points = {{0, 0}, {1, 3}};
  pressure.varies_in_space = true;
  deck.loads = {Pressure{"a.zmax", pressure}};
  deck.time.end = 1;
  Model model = build_model(deck);
  ASSERT_EQ(model.loads.size(), 1u);
  apply(model.loads[0], 10, model.nodes);
  const Impulse force = resultant(model.loads[0], model.nodes);
  EXPECT_NEAR(force.linear[2], -10 * (3 * 2 + 2 * 2 * 1), 1e-12);
  // Of centres: sum of (3 + 2 x_c) x_c A; the integral of x^2 is larger by the 8 h^3 / 12 within the sides.
  const double exact = 10 * (3 * 2 + 2 * (8.0 / 3 - 8 * std::pow(0.25, 3) / 12));
  EXPECT_NEAR(force.angular[1], exact, 1e-12 * exact);
}

TEST(Expression, FaultsTellWhereTheyAre) {
  const auto fault_of = [](const std::string& text) {
    try {
      Expression(text, std::vector<std::pair<std::string, double>>{{"v", 1}}, Variables::time);
    } catch (const ExpressionError& error) {
      return std::to_string(error.position()) + " " + error.what() + " [" + error.unknown() + "]";
    }
    return std::string("none");
  };
  EXPECT_EQ(fault_of("2*v"), "none");
  EXPECT_EQ(fault_of("2*vv"), "2 'vv' means nothing here [vv]");
  EXPECT_EQ(fault_of("3 + foo(1)"), "4 'foo' means nothing here [foo]");
  EXPECT_EQ(fault_of("x"), "0 'x' means nothing here [x]");
  EXPECT_EQ(fault_of("1 +"), "3 the expression ends too early []");
  EXPECT_EQ(fault_of("(1"), "2 a parenthesis is not closed []");
  EXPECT_EQ(fault_of("v = 3"), "2 '=' cannot stand here; accepted for a comparison is == []");
  EXPECT_EQ(fault_of("1, 2"), "1 ',' cannot stand here; one number is accepted []");
  EXPECT_EQ(fault_of(""), "0 the expression is empty []");
  EXPECT_NE(fault_of("sin(1, 2)"), "none");
  EXPECT_NE(fault_of("2 3"), "none");
}

}  // namespace
}  // namespace brio
