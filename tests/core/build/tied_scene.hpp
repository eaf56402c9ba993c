#pragma once
/// Parts that are tied.

#include <string>
#include <utility>

#include "contact/surface/face_geometry.hpp"
#include "tests/core/scene.hpp"

namespace brio::test {

inline TieToSurface tied(std::string nodes, std::string surface, double tolerance = 1e-3) {
  return {.names = {std::move(nodes), std::move(surface)}, .tolerance = tolerance, .place = "deck.yaml:3:5"};
}

/// A box of coarse elements below z = 0 and one of fine elements above a gap.
inline Deck two_boxes(std::array<int, 3> coarse, std::array<int, 3> fine, double gap = 0,
                      double poissons_ratio = 0.3) {
  Deck deck;
  deck.materials = {{"material", elastic(poissons_ratio)}};
  deck.parts = {box("coarse", {1, 1, 1}, coarse, {0, 0, -0.5}, inviscid_hex8()),
                box("fine", {1, 1, 1}, fine, {0, 0, 0.5 + gap}, inviscid_hex8())};
  deck.connections = {tied("fine.zmin", "coarse", 2 * gap + 1e-3)};
  deck.time.end = 1e-2;
  return deck;
}

/// Velocities of a linear field, with tied nodes at their positions.
inline void set_velocities(Model& model, const Vector3d& constant, const Tensor<double>& gradient) {
  const Vector3d spin{0.5 * (gradient(2, 1) - gradient(1, 2)), 0.5 * (gradient(0, 2) - gradient(2, 0)),
                      0.5 * (gradient(1, 0) - gradient(0, 1))};
  Nodes& nodes = model.nodes;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const Vector3d v = constant + gradient * vector_at(nodes.record[i].position);
    for (int axis = 0; axis < 3; ++axis) {
      nodes.record[i].velocity[axis] = v[axis];
      if (nodes.has_rotations()) nodes.angular_velocity[i].component[axis] = spin[axis];
    }
  }
  carry_velocities(model.ties, nodes, 0);
  double energy = 0;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    energy += 0.5 * nodes.mass[i] * squared_norm(velocity(nodes, static_cast<int>(i)));
    if (nodes.has_rotations())
      energy +=
          0.5 * nodes.rotational_inertia[i] * squared_norm(vector_at(nodes.angular_velocity[i].component));
  }
  model.energy.kinetic_start = energy;
}

inline Part plate(std::string name, std::array<double, 2> size, std::array<int, 2> elements, Vector3d centre,
                  double thickness) {
  Shell4 shell;
  shell.thickness = thickness;
  Part part{std::move(name), PlateMesh{size, elements}, {}, shell, "material"};
  part.placement.translate = centre;
  return part;
}

inline Part stiffener(double height, int elements) {
  Beam2 element;
  element.section = RectangleSection{.width = 0.02, .height = 0.04};
  element.orientation = {0, 0, 1};
  return {"stiffener", LineMesh{{-0.5, 0, height}, {0.5, 0, height}, elements}, {}, element, "material"};
}

/// A panel with a beam beside its middle surface.
inline Deck stiffened_panel(double height = 0.03, int beams = 24) {
  Deck deck;
  deck.materials = {{"material", elastic(0)}};
  deck.parts = {plate("panel", {1, 0.1}, {16, 2}, {0, 0, 0}, 0.02), stiffener(height, beams)};
  deck.connections = {tied("stiffener", "panel", 0.03)};
  deck.time.end = 0.05;
  return deck;
}

}  // namespace brio::test
