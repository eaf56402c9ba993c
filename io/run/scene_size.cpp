#include "io/run/scene_size.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>

#include "io/yaml/deck_error.hpp"
#include "src/build/build.hpp"
#include "src/forecast/memory.hpp"

namespace brio {

namespace {

struct Count {
  double elements = 0;
  double nodes = 0;
  double faces = 0;  ///< of the surface
  bool sheet = false;
};

Count block(double a, double b, double c) {
  return {a * b * c, (a + 1) * (b + 1) * (c + 1), 2 * (a * b + b * c + c * a)};
}
Count sheet(double a, double b) { return {a * b, (a + 1) * (b + 1), a * b, true}; }
Count lattice(double particles) { return {particles, particles, 0}; }

Count count(const BoxMesh& mesh) { return block(mesh.elements[0], mesh.elements[1], mesh.elements[2]); }
Count count(const PlateMesh& mesh) { return sheet(mesh.elements[0], mesh.elements[1]); }
Count count(const CylinderMesh& mesh) { return sheet(mesh.elements[0], mesh.elements[1]); }
Count count(const TubeMesh& mesh) { return block(mesh.elements[0], mesh.elements[1], mesh.elements[2]); }
Count count(const WedgeMesh& mesh) { return block(mesh.elements[0], mesh.elements[1], mesh.elements[2]); }
// An O-grid of layers a quarter of the diameter deep: 3/4 of the square of what lies across.
Count count(const RodMesh& mesh) {
  const double across = mesh.elements[0], along = mesh.elements[1];
  const double section = 0.75 * across * across;
  return {section * along, section * (along + 1), 2 * section + 2 * across * along};
}
// The same in space: a core of half the diameter and six times a quarter of it around.
Count count(const SphereMesh& mesh) {
  const double across = mesh.elements, cells = 0.5 * across * across * across;
  return {cells, cells, 1.5 * across * across};
}
Count count(const HollowSphereMesh& mesh) {
  const double shells = 6.0 * mesh.elements * mesh.elements;
  return {shells, shells, shells, true};
}
Count count(const LineMesh& mesh) { return {double(mesh.elements), mesh.elements + 1.0, 0}; }
Count count(const ParticleMesh& mesh) {
  if (mesh.box) {
    const auto& [size, spacing] = *mesh.box;
    return lattice(size[0] * size[1] * size[2] / (spacing * spacing * spacing));
  }
  if (mesh.cylinder) {
    const auto& [radius, height, spacing, inner] = *mesh.cylinder;
    return lattice(std::numbers::pi * (radius * radius - inner * inner) * height /
                   (spacing * spacing * spacing));
  }
  return lattice(4 * std::numbers::pi / 3 * std::pow(mesh.sphere->radius / mesh.sphere->spacing, 3));
}

// Of a mesh of hexahedra without holes each element has a node of its own but for those of half of its
// surface.
Count count(const MeshFromFile& source) {
  const Mesh& mesh = *source.mesh;
  const auto elements = static_cast<double>(mesh.element_count()),
             nodes = static_cast<double>(mesh.position.size());
  if (mesh.nodes_per_element == 8)
    return {elements, nodes, std::max(2 * (nodes - elements), 6 * std::cbrt(elements * elements))};
  return {elements, nodes, mesh.nodes_per_element == 4 ? elements : 0, mesh.nodes_per_element == 4};
}

Count count(const Part& part) {
  return std::visit([](const auto& mesh) { return count(mesh); }, part.mesh);
}

// Bytes at the peak of a run, while meshes and model are there together, as measured with 36,000 to 220,000
// elements of each kind and a law with hardening.
constexpr double bytes_of_node = 270, bytes_of_side = 3800, bytes_of_shell_side = 3300;
double bytes_of_element(const Hex8&) { return 500; }
double bytes_of_element(const Hex8Full&) { return 1400; }
double bytes_of_element(const Shell4&) { return 620; }
double bytes_of_element(const Beam2&) { return 2000; }
double bytes_of_element(const Particle& particle) { return particle.is_eulerian() ? 5200 : 1900; }
double bytes_of_element(const Rigid&) { return 270; }

double bytes_of(const Part& part, const Deck& deck) {
  const Count size = count(part);
  const double surface =
      is_in_contact(deck, part.name) ? size.faces * (size.sheet ? bytes_of_shell_side : bytes_of_side) : 0;
  const double each = std::visit([](const auto& element) { return bytes_of_element(element); }, part.element);
  return size.elements * each + size.nodes * bytes_of_node + surface;
}

const Part& largest_part(const Deck& deck) {
  return *std::max_element(deck.parts.begin(), deck.parts.end(), [&](const Part& a, const Part& b) {
    return bytes_of(a, deck) < bytes_of(b, deck);
  });
}

std::string in_words(double megabytes) {
  return megabytes < 1e4 ? fmt::format("{:.0f} MB", megabytes) : fmt::format("{:.4g} GB", megabytes / 1024);
}

[[noreturn]] void refuse(const Deck& deck, const std::string& fault) {
  const Part& part = largest_part(deck);
  throw DeckError(fmt::format("{}: {}; a coarser mesh is accepted, here of part '{}', the largest",
                              part.place.empty() ? deck.file : part.place, fault, part.name));
}

std::string memory_fault(double wanted_mb, double there_mb) {
  return fmt::format("the scene needs about {} of memory, {} are available", in_words(wanted_mb),
                     in_words(there_mb));
}

}  // namespace

double memory_of_scene_mb(const Deck& deck) {
  double bytes = 0;
  for (const Part& part : deck.parts) bytes += bytes_of(part, deck);
  return bytes / (1 << 20);
}

void refuse_memory(const Deck& deck) {
  refuse(deck, "not enough memory: " + memory_fault(memory_of_scene_mb(deck), available_memory_mb()));
}

void check_scene_size(const Deck& deck) {
  double nodes = 0;
  for (const Part& part : deck.parts) nodes += count(part).nodes;
  constexpr double most_nodes = std::numeric_limits<int>::max();
  if (nodes > most_nodes)
    refuse(deck, fmt::format("the scene has about {:.3g} nodes; at most {:.0f} can be numbered", nodes,
                             most_nodes));
  const double wanted = memory_of_scene_mb(deck), there = available_memory_mb();
  if (wanted > there) refuse(deck, memory_fault(wanted, there));
}

}  // namespace brio
