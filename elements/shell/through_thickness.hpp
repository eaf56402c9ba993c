#pragma once
/// Rules of integration through the thickness of a shell: 1 to 9 points, Gauss or Gauss-Lobatto.

#include <array>

#include "src/base/fields.hpp"
#include "src/base/index.hpp"

namespace brio {

enum class ThicknessQuadrature { gauss, lobatto };
constexpr std::array<NamedValue<ThicknessQuadrature>, 2> named_values(ThicknessQuadrature) {
  return {{{"gauss", ThicknessQuadrature::gauss}, {"lobatto", ThicknessQuadrature::lobatto}}};
}

inline constexpr int most_thickness_points = 9;

/// Places as fractions of the thickness, from -1/2 to 1/2, and weights whose sum is 1.
struct ThicknessRule {
  int count = 0;
  std::array<double, most_thickness_points> place{};
  std::array<double, most_thickness_points> weight{};

  double second_moment = 0;  ///< integral of the square of the place; 1/12 if the rule is exact for it
};

namespace detail {

/// Legendre polynomial of degree n and its first two derivatives at x inside (-1, 1).
struct Legendre {
  double value, slope, curvature;
};
constexpr Legendre legendre(int n, double x) {
  double before = 0;
  double value = 1;
  for (int k = 0; k < n; ++k) {
    const double next = ((2 * k + 1) * x * value - k * before) / (k + 1);
    before = value;
    value = next;
  }
  const double slope = n * (before - x * value) / (1 - x * x);
  return {value, slope, (2 * x * slope - n * (n + 1) * value) / (1 - x * x)};
}

/// Roots of P_n (Gauss) or of the slope of P_{n-1} (Lobatto's inner points) by Newton's method with the roots
/// already found divided out, from the right; mirrored so that the rule is symmetric to the bit.
constexpr ThicknessRule thickness_rule(ThicknessQuadrature quadrature, int count) {
  ThicknessRule rule;
  rule.count = count;
  const bool ends = quadrature == ThicknessQuadrature::lobatto && count > 1;
  const int degree = ends ? count - 1 : count;
  const int inner = ends ? count - 2 : count;
  std::array<double, most_thickness_points> root{};
  for (int k = 0; k < (inner + 1) / 2; ++k) {
    double x = 0.999999;
    for (int iteration = 0; iteration < 200; ++iteration) {
      const Legendre p = legendre(degree, x);
      if ((ends ? p.slope : p.value) == 0) break;
      double log_slope = ends ? p.curvature / p.slope : p.slope / p.value;
      for (int j = 0; j < k; ++j) log_slope -= 1 / (x - root[index(j)]);
      x -= 1 / log_slope;
    }
    if (inner % 2 == 1 && k == inner / 2) x = 0;
    root[index(k)] = x;
  }
  for (int k = 0; k < count; ++k) {
    const int from_end = k < count - 1 - k ? k : count - 1 - k;
    double x = 1;
    if (!ends || from_end > 0) x = root[index(ends ? from_end - 1 : from_end)];
    double weight = 1.0 / (count > 1 ? count * (count - 1.0) : 1.0);
    if (!ends) {
      const double slope = legendre(count, x).slope;
      weight = 1 / ((1 - x * x) * slope * slope);
    } else if (from_end > 0) {
      const double value = legendre(count - 1, x).value;
      weight /= value * value;
    }
    const auto p = index(k);
    rule.place[p] = (k < count - 1 - k ? -0.5 : 0.5) * x;
    rule.weight[p] = weight;
    rule.second_moment += weight * rule.place[p] * rule.place[p];
  }
  return rule;
}

constexpr auto all_thickness_rules() {
  std::array<std::array<ThicknessRule, most_thickness_points + 1>, 2> rules{};
  for (int count = 1; count <= most_thickness_points; ++count) {
    rules[0][index(count)] = thickness_rule(ThicknessQuadrature::gauss, count);
    rules[1][index(count)] = thickness_rule(ThicknessQuadrature::lobatto, count);
  }
  return rules;
}
inline constexpr auto thickness_rules = all_thickness_rules();

}  // namespace detail

/// A single Lobatto point stands in the middle, as Gauss' does.
constexpr const ThicknessRule& thickness_rule(ThicknessQuadrature quadrature, int count) {
  return detail::thickness_rules[index(quadrature)][index(count)];
}

}  // namespace brio
