#pragma once
/// A small elastic world for tests of contact: hexahedra and shells whose nodes are connected by springs
/// (between all nodes of an element, and for shells between nodes two apart, which resist bending). Central
/// difference.

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include "contact/erosion.hpp"
#include "contact/scene.hpp"
#include "contact/start/initial_gap.hpp"
#include "contact/surface/surface.hpp"
#include "src/base/index.hpp"
#include "src/base/nodes.hpp"
#include "src/base/parallel.hpp"

namespace brio::test {

/// Where a point of a new piece goes.
using Map = std::function<Vector3d(const Vector3d&)>;
/// Moved by a vector.
inline Map shifted(const Vector3d& by) {
  return [by](const Vector3d& x) -> Vector3d { return x + by; };
}

class SpringModel {
 public:
  double stiffness = 1e4;  ///< of a spring times its length
  Vector3d gravity{};
  double damping = 0;        ///< rate at which velocities decay
  double debris_radius = 0;  ///< of nodes left without elements
  Nodes nodes;
  ContactScene scene;

  /// Box of cells with its lowest corner at the origin, placed by `map`. \returns its first node.
  int add_box(std::array<int, 3> cells, const Vector3d& size, double density, const Map& map) {
    const int first = static_cast<int>(position_.size());
    const int nx = cells[0], ny = cells[1], nz = cells[2];
    for (int k = 0; k <= nz; ++k)
      for (int j = 0; j <= ny; ++j)
        for (int i = 0; i <= nx; ++i) {
          add_node(map(Vector3d{size[0] * i / nx, size[1] * j / ny, size[2] * k / nz}));
        }
    Piece& piece = pieces_.emplace_back();
    piece.first_spring = static_cast<int>(springs_.size());
    const double mass = density * (size.x * size.y * size.z) / (8.0 * nx * ny * nz);
    const auto at = [&](int i, int j, int k) { return first + i + (nx + 1) * (j + (ny + 1) * k); };
    for (int k = 0; k < nz; ++k)
      for (int j = 0; j < ny; ++j)
        for (int i = 0; i < nx; ++i) {
          const int corner[8] = {
              at(i, j, k),     at(i + 1, j, k),     at(i + 1, j + 1, k),     at(i, j + 1, k),
              at(i, j, k + 1), at(i + 1, j, k + 1), at(i + 1, j + 1, k + 1), at(i, j + 1, k + 1)};
          for (int a : corner) {
            piece.connectivity.push_back(a);
            mass_[index(a)] += mass;
          }
          for (int a = 0; a < 8; ++a)
            for (int b = 0; b < a; ++b) add_spring(corner[a], corner[b]);
        }
    return first;
  }

  /// Sheet of shells in the plane z = 0, placed by `map`. \returns its first node.
  int add_sheet(std::array<int, 2> cells, std::array<double, 2> size, double thickness, double density,
                const Map& map) {
    const int first = static_cast<int>(position_.size());
    const int nx = cells[0], ny = cells[1];
    for (int j = 0; j <= ny; ++j)
      for (int i = 0; i <= nx; ++i) {
        add_node(map(Vector3d{size[0] * i / nx, size[1] * j / ny, 0}));
      }
    add_shells(
        nx, ny, thickness, density * thickness * size[0] * size[1] / (4.0 * nx * ny),
        [&](int i, int j) { return first + i + (nx + 1) * j; }, false);
    return first;
  }

  /// Closed tube of shells about the z axis. \returns its first node.
  int add_tube(std::array<int, 2> cells, double radius, double height, double thickness, double density) {
    const int first = static_cast<int>(position_.size());
    const int nc = cells[0], nz = cells[1];
    for (int j = 0; j <= nz; ++j)
      for (int i = 0; i < nc; ++i) {
        const double angle = 2 * std::numbers::pi * i / nc;
        add_node({radius * std::cos(angle), radius * std::sin(angle), height * j / nz});
      }
    add_shells(
        nc, nz, thickness, density * thickness * 2 * std::numbers::pi * radius * height / (4.0 * nc * nz),
        [&](int i, int j) { return first + i % nc + nc * j; }, true);
    return first;
  }

