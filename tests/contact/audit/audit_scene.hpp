#pragma once
/// Scenes of a few elements at positions of choice, for the audit.

#include <functional>
#include <string>
#include <vector>

#include "contact/audit/audit.hpp"
#include "contact/scene.hpp"
#include "src/base/index.hpp"

namespace brio::test {

class AuditScene {
 public:
  using Map = std::function<Vector3d(const Vector3d&)>;

  ContactOptions options;
  std::vector<PairRule> rules;
  Nodes nodes;
  ContactScene scene;

  /// Parts, in the order of the surface: those of hexahedra first. \returns the number of the part.
  int add_box(std::array<int, 3> cells, const Vector3d& size, const Map& map) {
    const int nx = cells[0], ny = cells[1], nz = cells[2];
    const int first = count();
    for (int k = 0; k <= nz; ++k)
      for (int j = 0; j <= ny; ++j)
        for (int i = 0; i <= nx; ++i)
          position_.push_back(map({size[0] * i / nx, size[1] * j / ny, size[2] * k / nz}));
    const auto at = [&](int i, int j, int k) { return first + i + (nx + 1) * (j + (ny + 1) * k); };
    Piece& piece = add_piece(8);
    for (int k = 0; k < nz; ++k)
      for (int j = 0; j < ny; ++j)
        for (int i = 0; i < nx; ++i)
          for (int node :
               {at(i, j, k), at(i + 1, j, k), at(i + 1, j + 1, k), at(i, j + 1, k), at(i, j, k + 1),
                at(i + 1, j, k + 1), at(i + 1, j + 1, k + 1), at(i, j + 1, k + 1)})
            piece.connectivity.push_back(node);
    return parts() - 1;
  }
  int add_sheet(std::array<int, 2> cells, std::array<double, 2> size, double thickness, const Map& map) {
    const int nx = cells[0], ny = cells[1];
    const int first = count();
    for (int j = 0; j <= ny; ++j)
      for (int i = 0; i <= nx; ++i) position_.push_back(map({size[0] * i / nx, size[1] * j / ny, 0}));
    Piece& piece = add_piece(4);
    for (int j = 0; j < ny; ++j)
      for (int i = 0; i < nx; ++i) {
        const int corner = first + i + (nx + 1) * j;
        for (int node : {corner, corner + 1, corner + nx + 2, corner + nx + 1})
          piece.connectivity.push_back(node);
        piece.thickness.push_back(thickness);
      }
    return parts() - 1;
  }
  /// Beams from point to point.
  int add_beams(const std::vector<Vector3d>& points, double radius) {
    const int first = count();
    position_.insert(position_.end(), points.begin(), points.end());
    Piece& piece = add_piece(2);
    for (int i = 1; i < static_cast<int>(points.size()); ++i) {
      piece.connectivity.push_back(first + i - 1);
      piece.connectivity.push_back(first + i);
      piece.thickness.push_back(2 * radius);
    }
    return parts() - 1;
  }
  int add_particles(const std::vector<Vector3d>& points, double radius) {
    const int first = count();
    position_.insert(position_.end(), points.begin(), points.end());
    Piece& piece = add_piece(1);
    for (int i = 0; i < static_cast<int>(points.size()); ++i) {
      piece.connectivity.push_back(first + i);
      piece.thickness.push_back(2 * radius);
    }
    return parts() - 1;
  }
  void make_rigid(int part, int body) { piece_[index(part)].rigid = body; }

  int count() const { return static_cast<int>(position_.size()); }
  int parts() const { return static_cast<int>(piece_.size()); }
  int first_node(int part) const { return piece_[index(part)].connectivity.front(); }
  const std::vector<Vector3d>& positions() const { return position_; }

  /// After everything is added.
  void start() {
    nodes = Nodes(position_.size(), false);
    for (std::size_t n = 0; n < position_.size(); ++n) {
      nodes.mass[n] = 1;
      nodes.record[n].inverse_mass = 1;
      place(static_cast<int>(n), position_[n]);
    }
    std::vector<SurfacePart> surface_parts;
    for (const Piece& piece : piece_)
      surface_parts.push_back({.name = "part " + std::to_string(surface_parts.size()),
                               .nodes_per_element = piece.nodes_per_element,
                               .connectivity = piece.connectivity,
                               .thickness = piece.thickness,
                               .rigid = piece.rigid});
    scene = make_contact_scene(options, surface_parts, nodes);
    scene.surface.pairs = PairTable(rules, surface_parts, nodes.size());
  }
  /// Let contact find what it leaves out: nothing moves.
  void step() {
    ThreadTeam team(1);
    nodes.velocity_before = AlignedBuffer<NodeVector>(nodes.size());
    resolve(scene, nodes, 1e-6, team);
  }
  void place(int node, const Vector3d& x) {
    position_[index(node)] = x;
    for (int axis = 0; axis < 3; ++axis) nodes.record[index(node)].position[axis] = x[axis];
  }
  void place_all(const Map& map) {
    for (int n = 0; n < count(); ++n) place(n, map(position_[index(n)]));
  }

  Audit found(int threads = 1) const {
    ThreadTeam team(threads);
    return audit(scene, nodes, team);
  }

 private:
  struct Piece {
    int nodes_per_element;
    std::vector<int> connectivity;
    std::vector<double> thickness;
    int rigid = -1;
  };
  Piece& add_piece(int nodes_per_element) {
    return piece_.emplace_back(
        Piece{.nodes_per_element = nodes_per_element, .connectivity = {}, .thickness = {}});
  }

  std::vector<Vector3d> position_;
  std::vector<Piece> piece_;
};

inline AuditScene::Map moved(const Vector3d& by) {
  return [by](const Vector3d& x) -> Vector3d { return x + by; };
}

}  // namespace brio::test
