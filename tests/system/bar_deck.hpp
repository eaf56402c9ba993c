#pragma once
/// A bar whose end is given a push: cheap, and different on every mesh.

#include <string>

namespace brio::test {

inline const std::string bar_deck = R"(
materials:
  rubber: {model: elastic, density: 1000, youngs_modulus: 1e9, poissons_ratio: 0}
parts:
  bar: {mesh: {box: {size: [1, 0.1, 0.1], elements: [20, 1, 1]}}, element: hex8, material: rubber}
boundary_conditions: [{set: bar.xmin, fix: [x, y, z]}]
initial_conditions: [{set: bar.xmax, velocity: [1, 0, 0]}]
time: {end: 2e-3}
output: {history: {every: 1e-5}}
)";

}  // namespace brio::test