  int count() const { return static_cast<int>(position_.size()); }
  /// Set the velocity of the nodes from `first` to the last one so far.
  void throw_from(int first, const Vector3d& velocity) {
    for (std::size_t n = index(first); n < velocity_.size(); ++n) velocity_[n] = velocity;
  }

  /// After everything is added.
  void start(const ContactOptions& options) {
    nodes = Nodes(position_.size(), false);
    nodes.prescribed = AlignedBuffer<std::uint8_t>(position_.size());
    nodes.velocity_before = AlignedBuffer<NodeVector>(position_.size());
    for (std::size_t n = 0; n < position_.size(); ++n) {
      for (int axis = 0; axis < 3; ++axis) {
        nodes.record[n].position[axis] = position_[n][axis];
        nodes.record[n].velocity[axis] = velocity_[n][axis];
      }
      nodes.mass[n] = mass_[n];
      nodes.record[n].inverse_mass = 1 / mass_[n];
    }
    scene = make_contact_scene(options, parts(), nodes);
    rest();
  }
  /// The same, and elements may be deleted.
  void start_erodible(const ContactOptions& options) {
    start(options);
    std::vector<SurfacePart> erodible = parts();
    for (SurfacePart& part : erodible) part.debris_radius = debris_radius;
    make_erodible(scene, erodible, nodes);
  }
  /// Delete elements with their springs; mass stays on the nodes.
  void erode(std::span<const SurfaceElement> deleted) {
    for (const auto& [part, element] : deleted) {
      const Piece& piece = pieces_[index(part)];
      const int springs = piece.shell ? 6 : 28;
      for (int i = 0; i < springs; ++i)
        springs_[index(piece.first_spring + springs * element + i)].broken = true;
      const int corners = piece.shell ? 4 : 8;
      const auto first = piece.connectivity.begin() + corners * element;
      const auto is_corner = [&](int node) {
        return std::find(first, first + corners, node) != first + corners;
      };
      for (std::size_t i = piece.first_bending; i < piece.end; ++i)
        if (is_corner(springs_[i].a) || is_corner(springs_[i].b)) springs_[i].broken = true;
    }
    brio::erode(scene, deleted);
  }

  /// What the contact surface is made of.
  std::vector<SurfacePart> parts() const {
    std::vector<SurfacePart> parts;
    for (const Piece& piece : pieces_)
      parts.push_back({.name = "part " + std::to_string(parts.size()),
                       .nodes_per_element = piece.shell ? 4 : 8,
                       .connectivity = piece.connectivity,
                       .thickness = piece.thickness});
    return parts;
  }
  ThreadTeam& alone() { return alone_; }
  /// Bodies that touch are moved apart by the gap of contact, at rest.
  void make_gap() {
    ThreadTeam team(1);
    make_initial_gap(scene, nodes, team);
    rest();
  }
  /// Take the present positions as those without strain.
  void rest() {
    for (Spring& spring : springs_) spring.length = norm(x(spring.a) - x(spring.b));
  }

  void hold(int first, int end, int axes = 7) {
    for (int n = first; n < end; ++n) nodes.prescribed[index(n)] |= static_cast<std::uint8_t>(axes);
  }

  void accelerate(double dt) {
    std::vector<Vector3d> force(nodes.size(), Vector3d{});
    for (const Spring& s : springs_) {
      if (s.broken) continue;
      const Vector3d along = x(s.b) - x(s.a);
      const double length = norm(along);
      const Vector3d pull = stiffness / s.length * (length - s.length) / length * along;
      force[index(s.a)] += pull;
      force[index(s.b)] -= pull;
    }
    for (std::size_t n = 0; n < nodes.size(); ++n)
      for (int axis = 0; axis < 3; ++axis) {
        NodeRecord& record = nodes.record[n];
        nodes.velocity_before[n].component[axis] = record.velocity[axis];
        if ((nodes.prescribed[n] >> axis & 1) != 0) continue;
        record.velocity[axis] += dt * (force[n][axis] * record.inverse_mass + gravity[axis]);
        record.velocity[axis] *= 1 - dt * damping;
      }
  }

