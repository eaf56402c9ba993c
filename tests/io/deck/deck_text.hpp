#pragma once
/// A small deck that is right, to change piece by piece.

#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <vector>

#include "io/deck/read_deck.hpp"

namespace brio {

inline constexpr const char* plain_deck = R"(title: Two boxes
materials:
  steel: {model: elastic, density: 7.34e-4, youngs_modulus: 30e6, poissons_ratio: 0.3}
parts:
  left:
    mesh: {box: {size: [1, 1, 2], elements: [2, 2, 4]}}
    element: hex8
    material: steel
  right:
    mesh: {tube: {inner_radius: 1, outer_radius: 2, height: 3, elements: [12, 4, 2]}}
    placement: {rotate: {axis: [0, 1, 0], degrees: 90}, translate: [0, 0, 19]}
    element: {type: hex8}
    material: steel
initial_conditions:
  - {part: left, velocity: [0, 0, -5000]}
  - {set: right.top, spin: {point: [0, 0, 0], angular_velocity: [0, 0, 1]}}
boundary_conditions:
  - {set: left.bottom, fix: [x, y, z]}
  - {set: {plane: {point: [0, 0, 1], normal: [0, 0, 1], tolerance: 1e-6}, part: left}, velocity: {z: [[0, 0], [1e-3, 5]]}}
  - {rigid_wall: {point: [0, 0, -3], normal: [0, 0, 1]}}
loads:
  - {gravity: [0, 0, -9.81], factor: [[0, 0], [1, 1]]}
  - {set: left.top, force: [1, 2, 3]}
  - {side_set: right.inside, pressure: 100}
contact: {surfaces: all, exclude: [left], friction: 0.1}
time: {end: 3e-3, step_scale: 0.9}
output: {fields: {every: 5e-5}, history: {every: 1e-6}}
)";

/// The same with a piece of it replaced.
inline std::string with(const std::string& from, const std::string& to) {
  std::string text = plain_deck;
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

/// The message of the error, or nothing.
inline std::string fault_of(const std::function<void()>& read) {
  try {
    read();
  } catch (const DeckError& fault) {
    return fault.what();
  }
  return {};
}
/// \param name of the deck, beside which its meshes are
inline std::string fault_of(const std::string& text, const std::vector<std::string>& overrides = {},
                            const std::string& name = "a.yaml") {
  return fault_of([&] { parse_deck(text, name, overrides); });
}

/// The same with local coordinate systems, of which motions and loads take their axes.
inline std::string deck_with_systems() {
  std::string text = plain_deck;
  text.insert(text.find("boundary_conditions:\n"),
              "coordinate_systems:\n"
              "  ramp: {rectangular: {x: [1, 0, 1], y: [1, 1, 0]}}\n"
              "  axle: {cylindrical: {point: [0, 0, 19], axis: [1, 0, 0]}}\n");
  text.insert(text.find("loads:\n"),
              "  - {name: cut, set: right.top, system: axle, fix: [t, z]}\n"
              "  - {set: right.bottom, system: ramp, velocity: {y: 3}}\n");
  text.insert(text.find("contact:"),
              "  - {set: right.top, system: axle, force: [1, 2, 3]}\n"
              "  - {gravity: [0, 0, 1], system: ramp}\n");
  return text;
}

}  // namespace brio