  void move(double dt) {
    for (std::size_t n = 0; n < nodes.size(); ++n)
      for (int axis = 0; axis < 3; ++axis)
        nodes.record[n].position[axis] += dt * nodes.record[n].velocity[axis];
  }
  void step(double dt, ThreadTeam& team) {
    accelerate(dt);
    resolve(scene, nodes, dt, team);
    EXPECT_EQ(scene.unresolved.steps, 0) << "surfaces cross";
    move(dt);
  }
  void step(double dt) { step(dt, alone_); }

  Vector3d x(int n) const { return vector_at(nodes.record[index(n)].position); }
  Vector3d v(int n) const { return vector_at(nodes.record[index(n)].velocity); }
  void set_velocity(int n, const Vector3d& value) {
    for (int axis = 0; axis < 3; ++axis) nodes.record[index(n)].velocity[axis] = value[axis];
  }
  double mass(int n) const { return nodes.mass[index(n)]; }

  double kinetic_energy() const {
    double sum = 0;
    for (int n = 0; n < count(); ++n) sum += 0.5 * mass(n) * squared_norm(v(n));
    return sum;
  }
  double spring_energy() const {
    double sum = 0;
    for (const Spring& s : springs_) {
      if (s.broken) continue;
      const double stretch = norm(x(s.a) - x(s.b)) - s.length;
      sum += 0.5 * stiffness / s.length * stretch * stretch;
    }
    return sum;
  }
  Vector3d momentum(int first = 0, int end = -1) const {
    Vector3d sum{};
    for (int n = first; n < (end < 0 ? count() : end); ++n) sum += mass(n) * v(n);
    return sum;
  }
  Vector3d angular_momentum() const {
    Vector3d sum{};
    for (int n = 0; n < count(); ++n) sum += mass(n) * cross(x(n), v(n));
    return sum;
  }
  Vector3d mean_velocity(int first, int end) const {
    double total = 0;
    for (int n = first; n < end; ++n) total += mass(n);
    return momentum(first, end) / total;
  }
  Vector3d centre(int first, int end) const {
    Vector3d sum{};
    double total = 0;
    for (int n = first; n < end; ++n) {
      sum += mass(n) * x(n);
      total += mass(n);
    }
    return sum / total;
  }

 private:
  struct Piece {
    bool shell = false;
    std::vector<int> connectivity;
    std::vector<double> thickness;
    int first_spring = 0;  ///< those of element after element, then those against bending
    std::size_t first_bending = 0, end = 0;
  };
  struct Spring {
    int a, b;
    double length = 0;
    bool broken = false;
  };

  void add_node(const Vector3d& position) {
    position_.push_back(position);
    mass_.push_back(0);
    velocity_.push_back(Vector3d{});
  }

  /// Shells between the nodes at(i, j), with `mass` to each corner of each; `closed`: column nx is column 0.
  template <class At>
  void add_shells(int nx, int ny, double thickness, double mass, const At& at, bool closed) {
    Piece& piece = pieces_.emplace_back();
    piece.shell = true;
    piece.first_spring = static_cast<int>(springs_.size());
    for (int j = 0; j < ny; ++j)
      for (int i = 0; i < nx; ++i) {
        const int corner[4] = {at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)};
        piece.thickness.push_back(thickness);
        for (int a : corner) {
          piece.connectivity.push_back(a);
          mass_[index(a)] += mass;
        }
        for (int a = 0; a < 4; ++a)
          for (int b = 0; b < a; ++b) add_spring(corner[a], corner[b]);
      }
    piece.first_bending = springs_.size();
    for (int j = 0; j <= ny; ++j)
      for (int i = 0; i < nx + (closed ? 0 : 1); ++i) {
        if (closed || i + 2 <= nx) add_spring(at(i, j), at(i + 2, j));
        if (j + 2 <= ny) add_spring(at(i, j), at(i, j + 2));
      }
    piece.end = springs_.size();
  }

  void add_spring(int a, int b) { springs_.push_back({.a = a, .b = b}); }

  std::vector<Vector3d> position_, velocity_;
  std::vector<double> mass_;
  std::vector<Piece> pieces_;
  std::vector<Spring> springs_;
  ThreadTeam alone_{1};
};

}  // namespace brio::test
